// eulumdat.h: reads the text of EULUMDAT files (.ldt; A. Stockmar, "EULUMDAT, ein
// Leuchtendatenformat für den europäischen Beleuchtungsplaner", Licht '90). Every value stands in a
// line of its own, and intensities are in candela per 1000 lumen of the lamps. Pure functions.
#pragma once

#include "photometry.h"

namespace eulumdat {

using photometry::maxAngles;
using photometry::maxValues;
using photometry::Photometry;
using photometry::rising;

// Reads a text line by line.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  int line() const { return line_; } // the number of the last line read, from 1
  bool next(std::string_view& out) {
    if (rest_.empty()) return false;
    out = photometry::takeLine(rest_);
    line_++;
    return true;
  }
  bool skip(size_t count) {
    std::string_view ignored;
    for (size_t i = 0; i < count; i++)
      if (!next(ignored)) return false;
    return true;
  }
  // Reads a line that begins with a number, perhaps with a decimal comma.
  bool number(double& out) {
    std::string_view text;
    if (!next(text) || text.empty()) return false;
    char copy[64] = {};
    const size_t size = std::min(text.size(), sizeof copy - 1);
    std::transform(text.begin(), text.begin() + std::ptrdiff_t(size), copy,
                   [](char c) { return c == ',' ? '.' : c; });
    const char* begin = copy + (copy[0] == '+');
    const auto result = std::from_chars(begin, copy + size, out);
    const bool ends = result.ptr == copy + size || photometry::isBlank(*result.ptr);
    return result.ec == std::errc() && ends && std::isfinite(out) && std::fabs(out) <= 1e30;
  }
  bool whole(double least, double most, size_t& out) {
    double value;
    if (!number(value) || !(value >= least && value <= most) || value != std::floor(value))
      return false;
    out = size_t(value);
    return true;
  }
  // Returns whether a number follows, after empty lines.
  bool moreNumbers() {
    std::string_view before = rest_, text;
    while (next(text) && text.empty()) before = rest_;
    rest_ = before;
    double ignored;
    return number(ignored);
  }
  bool numbers(size_t count, std::vector<float>& out) {
    out.clear();
    for (size_t i = 0; i < count; i++) {
      double value;
      if (!number(value)) return false;
      out.push_back(float(value));
    }
    return true;
  }

 private:
  std::string_view rest_;
  int line_ = 0;
};

// Which of the planes C0 ... a file contains, by its symmetry (line 3).
struct Planes {
  size_t first, count;
};
inline Planes planesOf(size_t symmetry, size_t all) {
  switch (symmetry) {
  case 1: return {0, 1};                     // about the vertical axis
  case 2: return {0, all / 2 + 1};           // to the plane C0-C180
  case 3: return {3 * all / 4, all / 2 + 1}; // to the plane C90-C270: from C270 by C0 to C90
  case 4: return {0, all / 4 + 1};           // to both
  default: return {0, all};
  }
}

// Writes the angles of the planes, mirrored where the symmetry is to C90-C270: then the file has
// the planes from C270 to C90, and Photometry wants those from C90 to C270. Returns null or an
// error message.
inline const char* arrangePlanes(const std::vector<float>& angles, size_t symmetry,
                                 const std::vector<float>& values, size_t rows, Photometry& out) {
  const Planes planes = planesOf(symmetry, angles.size());
  out.horizontal.clear();
  out.candela.clear();
  if (symmetry == 1) {
    out.horizontal = {0};
    out.candela = values;
    return nullptr;
  }
  for (size_t i = 0; i < planes.count; i++) {
    const size_t from = symmetry == 3 ? planes.count - 1 - i : i;
    float angle = angles[(planes.first + from) % angles.size()];
    if (symmetry == 3) angle = angle >= 180 ? 540 - angle : 180 - angle;
    out.horizontal.push_back(angle);
    const auto column = values.begin() + std::ptrdiff_t(from * rows);
    out.candela.insert(out.candela.end(), column, column + std::ptrdiff_t(rows));
  }
  const float first = out.horizontal.front(), last = out.horizontal.back();
  const bool fits = symmetry == 2   ? first == 0 && last == 180
                    : symmetry == 3 ? first == 90 && last == 270
                    : symmetry == 4 ? first == 0 && last == 90
                                    : first == 0 && (out.horizontal.size() == 1 || last > 180);
  return rising(out.horizontal) && fits && last <= 360
             ? nullptr
             : "the C-planes must rise and cover the part of the circle that the symmetry in line "
               "3 asks for";
}

