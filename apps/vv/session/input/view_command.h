// view_command.h: Builds the vv command line that renders what the window shows. [any thread]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libpicture/camera.h"
#include "libpicture/files/view_transform.h"

namespace vv {

struct ShownView {
  std::string world; // name of the world's file
  xvrml::CameraSettings camera;
  int width = 0, height = 0;
  double time = 0;             // seconds since the world was loaded
  std::optional<double> epoch; // loading time in seconds since 1970; none: the default
  std::optional<bool> headlight;
  std::optional<picture::ViewTransform> transform; // none: that of a world without options
  std::optional<double> falseColour;               // end of the scale, 0: auto; none: own colours
};

// Returns a line for a shell. `arguments` are those of this run; the ones about quality, changes of
// the world and trust are kept.
std::string viewCommand(const ShownView& view, const std::vector<std::string>& arguments);

} // namespace vv
