// picture.cpp: Reads the library's table of channels, and converts pictures to display colours.
#include "libpicture/files/picture.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "libpicture/doubt.h"
#include "openrt/openrt.h"
#include "srgb.h"

namespace picture {

namespace {

Channel channelOf(const RTchannelInfo& info) {
  Channel channel{.name = info.name,
                  .bit = info.channel,
                  .components = info.components,
                  .exr = {},
                  .isWhole = info.kind == RT_CHANNEL_COUNTS || info.kind == RT_CHANNEL_NAMES,
                  .hasNames = info.kind == RT_CHANNEL_NAMES || info.kind == RT_CHANNEL_SHARES,
                  .text = info.text ? info.text : ""};
  std::istringstream words(info.planes);
  for (std::string plane; words >> plane;) channel.exr.push_back(plane);
  return channel;
}

uint8_t rounded(float v) { return uint8_t(v * 255 + 0.5f); }

// Converts linear values to sRGB bytes; pictures are displayed thirty times a second. A table gives
// a nearby byte, and comparisons then find exactly the byte of the formula.
class CurveBytes {
 public:
  CurveBytes() {
    for (uint32_t byte = 1; byte < 256; byte++) least_[byte] = leastOf(uint8_t(byte));
    least_[256] = std::numeric_limits<float>::infinity();
    for (uint32_t i = 0; i < places; i++) near_[i] = rounded(encodeSrgb(float(i) / places));
  }
  // Requires 0 < v < 1.
  uint8_t of(float v) const {
    uint32_t byte = near_[uint32_t(v * places)];
    while (v >= least_[byte + 1]) byte++;
    return uint8_t(byte);
  }

 private:
  // Returns the smallest float that becomes this byte, by bisection over the bit patterns.
  static float leastOf(uint8_t byte) {
    uint32_t below = 0, from = std::bit_cast<uint32_t>(1.0f);
    while (from - below > 1) {
      const uint32_t middle = below + (from - below) / 2;
      (rounded(encodeSrgb(std::bit_cast<float>(middle))) >= byte ? from : below) = middle;
    }
    return std::bit_cast<float>(from);
  }
  static constexpr uint32_t places = 4096;
  float least_[257] = {};
  uint8_t near_[places];
};

uint8_t displayByte(float v, bool linear) {
  static const CurveBytes curve;
  if (!(v > 0)) return 0; // also true for NaN
  if (v >= 1) return 255;
  return linear ? curve.of(v) : rounded(v);
}

} // namespace

const std::vector<Channel>& channelTable() {
  static const std::vector<Channel> table = [] {
    std::vector<Channel> rows;
    RTchannelInfo info{};
    info.size = sizeof info;
    for (int i = 0; rtGetChannelInfo(i, &info); ++i) rows.push_back(channelOf(info));
    return rows;
  }();
  return table;
}

const std::vector<Channel>& pictureChannels() {
  static const std::vector<Channel> table = [] {
    std::vector<Channel> rows = channelTable();
    rows.push_back({.name = "doubt",
                    .bit = doubtBit,
                    .components = 1,
                    .exr = {"doubt"},
                    .isWhole = false,
                    .hasNames = false,
                    .text = ""});
    return rows;
  }();
  return table;
}

namespace {

const Channel* find(const std::vector<Channel>& table, std::string_view name) {
  for (const Channel& channel : table)
    if (channel.name == name) return &channel;
  return nullptr;
}

} // namespace

const Channel* findChannel(std::string_view name) { return find(channelTable(), name); }
const Channel* findPictureChannel(std::string_view name) { return find(pictureChannels(), name); }

bool hasNames(uint32_t channels) {
  for (const Channel& channel : channelTable())
    if (channel.hasNames && (channels & channel.bit)) return true;
  return false;
}

const std::vector<float>& rgbaOf(const Picture& picture) {
  auto found = picture.planes.find(RT_RGBA);
  if (found == picture.planes.end()) throw std::runtime_error("the picture has no channel rgba");
  return found->second;
}

Picture withChannels(const Picture& picture, uint32_t channels) {
  Picture out{picture, {}};
  if (!hasNames(channels)) out.names.clear();
  for (const auto& [bit, plane] : picture.planes)
    if (channels & bit) out.planes[bit] = plane;
  return out;
}

void cut(Picture& picture, int x, int y, int width, int height) {
  for (const Channel& channel : pictureChannels()) {
    const auto found = picture.planes.find(channel.bit);
    if (found == picture.planes.end()) continue;
    const std::vector<float> whole = std::move(found->second);
    const auto components = size_t(channel.components), row = size_t(width) * components;
    found->second.resize(row * size_t(height));
    for (size_t j = 0; j < size_t(height); ++j)
      std::copy_n(
          whole.begin() +
              std::ptrdiff_t(((size_t(y) + j) * size_t(picture.width) + size_t(x)) * components),
          row, found->second.begin() + std::ptrdiff_t(j * row));
  }
  picture.wholeWidth = picture.width;
  picture.wholeHeight = picture.height;
  picture.left = x;
  picture.top = y;
  picture.width = width;
  picture.height = height;
}

// behind: what is seen behind the shapes, in the colours of rgba; null: black
static std::vector<uint8_t> bytesOver(const Picture& picture, const float* behind) {
  const std::vector<float>& rgba = rgbaOf(picture);
  const bool plain = picture.view.isPlain() || !picture.linear;
  std::vector<uint8_t> bytes(rgba.size() / 4 * 3);
  for (size_t i = 0; i < rgba.size() / 4; ++i) {
    float screen[3] = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
    const float open = 1 - rgba[4 * i + 3];
    for (size_t c = 0; behind && open > 0 && c < 3; ++c) screen[c] += open * behind[c];
    if (!plain) toScreen(picture.view, screen, screen);
    for (size_t c = 0; c < 3; ++c) bytes[3 * i + c] = displayByte(screen[c], picture.linear);
  }
  return bytes;
}

std::vector<uint8_t> displayBytes(const Picture& picture) {
  if (!picture.backdrop) return bytesOver(picture, nullptr);
  float behind[3];
  for (size_t c = 0; c < 3; ++c)
    behind[c] = picture.linear ? linearOf((*picture.backdrop)[c]) : (*picture.backdrop)[c];
  return bytesOver(picture, behind);
}

std::vector<uint8_t> displayBytesAlone(const Picture& picture) {
  return bytesOver(picture, nullptr);
}

std::vector<uint8_t> displayBytesAlpha(const Picture& picture) {
  const std::vector<float>& rgba = rgbaOf(picture);
  const bool plain = picture.view.isPlain() || !picture.linear;
  std::vector<uint8_t> bytes(rgba.size());
  for (size_t i = 0; i < rgba.size(); i += 4) {
    const float alpha = rgba[i + 3];
    bytes[i + 3] = displayByte(alpha, false);
    if (!(alpha > 0)) continue; // black, as all bytes are at first
    float screen[3];
    for (size_t c = 0; c < 3; ++c) screen[c] = rgba[i + c] / std::min(alpha, 1.0f);
    if (!plain) toScreen(picture.view, screen, screen);
    for (size_t c = 0; c < 3; ++c) bytes[i + c] = displayByte(screen[c], picture.linear);
  }
  return bytes;
}

} // namespace picture
