#include "names.h"

#include <cctype>

#include <fmt/format.h>

#include "values.h"

namespace vv {

namespace {

constexpr std::string_view viewpointPlace = "{viewpoint}", frameStart = "{frame";
constexpr int defaultDigits = 4, maxDigits = 12;

struct FramePlace {
  size_t at = std::string::npos, length = 0;
  int digits = defaultDigits;
};

FramePlace findFrame(const std::string& path) {
  FramePlace place;
  place.at = path.find(frameStart);
  if (place.at == path.npos) return place;
  const size_t end = path.find('}', place.at);
  const size_t from = place.at + frameStart.size();
  const std::string inside = end == path.npos ? "?" : path.substr(from, end - from);
  if (inside.empty())
    place.digits = 1;
  else if (inside[0] != ':')
    throw UsageError(fmt::format("{{frame}} or {{frame:DIGITS}} was expected in \"{}\"", path));
  else
    place.digits = int(readInteger(std::string_view(inside).substr(1), 1, maxDigits));
  place.length = end + 1 - place.at;
  return place;
}

void beforeSuffix(std::string& path, const std::string& part) {
  const size_t slash = path.rfind('/'), dot = path.rfind('.');
  const bool hasSuffix = dot != path.npos && (slash == path.npos || dot > slash);
  path.insert(hasSuffix ? dot : path.size(), "-" + part);
}

} // namespace

std::string PictureName::text() const {
  if (!frame) return viewpoint;
  return fmt::format("{}{}frame {}", viewpoint, viewpoint.empty() ? "" : ", ", *frame);
}

void checkFramePlace(const std::string& path) { findFrame(path); }

std::string pathFor(const std::string& path, const PictureName& name) {
  std::string out = path;
  const size_t at = out.find(viewpointPlace);
  if (at != out.npos)
    out.replace(at, viewpointPlace.size(), name.viewpoint.empty() ? "0" : name.viewpoint);
  else if (!name.viewpoint.empty())
    beforeSuffix(out, name.viewpoint);
  const FramePlace place = findFrame(out);
  const std::string number = fmt::format("{:0{}}", name.frame.value_or(0), place.digits);
  if (place.at != out.npos)
    out.replace(place.at, place.length, number);
  else if (name.frame)
    beforeSuffix(out, number);
  return out;
}

std::string fileNamePart(const std::string& name) {
  std::string part;
  for (unsigned char c : name)
    part += std::isalnum(c) || c == '-' || c == '_' || c >= 0x80 ? char(c) : '_';
  return part;
}

} // namespace vv
