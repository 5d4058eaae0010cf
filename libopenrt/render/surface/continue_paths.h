// continue_paths.h: continues the paths at all hits of a batch with vector lanes: selects BSDF
// samples; for camera paths applies Russian roulette or the energy cut, and queues the next rays.
// Called by spawnRays() (render/path/spawn_rays.h), and by the tracers of light paths and of guided
// rays, which follow one sample of each hit. [render]
#pragma once

#include "render/surface/sample_arrays.h"

namespace openrt {

// A camera path that carries at least this throughput always survives Russian roulette. It has the
// effect that a path that splits at glass spends few rays on what is hardly seen, and that the rays
// of a path which carries energy are no more than 8 at a time, on the mean (decision 47).
constexpr float certainThroughput = 0.125f;
// A camera path follows all BSDF samples of a surface unless it has split this often before.
constexpr uint32_t mostSplits = 4;

// The selection of one sample of each hit, in proportion to the throughput that the samples are
// expected to carry.
struct Selection {
  const Points* points;
  // By hit: random numbers in [0, 1), to select a sample and for Russian roulette. survival null:
  // every path survives.
  const float *choice, *survival;
  float* const* throughput;     // throughputs of the paths, by lane; null: not known yet
  const uint32_t* onlySpecular; // by hit: 1 where non-specular samples do not count; null: nowhere
  // Written by selectSamples(), by hit.
  uint32_t* number; // index of the sample; SampleArrays::lacking where none is followed
  // Probabilities of the selection and of surviving Russian roulette.
  float *probability, *survivalProbability;

  // Allocates what is written.
  void allocate(Arena& arena);
};
void selectSamples(const Selection& selection, const BsdfSampleArrays& samples);

// The camera paths at the hits of a batch.
struct Continuation {
  const Points* points;
  const PathStates* states;
  uint32_t level; // number of surfaces that the paths have hit before
  // Random numbers by hit: to select a sample, for Russian roulette. Null without path tracing:
  // then paths end where they carry less than the energy cut.
  const float *choice, *survival;
  float energyCut;
  const Crossing* crossing; // boundaries of media by hit; null: there are none
  // By hit: share of the scattered light that passes the fog; null: all of it does.
  const float* throughFog;
  // By hit: 1 if light from behind the surface counts for light samples; null: nowhere.
  const uint32_t* twoSided;
  // By hit: 1 where light samples do not pass what the surface transmits straight on, so that rays
  // lose the pdf of their directions there; null: nowhere.
  const uint32_t* unsampled;
  // Written by chooseSamples(), by hit: number of samples; 1 if chance has decided which of them
  // are followed.
  uint32_t *count, *random;
};

// Decides which samples of each hit are followed: all, or a selected one if the path has split
// several times. The probability of the selection does not depend on the sampled directions,
// because the MIS weights of light sampling use it.
void chooseSamples(const Continuation& paths, const BsdfSampleArrays& samples);

// Appends to the queue the rays of the hits that follow a sample, in the order of the hits.
// `hitOf` is working storage for as many numbers as there are hits, padded, and 16 more.
void continuePaths(const Continuation& paths, const SampleArrays& sample, uint32_t* hitOf,
                   RayQueue& queue);

} // namespace openrt
