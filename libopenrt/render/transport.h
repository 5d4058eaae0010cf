// transport.h: which transport a scene needs, where nobody says: what its shaders ask for and no more. Called between frames.
#pragma once

#include <string>

#include "openrt/openrt.h"

namespace openrt {

struct RenderScene;

struct TransportChoice {
  RTenum transport = RT_TRANSPORT_DIRECT; // never RT_TRANSPORT_AUTO
  std::string reason;                     // for people
  uint32_t unreached = 0;                 // RTstats.unreachedLights
};
TransportChoice chooseTransport(const RenderScene& scene);

} // namespace openrt
