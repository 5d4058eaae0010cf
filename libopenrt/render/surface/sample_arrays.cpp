#include "render/surface/sample_arrays.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface/sample_arrays.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/directions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// Fresnel's equations and refraction need double precision near the critical angle (scatter.h). So
// the lanes are doubles, and half as many floats.
using DoublesTag = hn::CappedTag<double, lanes>;
using FloatsTag = hn::Rebind<float, DoublesTag>;
using Doubles = hn::Vec<DoublesTag>;
using Floats = hn::Vec<FloatsTag>;
using FloatsVec = Vec3<Floats>;
using DoublesVec = Vec3<Doubles>;

Floats loadFloats(const float* from) { return hn::LoadU(FloatsTag(), from); }
FloatsVec loadFloats(const float* const from[3], uint32_t i) {
  return {loadFloats(from[0] + i), loadFloats(from[1] + i), loadFloats(from[2] + i)};
}
void storeFloats(Floats v, float* to) { hn::StoreU(v, FloatsTag(), to); }
void storeFloats(const FloatsVec& v, float* const to[3], uint32_t i) {
  storeFloats(v.x, to[0] + i);
  storeFloats(v.y, to[1] + i);
  storeFloats(v.z, to[2] + i);
}
Doubles promote(Floats v) { return hn::PromoteTo(DoublesTag(), v); }
DoublesVec promote(const FloatsVec& v) { return {promote(v.x), promote(v.y), promote(v.z)}; }
Floats demote(Doubles v) { return hn::DemoteTo(FloatsTag(), v); }
FloatsVec demote(const DoublesVec& v) { return {demote(v.x), demote(v.y), demote(v.z)}; }

// Calls f with the first hit of each group of lanes.
template <class F> void forEachGroup(uint32_t count, const F& f) {
  for (uint32_t i = 0; i < count; i += uint32_t(hn::Lanes(DoublesTag()))) f(i);
}

// Returns the cosine of the angle of incidence, between 0 and 1.
Doubles incidence(const FloatsVec& d, const FloatsVec& n) {
  const Doubles zero = constant<Doubles>(0);
  return min(constant<Doubles>(1), max(zero, zero - promote(dot(d, n))));
}

// Reflects directions at shading normals; at the facets' own normals where the shading normal
// reflects below the facet.
template <class V> Vec3<V> mirrored(const Vec3<V>& d, const Vec3<V>& n, const Vec3<V>& g) {
  const Vec3<V> out = reflectAt(d, n);
  return select(dot(out, g) > constant<V>(0), out, reflectAt(d, g));
}

} // namespace

void mirrorLanes(const RtsHits& hits, const RtsLobe& lobe, float* const direction[3]) {
  for (uint32_t i = 0; i < hits.count; i += width())
    store(mirrored(load(hits.direction, i), load(lobe.normal, i), load(hits.geometric, i)),
          direction, i);
}

// Radiance is scaled by the squared relative index where it enters a denser medium (R. Siegel, J.
// Howell, "Thermal Radiation Heat Transfer", on n^2). So a refracted ray has the weight eta^2.
void boundaryLanes(const RtsHits& hits, const RtsLobe& lobe, const float* etas, TransportMode mode,
                   const BoundarySamples& out) {
  forEachGroup(hits.count, [&](uint32_t i) {
    const Floats zero = constant<Floats>(0), one = constant<Floats>(1);
    const FloatsVec d = loadFloats(hits.direction, i), n = loadFloats(lobe.normal, i),
                    g = loadFloats(hits.geometric, i);
    const Floats given = loadFloats(etas + i);
    const auto known =
        hn::And(given > zero, given <= constant<Floats>(std::numeric_limits<float>::max()));
    const Doubles eta = promote(select(known, given, one)), cosine = incidence(d, n);
    Doubles behind;
    const Doubles r = fresnel(cosine, eta, behind), all = constant<Doubles>(1);
    const FloatsVec refracted = demote(refractAt(promote(d), promote(n), eta, cosine, behind));
    const Floats refractedShare =
        demote(mode == TransportMode::radiance ? (all - r) * eta * eta : all - r);
    storeFloats(mirrored(d, n, g), out.reflected, i);
    storeFloats(demote(r), out.reflectedShare + i);
    storeFloats(refracted, out.refracted, i);
    storeFloats(select(dot(refracted, g) < zero, refractedShare, zero), out.refractedShare + i);
  });
}

