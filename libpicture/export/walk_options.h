// walk_options.h: How exports walk over a world, whatever the format. [any thread]
#pragma once

#include "xvrml/renderer.h"

namespace picture {

// No viewer is near an exported file: Billboards face +z, as they are written.
inline xvrml::RenderOptions walkOptions() {
  static constexpr double farInFront[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1e7, 1};
  xvrml::RenderOptions options;
  options.view = farInFront;
  return options;
}

} // namespace picture
