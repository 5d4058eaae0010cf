// ies.h: reads the text of ANSI/IES LM-63 files (1986, 1991, 1995, 2002, 2019) of photometric type
// C, and returns the intensity of the luminaire in a direction. The text is untrusted: sizes are
// bounded, and every error has a message. Pure functions.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

namespace ies {

// Limits of the angles of one kind and of all intensities.
constexpr size_t maxAngles = 4096, maxValues = size_t(1) << 20;

class Photometry {
 public:
  // In degrees. Vertical 0 is straight down; horizontal angles cover the part that the file
  // contains.
  std::vector<float> vertical, horizontal;
  std::vector<float> candela; // by horizontal, then by vertical angle, all factors applied

  // Returns the interpolated intensity in candela; 0 outside the measured vertical angles.
  float intensity(double down, double around) const {
    if (down < double(vertical.front()) || down > double(vertical.back())) return 0;
    const Interpolation v = interpolationAt(vertical, down),
                        h = interpolationAt(horizontal, foldToMeasured(around));
    const auto at = [&](size_t column, size_t row) {
      return double(candela[column * vertical.size() + row]);
    };
    const auto along = [&](size_t column) {
      return at(column, v.first) * (1 - v.weight) + at(column, v.second) * v.weight;
    };
    return float(along(h.first) * (1 - h.weight) + along(h.second) * h.weight);
  }
  float largest() const { return *std::max_element(candela.begin(), candela.end()); }
  // Returns the luminous flux: the integral over all directions, by the midpoint rule on fine
  // cells.
  double flux() const {
    constexpr int rows = 360, columns = 144;
    double sum = 0;
    for (int row = 0; row < rows; row++) {
      const double down = 180.0 * (row + .5) / rows, sine = std::sin(down * M_PI / 180);
      for (int column = 0; column < columns; column++)
        sum += double(intensity(down, 360.0 * (column + .5) / columns)) * sine;
    }
    return sum * (M_PI / rows) * (2 * M_PI / columns);
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

// Reads numbers one after the other, across line ends.
class Reader {
 public:
  Reader(std::string_view text, int line) : rest_(text), line_(line) {}
  int line() const { return line_; }
  bool number(double& out) {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r' ||
                              rest_[0] == '\n' || rest_[0] == ',')) {
      line_ += rest_[0] == '\n';
      rest_.remove_prefix(1);
    }
    if (!rest_.empty() && rest_[0] == '+') rest_.remove_prefix(1);
    const auto result = std::from_chars(rest_.data(), rest_.data() + rest_.size(), out);
    if (result.ec != std::errc() || !std::isfinite(out) || std::fabs(out) > 1e30) return false;
    rest_.remove_prefix(size_t(result.ptr - rest_.data()));
    return true;
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
  std::string_view rest_;
  int line_;
};

inline bool rising(const std::vector<float>& angles) {
  return std::adjacent_find(angles.begin(), angles.end(),
                            [](float a, float b) { return !(a < b); }) == angles.end();
}

// Parses a file. Returns null, or an error message; `line` is then the line of the error.
inline const char* parse(std::string_view text, Photometry& out, int& line) {
  line = 1;
  if (text.empty()) return "the profile is empty: give the text of an IES LM-63 file";
  // Skips the keywords before the line TILT=... Only the two oldest formats (1986, 1991) have a
  // second factor; later formats have 1 in its place.
  const bool factorLater = text.substr(0, 5) != "IESNA" && text.substr(0, 4) != "IES:"
                               ? true
                               : text.substr(0, 7) == "IESNA91";
  std::string_view tilt;
  for (;; line++) {
    const size_t end = text.find('\n');
    std::string_view here = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    while (!here.empty() && (here.back() == '\r' || here.back() == ' ' || here.back() == '\t'))
      here.remove_suffix(1);
    while (!here.empty() && (here.front() == ' ' || here.front() == '\t')) here.remove_prefix(1);
    if (here.substr(0, 5) == "TILT=") {
      tilt = here.substr(5);
      break;
    }
    if (text.empty()) return "this is not an IES file: there is no line TILT=";
  }
  if (tilt == "INCLUDE")
    return "TILT=INCLUDE is not supported: the lamp's output would depend on how the luminaire "
           "hangs";
  if (tilt != "NONE") return "TILT names a file; only TILT=NONE is supported";
  Reader reader(text, line + 1);
  // Lamps, lumens, multiplier, numbers of vertical and horizontal angles, type, units, three sizes,
  // ballast factor, ballast-lamp factor, watts.
  double head[13];
  for (double& value : head) {
    const bool good = reader.number(value);
    line = reader.line();
    if (!good) return "a number of the luminaire's description is missing or not a number";
  }
  const double factor = head[2] * head[10] * (factorLater ? head[11] : 1);
  if (!(factor >= 0)) return "the multiplier or the ballast factor is negative";
  if (!(head[3] >= 1 && head[3] <= double(maxAngles)) ||
      !(head[4] >= 1 && head[4] <= double(maxAngles)) || head[3] != std::floor(head[3]) ||
      head[4] != std::floor(head[4]) || head[3] * head[4] > double(maxValues))
    return "the number of angles is out of range: 1 to 4096 each, 2^20 values";
  if (head[5] != 1) return "only photometric type C (1) is supported";
  const auto rows = size_t(head[3]), columns = size_t(head[4]);
  const char* message = nullptr;
  if (!reader.numbers(rows, 1, out.vertical))
    message = "a vertical angle is missing or not a number";
  else if (!rising(out.vertical) || out.vertical.front() < 0 || out.vertical.back() > 180)
    message = "vertical angles must rise from 0 to 180 degrees";
  else if (!reader.numbers(columns, 1, out.horizontal))
    message = "a horizontal angle is missing or not a number";
  else if (!rising(out.horizontal) || out.horizontal.front() < 0 || out.horizontal.back() > 360)
    message = "horizontal angles must rise from 0 to 360 degrees";
  else if (const float first = out.horizontal.front(), last = out.horizontal.back();
           columns > 1 && !(first == 0 && (last == 90 || last >= 180)) &&
           !(first == 90 && last == 270))
    message = "horizontal angles must run from 0 to 0, 90, 180 or 360 degrees, or from 90 to 270";
  else if (!reader.numbers(rows * columns, factor, out.candela))
    message = "a candela value is missing, not a number, or too large";
  else if (*std::min_element(out.candela.begin(), out.candela.end()) < 0)
    message = "a candela value is negative";
  line = reader.line();
  return message;
}

} // namespace ies
