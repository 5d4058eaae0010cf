#include "render/surface/sample_arrays.h"

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
using WordsTag = hn::Rebind<uint32_t, DoublesTag>;
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

void boundaryLanes(const RtsHits& hits, const RtsLobe& lobe, const float* etas,
                   const uint32_t* wanted, const BoundarySamples& out) {
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
    Floats reflectedShare = demote(r), refractedShare = demote((all - r) * eta * eta);
    refractedShare = select(dot(refracted, g) < zero, refractedShare, zero);
    if (wanted) {
      const auto absent = hn::RebindMask(
          FloatsTag(), hn::Eq(hn::LoadU(WordsTag(), wanted + i), hn::Zero(WordsTag())));
      reflectedShare = select(absent, zero, reflectedShare);
      refractedShare = select(absent, zero, refractedShare);
    }
    storeFloats(mirrored(d, n, g), out.reflected, i);
    storeFloats(reflectedShare, out.reflectedShare + i);
    storeFloats(refracted, out.refracted, i);
    storeFloats(refractedShare, out.refractedShare + i);
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

void sampleBoundary(const RtsHits& hits, const RtsLobe& lobe, const float* eta,
                    const uint32_t* wanted, const BoundarySamples& out) {
  HWY_DYNAMIC_DISPATCH(boundaryLanes)(hits, lobe, eta, wanted, out);
}

void expectGlossy(const RtsHits& hits, const RtsLobe& lobe, float* share) {
  HWY_DYNAMIC_DISPATCH(glossyLanes)(hits, lobe, share);
}

BsdfSampleArrays::BsdfSampleArrays(const RtsBatch& batch, const LobeSampling& sampling,
                                   const Boundaries& boundaries, bool onlyStraight)
    : batch_(batch), list_(batch.arena->take<SampleArrays>(mostOfLobe * batch.lobeCount)) {
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    if (!onlyStraight || batch.lobes[l].kind == RTS_LOBE_TRANSPARENT)
      addLobe(l, sampling, boundaries);
}

void BsdfSampleArrays::addLobe(uint32_t number, const LobeSampling& sampling,
                               const Boundaries& boundaries) {
  const RtsLobe& lobe = batch_.lobes[number];
  const RtsHits& hits = batch_.points->hits;
  const LobeSamples* samples = sampling.samples[number];
  switch (lobe.kind) {
  case RTS_LOBE_TRANSPARENT: add(lobe, hits.direction).deflected = false; return;
  case RTS_LOBE_DIELECTRIC: return addBoundary(lobe, boundaries);
  case RTS_LOBE_REFLECTION: {
    float* const direction[3] = {take<float>(), take<float>(), take<float>()};
    sampleMirror(hits, lobe, direction);
    add(lobe, direction);
    return;
  }
  default: break;
  }
  if (!samples) return;
  SampleArrays& sample = add(lobe, samples->direction);
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

// Where the indices of the media differ by colour, every colour is refracted separately.
void BsdfSampleArrays::addBoundary(const RtsLobe& lobe, const Boundaries& boundaries) {
  const uint32_t* disperses = boundaries.disperses;
  if (!disperses) return addPair(lobe, lobe.parameter[0], nullptr, 0);
  auto* even = take<uint32_t>();
  for (uint32_t i = 0; i < hitCount(); i++) even[i] = !disperses[i];
  addPair(lobe, lobe.parameter[0], even, 0);
  for (uint32_t k = 0; k < 3; k++) {
    auto* eta = take<float>();
    for (uint32_t i = 0; i < hitCount(); i++) eta[i] = boundaries.eta[i][k];
    addPair(lobe, eta, disperses, k + 1);
  }
}

void BsdfSampleArrays::addPair(const RtsLobe& lobe, const float* eta, const uint32_t* wanted,
                               uint32_t colour) {
  BoundarySamples pair;
  for (auto* group : {pair.reflected, pair.refracted})
    for (int k = 0; k < 3; k++) group[k] = take<float>();
  pair.reflectedShare = take<float>();
  pair.refractedShare = take<float>();
  sampleBoundary(batch_.points->hits, lobe, eta, wanted, pair);
  SampleArrays& reflected = add(lobe, pair.reflected);
  reflected.share = pair.reflectedShare;
  reflected.colour = colour;
  SampleArrays& refracted = add(lobe, pair.refracted);
  refracted.share = pair.refractedShare;
  refracted.colour = colour;
}

SampleArrays& BsdfSampleArrays::add(const RtsLobe& lobe, const float* const direction[3]) {
  SampleArrays& sample = list_[count_++];
  sample = {.lobe = &lobe, .direction = {direction[0], direction[1], direction[2]}};
  sample.number = take<uint32_t>();
  sample.kept = take<float>();
  return sample;
}

} // namespace openrt
#endif
