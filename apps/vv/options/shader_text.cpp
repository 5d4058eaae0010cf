#include "options/shader_text.h"

namespace vv {

xvrml::NodeRef readCameraShader(const Options& options) {
  if (options.cameraShader.empty()) return {};
  try {
    return picture::readShader(options.cameraShader, "--camera-shader", RT_CAMERA,
                               options.render.shaderPath, options.cameraShaderFolder);
  } catch (const picture::ShaderError& error) { throw UsageError(error.what()); }
}

} // namespace vv
