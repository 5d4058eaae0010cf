// view_command.h: the vv command that makes a picture of what the window shows. [any thread]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libpicture/camera.h"

namespace vv {

struct ShownView {
  std::string world; // its file
  xvrml::CameraSettings camera;
  int width = 0, height = 0;
  double time = 0;             // seconds since the world was loaded
  std::optional<double> epoch; // when it was, in seconds since 1970; none: as by default
  std::optional<bool> headlight;
};

// A line for a shell. arguments: of this run; what they say about the quality, the world's changes
// and whom to trust is kept.
std::string viewCommand(const ShownView& view, const std::vector<std::string>& arguments);

} // namespace vv
