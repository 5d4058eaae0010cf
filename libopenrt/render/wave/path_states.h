// path_states.h: rays with what they carry for their paths, as structure of arrays, and the queue
// of rays for the next wave. A path may spawn several rays. [render]
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "render/arena.h"
#include "render/media.h"
#include "render/rays.h"

namespace openrt {

// Passing straight on is not a bounce: clear sheets, holes of textures and boundaries without
// effect do not count for RT_MAX_DEPTH. A path or a shadow ray passes at most so many of them more;
// the rest is cut and counted (Ledger::cutByDepth; docs/decisions/0077).
constexpr uint32_t mostPassages = 512;

// Class of a path so far. Light tracing takes over the `caustic` camera paths that end on a light
// source; path tracing must leave those out.
enum class PathClass : uint8_t {
  undeflected, // no scattering event yet: the ray still follows the camera ray
  diffuse,     // the first and the last scattering events were non-specular
  caustic,     // as `diffuse`, followed only by specular events since the last non-specular one
  // The first event was specular. For a path from a light source: this is a path that light tracing
  // follows.
  specularFirst
};

// Facts of a path in one number, for vector lanes.
struct PathFlags {
  uint32_t bits = 0;
  static constexpr uint32_t classBits = 3;
  // The path has a non-specular vertex.
  static constexpr uint32_t scatteredBit = 4;
  // The path has a non-specular vertex and only specular ones since: light sampling cannot find an
  // emitter that the ray hits (UnsampledLight, ledger.h).
  static constexpr uint32_t specularSinceDiffuseBit = 8;
  // A surface has changed the direction: the pixel's alpha is final.
  static constexpr uint32_t deflectedBit = 16;
  // A coat has reflected the path (RT_REFLECTION).
  static constexpr uint32_t reflectedBit = 32;
  // Since its last non-specular vertex the path has passed straight through something that light
  // samples do not pass.
  static constexpr uint32_t passedUnsampledBit = 64;
  // The first non-specular surface of the path, seen by way of specular ones, has scattered the
  // ray, and nothing has bent it since: a connection of a light path may lie along it
  // (render/lights/light_path_weights.h).
  static constexpr uint32_t connectableBit = 128;
  static constexpr uint32_t channelShift = 8, channelBits = 3, splitsShift = 10, mostSplits = 63;
  static constexpr uint32_t passagesShift = 16;

  PathClass pathClass() const { return PathClass(bits & classBits); }
  bool scattered() const { return bits & scatteredBit; }
  bool specularSinceDiffuse() const { return bits & specularSinceDiffuseBit; }
  bool deflected() const { return bits & deflectedBit; }
  bool reflected() const { return bits & reflectedBit; }
  // Returns whether light sampling at the last non-specular vertex cannot find what the ray hits.
  bool unsampled() const { return bits & (specularSinceDiffuseBit | passedUnsampledBit); }
  bool connectable() const { return bits & connectableBit; }
  // 1 + index of the only colour that the ray carries (dispersion); 0: all colours
  uint8_t channel() const { return uint8_t(bits >> channelShift & channelBits); }
  // number of times the path has split into several rays
  uint32_t splits() const { return bits >> splitsShift & mostSplits; }
  // number of surfaces that the path has passed straight through
  uint32_t passages() const { return bits >> passagesShift; }

