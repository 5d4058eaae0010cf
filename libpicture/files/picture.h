// picture.h: a rendered picture in memory and its file formats. Owned by whoever rendered it; vv
// and the Python binding both write pictures through this. [any thread]
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
  bool linear = true; // rgba is linear radiance; false: the numbers are display values already
  bool transparent = false; // a PNG of it has alpha
  std::map<uint32_t, std::vector<float>>
      planes;                     // by Channel::bit; width*height*components, first row at the top
  std::vector<std::string> names; // what the numbers of channel id stand for; names[0] is ""
};

enum class Format { png, jpeg, exr, ppm, pfm };
// By the suffix of a file name; nothing for an unknown one.
std::optional<Format> formatOf(std::string_view path);
std::optional<Format> formatNamed(std::string_view name);
inline constexpr std::string_view formatNames = "exr, png, jpg, ppm, pfm";

// The bytes of a file. png, jpeg and ppm hold 8 bit red, green, blue with the sRGB curve if the
// picture is linear, png also alpha if the picture is transparent (colours are not multiplied with
// it then); pfm holds red, green, blue and exr every channel of the picture, as they are. Throws
// std::runtime_error.
std::string encode(const Picture& picture, Format format);

// 8 bit red, green, blue of the picture as a screen shows it, first row at the top.
std::vector<uint8_t> displayBytes(const Picture& picture);
// The same with alpha, and colours that are not multiplied with it.
std::vector<uint8_t> displayBytesAlpha(const Picture& picture);

// The encoders behind encode(), one file each.
std::string encodePng(const Picture& picture);
std::string encodeJpeg(const Picture& picture);
std::string encodeExr(const Picture& picture);

// rgba of an OpenEXR file, and error and trust if it has them. Throws std::runtime_error that names
// the file.
Picture readExr(const std::string& path);

} // namespace picture
