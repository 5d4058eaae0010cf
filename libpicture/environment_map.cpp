#include "libpicture/environment_map.h"

namespace picture {

RTid makeEnvironmentMap(int width, int height, const float* rgb, RTid& texture) {
  rtGenTextures(1, &texture);
  rtBindTexture(texture);
  rtTexImage2D(3, width, height, RT_FLOAT, rgb);
  rtTexParameteri(RT_TEXTURE_WRAP_T, RT_CLAMP_TO_EDGE);
  const RTid shader = rtNewShader(rtNewShaderClass("EnvironmentMap", nullptr));
  rtBindShader(shader);
  rtParameterTexture(rtParameterHandle("texture"), texture);
  return shader;
}

} // namespace picture
