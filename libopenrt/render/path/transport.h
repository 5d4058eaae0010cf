// transport.h: which transport a scene needs where nobody names one, and what a transport leaves
// out of a scene. Both follow from what the scene holds, by the tables in transport.cpp. Called
// between frames.
#pragma once

#include <cstdint>
#include <string>

#include "openrt/openrt.h"

namespace openrt {

struct RenderScene;

// What a scene holds, as far as a transport matters to it.
enum Contents : uint32_t {
  hasLobes = 1u << 0,      // surfaces that are described by lobes alone
  hasScattering = 1u << 1, // surfaces of lobes alone that may scatter light
  hasShading = 1u << 2,    // surfaces that answer by themselves (`shade`), and scatter light only
                           // where they are asked for lobes
  hasMirrors = 1u << 3,    // mirrors and smooth boundaries
  hasEmitters = 1u << 4,   // surfaces of lobes alone that emit
  hasGlow = 1u << 5, // surfaces that answer by themselves and emit: a picture of light to others of
                     // their kind
  hasSky = 1u << 6,  // an environment that is not black
  hasSkyLight = 1u << 7,    // one that is meant as light and not as a backdrop
  hasLamps = 1u << 8,       // lights, which have no extent
  hasStarts = 1u << 9,      // lights or emitters where light paths may begin
  hasProjection = 1u << 10, // a camera that light paths can be connected with
  asksForAll = 1u << 11,    // surfaces that ask for the light of other surfaces
};
constexpr uint32_t contentsBits = 12;

struct SceneContents {
  uint32_t bits = 0;
  const char* who[contentsBits] = {}; // the first class that set each bit, or null
};
// before: the last snapshot, or null. Stores in the scene whether its environment shines.
SceneContents contentsOf(RenderScene& scene, const RenderScene* before);

struct TransportChoice {
  RTenum transport = RT_TRANSPORT_DIRECT; // never RT_TRANSPORT_AUTO
  std::string reason;                     // for people
  uint32_t unreached = 0;                 // RTstats.unreachedLights
  uint32_t leavesOut = 0;                 // RTstats.transportLeavesOut
};
TransportChoice chooseTransport(RenderScene& scene, const RenderScene* before);

} // namespace openrt
