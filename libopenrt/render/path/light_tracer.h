// light_tracer.h: follows light from lamps that a mirror or a lens bends first, to surfaces that
// the camera sees directly: what path tracing meets by chance only, or never (lights without
// extent). Each place where it scatters is connected with the camera: E. Veach, "Robust Monte Carlo
// Methods for Light Transport Simulation", 1997, chapter 10, with no other subpath. One thread's.
//
// Path tracing leaves out exactly these paths (RayState::course): first seen surface scatters, next
// to the lamp is a mirror or a smooth boundary.
#pragma once

#include <atomic>
#include <vector>

#include "render/lights/light_sources.h"
#include "render/path/ray_queue.h"
#include "render/path/sampler.h"
#include "render/surface/lobes.h"
#include "render/surface/surfaces.h"

namespace openrt {

class LightTracer {
 public:
  LightTracer(const RenderScene& scene, const LightSources& sources);
  // A whole picture (rgb by pixel) of a number of paths; seed: another one for each part. False:
  // the flag was set, which is looked at between some thousand paths.
  bool trace(uint32_t paths, uint32_t seed, const std::atomic<bool>& stop);
  std::vector<float>& picture() { return picture_; }
  RayCounters& counters() { return counters_; } // since they were emptied

 private:
  void begin(uint32_t first, uint32_t n);
  void load(uint32_t n);
  void step(uint32_t n);
  RtsBatch makeBatch(const Points& points);
  void pass(const Points& points, const uint32_t* order, const RtsClass& shaderClass);
  void scatter(const Points& points, const uint32_t* order, const RtsClass& shaderClass);
  bool leaveLamp(const Points& points, uint32_t i, RayState& state);
  void lampFlux(const Points& points, const LightSources::Start& start, const float at[3],
                float flux[3]);
  void attenuate(const Points& points, uint32_t path);
  void connect(const RtsBatch& batch, const uint32_t* hits, uint32_t n);
  void goOn(const RtsBatch& batch, uint32_t i, const LobeSamples* const samples[],
            const Boundaries& boundaries);
  void push(const Points& points, uint32_t i, const RayState& state, const float direction[3]);
  void sampleAt(const RayState& state, uint32_t pair, float out[2]) const;

  // The light of a path that has left a light without extent. Attenuation is that of the whole way
  // to the first surface that scatters, as if mirrors and smooth boundaries had not bent it.
  struct Departure {
    double way = 0;                   // length up to the hit
    float flux[3] = {0, 0, 0};        // at the first surface; the throughput counts it
    float attenuation[3] = {1, 1, 1}; // at this hit, over that
    bool settled = true;              // the light has been scattered, or no distance matters
  };

  const RenderScene& scene_;
  const LightSources& sources_;
  uint32_t width_, height_, seed_ = 0, first_ = 0, level_ = 0;
  double scale_ = 0,
         cameraArea_ =
             1; // paths' share of the picture; areas of the camera's space in render space
  Arena arena_;
  RayCounters counters_;
  std::vector<LightSources::Start> starts_;
  std::vector<Departure> departures_; // by path
  std::vector<float> picture_;
  std::vector<uint32_t> counts_;
  RayQueue queue_, next_;
  Rays rays_;
  RayState* states_ = nullptr;
};

} // namespace openrt
