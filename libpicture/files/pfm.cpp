// pfm.cpp: Encodes portable float maps (PFM): red, green, blue as floats, unchanged. [any thread]
#include <algorithm>
#include <bit>

#include "libpicture/files/formats.h"

namespace picture {

// The rows go from the bottom up; the negative third number means little-endian.
std::string encodePfm(const Picture& picture) {
  static_assert(std::endian::native == std::endian::little);
  std::string out =
      "PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n";
  const std::vector<float>& rgba = rgbaOf(picture);
  const size_t width = size_t(picture.width);
  std::vector<float> row(width * 3);
  for (int y = picture.height; y-- > 0;) {
    const float* from = rgba.data() + size_t(y) * width * 4;
    for (size_t x = 0; x < width; ++x) std::copy_n(from + 4 * x, 3, row.data() + 3 * x);
    out.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
  }
  return out;
}

} // namespace picture