void glossyLanes(const RtsHits& hits, const RtsLobe& lobe, float* share) {
  forEachGroup(hits.count, [&](uint32_t i) {
    const Floats eta = loadFloats(lobe.parameter[1] + i), one = constant<Floats>(1);
    const auto coated = eta > constant<Floats>(0);
    Floats out = one;
    if (!hn::AllFalse(FloatsTag(), coated)) {
      Doubles behind;
      const Doubles cosine = incidence(loadFloats(hits.direction, i), loadFloats(lobe.normal, i));
      out = select(coated, demote(fresnel(cosine, promote(eta), behind)), one);
    }
    storeFloats(out, share + i);
  });
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

HWY_EXPORT(mirrorLanes);
HWY_EXPORT(boundaryLanes);
HWY_EXPORT(glossyLanes);

void sampleMirror(const RtsHits& hits, const RtsLobe& lobe, float* const direction[3]) {
  HWY_DYNAMIC_DISPATCH(mirrorLanes)(hits, lobe, direction);
}

void sampleBoundary(const RtsHits& hits, const RtsLobe& lobe, const float* eta, TransportMode mode,
                    const BoundarySamples& out) {
  HWY_DYNAMIC_DISPATCH(boundaryLanes)(hits, lobe, eta, mode, out);
}

void expectGlossy(const RtsHits& hits, const RtsLobe& lobe, float* share) {
  HWY_DYNAMIC_DISPATCH(glossyLanes)(hits, lobe, share);
}

Vec3f SampleArrays::weightAt(uint32_t i) const {
  Vec3f weight;
  openrt::weightAt(*lobe, i, weight);
  for (uint32_t k = 0; k < 3; k++) {
    if (colour && colour != k + 1)
      weight[k] = 0;
    else if (const float* factor = valueOf(k))
      weight[k] *= factor[i];
  }
  return weight;
}

bool SampleArrays::isConsistentAt(const RtsHits& hits, uint32_t i) const {
  if (!pdf) return true;
  const Vec3f out = load(direction, i), g = load(hits.geometric, i);
  if (!(pdf[i] > 0)) return false;
  return dot(out, load(lobe->normal, i)) > 0 ? dot(out, g) > 0 : transmits && dot(out, g) < 0;
}

BsdfSampleArrays::BsdfSampleArrays(const RtsBatch& batch, const LobeSampling& sampling,
                                   const Boundaries& boundaries, TransportMode mode,
                                   bool onlyStraight)
    : batch_(batch), mode_(mode),
      list_(batch.arena.take<SampleArrays>(mostOfLobe * batch.lobes.size())) {
  for (uint32_t l = 0; l < batch.lobes.size(); l++)
    if (!onlyStraight || batch.lobes[l].kind == RTS_LOBE_TRANSPARENT)
      addLobe(l, sampling, boundaries);
}

void BsdfSampleArrays::addLobe(uint32_t number, const LobeSampling& sampling,
                               const Boundaries& boundaries) {
  const RtsLobe& lobe = batch_.lobes[number];
  const RtsHits& hits = batch_.points->hits;
  const LobeSamples* samples = sampling.samples[number];
  switch (lobe.kind) {
  case RTS_LOBE_TRANSPARENT: add(lobe, hits.direction, nullptr).deflected = false; return;
  case RTS_LOBE_DIELECTRIC: return addBoundary(lobe, boundaries);
  case RTS_LOBE_REFLECTION: {
    float* const direction[3] = {take<float>(), take<float>(), take<float>()};
    sampleMirror(hits, lobe, direction);
    add(lobe, direction, nullptr);
    return;
  }
  default: break;
  }
  if (!samples) return;
  SampleArrays& sample = add(lobe, samples->direction, nullptr);
  std::copy_n(samples->value, 3, sample.value);
  sample.pdf = samples->pdf;
  sample.transmits = nonSpecularFunctions(lobe)->transmits != 0;
  sample.probability = take<float>();
  sample.selectionProbability = sampling.selectionProbability[number];
  if (lobe.kind != RTS_LOBE_GLOSSY) return;
  auto* share = take<float>();
  expectGlossy(hits, lobe, share);
  sample.share = share;
}

void BsdfSampleArrays::addBoundary(const RtsLobe& lobe, const Boundaries& boundaries) {
  if (boundaries.disperses) return addDispersion(lobe, boundaries);
  const BoundarySamples both = sampleBoundary(lobe, lobe.parameter[0]);
  add(lobe, both.reflected, both.reflectedShare);
  add(lobe, both.refracted, both.refractedShare);
}

// Where the indices of the media differ by colour, every colour is refracted separately. All are
// reflected in one direction.
void BsdfSampleArrays::addDispersion(const RtsLobe& lobe, const Boundaries& boundaries) {
  BoundarySamples byColour[3];
  for (uint32_t k = 0; k < 3; k++) {
    auto* eta = take<float>();
    for (uint32_t i = 0; i < hitCount(); i++)
      eta[i] = boundaries.disperses[i] ? boundaries.eta[i][k] : lobe.parameter[0][i];
    byColour[k] = sampleBoundary(lobe, eta);
  }
  auto *most = take<float>(), *together = take<float>();
  for (uint32_t i = 0; i < hitCount(); i++) {
    most[i] = std::max({byColour[0].reflectedShare[i], byColour[1].reflectedShare[i],
                        byColour[2].reflectedShare[i]});
    together[i] = boundaries.disperses[i] ? 0 : byColour[0].refractedShare[i];
    for (const BoundarySamples& one : byColour)
      if (!boundaries.disperses[i]) one.refractedShare[i] = 0;
  }
  SampleArrays& reflected = add(lobe, byColour[0].reflected, most);
  for (uint32_t k = 0; k < 3; k++) reflected.value[k] = byColour[k].reflectedShare;
  add(lobe, byColour[0].refracted, together);
  for (uint32_t k = 0; k < 3; k++)
    add(lobe, byColour[k].refracted, byColour[k].refractedShare).colour = k + 1;
}

BoundarySamples BsdfSampleArrays::sampleBoundary(const RtsLobe& lobe, const float* eta) const {
  BoundarySamples out;
  for (auto* group : {out.reflected, out.refracted})
    for (int k = 0; k < 3; k++) group[k] = take<float>();
  out.reflectedShare = take<float>();
  out.refractedShare = take<float>();
  openrt::sampleBoundary(batch_.points->hits, lobe, eta, mode_, out);
  return out;
}

SampleArrays& BsdfSampleArrays::add(const RtsLobe& lobe, const float* const direction[3],
                                    const float* share) {
  SampleArrays& sample = list_[count_++];
  sample = {.lobe = &lobe, .direction = {direction[0], direction[1], direction[2]}};
  sample.share = share;
  sample.number = take<uint32_t>();
  sample.kept = take<float>();
  return sample;
}

} // namespace openrt
#endif
