// walk_options.h: How exports walk over a world, whatever the format. [any thread]
#pragma once

#include "xvrml/renderer.h"

namespace picture {

// An exported file has no viewer: LODs have their finest level, and Billboards face +z.
inline xvrml::RenderOptions walkOptions() {
  static constexpr double farInFront[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1e7, 1};
  xvrml::RenderOptions options;
  options.view = farInFront;
  options.finestLevels = true;
  return options;
}

} // namespace picture
