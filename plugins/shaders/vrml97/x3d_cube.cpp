// x3d_cube.cpp: directions of look-ups, and rays of mirrors. Directions have the axes of render
// space, which are those of the world. [render]
#include "vrml97/x3d_cube.h"

#include <algorithm>

#include "vrml97/cube_lookup.h"

namespace vrml97 {
namespace {

bool hasOwnPicture(const X3dParams& p, uint32_t flags) {
  return sideOf(p, flags) == 1 && p.backPicture != 0;
}

// Writes the direction of the reflected ray of a lane. One that would enter the surface, because
// its shading normal is bent, is turned to the near side.
void reflect(const RtsHits* hits, const float* const normal[3], uint32_t i, float out[3]) {
  float along = 0, above = 0;
  for (int c = 0; c < 3; c++) along += hits->direction[c][i] * normal[c][i];
  for (int c = 0; c < 3; c++) {
    out[c] = hits->direction[c][i] - 2 * along * normal[c][i];
    above += out[c] * hits->geometric[c][i];
  }
  if (above < 0)
    for (int c = 0; c < 3; c++) out[c] -= 2 * above * hits->geometric[c][i];
}

float inPicture(float place) { return smaller(larger(place, 0.0f), 1.0f); }

} // namespace

void placeInCubes(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                  const float* const normal[3], RtsTexture* texture, float* const uv[2]) {
  const uint32_t lanes = wholeLanes(hits->count);
  float* direction[3];
  for (float*& d : direction) {
    d = host->scratch(batch, lanes);
    std::fill_n(d, lanes, 0.0f);
  }
  bool maps = false;
  const auto looksUp = [&](uint32_t i) {
    const X3dParams& p = x3dParamsOf(hits, i);
    return p.cubeLookup != noCube && !hasOwnPicture(p, hits->flags[i]) &&
           !(hits->flags[i] & RTS_HIT_LINE);
  };
  for (uint32_t i = 0; i < hits->count; i++) {
    if (!looksUp(i)) continue;
    const X3dParams& p = x3dParamsOf(hits, i);
    float d[3] = {normal[0][i], normal[1][i], normal[2][i]};
    if (p.cubeLookup == byReflection) reflect(hits, normal, i, d);
    for (int c = 0; c < 3; c++) direction[c][i] = d[c];
    maps |= p.cubeMap != 0;
    if (p.cubeMap != 0) continue;
    const FaceCoords look = faceCoordsOf(d[0], d[1], d[2]);
    texture[i] = p.cube[look.face];
    uv[0][i] = inPicture(look.s);
    uv[1][i] = inPicture(look.t);
  }
  if (!maps) return;
  float *u = host->scratch(batch, lanes), *v = host->scratch(batch, lanes);
  mapPlaces(lanes, direction[0], direction[1], direction[2], u, v);
  for (uint32_t i = 0; i < hits->count; i++) {
    const X3dParams& p = x3dParamsOf(hits, i);
    if (p.cubeMap == 0 || !looksUp(i)) continue;
    texture[i] = p.cubeMap;
    uv[0][i] = inPicture(u[i]);
    uv[1][i] = inPicture(v[i]);
  }
}

void findMirrors(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, Terms& t) {
  const auto mirrors = [&](uint32_t i) {
    const X3dParams& p = x3dParamsOf(hits, i);
    return p.mirror != 0 && !hasOwnPicture(p, hits->flags[i]) && !(hits->flags[i] & RTS_HIT_LINE);
  };
  uint32_t first = 0;
  while (first < hits->count && !mirrors(first)) first++;
  if (first == hits->count) return;
  const uint32_t lanes = wholeLanes(hits->count);
  auto* mirror = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
  std::fill_n(mirror, lanes, 0u);
  for (uint32_t i = first; i < hits->count; i++) {
    if (!mirrors(i)) continue;
    mirror[i] = 1;
    if (x3dParamsOf(hits, i).front.lit) continue;
    for (int c = 0; c < 3; c++) { // the colour of an unlit lane
      t.diffuse[c][i] = t.glow[c][i];
      t.glow[c][i] = 0;
    }
  }
  t.mirror = mirror;
}

MirrorColors takeMirrors(const RtsHost* host, RtsBatch* batch, const RtsHits* hits,
                         const Terms& t) {
  MirrorColors taken;
  if (!t.mirror) return taken;
  for (int c = 0; c < 3; c++) {
    taken.c[c] = host->scratch(batch, wholeLanes(hits->count));
    for (uint32_t i = 0; i < hits->count; i++) {
      taken.c[c][i] = smaller(larger(t.diffuse[c][i], 0.0f), 1.0f);
      if (t.mirror[i]) t.diffuse[c][i] = 0;
    }
  }
  return taken;
}

void addMirrored(const RtsHost* host, RtsBatch* batch, const RtsHits* hits, const Terms& t,
                 const MirrorColors& reflectance, float* const radiance[3]) {
  if (!t.mirror) return;
  const uint32_t lanes = wholeLanes(hits->count);
  auto* hit = reinterpret_cast<uint32_t*>(host->scratch(batch, lanes));
  float *direction[3], *seen[4];
  for (float*& d : direction) d = host->scratch(batch, lanes);
  for (float*& s : seen) s = host->scratch(batch, lanes);
  uint32_t rays = 0;
  for (uint32_t i = 0; i < hits->count; i++) {
    const bool bright =
        reflectance.c[0][i] > 0 || reflectance.c[1][i] > 0 || reflectance.c[2][i] > 0;
    if (!t.mirror[i] || !bright || !(t.alpha[i] > 0)) continue;
    float d[3];
    reflect(hits, t.normal, i, d);
    hit[rays] = i;
    for (int c = 0; c < 3; c++) direction[c][rays] = d[c];
    rays++;
  }
  if (rays == 0) return;
  for (uint32_t k = rays; k < wholeLanes(rays); k++) { // the padding repeats the last lane
    hit[k] = hit[rays - 1];
    for (int c = 0; c < 3; c++) direction[c][k] = direction[c][rays - 1];
  }
  RtsRequest request{};
  request.count = rays;
  request.hit = hit;
  for (int c = 0; c < 3; c++) request.direction[c] = direction[c];
  float* const rgba[4] = {seen[0], seen[1], seen[2], nullptr};
  host->trace(batch, &request, rgba);
  for (uint32_t k = 0; k < rays; k++)
    for (int c = 0; c < 3; c++)
      radiance[c][hit[k]] += t.alpha[hit[k]] * reflectance.c[c][hit[k]] * seen[c][k];
}

} // namespace vrml97
