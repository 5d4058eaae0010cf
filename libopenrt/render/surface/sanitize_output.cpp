#include "render/surface/sanitize_output.h"

#include <algorithm>
#include <cmath>

#include "render/lanes/all_finite.h"
#include "render/surface/lobes.h"

namespace openrt {
namespace {

uint32_t traitsAt(const RtsBatch& batch, uint32_t i) {
  const Record& record = batch.scene.records[batch.points->record[i]];
  return (*batch.scene.shaders)[record.shader].traits;
}

// Counts the hits with values above 0 that the class's traits do not declare.
template <class Above> void demandTrait(const RtsClass& c, RtsBatch& batch, uint32_t trait,
                                        Fault fault, const Above& above) {
  uint64_t hits = 0;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    hits += !(traitsAt(batch, i) & trait) && above(i);
  if (hits) batch.counters.faults.add(c, fault, hits);
}

bool anyAbove(float* const group[3], uint32_t i) {
  return group[0][i] > 0 || group[1][i] > 0 || group[2][i] > 0;
}

// Counts the hits with values above 0 that the class's traits exclude. Hits on geometry with
// parameter values of its own are skipped, because traits do not cover these values.
template <class Above> void excludeTrait(const RtsClass& c, RtsBatch& batch, uint32_t trait,
                                         Fault fault, const Above& above) {
  uint64_t hits = 0;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    hits += (traitsAt(batch, i) & trait) &&
            !batch.scene.records[batch.points->record[i]].parameterCount && above(i);
  if (hits) batch.counters.faults.add(c, fault, hits);
}

// Counts the hits whose emission differs from that of the hit before on the same side of the same
// geometry, although the class's traits say that it is uniform.
void demandUniformEmission(const RtsClass& c, RtsBatch& batch, const RtsSurface& out) {
  const Points& points = *batch.points;
  uint64_t hits = 0;
  for (uint32_t i = 1; i < points.hits.count; i++) {
    if (!(traitsAt(batch, i) & RTS_UNIFORM_EMISSION) || points.record[i] != points.record[i - 1] ||
        ((points.hits.flags[i] ^ points.hits.flags[i - 1]) & RTS_HIT_BACK) ||
        batch.scene.records[points.record[i]].parameterCount)
      continue;
    bool varies = false;
    for (const auto* e : out.emission)
      varies |= std::fabs(e[i] - e[i - 1]) > 1e-3f * std::fabs(e[i]);
    hits += varies;
  }
  if (hits) batch.counters.faults.add(c, Fault::varyingEmission, hits);
}

void diagnose(const RtsClass& c, RtsBatch& batch, const RtsSurface& out) {
  demandUniformEmission(c, batch, out);
  demandTrait(c, batch, RTS_EMISSIVE, Fault::undeclaredEmission,
              [&](uint32_t i) { return anyAbove(out.emission, i); });
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const RtsLobe& lobe = batch.lobes[l];
    if (lobe.kind == RTS_LOBE_TRANSPARENT)
      demandTrait(c, batch, RTS_TRANSPARENT, Fault::undeclaredTransparency,
                  [&](uint32_t i) { return anyAbove(lobe.weight, i); });
    if (nonSpecularFunctions(lobe))
      excludeTrait(c, batch, RTS_NO_SCATTER, Fault::undeclaredScattering,
                   [&](uint32_t i) { return anyAbove(lobe.weight, i); });
    if (lobe.kind == RTS_LOBE_GLOSSY || lobe.kind == RTS_LOBE_ROUGH_DIELECTRIC ||
        lobe.kind == RTS_LOBE_CUSTOM)
      demandTrait(c, batch, RTS_GLOSSY, Fault::undeclaredGlossy,
                  [&](uint32_t i) { return anyAbove(lobe.weight, i); });
  }
}

// Sets the weight of a lobe to 0 at hits where any of its numbers is not finite, and sets bad[i]
// there.
void checkLobe(RtsLobe& lobe, const RtsHits& hits, uint8_t* bad) {
  float* all[8 + RTS_MAX_LOBE_FLOATS] = {lobe.weight[0],    lobe.weight[1],   lobe.weight[2],
                                         lobe.normal[0],    lobe.normal[1],   lobe.normal[2],
                                         lobe.parameter[0], lobe.parameter[1]};
  std::copy(std::begin(lobe.data), std::end(lobe.data), all + 8);
  for (float* values : all) {
    if (!values || allFinite(values, hits.count)) continue;
    for (uint32_t i = 0; i < hits.count; i++) {
      if (std::isfinite(values[i])) continue;
      bad[i] = 1;
      values[i] = 0;
      for (int k = 0; k < 3; k++) {
        lobe.weight[k][i] = 0;
        lobe.normal[k][i] = hits.normal[k][i];
      }
    }
  }
}

void countBad(const RtsClass& c, RtsBatch& batch, const uint8_t* bad, uint32_t n) {
  const auto hits = uint64_t(std::count(bad, bad + n, uint8_t(1)));
  if (hits) batch.counters.faults.add(c, Fault::notFinite, hits);
}

void clear(std::initializer_list<float*> arrays, uint32_t n, uint8_t* bad) {
  for (float* values : arrays) {
    if (!values || allFinite(values, n)) continue;
    for (uint32_t i = 0; i < n; i++)
      if (!std::isfinite(values[i])) {
        values[i] = 0;
        bad[i] = 1;
      }
  }
}

} // namespace

void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, uint32_t n,
                    std::initializer_list<float*> arrays) {
  ArenaScope scope(batch.arena);
  auto* bad = batch.arena.takeZero<uint8_t>(n);
  clear(arrays, n, bad);
  countBad(shaderClass, batch, bad, n);
}

void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsSurface& out) {
  ArenaScope scope(batch.arena);
  const RtsHits& hits = batch.points->hits;
  auto* bad = batch.arena.takeZero<uint8_t>(hits.count);
  clear({out.emission[0], out.emission[1], out.emission[2], out.albedo[0], out.albedo[1],
         out.albedo[2]},
        hits.count, bad);
  for (uint32_t l = 0; l < batch.lobes.size(); l++) checkLobe(batch.lobes[l], hits, bad);
  countBad(shaderClass, batch, bad, hits.count);
  if (batch.scene.host.diagnose) diagnose(shaderClass, batch, out);
}

void sanitizeOutput(const RtsClass& shaderClass, RtsBatch& batch, const RtsShading& out) {
  const uint32_t n = batch.points->hits.count;
  sanitizeOutput(shaderClass, batch, n,
                 {out.radiance[0], out.radiance[1], out.radiance[2], out.transmission[0],
                  out.transmission[1], out.transmission[2], out.albedo[0], out.albedo[1],
                  out.albedo[2]});
  if (batch.scene.host.diagnose)
    demandTrait(shaderClass, batch, RTS_TRANSPARENT, Fault::undeclaredTransparency,
                [&](uint32_t i) { return anyAbove(out.transmission, i); });
}

} // namespace openrt
