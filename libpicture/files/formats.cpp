// formats.cpp: Defines the table of file formats that pictures are written in.
#include "libpicture/files/formats.h"
#include "lower_case.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace picture {

namespace {

// name, suffixes, keepsAlpha, appliesCurve, keepsNote, encode; in the order in which messages list
// them
constexpr Format table[] = {
    {"EXR", {"exr"}, true, false, true, encodeExr},
    {"PNG", {"png"}, true, true, true, encodePng},
    {"JPEG", {"jpg", "jpeg"}, false, true, true, encodeJpeg},
    {"PPM", {"ppm"}, false, true, true, encodePpm},
    {"PFM", {"pfm"}, false, false, false, encodePfm},
    {"HDR", {"hdr"}, false, false, true, encodeHdr},
};

} // namespace

std::span<const Format> formatTable() { return table; }

const Format* formatNamed(std::string_view suffix) {
  if (suffix.empty()) return nullptr; // a format may have an empty second suffix
  const std::string lower = lowerCase(suffix);
  for (const Format& format : table)
    if (lower == format.suffixes[0] || lower == format.suffixes[1]) return &format;
  return nullptr;
}

const Format* formatOf(std::string_view path) {
  const size_t dot = path.rfind('.');
  if (dot == path.npos || path.find('/', dot) != path.npos) return nullptr;
  return formatNamed(path.substr(dot + 1));
}

std::string formatSuffixes() {
  std::string list;
  for (const Format& format : table) {
    if (!list.empty()) list += ", ";
    list += format.suffixes[0];
  }
  return list;
}

std::string formatsWith(bool Format::*property) {
  std::vector<std::string_view> names;
  for (const Format& format : table)
    if (format.*property) names.push_back(format.name);
  if (names.size() < 2) return std::string(names.empty() ? "none" : names.front());
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

} // namespace picture
