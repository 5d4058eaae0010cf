// photometry.h: the luminous intensity of a luminaire by direction, and the reader of numbers that
// the parsers of measured luminaires share (ies.h, eulumdat.h). The texts are untrusted: sizes are
// bounded, and every error has a message. Pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace photometry {

// Limits of the angles of one kind and of all intensities.
constexpr size_t maxAngles = 4096, maxValues = size_t(1) << 20;

// How a direction is told by two angles (ANSI/IES LM-63, CIE 121). The photometric axis points down
// in type C, and forward in types A and B, where positive angles point right and up.
enum class Type {
  C, // vertical: from the axis, 0 to 180; horizontal: around it, counter-clockwise seen from above
  B, // polar axis horizontal: vertical turns around it, horizontal leads to the side, -90 to 90
  A  // polar axis vertical: horizontal turns around it, vertical leads up, -90 to 90
};

// A point or direction: along the photometric axis, and towards horizontal angles 0 and 90.
using Coordinates = std::array<double, 3>;

enum class Shape {
  box,
  cylinder, // elliptic
  ellipsoid
};

// The part of a luminaire that shines, in metres, about the photometric centre. A file that does
// not say it has zeros.
struct Opening {
  double zero = 0, ninety = 0; // sizes towards horizontal angles 0 and 90
  // of the sides that face horizontal angles 0, 90, 180 and 270
  double heights[4] = {};
  Shape shape = Shape::box;
  // An opening that lies has the photometric axis and the coordinate `upright` exchanged: its
  // heights are then its size along that coordinate, in place of zero (1) or ninety (2).
  size_t upright = 0;

  bool exists() const {
    return zero > 0 && ninety > 0 && (shape != Shape::ellipsoid || heights[0] > 0);
  }
  // Returns where a ray meets the opening from outside, in lengths of its direction; infinite: it
  // does not.
  double meet(Coordinates from, Coordinates along) const {
    std::swap(from[0], from[upright]);
    std::swap(along[0], along[upright]);
    const double distance =
        shape == Shape::ellipsoid ? reachRound(from, along, heights[0]) : meetSides(from, along);
    return distance > 0 ? distance : std::numeric_limits<double>::infinity();
  }
  // Returns the area that is seen from a direction, a unit vector as for Photometry::towards.
  double projected(double axis, double toZero, double toNinety) const {
    Coordinates way = {axis, toZero, toNinety};
    std::swap(way[0], way[upright]);
    const double h0 = heights[way[1] < 0 ? 2 : 0], h90 = heights[way[2] < 0 ? 3 : 1],
                 face = zero * ninety * std::fabs(way[0]);
    if (shape == Shape::ellipsoid)
      return M_PI / 4 * std::hypot(face, h0 * ninety * way[1], h0 * zero * way[2]);
    if (shape == Shape::cylinder)
      return M_PI / 4 * face + h0 * std::hypot(ninety * way[1], zero * way[2]);
    return face + ninety * h0 * std::fabs(way[1]) + zero * h90 * std::fabs(way[2]);
  }

 private:
  // Returns how far it is to a box or cylinder; 0: it is not met. The sides stand on the lower
  // face, which is half of the largest height below the centre.
  double meetSides(const Coordinates& from, const Coordinates& along) const {
    const double low = *std::max_element(heights, heights + 4) / 2;
    const bool isRound = shape == Shape::cylinder;
    const auto at = [&](double distance, size_t k) { return from[k] + distance * along[k]; };
    const auto isOnFace = [&](double d) {
      return isRound ? std::hypot(at(d, 1) / zero, at(d, 2) / ninety) <= .5
                     : std::fabs(at(d, 1)) <= zero / 2 && std::fabs(at(d, 2)) <= ninety / 2;
    };
    if (const double d = reach(from[0], along[0], low); d > 0 && isOnFace(d)) return d;
    for (size_t k = 1; k <= (isRound ? 1 : 2); k++) { // the side that the ray comes from
      const double d = isRound ? reachRound(from, along, std::numeric_limits<double>::infinity())
                               : reach(from[k], along[k], (k == 1 ? zero : ninety) / 2),
                   height = heights[k - 1 + (along[k] > 0 ? 2 : 0)];
      if (d > 0 && at(d, 0) <= low && at(d, 0) >= low - height && height > 0 &&
          (isRound || std::fabs(at(d, 3 - k)) <= (k == 1 ? ninety : zero) / 2))
        return d;
    }
    return 0;
  }
  // Returns how far it is to the nearer of two planes at both sides of the centre; 0: never.
  static double reach(double from, double along, double plane) {
    return along == 0 ? 0 : ((along < 0 ? plane : -plane) - from) / along;
  }
  // Returns how far it is to an ellipsoid, from outside; 0: never. One of infinite height is the
  // mantle of a cylinder.
  double reachRound(const Coordinates& from, const Coordinates& along, double height) const {
    const double sizes[3] = {height, zero, ninety};
    double a = 0, b = 0, c = -.25;
    for (size_t k = 0; k < 3; k++) {
      const double p = from[k] / sizes[k], v = along[k] / sizes[k];
      a += v * v;
      b += p * v;
      c += p * p;
    }
    const double root = b * b - a * c;
    return a > 0 && root > 0 ? (-b - std::sqrt(root)) / a : 0;
  }
};

