// line_properties.cpp: a line's nominal width and a point's nominal size are one pixel.
#include "mapper/shading/line_properties.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "mapper/shading/fill_properties.h"

namespace xvrml::mapper {
namespace {

constexpr float mostPixels = 1000;

template <class T> const T* propertyOf(const NodeRef& node) {
  return nodeCast<T>(renderedNode(node.get()));
}

float pixels(float size) {
  return std::isfinite(size) && size > 0 ? std::min(size, mostPixels) : 1;
}

// Returns the pattern of dashes and gaps in turn, whose lengths are given in cells; they repeat.
constexpr uint16_t patternOf(std::initializer_list<int> lengths) {
  uint16_t pattern = 0;
  for (int cell = 0; cell < 16;) {
    bool dash = true;
    for (const int length : lengths) {
      for (int i = 0; i < length && cell < 16; i++) pattern |= uint16_t(dash << cell++);
      dash = !dash;
    }
  }
  return pattern;
}

// A type of line by its number (ISO/IEC 19775-1 table 12.2). The standard does not say how long
// dashes are; these repeat after 16 or 32 pixels.
struct LineType {
  int32_t number;
  int factor; // pixels of a cell
  uint16_t pattern;
};
constexpr LineType lineTypes[] = {
    {2, 1, patternOf({9, 7})},              // dashed
    {3, 1, patternOf({2, 2})},              // dotted
    {4, 1, patternOf({8, 3, 2, 3})},        // dashed and dotted
    {5, 1, patternOf({6, 2, 2, 2, 2, 2})},  // a dash and two dots
    {9, 2, patternOf({8, 8})},              // stitch line
    {10, 2, patternOf({8, 2, 4, 2})},       // chain line
    {11, 2, patternOf({9, 2, 3, 2})},       // centre line
    {12, 2, patternOf({12, 4})},            // hidden line
    {13, 2, patternOf({6, 2, 2, 2, 2, 2})}, // phantom line
};

// Returns null for solid lines, and for types that are not drawn.
const LineType* typeOf(int32_t number) {
  const auto found = std::find_if(std::begin(lineTypes), std::end(lineTypes),
                                  [=](const LineType& type) { return type.number == number; });
  return found == std::end(lineTypes) ? nullptr : found;
}

// A type of line that is not drawn, and why (decision 112).
struct LeftOut {
  int32_t number;
  const char* what;
};
constexpr LeftOut leftOut[] = {
    {6, "single arrow: heads of arrows are not drawn"},
    {7, "single dot: dots at ends are not drawn"},
    {8, "double arrow: heads of arrows are not drawn"},
    {14, "break line of style 1: its waves are not drawn"},
    {15, "break line of style 2: its zigzags are not drawn"},
    {16, "pattern of the user: no field says which"},
};

// Returns why lines of a type are solid; an empty text if they are drawn as the type says.
std::string whySolid(int32_t number) {
  if (number == 1 || typeOf(number)) return {};
  for (const LeftOut& type : leftOut)
    if (type.number == number)
      return fmt::format("linetype is {} ({}); lines are solid", number, type.what);
  return fmt::format("linetype is {}, expected 1 to 16; lines are solid", number);
}

// The size of a point at distance 0. Attenuation with distance is left out.
float pointSize(const nodes::PointProperties& p) {
  const float near = p.attenuation.x > 0 ? p.pointSizeScaleFactor / std::sqrt(p.attenuation.x)
                                         : p.pointSizeScaleFactor;
  return pixels(std::min(std::max(near, p.pointSizeMinValue), p.pointSizeMaxValue));
}

} // namespace

LineStyle lineStyle(const nodes::Appearance* appearance) {
  LineStyle style;
  if (!appearance) return style;
  if (const auto* lines = propertyOf<nodes::LineProperties>(appearance->lineProperties);
      lines && lines->applied) {
    style.line = pixels(lines->linewidthScaleFactor);
    if (const LineType* type = typeOf(lines->linetype)) {
      style.pattern = type->pattern;
      style.factor = type->factor;
    }
  }
  if (const auto* points = propertyOf<nodes::PointProperties>(appearance->pointProperties))
    style.point = pointSize(*points);
  return style;
}

void warnOfLines(const nodes::Appearance* appearance, World& world) {
  if (!appearance) return;
  if (const auto* lines = propertyOf<nodes::LineProperties>(appearance->lineProperties);
      lines && lines->applied)
    if (const std::string why = whySolid(lines->linetype); !why.empty())
      world.diagnostics.warn(lines->source, "LineProperties: " + why);
  if (const auto* points = propertyOf<nodes::PointProperties>(appearance->pointProperties);
      points && (points->attenuation.y != 0 || points->attenuation.z != 0))
    world.diagnostics.warn(points->source,
                           "PointProperties: points do not get smaller with their distance; the "
                           "size at distance 0 is used");
}

void warnOfFaces(const nodes::Appearance* appearance, World& world) {
  if (!appearance) return;
  warnOfHatching(appearance, world);
  Node* back = renderedNode(appearance->backMaterial.get());
  Node* front = renderedNode(appearance->material.get());
  if (back && !(nodeCast<nodes::Material>(back) && nodeCast<nodes::Material>(front)))
    world.diagnostics.warn(back->source,
                           "backMaterial: a back of its own can be drawn if material and "
                           "backMaterial are Materials; here both sides have material");
}

} // namespace xvrml::mapper
