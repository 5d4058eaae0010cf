// picture_read.cpp: Reads pictures that the user names, of any program. [any thread]
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "libpicture/files/picture.h"
#include "openrt/openrt.h"
#include "xvrml/image.h"
#include "xvrml/radiance.h"

namespace picture {

namespace {

std::vector<uint8_t> firstBytes(const std::string& path) {
  std::vector<uint8_t> bytes(16);
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  bytes.resize(file ? std::fread(bytes.data(), 1, bytes.size(), file.get()) : 0);
  return bytes;
}

bool isExr(const std::vector<uint8_t>& bytes) {
  constexpr std::array<uint8_t, 4> magic = {0x76, 0x2f, 0x31, 0x01};
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

// Makes the plane rgba. colour(i, rgba): writes a pixel; i counts rows from the bottom up.
template <class F> Picture fromBelow(int width, int height, bool linear, const F& colour) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.linear = linear;
  std::vector<float>& rgba = picture.planes[RT_RGBA];
  rgba.assign(4 * size_t(width) * size_t(height), 1);
  float* to = rgba.data();
  for (size_t y = size_t(height); y-- > 0;)
    for (size_t x = 0; x < size_t(width); ++x, to += 4) colour(y * size_t(width) + x, to);
  return picture;
}

Picture readWorldPicture(const std::string& path, bool isRadiance) {
  if (isRadiance) {
    const xvrml::RadianceImage read = xvrml::readRadiance(path);
    return fromBelow(read.width, read.height, true,
                     [&](size_t i, float* to) { std::copy_n(&read.rgb[3 * i], 3, to); });
  }
  const xvrml::Image read = xvrml::loadImage(path);
  const size_t components = size_t(read.components);
  return fromBelow(read.width, read.height, false, [&](size_t i, float* to) {
    const uint8_t* const from = &read.pixels[i * components];
    for (size_t c = 0; c < 3; ++c) to[c] = float(from[components > 2 ? c : 0]) / 255;
    if (components % 2 == 0) to[3] = float(from[components - 1]) / 255;
  });
}

} // namespace

Picture readPicture(const std::string& path, uint32_t channels) {
  const std::vector<uint8_t> head = firstBytes(path);
  if (isExr(head)) return readExr(path, channels | RT_RGBA);
  try {
    Picture picture = readWorldPicture(path, xvrml::looksLikeRadiance(head.data(), head.size()));
    if (picture.width < 1 || picture.height < 1) throw std::runtime_error("there are no pixels");
    return picture;
  } catch (const std::bad_alloc&) { throw; } catch (const std::runtime_error& error) {
    throw InputError(path, error.what());
  }
}

} // namespace picture