class Photometry {
 public:
  Opening opening;
  Type type = Type::C;
  // In degrees. Horizontal angles cover the part that the file contains.
  std::vector<float> vertical, horizontal;
  std::vector<float> candela; // by horizontal, then by vertical angle, all factors applied

  // Returns the intensity in candela in a direction of any length: along the photometric axis,
  // towards horizontal angle 0 (types A and B: right), and towards 90 degrees (up).
  float towards(double axis, double zero, double ninety) const {
    constexpr double degrees = 180 / M_PI;
    if (type == Type::A)
      return intensity(std::atan2(ninety, std::hypot(axis, zero)) * degrees,
                       std::atan2(zero, axis) * degrees);
    if (type == Type::B)
      return intensity(std::atan2(ninety, axis) * degrees,
                       std::atan2(zero, std::hypot(axis, ninety)) * degrees);
    return intensity(std::atan2(std::hypot(zero, ninety), axis) * degrees,
                     std::atan2(ninety, zero) * degrees);
  }

  // Returns the interpolated intensity in candela; 0 outside the measured angles.
  float intensity(double up, double around) const {
    if (up < double(vertical.front()) || up > double(vertical.back())) return 0;
    if (type != Type::C) {
      if (horizontal.front() >= 0) around = std::fabs(around); // one side stands for both
      if (around < double(horizontal.front()) || around > double(horizontal.back())) return 0;
    }
    const Interpolation v = interpolationAt(vertical, up),
                        h = interpolationAt(horizontal,
                                            type == Type::C ? foldToMeasured(around) : around);
    const auto at = [&](size_t column, size_t row) {
      return double(candela[column * vertical.size() + row]);
    };
    const auto along = [&](size_t column) {
      return at(column, v.first) * (1 - v.weight) + at(column, v.second) * v.weight;
    };
    return float(along(h.first) * (1 - h.weight) + along(h.second) * h.weight);
  }
  float largest() const { return *std::max_element(candela.begin(), candela.end()); }
  // Returns the luminous flux in lumen: the integral over all directions, by the midpoint rule on
  // fine cells.
  double flux() const {
    constexpr int rows = 360, columns = 144;
    double sum = 0;
    for (int row = 0; row < rows; row++) {
      const double down = M_PI * (row + .5) / rows, sine = std::sin(down);
      for (int column = 0; column < columns; column++) {
        const double turn = 2 * M_PI * (column + .5) / columns;
        sum += double(towards(std::cos(down), sine * std::cos(turn), sine * std::sin(turn))) * sine;
      }
    }
    return sum * (M_PI / rows) * (2 * M_PI / columns);
  }
  // Multiplies all intensities. Returns false if one would not be a finite float.
  bool scale(double factor) {
    if (!(double(largest()) * factor <= 1e30)) return false;
    for (float& value : candela) value = float(double(value) * factor);
    return true;
  }

