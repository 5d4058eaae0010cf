// light_connections.h: the stage of camera paths that connects them with light paths by way of
// glossy surfaces (surface_connections.h), where a trial has found that it pays
// (light_path_trial.h).
// Each first non-specular surface that is seen by way of mirrors or smooth glass gets a light path
// of its own, with a probability that grows with what the camera path carries. One instance per
// path tracer.
#pragma once

#include <memory>

#include "render/path/light_path_gain.h"
#include "render/path/spawn_rays.h"
#include "render/surface/sent_light.h"

namespace openrt {

class LightTracer;

class LightConnections {
 public:
  explicit LightConnections(const StageContext& context);
  ~LightConnections();
  // Tells a trial about all connections from now on.
  void observe(LightPathGain* gain) { gain_ = gain; }
  // Adds the light that connections find at the hits of a batch to what they send back.
  void connect(const CameraPaths& paths, const LobeSampling& sampling, const Boundaries& boundaries,
               const SentLight& sent);

 private:
  const StageContext context_;
  LightPathGain* gain_ = nullptr;
  std::unique_ptr<LightTracer> tracer_; // made with the first connection
};

} // namespace openrt
