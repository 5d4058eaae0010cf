// light_tracer.h: light tracing for caustics. Follows paths from light sources whose first hit is
// specular (a mirror or a smooth boundary). Path tracing from the camera finds these paths with low
// probability, or never if the light has no extent. Where it pays (light_path_trial.h), it also
// follows paths that a glossy lobe scatters first. Each non-specular vertex of a light path is
// connected to the camera: E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
// 1997, chapter 10, with a camera subpath of one vertex. One instance per render thread.
//
// Where the camera sees the first such surface by way of mirrors or glass, each vertex of a path by
// way of glossy surfaces is connected to that surface instead (surface_connections.h).
//
// Illuminance sensors have no lens to connect to. There a path adds its flux to each cell of the
// grid that it crosses (sensor_plane.h): "crossed" instead of "connected" below.
//
// The camera paths of the same frame leave out exactly these paths (PathFlags::pathClass,
// PathClass::caustic): the surface seen by the camera is non-specular, and the vertex next to the
// light is specular. They keep the light of the sky beside its sun (unsampled_lights.h). Light
// by way of glossy lobes is divided between both by weights (lights/light_path_weights.h).
#pragma once

#include <atomic>
#include <vector>

#include "render/lights/photon_guide.h"
#include "render/path/camera_connections.h"
#include "render/path/light_departures.h"
#include "render/path/light_path_gain.h"
#include "render/path/sensor_plane.h"
#include "render/path/surface_connections.h"
#include "render/surface/sample_arrays.h"
#include "render/wave/boundaries.h"
#include "render/wave/wave.h"

namespace openrt {

class LightTracer {
 public:
  explicit LightTracer(const RenderScene& scene);
  // Traces light paths from sources to their first non-specular surfaces and returns what they
  // leave there; less if `stop` was set.
  std::vector<Photon> tracePhotons(const LightSources& sources, uint32_t paths, uint32_t seed,
                                   const std::atomic<bool>& stop);
  // Returns the largest flux that a light path had after the first surface, summed over the
  // colours.
  double largestFlux() const { return largestFlux_; }
  // Traces the light paths of each kind that go with `paths` camera paths into picture() (rgb by
  // pixel). Each part of a frame needs its own seed. Returns false if `stop` was set; it is checked
  // every few thousand paths.
  bool trace(uint32_t paths, uint32_t seed, const std::atomic<bool>& stop);
  // Traces a path by way of glossy surfaces for each surface of a camera path, and adds its light
  // there. samples: of the light paths.
  void connectTo(const ConnectedSurfaces& surfaces, const PathSamples& samples);
  // Traces paths from sources and returns what they bring to the picture.
  std::vector<LightPathFind> tryPaths(const LightSources& sources, uint32_t paths, uint32_t seed,
                                      const std::atomic<bool>& stop);
  std::vector<float>& picture() { return picture_; }
  RayCounters& counters() { return counters_; } // ray counts since the counters were last reset

 private:
  bool traceFrom(const LightSources& sources, uint32_t paths, uint32_t seed,
                 const std::atomic<bool>& stop);
  void tracePaths(uint32_t first, uint32_t n);
  void followPaths(uint32_t n);
  void traceWave(Wave& wave);
  void selectMet(Wave& wave);
  void transmitRays(const Points& points, const PathStates& states, const RtsClass& shaderClass);
  void scatter(const Points& points, const Wave& wave, const Bucket& bucket);
  void countNeverEntered(const Points& points, const Rays& rays, const Boundaries& boundaries,
                         const RtsClass& shaderClass);
  void dropLobes(const RtsBatch& batch) const;
  void leavePhotons(const Points& points, const PathStates& states, const uint32_t* hits,
                    uint32_t n);
  Vec3f attenuationAt(const RtsBatch& batch, uint32_t i) const;
  bool isInPicture(const CameraConnections& to, uint32_t i) const;
  void addFinds(const RtsBatch& batch, const CameraConnections& to);
  const float* ratiosToCamera(const RtsBatch& batch, const CameraConnections& to);
  void connect(const RtsBatch& batch, const RandomNumbers& random, const uint32_t* hits,
               uint32_t n);
  void connectToSurfaces(const RtsBatch& batch);
  LightStarts startsOf(const RtsBatch& batch) const;
  bool shares() const;
  void spawnRays(const RtsBatch& batch, const LobeSampling& sampling, const Boundaries& boundaries);
  void spawnRay(const RtsBatch& batch, uint32_t i, const SampleArrays& sample, double kept,
                const Boundaries& boundaries);
  void push(const Points& points, uint32_t i, const RayState& state, const Vec3f& direction);
  void findCrossings(const Wave& wave);
  void addCrossings(const Wave& wave);

  const RenderScene& scene_;
  const LightSources* sources_ = nullptr; // where the paths in flight have started
  uint32_t seed_ = 0;
  uint32_t level_ = 0; // depth of the current wave
  // scale_: contribution of one path to the picture. cameraArea_: factor from areas in
  // camera space to areas in render space.
  double scale_ = 0;
  const double cameraArea_;
  double largestFlux_ = 0;
  Arena arena_;
  RayCounters counters_;
  const StageContext context_{scene_, arena_, counters_};
  LightDepartures departures_;
  std::vector<float> picture_;
  // The sensors' plane; none in pictures, which connect paths to the camera instead.
  const std::optional<SensorPlane> sensors_;
  struct Crossing { // where a ray of the wave meets a cell of the sensors, if nothing is before it
    uint32_t lane, pixel;
    double distance;
    Vec3f flux; // without the attenuation of lamps
  };
  std::vector<Crossing> crossings_;
  // Where paths of the current call were found to start, and whether in the medium; how often.
  Vec3f probed_;
  uint16_t probedMedium_ = 0;
  bool probedInside_ = false;
  uint32_t probes_ = 0;
  std::vector<Photon>* photons_ = nullptr; // gets the ends of the paths; null: they are connected
  std::vector<LightPathFind>* finds_ = nullptr; // gets the light; null: picture_ does
  const ConnectedSurfaces* surfaces_ = nullptr; // get the light; null: picture_ does
  PathSamples samples_{};                       // samples of the paths in flight
  RayQueue queue_, next_;                       // rays of the current wave, and of the next one
};

} // namespace openrt
