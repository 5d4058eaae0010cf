#include "values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "habits.h"

namespace vv {

namespace {

// Parses the whole text as a number; blanks, a `+` sign and the locale's format are not accepted.
template <class T> bool whole(std::string_view text, T& value) {
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

void readTriple(std::string_view text, double out[3]) {
  std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) throw UsageError("");
  for (size_t i = 0; i < 3; ++i)
    if (!whole(parts[i], out[i]) || !(std::abs(out[i]) < 1e30)) throw UsageError("");
}

} // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t start = 0;;) {
    size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == text.npos) return parts;
    start = end + 1;
  }
}

long long readInteger(std::string_view text, long long minimum, long long maximum) {
  long long value = 0;
  if (!whole(text, value) || value < minimum || value > maximum)
    throw UsageError(fmt::format("a whole number from {} to {} was expected, not \"{}\"", minimum,
                                 maximum, text));
  return value;
}

double readNumber(std::string_view text, double minimum, double maximum) {
  double value = 0;
  if (!whole(text, value) || !(value > minimum && value < maximum))
    throw UsageError(maximum > 1e30
                         ? fmt::format("a number above {} was expected, not \"{}\"", minimum, text)
                         : fmt::format("a number between {} and {} was expected, not \"{}\"",
                                       minimum, maximum, text));
  return value;
}

double readQuality(RTenum quality, std::string_view text) {
  if (picture::isSwitch(quality)) return readSwitch(text) ? 1 : 0;
  const RTqualityInfo info = picture::qualityInfo(quality);
  if (info.choices) {
    if (const std::optional<int> value = picture::qualityNamed(quality, text)) return *value;
    throw UsageError(
        fmt::format("{} was expected, not \"{}\"", picture::qualityChoiceList(quality), text));
  }
  double value = 0;
  long long count = 0;
  const bool read = info.isReal ? whole(text, value) : whole(text, count);
  if (!info.isReal) value = double(count);
  if (!read || !rtIsQualityAllowed(quality, value))
    throw UsageError(
        fmt::format("{} was expected, not \"{}\"", picture::qualityRange(quality), text));
  return value;
}

double readSeconds(std::string_view text) {
  double value = 0;
  if (!whole(text, value) || !(value >= 0 && value <= 1e6))
    throw UsageError(fmt::format("seconds from 0 to 1000000 were expected, not \"{}\"", text));
  return value;
}

double readShare(RTenum quality, std::string_view text) {
  const bool percent = text.ends_with('%');
  double value = 0;
  const bool read = whole(text.substr(0, text.size() - (percent ? 1 : 0)), value);
  if (percent) value /= 100;
  if (!read || !rtIsQualityAllowed(quality, value))
    throw UsageError(fmt::format("{}, or up to {:.10g}%, was expected, not \"{}\"",
                                 picture::qualityRange(quality),
                                 100 * picture::qualityInfo(quality).maximum, text));
  return value;
}

FrameRange readFrames(std::string_view text) {
  constexpr long long most = 10'000'000;
  FrameRange range;
  std::string_view numbers = text;
  const auto good = [](std::string_view digits, long long least, long long& out) {
    return whole(digits, out) && out >= least && out <= most;
  };
  bool fine = true;
  if (const size_t slash = numbers.find('/'); slash != numbers.npos) {
    fine = good(numbers.substr(slash + 1), 1, range.step);
    numbers = numbers.substr(0, slash);
  }
  const size_t dash = numbers.find('-', 1 <= numbers.size() ? 1 : 0);
  fine = fine && good(numbers.substr(0, dash), 0, range.first);
  range.last = range.first;
  if (dash != numbers.npos) fine = fine && good(numbers.substr(dash + 1), range.first, range.last);
  if (!fine)
    throw UsageError(fmt::format(
        "FIRST-LAST or FIRST-LAST/STEP was expected, with whole numbers up to {}, not \"{}\"", most,
        text));
  return range;
}

uint64_t readCount(std::string_view text) {
  int shift = 0;
  std::string_view digits = text;
  if (!digits.empty()) {
    switch (digits.back()) {
    case 'k': shift = 10; break;
    case 'M': shift = 20; break;
    case 'G': shift = 30; break;
    default: break;
    }
    if (shift) digits.remove_suffix(1);
  }
  uint64_t value = 0;
  if (!whole(digits, value) || value > (std::numeric_limits<uint64_t>::max() >> shift))
    throw UsageError(
        fmt::format("a count was expected (digits, then k, M or G if wanted), not \"{}\"", text));
  return value << shift;
}

bool readSwitch(std::string_view text) {
  if (text == "on") return true;
  if (text == "off") return false;
  throw UsageError(fmt::format("on or off was expected, not \"{}\"", text));
}

void readSize(std::string_view text, int& width, int& height) {
  std::vector<std::string_view> parts = split(text, 'x');
  int w = 0, h = 0;
  const bool read = parts.size() == 2 && whole(parts[0], w) && whole(parts[1], h);
  if (!read || w < 1 || h < 1 || w > 65536 || h > 65536 || int64_t(w) * h > (int64_t(1) << 28))
    throw UsageError(fmt::format("a size such as 640x480 was expected (each side 1 to 65536, at "
                                 "most 2^28 pixels), not \"{}\"{}",
                                 text, sizeHint(text)));
  width = w;
  height = h;
}

picture::LookAt readCamera(std::string_view text) {
  picture::LookAt camera;
  double matrix[16];
  try {
    std::vector<std::string_view> parts = split(text, ':');
    if (parts.size() != 2 && parts.size() != 3) throw UsageError("");
    readTriple(parts[0], camera.position);
    readTriple(parts[1], camera.target);
    if (parts.size() == 3) {
      readTriple(parts[2], camera.up);
      camera.saysUp = true;
    }
  } catch (const UsageError&) {
    throw UsageError(fmt::format("position, target and, if wanted, up vector as "
                                 "px,py,pz:tx,ty,tz:ux,uy,uz were expected, not \"{}\"",
                                 text));
  }
  if (!picture::lookAtMatrix(camera, matrix))
    throw UsageError("position and target are the same point");
  return camera;
}

xvrml::Axis readAxis(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const std::optional<xvrml::Axis> axis = picture::axisNamed(small);
  if (!axis) throw UsageError(fmt::format("x, y, z, -x, -y or -z was expected, not \"{}\"", text));
  return *axis;
}

} // namespace vv
