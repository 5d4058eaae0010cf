// background.cpp: Parses backgrounds and composites pictures over them. The colour names are the
// sixteen basic ones of CSS Color Module 4, and orange.
#include "libpicture/background.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "libpicture/files/picture.h"
#include "libpicture/files/radiance.h"
#include "lower_case.h"

namespace picture {

namespace {

struct Named {
  std::string_view name;
  unsigned rgb;
};
constexpr Named colours[] = {
    {"black", 0x000000},   {"silver", 0xc0c0c0},  {"gray", 0x808080},  {"grey", 0x808080},
    {"white", 0xffffff},   {"maroon", 0x800000},  {"red", 0xff0000},   {"purple", 0x800080},
    {"fuchsia", 0xff00ff}, {"magenta", 0xff00ff}, {"green", 0x008000}, {"lime", 0x00ff00},
    {"olive", 0x808000},   {"yellow", 0xffff00},  {"navy", 0x000080},  {"blue", 0x0000ff},
    {"teal", 0x008080},    {"aqua", 0x00ffff},    {"cyan", 0x00ffff},  {"orange", 0xffa500},
};

[[noreturn]] void refuse(const std::string& text) {
  throw std::invalid_argument(fmt::format("{} was expected, not \"{}\"", backgroundForms, text));
}

std::array<float, 3> unpacked(unsigned rgb) {
  return {float(rgb >> 16 & 255) / 255, float(rgb >> 8 & 255) / 255, float(rgb & 255) / 255};
}

std::array<float, 3> hexadecimal(const std::string& text) {
  unsigned rgb = 0;
  const char *begin = text.data() + 1, *end = text.data() + text.size();
  const auto read = std::from_chars(begin, end, rgb, 16);
  if (read.ec != std::errc() || read.ptr != end || (text.size() != 4 && text.size() != 7))
    refuse(text);
  if (text.size() == 4)
    rgb = (rgb >> 8 & 15) * 0x110000 + (rgb >> 4 & 15) * 0x1100 + (rgb & 15) * 0x11;
  return unpacked(rgb);
}

std::array<float, 3> triple(const std::string& text) {
  std::array<float, 3> out{};
  const char *at = text.data(), *end = text.data() + text.size();
  for (size_t k = 0; k < 3; ++k) {
    const auto read = std::from_chars(at, end, out[k]);
    const bool follows = k < 2 ? read.ptr != end && *read.ptr == ',' : read.ptr == end;
    if (read.ec != std::errc() || !follows || !(out[k] >= 0 && out[k] <= 1)) refuse(text);
    at = read.ptr + 1;
  }
  return out;
}

bool isRadiance(std::string_view suffix) {
  return suffix == "exr" || suffix == "hdr" || suffix == "pfm";
}

std::string suffixOf(const std::string& path) {
  const size_t dot = path.rfind('.');
  return dot == path.npos ? "" : lowerCase(path.substr(dot + 1));
}

} // namespace

Background readBackground(const std::string& text) {
  using Kind = Background::Kind;
  const std::string low = lowerCase(text);
  if (low == "none" || low == "transparent") return {Kind::none, {}, {}};
  for (const Named& one : colours)
    if (low == one.name) return {Kind::colour, unpacked(one.rgb), {}};
  if (low.starts_with('#')) return {Kind::colour, hexadecimal(low), {}};
  const std::string suffix = suffixOf(text);
  constexpr std::string_view suffixes[] = {"png", "jpg", "jpeg", "gif", "webp", "bmp", "tga"};
  if (isRadiance(suffix) || std::ranges::find(suffixes, suffix) != std::end(suffixes))
    return {Kind::file, {}, text};
  if (low.find(',') != low.npos) return {Kind::colour, triple(low), {}};
  refuse(text);
}

void setBackdrop(const Background& background, PictureFacts& picture) {
  picture.transparent = background.kind == Background::Kind::none;
  picture.backdrop.reset();
  if (background.kind == Background::Kind::backdrop) picture.backdrop = background.colour;
}

BackgroundLayer::BackgroundLayer(const Background& background, bool linear) {
  if (background.kind == Background::Kind::file) read(background.file, linear);
  if (background.kind != Background::Kind::colour) return;
  width_ = height_ = 1;
  for (const float v : background.colour) rgb_.push_back(linear ? linearOf(v) : v);
}

void BackgroundLayer::read(const std::string& file, bool linear) {
  if (isRadiance(suffixOf(file))) {
    const xvrml::RadianceImage read = readRadiance(file);
    width_ = read.width;
    height_ = read.height;
    rgb_.resize(read.rgb.size());
    const size_t row = size_t(width_) * 3;
    for (size_t y = 0; y < size_t(height_); ++y)
      std::copy_n(read.rgb.data() + y * row, row, rgb_.data() + (size_t(height_) - 1 - y) * row);
    return;
  }
  const Picture read = readPicture(file, 0);
  width_ = read.width;
  height_ = read.height;
  const std::vector<float>& rgba = rgbaOf(read);
  rgb_.resize(rgba.size() / 4 * 3);
  for (size_t k = 0; k < rgb_.size(); ++k) {
    const float v = rgba[k / 3 * 4 + k % 3], alpha = rgba[k / 3 * 4 + 3];
    rgb_[k] = alpha * (linear && !read.linear ? linearOf(v) : v);
  }
}

void BackgroundLayer::colourAt(double x, double y, float rgb[3]) const {
  const double left = std::clamp(x - 0.5, 0.0, width_ - 1.0),
               top = std::clamp(y - 0.5, 0.0, height_ - 1.0);
  const int x0 = int(left), y0 = int(top), x1 = std::min(x0 + 1, width_ - 1),
            y1 = std::min(y0 + 1, height_ - 1);
  const float u = float(left - x0), v = float(top - y0);
  const auto at = [&](int column, int row) {
    return rgb_.data() + (size_t(row) * size_t(width_) + size_t(column)) * 3;
  };
  for (int c = 0; c < 3; ++c) {
    const float above = at(x0, y0)[c] * (1 - u) + at(x1, y0)[c] * u,
                below = at(x0, y1)[c] * (1 - u) + at(x1, y1)[c] * u;
    rgb[c] = above * (1 - v) + below * v;
  }
}

// Each pixel is the mean of several background samples: as many as the background has pixels there,
// up to 8 x 8.
void BackgroundLayer::compositeOver(std::vector<float>& rgba, int width, int height) const {
  if (width_ == 0) return;
  // background pixels per frame pixel
  const double scale = std::min(double(width_) / width, double(height_) / height);
  const double left = (width_ - scale * width) / 2, top = (height_ - scale * height) / 2;
  const int parts = std::clamp(int(std::ceil(scale)), 1, 8);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float* pixel = rgba.data() + (size_t(y) * size_t(width) + size_t(x)) * 4;
      const float open = 1 - pixel[3];
      pixel[3] = 1;
      if (!(open > 0)) continue;
      float sum[3] = {}, one[3];
      for (int i = 0; i < parts * parts; ++i) {
        colourAt(left + scale * (x + (i % parts + 0.5) / parts),
                 top + scale * (y + (i / parts + 0.5) / parts), one);
        for (int c = 0; c < 3; ++c) sum[c] += one[c];
      }
      for (int c = 0; c < 3; ++c) pixel[c] += open * sum[c] / float(parts * parts);
    }
}

} // namespace picture
