#include "libpicture/files/radiance.h"

#include <new>
#include <stdexcept>

#include "libpicture/files/picture.h"
#include "openrt/openrt.h"

namespace picture {

namespace {

xvrml::RadianceImage readOpenExr(const std::string& path) {
  const Picture read = readExr(path);
  xvrml::RadianceImage picture;
  picture.width = read.width;
  picture.height = read.height;
  const std::vector<float>& rgba = read.planes.at(RT_RGBA);
  const size_t w = size_t(read.width), h = size_t(read.height);
  picture.rgb.resize(3 * w * h);
  for (size_t y = 0; y < h; ++y)
    for (size_t x = 0; x < w; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const float v = picture.rgb[3 * (y * w + x) + c] = rgba[4 * ((h - 1 - y) * w + x) + c];
        if (!(v >= 0) || v > 1e30f)
          throw std::runtime_error("contains numbers that cannot be radiance");
      }
  return picture;
}

} // namespace

xvrml::RadianceImage readRadiance(const std::string& path) {
  try {
    return path.ends_with(".exr") ? readOpenExr(path) : xvrml::readRadiance(path);
  } catch (const std::bad_alloc&) { throw; } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) { throw InputError(path, error.what()); }
}

} // namespace picture
