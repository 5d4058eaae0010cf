// hit_info.cpp: data about hits that shaders may request beyond RtsHits; computed on request.
// Called by host.cpp. [render]
#include "render/surface/hit_info.h"

#include <algorithm>
#include <cmath>

#include "render/wave/batch.h"

namespace openrt {
namespace {

// Fills three arrays of a batch without hits; `arrays` may be null.
void fillVectors(const RtsBatch& batch, float* const arrays[3], float value) {
  for (int k = 0; arrays && k < 3; k++) std::fill_n(arrays[k], batch.lanes.count, value);
}
void fillNumbers(const RtsBatch& batch, uint32_t* array, uint32_t value) {
  if (array) std::fill_n(array, batch.lanes.count, value);
}

const Record& recordAt(const RtsBatch& batch, uint32_t i) {
  return batch.scene.records[batch.points->record[batch.pointOf(i)]];
}
uint32_t primitiveAt(const RtsBatch& batch, uint32_t i) {
  return batch.points->rayHits->primitive[batch.points->order[batch.pointOf(i)]];
}

void triangleDerivatives(const RtsBatch& batch, uint32_t i, float* const alongS[3],
                         float* const alongT[3]) {
  const Record& r = recordAt(batch, i);
  if (!r.texCoords) return;
  const uint32_t primitive = primitiveAt(batch, i);
  const auto p = r.cornersOf(primitive);
  const uint32_t* corner = r.indices + 3 * size_t(primitive);
  const float *a = r.texCoords + 2 * size_t(corner[0]), *b = r.texCoords + 2 * size_t(corner[1]),
              *c = r.texCoords + 2 * size_t(corner[2]);
  const double s1 = double(b[0]) - a[0], t1 = double(b[1]) - a[1], s2 = double(c[0]) - a[0],
               t2 = double(c[1]) - a[1];
  const double area = s1 * t2 - s2 * t1;
  if (area == 0) return;
  const Vec3d e1 = Vec3d(p[1]) - Vec3d(p[0]), e2 = Vec3d(p[2]) - Vec3d(p[0]);
  store(Vec3f((t2 * e1 - t1 * e2) / area), alongS, i);
  store(Vec3f((s1 * e2 - s2 * e1) / area), alongT, i);
}

// Computes the derivatives of the position by the texture coordinates of rtSphere.
void sphereDerivatives(const RtsBatch& batch, uint32_t i, float* const alongS[3],
                       float* const alongT[3]) {
  const Record& r = recordAt(batch, i);
  const Vec3f position = load(batch.points->hits.position, batch.pointOf(i));
  const Vec3d at = r.frames->fromRender.pointFromTranslation(Vec3d(position));
  if (!(length(at) > 0)) return;
  const Vec3d l = normalize(at);
  const double round = std::hypot(l.x, l.z), slope = round > 0 ? -l.y / round : 0;
  const Vec3d s{2 * M_PI * l.z, 0, -2 * M_PI * l.x},
      t{M_PI * slope * l.x, M_PI * round, M_PI * slope * l.z};
  store(Vec3f(r.frames->toRender.direction(s)), alongS, i);
  store(Vec3f(r.frames->toRender.direction(t)), alongT, i);
}

// Computes the derivatives of the position by the texture coordinates of a quadric or an asphere.
void analyticDerivatives(const RtsBatch& batch, uint32_t i, float* const alongS[3],
                         float* const alongT[3]) {
  const Record& r = recordAt(batch, i);
  const Vec3f position = load(batch.points->hits.position, batch.pointOf(i));
  const auto tangents = r.surface->tangentsAt(r.frames->fromRender.point(Vec3d(position)));
  store(Vec3f(r.frames->toRender.direction(tangents.alongS)), alongS, i);
  store(Vec3f(r.frames->toRender.direction(tangents.alongT)), alongT, i);
}

} // namespace

void localOf(const RtsBatch& batch, float* const position[3], float* const normal[3]) {
  if (!batch.points) {
    fillVectors(batch, position, 0);
    fillVectors(batch, normal, 0);
    return;
  }
  const RtsHits& hits = batch.points->hits;
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    const Affine& m = *recordAt(batch, i).toObject;
    const uint32_t at = batch.pointOf(i);
    if (position) store(m.point(load(hits.position, at)), position, i);
    if (normal) store(m.normal(load(hits.geometric, at)), normal, i);
  }
}

void derivativesOf(const RtsBatch& batch, float* const alongS[3], float* const alongT[3]) {
  if (!batch.points) {
    fillVectors(batch, alongS, 0);
    fillVectors(batch, alongT, 0);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    store(Vec3f(), alongS, i);
    store(Vec3f(), alongT, i);
    const edit::Primitive primitive = recordAt(batch, i).primitive;
    if (primitive == edit::Primitive::Triangles) triangleDerivatives(batch, i, alongS, alongT);
    if (primitive == edit::Primitive::Sphere) sphereDerivatives(batch, i, alongS, alongT);
    if (recordAt(batch, i).surface) analyticDerivatives(batch, i, alongS, alongT);
  }
}

void idsOf(const RtsBatch& batch, uint32_t* name, uint32_t* instance, uint32_t* primitive) {
  if (!batch.points) {
    for (uint32_t* array : {name, instance, primitive}) fillNumbers(batch, array, 0);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    const Record& r = recordAt(batch, i);
    if (name) name[i] = r.name;
    if (instance) instance[i] = r.instance;
    if (primitive) primitive[i] = primitiveAt(batch, i);
  }
}

void pathsOf(const RtsBatch& batch, uint32_t level, uint32_t* depth, float* const throughput[3]) {
  if (!batch.points) {
    fillNumbers(batch, depth, 0);
    fillVectors(batch, throughput, 1);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    if (depth) depth[i] = level;
    for (int k = 0; throughput && k < 3; k++)
      throughput[k][i] = batch.order ? batch.states->throughput[k][batch.order[i]] : 1.0f;
  }
}

} // namespace openrt
