// light_tracer.h: light tracing for caustics. Follows paths from light sources whose first hit is
// specular (a mirror or a smooth boundary). Path tracing from the camera finds these paths with low
// probability, or never if the light has no extent. Each non-specular vertex of a light path is
// connected to the camera: E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
// 1997, chapter 10, with a camera subpath of one vertex. One instance per render thread.
//
// The path tracer leaves out exactly these paths (RayState::pathClass): the surface seen by the
// camera is non-specular, and the vertex next to the light is specular.
#pragma once

#include <atomic>
#include <vector>

#include "render/lights/light_sources.h"
#include "render/path/path_states.h"
#include "render/path/random_numbers.h"
#include "render/surface/lobes.h"
#include "render/surface/surfaces.h"

namespace openrt {

class LightTracer {
 public:
  LightTracer(const RenderScene& scene, const LightSources& sources);
  // Traces `paths` light paths into picture() (rgb by pixel). Each part of a frame needs its own
  // seed. Returns false if `stop` was set; it is checked every few thousand paths.
  bool trace(uint32_t paths, uint32_t seed, const std::atomic<bool>& stop);
  std::vector<float>& picture() { return picture_; }
  RayCounters& counters() { return counters_; } // ray counts since the counters were last reset

 private:
  void begin(uint32_t first, uint32_t n);
  void load();
  void traceWave(uint32_t n);
  RtsBatch makeBatch(const Points& points);
  void transmitRays(const Points& points, const uint32_t* order, const RtsClass& shaderClass);
  void scatter(const Points& points, const uint32_t* order, const RtsClass& shaderClass);
  bool applyEmission(const Points& points, uint32_t i, RayState& state);
  void lampFlux(const Points& points, const LightSources::LightRay& start, const float at[3],
                float flux[3]);
  void attenuate(const Points& points, uint32_t path);
  void connect(const RtsBatch& batch, const RandomNumbers& random, const uint32_t* hits,
               uint32_t n);
  void spawnRay(const RtsBatch& batch, uint32_t i, const LobeSamples* const samples[],
                const float* const choices[2], const Boundaries& boundaries);
  void push(const Points& points, uint32_t i, const RayState& state, const float direction[3]);

  // State of a path that started at a light without extent. The attenuation is that of the unfolded
  // path, as if mirrors and smooth boundaries had not bent it, up to the first non-specular
  // surface.
  struct Departure {
    double pathLength = 0;     // path length from the light to the current hit
    float flux[3] = {0, 0, 0}; // flux at the first surface; already contained in the throughput
    float attenuation[3] = {1, 1, 1}; // flux at the current hit divided by `flux`
    // the attenuation has been applied, or the light does not depend on distance
    bool attenuationKnown = true;
  };

  const RenderScene& scene_;
  const LightSources& sources_;
  uint32_t width_, height_, seed_ = 0, level_ = 0;
  // scale_: contribution of one path to the picture. cameraArea_: factor from areas in
  // camera space to areas in render space.
  double scale_ = 0, cameraArea_ = 1;
  Arena arena_;
  RayCounters counters_;
  std::vector<LightSources::LightRay> lightRays_;
  std::vector<Departure> departures_; // by path index
  std::vector<float> picture_;
  RayQueue queue_, next_;
  Rays rays_;
  PathStates states_{};
  PathSamples samples_{};
};

} // namespace openrt