  void setClass(PathClass to) { bits = (bits & ~classBits) | uint32_t(to); }
  void set(uint32_t bit, bool on) { bits = on ? bits | bit : bits & ~bit; }
  void setChannel(uint8_t to) {
    bits = (bits & ~(channelBits << channelShift)) | uint32_t(to) << channelShift;
  }
  void addSplit() {
    if (splits() < mostSplits) bits += 1u << splitsShift;
  }
  void setPassages(uint32_t to) {
    bits = (bits & ((1u << passagesShift) - 1)) | to << passagesShift;
  }
  void addPassage() { bits += 1u << passagesShift; }
};

// Returns whether a path may meet surface number `level`, where it may be bent or scattered at
// `most` surfaces.
inline bool isWithinDepth(PathFlags path, uint32_t level, uint32_t most) {
  return level <= most + std::min(path.passages(), mostPassages);
}

// The reference point that light is sampled for.
struct LightSampleContext {
  Vec3f position;
  // Unit normal if light counts from its side only; 0 0 0: light counts from everywhere.
  Vec3f normal;
};

// State that one ray carries for its path.
struct RayState {
  Vec3f throughput{1, 1, 1};
  float travelled = 0; // path length up to the ray's origin
  uint32_t path = 0;   // index of the path (sample) in the tile
  // Distinguishes the random numbers of the path's branches; 0: the branch of the camera ray.
  uint32_t branch = 0;
  // Solid-angle pdf with which BSDF sampling chose the direction; 0: specular or camera ray.
  float pdf = 0;
  // The previous path vertex, where `pdf` was sampled; needed for the light pdf in MIS.
  LightSampleContext previous;
  // MIS weight of BSDF sampling for light that the ray finds by way of specular surfaces only:
  // photons may have guided another ray there (photon_guide.h).
  float unguidedWeight = 1;
  // How often light paths make the path so far, over how often camera paths do; and the solid-angle
  // pdf of the ray's direction if a glossy lobe has scattered the path there, else 0
  // (render/lights/light_path_weights.h).
  float lightPathRatio = 0, glossyPdf = 0;
  MediaStack media = {}; // the media that contain the ray
  PathFlags flags;
};

// The states of many rays: the fields of RayState, as arrays.
struct PathStates {
  float* throughput[3];
  float* travelled;
  uint32_t *path, *branch;
  float *pdf, *unguidedWeight, *lightPathRatio, *glossyPdf;
  float *previousPosition[3], *previousNormal[3];
  MediaStack* media;
  uint32_t* flags;

  void allocate(Arena& arena, uint32_t capacity) {
    const uint32_t n = padded(capacity);
    forEachArray(
        [&](auto*& array) { array = arena.take<std::remove_reference_t<decltype(*array)>>(n); });
  }
  RayState operator[](size_t i) const {
    return {load(throughput, i), travelled[i],      path[i],           branch[i],    pdf[i],
            previousOf(i),       unguidedWeight[i], lightPathRatio[i], glossyPdf[i], media[i],
            flagsOf(i)};
  }
  void set(size_t i, const RayState& state) const {
    store(state.throughput, throughput, i);
    store(state.previous.position, previousPosition, i);
    store(state.previous.normal, previousNormal, i);
    travelled[i] = state.travelled;
    path[i] = state.path;
    branch[i] = state.branch;
    pdf[i] = state.pdf;
    unguidedWeight[i] = state.unguidedWeight;
    lightPathRatio[i] = state.lightPathRatio;
    glossyPdf[i] = state.glossyPdf;
    media[i] = state.media;
    flags[i] = state.flags.bits;
  }
  PathFlags flagsOf(size_t i) const { return {flags[i]}; }
  LightSampleContext previousOf(size_t i) const {
    return {load(previousPosition, i), load(previousNormal, i)};
  }
  // Calls f with a reference to each pointer.
  template <class F> void forEachArray(const F& f) {
    for (auto* group : {throughput, previousPosition, previousNormal})
      for (int k = 0; k < 3; k++) f(group[k]);
    f(travelled);
    f(path);
    f(branch);
    f(pdf);
    f(unguidedWeight);
    f(lightPathRatio);
    f(glossyPdf);
    f(media);
    f(flags);
  }
};

// Rays that wait for the next wave. The path tracer of a tile keeps its queues from tile to tile to
// reuse their memory.
class RayQueue {
 public:
  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }
  void clear() { size_ = 0; }
  void push(const Vec3f& origin, const Vec3f& direction, const RayState& state) {
    reserve(1);
    store(origin, origin_, size_);
    store(direction, direction_, size_);
    states_.set(size_++, state);
  }
  // Makes room for `count` more rays and for the 16 elements after them, which vector lanes may
  // overwrite. add() says how many of them were written.
  void reserve(size_t count);
  void add(size_t count) { size_ += count; }
  // Removes the rays whose paths have been bent or scattered at more than `most` surfaces, or have
  // met more than most + mostPassages, if they have met `level`. Adds their throughputs,
  // colours summed, to `lost`.
  void cut(uint32_t level, uint32_t most, double& lost);
  // The arrays; valid until the next reserve() or push().
  float* const* origin() const { return origin_; }
  float* const* direction() const { return direction_; }
  const PathStates& states() const { return states_; }
  // Returns the arrays from ray `begin` on.
  PathStates statesFrom(size_t begin) const;

 private:
  size_t size_ = 0, capacity_ = 0;
  std::unique_ptr<std::byte[]> memory_;
  float *origin_[3] = {}, *direction_[3] = {};
  PathStates states_{};
};

} // namespace openrt