// Reads the luminous opening, lines 16 to 21: length and width, where a width of 0 makes the length
// a diameter, and four heights, in millimetres. A line without a number counts as 0, because many
// files have none. Planes C0 and C180 are across the length.
inline photometry::Opening readOpening(Lines& lines) {
  const auto metres = [&lines] {
    double value;
    return lines.number(value) ? std::fmin(std::fmax(value, 0) / 1000, 1e3) : 0.0;
  };
  const double length = metres(), width = metres();
  photometry::Opening out;
  if (width == 0) out.shape = photometry::Shape::cylinder;
  out.zero = width == 0 ? length : width;
  out.ninety = length;
  for (double& height : out.heights) height = metres();
  return out;
}

// Parses a file. Returns null, or an error message; `line` is then the line of the error.
inline const char* parse(std::string_view text, Photometry& out, int& line) {
  Lines lines(text);
  const auto stop = [&](const char* message) {
    line = lines.line();
    return message;
  };
  size_t symmetry, planes, rows, sets, ignored;
  if (!lines.skip(1) || !lines.whole(0, 3, ignored))
    return stop("this is not an EULUMDAT file: line 2 is the type of luminaire, 0 to 3");
  if (!lines.whole(0, 4, symmetry)) return stop("the symmetry is a number from 0 to 4");
  if (!lines.whole(1, double(maxAngles), planes))
    return stop("the number of C-planes is out of range: 1 to 4096");
  if ((symmetry == 2 && planes % 2 != 0) || (symmetry > 2 && planes % 4 != 0))
    return stop("the number of C-planes does not fit the symmetry");
  if (!lines.skip(1) || !lines.whole(1, double(maxAngles), rows) || planes * rows > maxValues)
    return stop("the number of intensities per C-plane is out of range: 1 to 4096, 2^20 values in "
                "all");
  double factor, tilt, flux;
  lines.skip(9);
  out.opening = readOpening(lines);
  if (!lines.skip(2) || !lines.number(factor) || !(factor > 0))
    return stop("the conversion factor for intensities is missing, not a number, or not above 0");
  if (!lines.number(tilt)) return stop("the tilt during measurement is missing or not a number");
  if (!lines.whole(1, 1000, sets))
    return stop("the number of lamp sets is out of range: 1 to 1000");
  // Sets of lamps are alternatives; the first one counts.
  if (!lines.skip(2) || !lines.number(flux) || !(flux > 0))
    return stop("the luminous flux of the lamps is missing, not a number, or not above 0");
  if (!lines.skip(3 + 6 * (sets - 1) + 10)) return stop("the file ends before the C-planes");
  std::vector<float> angles, values;
  if (!lines.numbers(planes, angles)) return stop("a C-plane is missing or not a number");
  if (!lines.numbers(rows, out.vertical)) return stop("a gamma angle is missing or not a number");
  if (!rising(out.vertical) || out.vertical.front() < 0 || out.vertical.back() > 180)
    return stop("gamma angles must rise from 0 to 180 degrees");
  if (!lines.numbers(planesOf(symmetry, planes).count * rows, values))
    return stop("an intensity is missing or not a number");
  if (*std::min_element(values.begin(), values.end()) < 0) return stop("an intensity is negative");
  if (lines.moreNumbers())
    return stop("there are more intensities than the numbers of C-planes and of intensities per "
                "C-plane (lines 4 and 6) ask for");
  out.type = photometry::Type::C;
  if (const char* wrong = arrangePlanes(angles, symmetry, values, rows, out)) return stop(wrong);
  return out.scale(factor * flux / 1000) ? nullptr : stop("an intensity is too large");
}

// Tells whether a text that is no IES file (without a line TILT=) may be EULUMDAT: lines 2 and 3
// are small whole numbers.
inline bool looksLike(std::string_view text) {
  std::string ignored;
  for (std::string_view rest = text; !rest.empty();)
    if (photometry::isTilt(photometry::takeLine(rest), ignored)) return false;
  Lines lines(text);
  size_t number;
  return lines.skip(1) && lines.whole(0, 9, number) && lines.whole(0, 9, number);
}

} // namespace eulumdat
