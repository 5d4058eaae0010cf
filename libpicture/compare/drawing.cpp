#include "libpicture/compare/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libpicture/luminance.h"
#include "openrt/openrt.h"

namespace picture {

Picture drawErrors(const PictureFacts& size, const std::vector<float>& errors, bool forScreens) {
  constexpr float full = 6; // standard errors
  constexpr std::array<float, 3> none = {.5f, .5f, .5f}, more = {1, .6f, .1f}, less = {.2f, .5f, 1};
  Picture picture;
  picture.width = size.width;
  picture.height = size.height;
  picture.linear = !forScreens;
  std::vector<float>& rgba = picture.planes[RT_RGBA];
  rgba.assign(errors.size() / 3 * 4, 1);
  for (size_t i = 0; i < errors.size() / 3; ++i) {
    const float z = luminanceOf(&errors[3 * i]), part = std::min(std::abs(z) / full, 1.0f);
    const std::array<float, 3>& end = z > 0 ? more : less;
    for (size_t k = 0; k < 3; ++k)
      rgba[4 * i + k] = forScreens ? none[k] + part * (end[k] - none[k]) : errors[3 * i + k];
  }
  return picture;
}

} // namespace picture
