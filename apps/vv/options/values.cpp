#include "values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "file_contents.h"
#include "habits.h"
#include "lower_case.h"
#include "number_text.h"
#include "picture_size.h"

namespace vv {

namespace {

void readTriple(std::string_view text, double out[3]) {
  std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 3) throw UsageError("");
  for (size_t i = 0; i < 3; ++i)
    if (!isNumber(parts[i], out[i]) || !(std::abs(out[i]) < 1e30)) throw UsageError("");
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
  if (!isNumber(text, value) || value < minimum || value > maximum)
    throw UsageError(fmt::format("a whole number from {} to {} was expected, not \"{}\"", minimum,
                                 maximum, text));
  return value;
}

double readNumber(std::string_view text, double minimum, double maximum) {
  double value = 0;
  if (!isNumber(text, value) || !(value > minimum && value < maximum))
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
  const bool read = info.isReal ? isNumber(text, value) : isNumber(text, count);
  if (!info.isReal) value = double(count);
  if (!read || !rtIsQualityAllowed(quality, value))
    throw UsageError(
        fmt::format("{} was expected, not \"{}\"", picture::qualityRange(quality), text));
  return value;
}

double readSeconds(std::string_view text) {
  double value = 0;
  if (!isNumber(text, value) || !(value >= 0 && value <= 1e6))
    throw UsageError(fmt::format("seconds from 0 to 1000000 were expected, not \"{}\"", text));
  return value;
}

double readShare(RTenum quality, std::string_view text) {
  const bool percent = text.ends_with('%');
  double value = 0;
  const bool read = isNumber(text.substr(0, text.size() - (percent ? 1 : 0)), value);
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
    return isNumber(digits, out) && out >= least && out <= most;
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
  if (!isNumber(digits, value) || value > (std::numeric_limits<uint64_t>::max() >> shift))
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
  const bool read = parts.size() == 2 && isNumber(parts[0], w) && isNumber(parts[1], h);
  if (!read || !isPictureSize(w, h))
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

picture::Crop readCrop(std::string_view text) {
  picture::Crop crop;
  const std::vector<std::string_view> parts = split(text, ',');
  const std::vector<std::string_view> size = split(parts.back(), 'x');
  const bool read = parts.size() == 3 && size.size() == 2 && isNumber(parts[0], crop.x) &&
                    isNumber(parts[1], crop.y) && isNumber(size[0], crop.width) &&
                    isNumber(size[1], crop.height);
  if (!read || crop.x < 0 || crop.y < 0 || crop.width < 1 || crop.height < 1)
    throw UsageError(fmt::format("X,Y,WxH was expected: the left upper pixel and the size of the "
                                 "part, such as 100,50,320x240, not \"{}\"",
                                 text));
  return crop;
}

std::array<int, 2> readSamplesOfTwo(std::string_view text) {
  std::array<int, 2> samples{};
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 2 || !isNumber(parts[0], samples[0]) || !isNumber(parts[1], samples[1]) ||
      samples[0] < 1 || samples[1] < 1)
    throw UsageError(fmt::format("N,M was expected: the samples per pixel of two pictures that are "
                                 "compared, not \"{}\" (--spp N sets those of a picture)",
                                 text));
  return samples;
}

picture::Intrinsics readIntrinsics(std::string_view text) {
  constexpr double most = 1e6, middle = 0.5; // pixels; of the first pixel, from the edge
  const std::vector<std::string_view> parts = split(text, ',');
  double numbers[4] = {};
  bool read = parts.size() == 4;
  for (size_t i = 0; i < 4 && read; ++i)
    read = isNumber(parts[i], numbers[i]) && std::abs(numbers[i]) <= most &&
           (i > 1 || numbers[i] >= 1 / most);
  if (!read)
    throw UsageError(
        fmt::format("FX,FY,CX,CY was expected: focal lengths from 1e-6 and the principal "
                    "point, in pixels, up to 1000000, not \"{}\"",
                    text));
  return {numbers[0], numbers[1], numbers[2] + middle, numbers[3] + middle};
}

namespace {

// Parses numbers between blanks, line breaks and commas; returns whether there are 16 and no more.
bool readMatrix(std::string_view text, double rows[16]) {
  size_t count = 0;
  for (size_t at = 0;;) {
    at = text.find_first_not_of(" \t\r\n,", at);
    if (at == text.npos) return count == 16;
    const size_t end = std::min(text.find_first_of(" \t\r\n,", at), text.size());
    if (count == 16 || !isNumber(text.substr(at, end - at), rows[count])) return false;
    ++count;
    at = end;
  }
}

// Reads at most as much as a matrix can need. Throws Failure.
std::string readPoseFile(const std::string& path) {
  constexpr size_t most = 4096;
  try {
    return fileContents(path, most);
  } catch (const std::runtime_error& why) {
    throw Failure{exitInput, fmt::format("--pose: cannot read {}: {}; 16 numbers were expected",
                                         path, why.what())};
  }
}

} // namespace

picture::LookAt readPose(std::string_view text, std::string& file) {
  bool opencv = true;
  for (const std::string_view name : {"opencv:", "opengl:"})
    if (text.starts_with(name)) {
      opencv = name == "opencv:";
      text.remove_prefix(name.size());
      break;
    }
  double rows[16];
  if (!readMatrix(text, rows)) {
    if (text.empty() || text.find_first_of(",") != text.npos)
      throw UsageError(fmt::format("16 numbers, row by row, or a file of them were expected, not "
                                   "\"{}\"",
                                   text));
    file = text;
    if (!readMatrix(readPoseFile(file), rows))
      throw Failure{exitInput, fmt::format("--pose: {}: 16 numbers were expected, row by row, and "
                                           "nothing else",
                                           file)};
  }
  if (opencv) // there y points down and z forward
    for (size_t i = 0; i < 3; ++i) {
      rows[4 * i + 1] = -rows[4 * i + 1];
      rows[4 * i + 2] = -rows[4 * i + 2];
    }
  try {
    return picture::lookAtOf(rows);
  } catch (const std::invalid_argument& error) {
    if (file.empty()) throw UsageError(error.what());
    throw Failure{exitInput, fmt::format("--pose: {}: {}", file, error.what())};
  }
}

xvrml::Axis readAxis(std::string_view text) {
  const std::optional<xvrml::Axis> axis = picture::axisNamed(lowerCase(text));
  if (!axis) throw UsageError(fmt::format("x, y, z, -x, -y or -z was expected, not \"{}\"", text));
  return *axis;
}

} // namespace vv
