// radiance.cpp: see radiance.h. RGBE: G. Ward, "Real Pixels", Graphics Gems II, with the run-length code of later Radiance files.
#include "picture/radiance.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "openrt/openrt.h"
#include "picture/picture.h"

namespace picture {

namespace {

constexpr int64_t mostPixels = int64_t(1) << 26;

[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error(why); }

class Bytes {
 public:
  explicit Bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) refuse("cannot be read");
    data_.assign(std::istreambuf_iterator<char>(in), {});
  }
  std::string line() {
    const size_t end = data_.find('\n', at_);
    if (end == data_.npos || end - at_ > 4096) refuse("the header does not end");
    std::string text = data_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }
  uint8_t next() {
    if (at_ == data_.size()) refuse("it ends too early");
    return static_cast<uint8_t>(data_[at_++]);
  }
  size_t left() const { return data_.size() - at_; }
  const char* here() const { return data_.data() + at_; }

 private:
  std::string data_;
  size_t at_ = 0;
};

void setSize(Radiance& picture, long width, long height) {
  if (width < 1 || height < 1 || width > 65536 || height > 65536 || int64_t(width) * height > mostPixels)
    refuse(fmt::format("{} x {} pixels", width, height));
  picture.width = int(width), picture.height = int(height);
  picture.rgb.resize(size_t(width) * size_t(height) * 3);
}

void readPfm(Bytes& in, Radiance& picture) {
  if (in.line() != "PF") refuse("is no colour PFM");
  long width = 0, height = 0;
  double scale = 0;
  if (std::sscanf(in.line().c_str(), "%ld %ld", &width, &height) != 2 || std::sscanf(in.line().c_str(), "%lf", &scale) != 1)
    refuse("the header cannot be read");
  setSize(picture, width, height);
  if (in.left() < picture.rgb.size() * 4) refuse("it ends too early");
  std::memcpy(picture.rgb.data(), in.here(), picture.rgb.size() * 4);
  if (scale > 0) // the other end first
    for (float& v : picture.rgb) v = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(v)));
}

void readRow(Bytes& in, int width, std::vector<uint8_t>& row) { // four planes, one after the other
  const size_t w = size_t(width);
  const uint8_t head[4] = {in.next(), in.next(), in.next(), in.next()};
  if (width < 8 || width > 32767 || head[0] != 2 || head[1] != 2 || (head[2] << 8 | head[3]) != width) { // not run-length coded
    for (size_t x = 0; x < w; ++x)
      for (size_t c = 0; c < 4; ++c) row[c * w + x] = x == 0 ? head[c] : in.next();
    return;
  }
  for (size_t c = 0; c < 4; ++c)
    for (size_t x = 0; x < w;) {
      const uint8_t code = in.next();
      const size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || x + count > w) refuse("a row is damaged");
      const uint8_t same = code > 128 ? in.next() : 0;
      for (size_t i = 0; i < count; ++i) row[c * w + x++] = code > 128 ? same : in.next();
    }
}

void readHdr(Bytes& in, Radiance& picture) {
  if (!in.line().starts_with("#?")) refuse("is no Radiance picture");
  while (!in.line().empty()) {}
  long width = 0, height = 0;
  if (std::sscanf(in.line().c_str(), "-Y %ld +X %ld", &height, &width) != 2) refuse("its rows do not run from the top left");
  setSize(picture, width, height);
  const size_t w = size_t(width);
  std::vector<uint8_t> row(4 * w);
  for (size_t y = size_t(height); y-- > 0;) {
    readRow(in, int(width), row);
    for (size_t x = 0; x < w; ++x)
      for (size_t c = 0; c < 3; ++c)
        picture.rgb[3 * (y * w + x) + c] = row[3 * w + x] ? float(std::ldexp(row[c * w + x] + 0.5, row[3 * w + x] - 136)) : 0.0f;
  }
}

void readOpenExr(const std::string& path, Radiance& picture) {
  const Picture read = readExr(path);
  setSize(picture, read.width, read.height);
  const std::vector<float>& rgba = read.planes.at(RT_RGBA);
  const size_t w = size_t(read.width), h = size_t(read.height);
  for (size_t y = 0; y < h; ++y)
    for (size_t x = 0; x < w; ++x)
      for (size_t c = 0; c < 3; ++c) picture.rgb[3 * (y * w + x) + c] = rgba[4 * ((h - 1 - y) * w + x) + c];
}

} // namespace

Radiance readRadiance(const std::string& path) {
  Radiance picture;
  try {
    Bytes in(path);
    const std::string suffix = path.substr(std::min(path.size(), path.rfind('.') + 1));
    if (suffix == "pfm")
      readPfm(in, picture);
    else if (suffix == "hdr")
      readHdr(in, picture);
    else if (suffix == "exr")
      readOpenExr(path, picture);
    else
      refuse("a picture of radiance was expected (exr, hdr, pfm)");
    for (const float v : picture.rgb)
      if (!(v >= 0) || v > 1e30f) refuse("holds numbers that are no radiance");
  } catch (const std::bad_alloc&) { throw; } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  return picture;
}

} // namespace picture
