// scatter.cpp: surfaces described by lobes: light from the lights, then the rays that go on. The other half of TileRenderer.
//
// Transports. Direct: lights alone. Whitted: every mirror image and refraction is followed, deterministically, until a branch
// carries less than `energyCut` of the camera ray. Path: also a direction from each diffuse lobe; where a path has split already
// one way is chosen with a probability in proportion to its weight, and from the fourth surface on Russian roulette ends paths.
#include "render/scatter.h"

#include <algorithm>

#include "render/paths.h"
#include "render/sampler.h"
#include "render/shadows.h"

namespace openrt {
namespace {

constexpr float energyCut = 1.0f / 4096;
constexpr uint32_t rouletteFrom = 3;
constexpr uint32_t maximumWays = 2 * RTS_MAX_LOBES;

// A direction in which a path may go on.
struct Way {
  float direction[3], weight[3], density;
  bool bent, lost; // lost: below the facet
  uint32_t lobe;
};

float largest(const float v[3]) { return std::max({v[0], v[1], v[2]}); }

bool weightAt(const RtsLobe& lobe, uint32_t i, float out[3]) {
  bool any = false;
  for (int k = 0; k < 3; k++) {
    const float w = lobe.weight[k][i];
    out[k] = w > 0 && std::isfinite(w) ? w : 0.0f;
    any |= out[k] > 0;
  }
  return any;
}

class Ways {
 public:
  Ways(const RtsHits& hits, uint32_t i) {
    for (int k = 0; k < 3; k++) d_[k] = hits.direction[k][i], g_[k] = hits.geometric[k][i];
  }
  // u, v: a point of the unit square for the diffuse lobe; below 0: light between diffuse surfaces is not followed.
  void add(uint32_t number, const RtsLobe& lobe, uint32_t i, float u, float v) {
    float w[3];
    if (!weightAt(lobe, i, w)) return;
    lobe_ = number;
    const float n[3] = {lobe.normal[0][i], lobe.normal[1][i], lobe.normal[2][i]};
    switch (lobe.kind) {
    case RTS_LOBE_DIFFUSE:
      if (u >= 0) diffuse(n, w, u, v), random = true;
      break;
    case RTS_LOBE_REFLECTION: mirror(n, w, 1); break;
    case RTS_LOBE_DIELECTRIC: dielectric(n, w, lobe.parameter[0][i]); break;
    case RTS_LOBE_TRANSPARENT: put(d_, w, 1, false); break;
    default: break;
    }
  }

  Way list[maximumWays];
  uint32_t count = 0;
  bool random = false;

 private:
  void put(const float direction[3], const float w[3], float factor, bool bent) {
    Way& way = list[count++];
    for (int k = 0; k < 3; k++) way.direction[k] = direction[k], way.weight[k] = w[k] * factor;
    way.density = 0, way.bent = bent, way.lost = false, way.lobe = lobe_;
  }
  // Density cosine / pi against a response of albedo / pi: what is left is the albedo.
  void diffuse(const float n[3], const float w[3], float u, float v) {
    float out[3];
    cosineDirection(n, u, v, out);
    put(out, w, 1, true);
    list[count - 1].density = std::max(dot3(out, n), 0.0f) * float(M_1_PI);
    list[count - 1].lost = !(dot3(out, g_) > 0);
  }
  // A bent normal may lead below the facet: then the facet's own is used.
  void mirror(const float n[3], const float w[3], float factor) {
    float out[3];
    reflectAt(d_, n, out);
    if (!(dot3(out, g_) > 0)) reflectAt(d_, g_, out);
    put(out, w, factor, true);
  }
  // Radiance is compressed by the square of the index where it enters a denser medium (R. Siegel, J. Howell, "Thermal Radiation
  // Heat Transfer", on n^2): a ray that goes on behind carries eta^2 of it back.
  void dielectric(const float n[3], const float w[3], float eta) {
    if (!(eta > 0) || !std::isfinite(eta)) eta = 1;
    const double cosine = std::min(1.0, std::max(0.0, -double(dot3(d_, n))));
    double behind;
    const double r = fresnel(cosine, eta, behind);
    if (r > 0) mirror(n, w, float(r));
    if (r >= 1) return;
    float out[3];
    refractAt(d_, n, eta, cosine, behind, out);
    if (dot3(out, g_) < 0) put(out, w, float((1 - r) * eta * eta), true);
  }

