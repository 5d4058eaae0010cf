// sample_arrays.h: the BSDF samples at all hits of a batch, as arrays: every lobe has one sample at
// each hit, a smooth boundary two. The directions of specular lobes are computed with vector lanes.
// Paths from the camera and from lamps, guided rays and first hits use the same samples. [render]
#pragma once

#include "render/surface/sample_lobes.h"
#include "render/wave/boundaries.h"

namespace openrt {

// Says what paths carry from surface to surface: radiance, if they start at the camera, or flux, if
// they start at a lamp. A smooth boundary scales radiance by eta squared, and not flux.
enum class TransportMode : uint8_t { radiance, importance };

// One sample at each hit. A hit lacks it where its lobe has no weight.
struct SampleArrays {
  const RtsLobe* lobe;
  const float* direction[3];
  // By hit: the expected part of the lobe's weight. A hit with 0 lacks a specular sample. Null: 1.
  const float* share = nullptr;
  // By hit and colour: value over pdf of a non-specular lobe; the part of a specular lobe's weight
  // that depends on the colour. Null: `share`.
  const float* value[3] = {};
  const float* pdf = nullptr; // solid-angle pdf of a non-specular lobe; null: specular
  uint32_t colour = 0;        // 1 + index of the only colour that is carried; 0: all colours
  bool deflected = true;      // the direction differs from the incoming ray's
  bool transmits = false;     // the direction may lead behind the surface
  // By hit: RayState::lightPathRatio and glossyPdf of a ray that follows a non-specular sample;
  // null: 0. For light paths: the factor of lightPathRatio; null: 1.
  const float *lightPathRatio = nullptr, *glossyPdf = nullptr;
  // By hit: gets the probability that the sample is followed if it survives. Null: nobody asks.
  float* selectionProbability = nullptr;

  // Written by chooseSamples() and selectSamples() (continue_paths.h), by hit.
  uint32_t* number = nullptr; // number of samples of the hit before this one; or `lacking`
  // Probability that the ray is spawned; 0: it is not. After selectSamples() the throughput that
  // the sample is expected to carry.
  float* kept = nullptr;
  float* probability = nullptr; // the same without Russian roulette; null: specular

  static constexpr uint32_t lacking = ~0u;
  // Factors of the lobe's weight.
  const float* valueOf(uint32_t k) const { return value[k] ? value[k] : share; }
  // Returns the factor of the throughput of a path that follows the sample at hit i.
  Vec3f weightAt(uint32_t i) const;
  // Returns whether the direction at hit i, if it was sampled from a non-specular lobe, is on the
  // same side of the facet as of the lobe's normal.
  bool isConsistentAt(const RtsHits& hits, uint32_t i) const;
};

// Reflection and refraction at a smooth boundary, by hit; share: of the lobe's weight.
struct BoundarySamples {
  float *reflected[3], *reflectedShare;
  float *refracted[3], *refractedShare;
};

// All samples of the hits of a batch. They lie in the arena of the batch.
class BsdfSampleArrays {
 public:
  // onlyStraight: leaves out everything but straight transmission.
  BsdfSampleArrays(const RtsBatch& batch, const LobeSampling& sampling,
                   const Boundaries& boundaries, TransportMode mode, bool onlyStraight = false);
  SampleArrays* begin() { return list_; }
  SampleArrays* end() { return list_ + count_; }
  const SampleArrays* begin() const { return list_; }
  const SampleArrays* end() const { return list_ + count_; }
  const SampleArrays& operator[](uint32_t number) const { return list_[number]; }
  bool empty() const { return count_ == 0; }

 private:
  void addLobe(uint32_t number, const LobeSampling& sampling, const Boundaries& boundaries);
  void addBoundary(const RtsLobe& lobe, const Boundaries& boundaries);
  void addDispersion(const RtsLobe& lobe, const Boundaries& boundaries);
  BoundarySamples sampleBoundary(const RtsLobe& lobe, const float* eta) const;
  SampleArrays& add(const RtsLobe& lobe, const float* const direction[3], const float* share);
  template <class T> T* take() const { return batch_.arena.take<T>(padded(hitCount())); }
  uint32_t hitCount() const { return batch_.points->hits.count; }

  // A boundary has a reflection, a refraction of all colours, and one of each colour where it
  // disperses light.
  static constexpr uint32_t mostOfLobe = 5;
  const RtsBatch& batch_;
  const TransportMode mode_;
  SampleArrays* list_;
  uint32_t count_ = 0;
};

// Computes the samples at a smooth boundary. eta: relative index of refraction, by hit.
void sampleBoundary(const RtsHits& hits, const RtsLobe& lobe, const float* eta, TransportMode mode,
                    const BoundarySamples& out);
// Computes the directions of a mirror.
void sampleMirror(const RtsHits& hits, const RtsLobe& lobe, float* const direction[3]);
// Computes the Fresnel reflectance of a glossy lobe at its normal; 1 without Fresnel factor.
void expectGlossy(const RtsHits& hits, const RtsLobe& lobe, float* share);

} // namespace openrt
