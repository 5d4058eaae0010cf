// transport.h: chooses the light transport that a scene needs if the user has not set one, and
// tells what a transport leaves out of a scene. Both follow from the scene's contents by the tables
// in transport.cpp. Called between frames.
#pragma once

#include <cstdint>
#include <string>

#include "openrt/openrt.h"

namespace openrt {

struct RenderScene;

// Properties of a scene that matter to the choice of a transport.
enum Contents : uint32_t {
  hasLobes = 1u << 0,      // surfaces whose class has only lobes (`surface`)
  hasScattering = 1u << 1, // lobe-only surfaces that may scatter light
  // Surfaces whose class has `shade`. They scatter light only in transports that request their
  // lobes.
  hasShading = 1u << 2,
  hasMirrors = 1u << 3,  // mirrors and smooth boundaries
  hasEmitters = 1u << 4, // lobe-only surfaces that emit
  // The scene has emissive surfaces whose class has `shade`. They light only surfaces that use
  // lobes. For other surfaces the emission is only the colour in which they appear.
  hasGlow = 1u << 5,
  hasSky = 1u << 6,         // an environment that is not black
  hasSkyLight = 1u << 7,    // an environment that is meant as light and not as a backdrop
  hasLamps = 1u << 8,       // light shaders, which have no extent
  hasStarts = 1u << 9,      // lights, emitters or a sun from which light paths can start
  hasProjection = 1u << 10, // a camera that light paths can be connected to
  asksForAll = 1u << 11,    // surfaces that request indirect light (RTS_GLOBAL)
  hasFog = 1u << 12,        // media that fill space; light paths from lamps do not know them
};
constexpr uint32_t contentsBits = 13;

struct SceneContents {
  uint32_t bits = 0;
  const char* who[contentsBits] = {}; // name of the first shader class that set each bit, or null
};
// Collects the contents of a scene. before: the last snapshot, or null. Stores in the scene whether
// its environment emits light.
SceneContents contentsOf(RenderScene& scene, const RenderScene* before);

struct TransportChoice {
  RTenum transport = RT_TRANSPORT_DIRECT; // never RT_TRANSPORT_AUTO
  std::string reason;                     // explanation for the user
  uint32_t unreached = 0;                 // RTstats.transport.unreachedLights
  uint32_t leavesOut = 0;                 // RTstats.transport.leavesOut
};
TransportChoice chooseTransport(RenderScene& scene, const RenderScene* before);

} // namespace openrt
