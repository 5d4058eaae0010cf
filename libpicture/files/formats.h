// formats.h: The table of file formats that pictures are written in. Whatever names or chooses a
// format reads the table: suffixes, messages, option texts of vv, docstrings of Python. [any
// thread]
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "libpicture/files/picture.h"

namespace picture {

// One file format: its name in texts, its suffixes, and what an encoded picture keeps.
struct Format {
  std::string_view name;
  std::string_view suffixes[2]; // lower case; the first is the usual one, the second may be empty
  bool keepsAlpha;              // the file has alpha if Picture::transparent is set
  bool appliesCurve;            // linear colours are sRGB-encoded
  bool keepsNote;               // the file has Picture::note
  // Returns the bytes of a file. Throws std::runtime_error that names the format.
  std::string (*encode)(const Picture& picture);
};
std::span<const Format> formatTable();

// Returns the format for a suffix in any case; null for an unknown one.
const Format* formatNamed(std::string_view suffix);
// Returns the format for the suffix of a file name; null for an unknown one.
const Format* formatOf(std::string_view path);

// Lists the usual suffixes: "exr, png, jpg".
std::string formatSuffixes();
// Lists the names of the formats with a property: "EXR and PNG" for &Format::keepsAlpha.
std::string formatsWith(bool Format::*property);

// The encoders of the table, one file each.
std::string encodeExr(const Picture& picture);
std::string encodeHdr(const Picture& picture);
std::string encodeJpeg(const Picture& picture);
std::string encodePfm(const Picture& picture);
std::string encodePng(const Picture& picture);
std::string encodePpm(const Picture& picture);

// Returns the bytes of a JPEG file for display bytes, first row at the top. quality: 1 to 100.
// note: a comment in the file. Throws std::runtime_error.
std::string jpegOf(const std::vector<uint8_t>& rgb, int width, int height, int quality,
                   const std::string& note = {});

// Returns the bytes of a PNG file for sRGB bytes, first row at the top. components: 1 grey, 2 grey
// and alpha, 3 colours, 4 colours and alpha. Throws std::runtime_error.
std::string pngOf(const std::vector<uint8_t>& bytes, int width, int height, int components,
                  std::string note = {});

} // namespace picture