  float d_[3], g_[3];
  uint32_t lobe_ = 0;
};

} // namespace

// Lights answer Lambert's law: a light's colour is the radiance of a white surface that faces it (openrts.h).
void TileRenderer::addLights(RtsBatch& batch, const RtsHits& hits, float* const radiance[3]) {
  bool diffuse = false;
  for (uint32_t l = 0; l < batch.lobeCount; l++) diffuse |= batch.lobes[l].kind == RTS_LOBE_DIFFUSE;
  const uint32_t lights = diffuse ? scene_.host.lights(&batch) : 0;
  auto* wanted = arena_.take<uint8_t>(padded(hits.count));
  for (uint32_t light = 0; light < lights; light++) {
    RtsIllumination from{};
    scene_.host.illuminate(&batch, light, &hits, &from);
    const auto cosine = [&](const RtsLobe& lobe, uint32_t i) {
      float c = 0;
      for (int k = 0; k < 3; k++) c += lobe.normal[k][i] * from.toLight[k][i];
      return c;
    };
    for (uint32_t i = 0; i < hits.count; i++) {
      wanted[i] = 0;
      float w[3];
      for (uint32_t l = 0; l < batch.lobeCount; l++)
        if (batch.lobes[l].kind == RTS_LOBE_DIFFUSE && cosine(batch.lobes[l], i) > 0 && weightAt(batch.lobes[l], i, w))
          wanted[i] = 1;
    }
    scene_.host.shadow(&batch, light, &hits, wanted, &from);
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      if (batch.lobes[l].kind != RTS_LOBE_DIFFUSE) continue;
      for (uint32_t i = 0; i < hits.count; i++) {
        float w[3];
        const float c = cosine(batch.lobes[l], i);
        if (!(c > 0) || !weightAt(batch.lobes[l], i, w)) continue;
        for (int k = 0; k < 3; k++) radiance[k][i] += w[k] * c * from.color[k][i];
      }
    }
  }
}

void TileRenderer::scatterRange(Paths& paths, const Points& points, const Bucket& bucket, const uint32_t* order) {
  const RtsHits& hits = points.hits;
  const uint32_t size = padded(hits.count);
  RtsSurface surface;
  float* radiance[3];
  for (int k = 0; k < 3; k++) {
    radiance[k] = surface.emission[k] = arena_.takeZero<float>(size);
    surface.albedo[k] = film_.has(RT_ALBEDO) ? arena_.takeZero<float>(size) : nullptr;
  }
  RtsBatch batch = makeBatch();
  batch.points = &points;
  batch.lightSet = bucket.lightSet;
  bucket.shaderClass->surface(&scene_.host, &batch, &hits, &surface);
  for (uint32_t i = 0; i < hits.count; i++) {
    const float share = chanceMet(paths.state[order[i]], points, i);
    for (int k = 0; k < 3; k++) radiance[k][i] *= share;
  }
  addLights(batch, hits, radiance);
  float* chance[RTS_MAX_LOBES] = {};
  const bool emitters = scene_.frame.transport == RT_TRANSPORT_PATH && scene_.emitters.any() && level_ < scene_.frame.depth;
  for (uint32_t l = 0; emitters && l < batch.lobeCount; l++)
    if (batch.lobes[l].kind == RTS_LOBE_DIFFUSE) chance[l] = arena_.takeZero<float>(size);
  for (uint32_t i = 0; i < hits.count; i++) sendOn(batch, points, i, order[i], paths, chance);
  if (emitters) addEmitters(batch, points, order, paths, chance, radiance);
  float* fog[4];
  attenuate(points, paths, order, fog);
  for (uint32_t i = 0; i < hits.count; i++) {
    const RayState& ray = paths.state[order[i]];
    float clear[3] = {0, 0, 0}, seen[3] = {0, 0, 0}, covered = 0; // straight behind; there, in mirrors and through lenses
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      float w[3];
      if (batch.lobes[l].kind == RTS_LOBE_DIFFUSE || !weightAt(batch.lobes[l], i, w)) continue;
      for (int k = 0; k < 3; k++) seen[k] += w[k], clear[k] += batch.lobes[l].kind == RTS_LOBE_TRANSPARENT ? w[k] : 0.0f;
    }
    for (int k = 0; k < 3; k++) {
      float light = std::isfinite(radiance[k][i]) ? radiance[k][i] : 0.0f;
      // Fog counts the whole length of a path: what is seen beyond brings the air's light of the way to here with it.
      if (fog[3]) light = fog[3][i] * light + (1 - fog[3][i]) * fog[k][i] * (1 - std::min(seen[k], 1.0f));
      paths.radiance[k][ray.path] += ray.throughput[k] * light;
      covered += ray.throughput[k] * (1 - std::min(clear[k], 1.0f));
    }
    if (!ray.bent) paths.alpha[ray.path] += covered / 3;
    if (paths.first[ray.path]) noteFirst(points, i, ray.path, surface.albedo, paths);
  }
}

