// view_transform.h: Owns how scene-linear colours become those of a screen: the exposure and the
// curves of --view. picture.cpp applies them to files for screens; OpenEXR files only record them.
// Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace picture {

struct Picture;

// How linear light is brought into the range of a screen, before the curve of sRGB.
enum class ViewCurve : uint8_t {
  standard, // values above 1 are cut off
  filmic,   // J. Hable, "Filmic Tonemapping Operators", 2010: each colour by itself
  agx       // T. Sobotka's AgX, in the polynomial form of B. Wrensch: bright colours turn white
};
std::string_view curveName(ViewCurve curve);
std::optional<ViewCurve> curveNamed(std::string_view name);
inline constexpr std::string_view curveNames = "standard, filmic or agx";

// The largest exposure, and the smallest one with the other sign, in stops.
inline constexpr double mostExposure = 32;

struct ViewTransform {
  double exposure = 0; // in stops (EV): light is multiplied by 2 to this power
  ViewCurve curve = ViewCurve::standard;
  bool isPlain() const { return exposure == 0 && curve == ViewCurve::standard; }
  bool operator==(const ViewTransform&) const = default;
};

// Returns the linear value of an sRGB-encoded one.
float linearOf(float v);

// Converts linear Rec. 709 radiance to linear Rec. 709 values of a screen, from 0 to 1. A value
// that is not a number counts as dark. Both arrays may be the same.
void toScreen(const ViewTransform& view, const float radiance[3], float screen[3]);

// Returns the exposure that fits the luminances of a picture, in stops, a multiple of 1/64: E.
// Reinhard, "Parameter Estimation for Photographic Tone Reproduction", JGT 7(1), 2002. The
// geometric mean of the luminances becomes middle grey, 0.18, where it lies midway between the
// darkest and the brightest hundredth; up to 0.72 in a bright picture (a white background), down to
// 0.045 in a dark one (a lamp at night). Black pixels do not count. 0 if all are black.
double fittingExposure(const Picture& picture);

} // namespace picture
