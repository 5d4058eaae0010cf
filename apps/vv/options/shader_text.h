// shader_text.h: Reads the shader of --camera-shader. [main thread]
#pragma once

#include "libpicture/shader_text.h"
#include "options/options.h"

namespace vv {

// Returns the camera shader that the options ask for; null if there is none. Throws UsageError.
xvrml::NodeRef readCameraShader(const Options& options);

} // namespace vv
