// picture.h: Holds a rendered picture in memory and encodes it in the file formats. vv and the
// Python binding write pictures through this. The renderer's caller owns the picture. [any thread]
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace picture {

// One channel of a frame: its name on the command line and in Python, OpenRT's bit, and the names
// of its planes in OpenEXR.
struct Channel {
  std::string_view name;
  uint32_t bit;
  int components;
  std::string_view exr[4];
  std::string_view text;
};
std::span<const Channel> channelTable();
const Channel* findChannel(std::string_view name);

struct Picture {
  int width = 0, height = 0;
  bool linear = true;       // true: rgba is linear radiance; false: rgba holds display values
  bool transparent = false; // a PNG of the picture has alpha
  // Indexed by Channel::bit; width*height*components floats, first row at the top.
  std::map<uint32_t, std::vector<float>> planes;
  std::vector<std::string> names; // names for the numbers of channel id; names[0] is ""
};

enum class Format { png, jpeg, exr, ppm, pfm };
// Returns the format for the suffix of a file name; nothing for an unknown one.
std::optional<Format> formatOf(std::string_view path);
std::optional<Format> formatNamed(std::string_view name);
inline constexpr std::string_view formatNames = "exr, png, jpg, ppm, pfm";

// Returns the bytes of a file. Throws std::runtime_error.
//
// * png, jpeg and ppm hold 8-bit red, green, blue. A linear picture is sRGB-encoded.
// * png also holds alpha if the picture is transparent; its colours are then not premultiplied.
// * pfm holds red, green, blue, and exr every channel, both unchanged.
std::string encode(const Picture& picture, Format format);

// Returns 8-bit red, green, blue as a screen shows them, first row at the top.
std::vector<uint8_t> displayBytes(const Picture& picture);
// Also returns alpha; the colours are not premultiplied.
std::vector<uint8_t> displayBytesAlpha(const Picture& picture);

// The encoders behind encode(), one file each.
std::string encodePng(const Picture& picture);
std::string encodeJpeg(const Picture& picture);
std::string encodeExr(const Picture& picture);

// Reads rgba of an OpenEXR file, and error and trust if it has them. Throws std::runtime_error that
// names the file.
Picture readExr(const std::string& path);

} // namespace picture