 private:
  struct Interpolation {
    size_t first, second;
    double weight;
  };
  // Finds the two angles around `at`. Beyond the last angle it interpolates to the first one, a
  // full turn later.
  static Interpolation interpolationAt(const std::vector<float>& angles, double at) {
    if (angles.size() == 1) return {0, 0, 0};
    const size_t last = angles.size() - 1;
    if (at >= double(angles[last])) {
      const double gap = double(angles[0]) + 360 - double(angles[last]);
      return gap > 0 && at > double(angles[last])
                 ? Interpolation{last, 0, (at - double(angles[last])) / gap}
                 : Interpolation{last, last, 0};
    }
    const auto above = std::upper_bound(angles.begin(), angles.end(), float(at), std::less<>());
    const size_t i = std::clamp<size_t>(size_t(above - angles.begin()), 1, last);
    const double low = double(angles[i - 1]), high = double(angles[i]);
    return {i - 1, i, std::clamp((at - low) / (high - low), 0.0, 1.0)};
  }
  // Maps a horizontal angle to the measured range; the rest is symmetric to it.
  double foldToMeasured(double around) const {
    around = std::fmod(around, 360.0);
    if (around < 0) around += 360;
    const double first = double(horizontal.front()), last = double(horizontal.back());
    if (horizontal.size() == 1) return first;
    if (first == 90)
      return around >= 90 && around <= 270 ? around : around < 90 ? 180 - around : 540 - around;
    if (last > 180) return around;
    if (around > 180) around = 360 - around;
    return last == 90 && around > 90 ? 180 - around : around;
  }
};

inline bool isBlank(char c) { return c == ' ' || c == '\t'; }

// Takes the first line off a text, without its end and the blanks around it. A line ends with
// "\n", "\r\n" or, in files of old Macintoshes, "\r".
inline std::string_view takeLine(std::string_view& text) {
  const size_t end = std::min(text.find_first_of("\r\n"), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  text.remove_prefix(text.substr(0, 2) == "\r\n" ? 2 : std::min<size_t>(1, text.size()));
  while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
  while (!line.empty() && isBlank(line.front())) line.remove_prefix(1);
  return line;
}

// Returns whether a line is TILT=..., which ends the keywords of an IES file; `value` is what
// follows, in capitals. Files in use have blanks about the equals sign and small letters.
inline bool isTilt(std::string_view line, std::string& value) {
  std::string capitals(line);
  for (char& c : capitals) c = char(std::toupper(static_cast<unsigned char>(c)));
  if (capitals.substr(0, 4) != "TILT") return false;
  const size_t equals = capitals.find_first_not_of(" \t", 4);
  if (equals == std::string::npos || capitals[equals] != '=') return false;
  const size_t begin = capitals.find_first_not_of(" \t", equals + 1);
  value = begin == std::string::npos ? "" : capitals.substr(begin);
  return true;
}

// Reads numbers one after the other, across line ends. Blanks and commas separate them.
class Reader {
 public:
  Reader(std::string_view text, int line) : rest_(text), line_(line) {}
  int line() const { return line_; }
  bool number(double& out) {
    while (!rest_.empty() && separates(rest_[0])) {
      line_ += rest_[0] == '\n' || (rest_[0] == '\r' && rest_.substr(0, 2) != "\r\n");
      rest_.remove_prefix(1);
    }
    if (!rest_.empty() && rest_[0] == '+') rest_.remove_prefix(1);
    const auto result = std::from_chars(rest_.data(), rest_.data() + rest_.size(), out);
    if (result.ec != std::errc() || !std::isfinite(out) || std::fabs(out) > 1e30) return false;
    rest_.remove_prefix(size_t(result.ptr - rest_.data()));
    return rest_.empty() || separates(rest_[0]);
  }
  bool numbers(size_t count, double factor, std::vector<float>& out) {
    out.clear();
    for (size_t i = 0; i < count; i++) {
      double value;
      if (!number(value) || !std::isfinite(value * factor) || std::fabs(value * factor) > 1e30)
        return false;
      out.push_back(float(value * factor));
    }
    return true;
  }

 private:
  // Control characters separate as well: some files end with the byte 26.
  static bool separates(char c) { return static_cast<unsigned char>(c) <= ' ' || c == ','; }
  std::string_view rest_;
  int line_;
};

inline bool rising(const std::vector<float>& angles) {
  return std::adjacent_find(angles.begin(), angles.end(),
                            [](float a, float b) { return !(a < b); }) == angles.end();
}

} // namespace photometry
