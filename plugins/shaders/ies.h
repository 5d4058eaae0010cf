// ies.h: reads the text of ANSI/IES LM-63 files (1986, 1991, 1995, 2002, 2019) of photometric types
// A, B and C. Pure functions.
#pragma once

#include "photometry.h"

namespace ies {

using photometry::maxAngles;
using photometry::maxValues;
using photometry::Photometry;
using photometry::Reader;
using photometry::rising;
using photometry::Type;

// Reads what follows TILT=INCLUDE: how the lamp stands in the luminaire, and factors by the angle
// of tilt in degrees. Writes the factor at the angle `tilt`. Returns null or an error message.
inline const char* readTilt(Reader& reader, double tilt, double& factor) {
  double geometry, pairs;
  if (!reader.number(geometry) || geometry < 1 || geometry > 3 || !reader.number(pairs))
    return "TILT=INCLUDE needs the lamp's position (1, 2 or 3) and the number of tilt angles";
  if (!(pairs >= 1 && pairs <= double(maxAngles)) || pairs != std::floor(pairs))
    return "the number of tilt angles is out of range: 1 to 4096";
  std::vector<float> angles, factors;
  if (!reader.numbers(size_t(pairs), 1, angles) || !rising(angles))
    return "the tilt angles must be rising numbers";
  if (!reader.numbers(size_t(pairs), 1, factors) ||
      *std::min_element(factors.begin(), factors.end()) < 0)
    return "a tilt factor is missing, not a number, or negative";
  const size_t i =
      size_t(std::upper_bound(angles.begin(), angles.end(), float(tilt)) - angles.begin());
  if (i == 0 || i == angles.size()) {
    factor = double(factors[i == 0 ? 0 : i - 1]);
    return nullptr;
  }
  const double low = double(angles[i - 1]), high = double(angles[i]),
               weight = (tilt - low) / (high - low);
  factor = double(factors[i - 1]) * (1 - weight) + double(factors[i]) * weight;
  return nullptr;
}

// Returns null if the angles are those of a type, else an error message.
inline const char* wrongAngles(const Photometry& p) {
  const float low = p.vertical.front(), high = p.vertical.back(), first = p.horizontal.front(),
              last = p.horizontal.back();
  if (p.type != Type::C) {
    if (!rising(p.vertical) || low < -90 || high > 90)
      return "vertical angles of types A and B must rise from -90 to 90 degrees";
    if (!rising(p.horizontal) || first < -90 || last > 90 || (p.horizontal.size() > 1 && first > 0))
      return "horizontal angles of types A and B must rise from -90 or 0 to 90 degrees";
    if (p.horizontal.size() < 2) return "types A and B need two horizontal angles or more";
    return nullptr;
  }
  if (!rising(p.vertical) || low < 0 || high > 180)
    return "vertical angles must rise from 0 to 180 degrees";
  if (!rising(p.horizontal) || first < 0 || last > 360)
    return "horizontal angles must rise from 0 to 360 degrees";
  if (p.horizontal.size() > 1 && !(first == 0 && (last == 90 || last >= 180)) &&
      !(first == 90 && last == 270))
    return "horizontal angles must run from 0 to 0, 90, 180 or 360 degrees, or from 90 to 270";
  return nullptr;
}

// Returns the luminous opening: width across horizontal angle 0, length along it, height. units: 1
// feet, 2 metres. Two sizes below 0 are the diameters of something round, three are those of an
// ellipsoid (LM-63-2002, 5.11). LM-63-1995 writes 0 for a diameter that equals another.
inline photometry::Opening openingOf(double units, double width, double length, double height,
                                     bool isOf1995) {
  if (width < 0 && length == 0 && (height >= 0 || isOf1995)) length = width;
  if (width == 0 && length > 0 && height < 0) width = height;
  if (length == 0 && width > 0 && height < 0) length = height;
  const double metres = units == 1 ? .3048 : 1;
  const auto size = [metres](double value) { return std::fmin(std::fabs(value) * metres, 1e3); };
  photometry::Opening out;
  const bool isRound = width < 0 || length < 0;
  if (width < 0 && length < 0 && height < 0)
    out.shape = photometry::Shape::ellipsoid;
  else if (isRound)
    out.shape = photometry::Shape::cylinder;
  // A cylinder of which the height is a diameter lies along the third size.
  if (out.shape == photometry::Shape::cylinder && height < 0) out.upright = width < 0 ? 1 : 2;
  out.zero = size(out.upright == 1 ? height : length);
  out.ninety = size(out.upright == 2 ? height : width);
  for (double& h : out.heights)
    h = size(out.upright == 0 ? height : out.upright == 1 ? length : width);
  return out;
}

// Parses a file. tiltAngle: degrees by which the luminaire is tilted, for TILT=INCLUDE. Returns
// null, or an error message; `line` is then the line of the error.
inline const char* parse(std::string_view text, Photometry& out, int& line, double tiltAngle = 0) {
  line = 1;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3); // the byte order mark of UTF-8
  if (text.empty())
    return "the profile is empty: give the text of an IES LM-63 or EULUMDAT file, or lumen";
  // Skips the keywords before the line TILT=... Only the two oldest formats (1986, 1991) have a
  // second factor; later formats have 1 in its place.
  const bool factorLater = text.substr(0, 5) != "IESNA" && text.substr(0, 4) != "IES:"
                               ? true
                               : text.substr(0, 7) == "IESNA91";
  const bool isOf1995 = text.substr(0, 16) != "IESNA:LM-63-2002" && text.substr(0, 4) != "IES:";
  std::string tilt;
  for (; !photometry::isTilt(photometry::takeLine(text), tilt); line++)
    if (text.empty()) return "this is not an IES file: there is no line TILT=";
  if (tilt != "NONE" && tilt != "INCLUDE")
    return "TILT names a file; only TILT=NONE and TILT=INCLUDE are supported";
  Reader reader(text, line + 1);
  double tiltFactor = 1;
  if (tilt == "INCLUDE") {
    const char* wrong = readTilt(reader, tiltAngle, tiltFactor);
    line = reader.line();
    if (wrong) return wrong;
  }
  // Lamps, lumens, multiplier, numbers of vertical and horizontal angles, type, units, three sizes,
  // ballast factor, ballast-lamp factor, watts.
  double head[13];
  for (double& value : head) {
    const bool good = reader.number(value);
    line = reader.line();
    if (!good) return "a number of the luminaire's description is missing or not a number";
  }
  const double lampFactor = head[2] * head[10] * (factorLater ? head[11] : 1),
               factor = lampFactor * tiltFactor;
  if (!(lampFactor > 0)) return "the multiplier or a ballast factor is not above 0";
  if (!(head[3] >= 1 && head[3] <= double(maxAngles)) ||
      !(head[4] >= 1 && head[4] <= double(maxAngles)) || head[3] != std::floor(head[3]) ||
      head[4] != std::floor(head[4]) || head[3] * head[4] > double(maxValues))
    return "the number of angles is out of range: 1 to 4096 each, 2^20 values";
  if (head[5] != 1 && head[5] != 2 && head[5] != 3)
    return "the photometric type is 1 (C), 2 (B) or 3 (A)";
  out.opening = openingOf(head[6], head[7], head[8], head[9], isOf1995);
  out.type = head[5] == 1 ? Type::C : head[5] == 2 ? Type::B : Type::A;
  const auto rows = size_t(head[3]), columns = size_t(head[4]);
  const char* message = nullptr;
  if (!reader.numbers(rows, 1, out.vertical))
    message = "a vertical angle is missing or not a number";
  else if (!reader.numbers(columns, 1, out.horizontal))
    message = "a horizontal angle is missing or not a number";
  else if (const char* wrong = wrongAngles(out))
    message = wrong;
  else if (!reader.numbers(rows * columns, factor, out.candela))
    message = "a candela value is missing, not a number, or too large";
  else if (*std::min_element(out.candela.begin(), out.candela.end()) < 0)
    message = "a candela value is negative";
  line = reader.line();
  if (double extra; !message && reader.number(extra)) {
    line = reader.line();
    return "there are more numbers than the numbers of angles ask for: one of these is wrong, or "
           "numbers have decimal commas";
  }
  return message;
}

} // namespace ies