// The share of a surface's own light that belongs to the ray: the rest comes from those who choose places on emitters.
float TileRenderer::chanceMet(const RayState& ray, const Points& points, uint32_t i) const {
  if (!(ray.density > 0)) return 1;
  const uint32_t lane = points.order[i];
  const RtsHits& h = points.hits;
  const float direction[3] = {h.direction[0][i], h.direction[1][i], h.direction[2][i]};
  const float chosen =
      scene_.emitters.density(ray.from, points.rayHits->record[lane], points.rayHits->primitive[lane], direction, h.segment[i]);
  return std::isfinite(chosen) ? ray.density / (ray.density + chosen) : 0.0f;
}

void TileRenderer::sampleAt(uint32_t path, uint32_t pair, float& u, float& v) const {
  const uint32_t sample = firstSample_ + path % samples_;
  PairSampler(pixels_[path / samples_], pair, replicates_.seedOf(sample))(replicates_.indexOf(sample), u, v);
}

// The rays that go on from hit i: all of them, or one of them chosen. chance: of each lobe's direction to be followed.
void TileRenderer::sendOn(const RtsBatch& batch, const Points& points, uint32_t i, uint32_t lane, Paths& paths,
                          float* const chance[]) {
  const RayState ray = paths.state[lane];
  const bool path = scene_.frame.transport == RT_TRANSPORT_PATH, direct = scene_.frame.transport == RT_TRANSPORT_DIRECT;
  float u = -1, v = -1, choice = 0, survival = 0;
  if (path) {
    sampleAt(ray.path, pairOf(ray, Draw::direction), u, v);
    sampleAt(ray.path, pairOf(ray, Draw::choice), choice, survival);
  }
  Ways ways(points.hits, i);
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    if (!direct || batch.lobes[l].kind == RTS_LOBE_TRANSPARENT) ways.add(l, batch.lobes[l], i, u, v);
  if (ways.random) paths.random[ray.path] = 1;
  float carried[maximumWays], sum = 0;
  for (uint32_t w = 0; w < ways.count; w++) {
    const Way& way = ways.list[w];
    const float left[3] = {way.weight[0] * ray.throughput[0], way.weight[1] * ray.throughput[1],
                           way.weight[2] * ray.throughput[2]};
    sum += carried[w] = largest(left);
  }
  if (!(sum > 0)) return;
  const bool all = !path || ways.count == 1 || ray.splits == 0;
  for (uint32_t w = 0; w < ways.count; w++)
    if (chance[ways.list[w].lobe]) chance[ways.list[w].lobe][i] = all ? 1 : carried[w] / sum;
  const auto send = [&](uint32_t w, float probability) {
    const Way& way = ways.list[w];
    float kept = probability;
    if (path && level_ >= rouletteFrom) {
      const float stay = std::min(1.0f, carried[w] / probability);
      if (stay < 1) paths.random[ray.path] = 1;
      if (survival >= stay) return;
      kept *= stay;
    } else if (!path && carried[w] < energyCut) {
      return;
    }
    if (way.lost) return;
    Step step{.density = way.density * probability,
              .bent = way.bent,
              .split = ways.count > 1,
              .branch = w == 0 ? ray.branch : hash(ray.branch + w, level_ + 1)};
    for (int k = 0; k < 3; k++) step.direction[k] = way.direction[k], step.weight[k] = way.weight[k] / kept;
    push(points, i, lane, step, paths);
  };
  if (all) {
    for (uint32_t w = 0; w < ways.count; w++) send(w, 1);
    return;
  }
  paths.random[ray.path] = 1;
  float at = choice * sum;
  uint32_t chosen = 0;
  while (chosen + 1 < ways.count && at >= carried[chosen]) at -= carried[chosen++];
  if (carried[chosen] > 0) send(chosen, carried[chosen] / sum);
}

} // namespace openrt
