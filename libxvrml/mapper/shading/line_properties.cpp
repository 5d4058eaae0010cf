// line_properties.cpp: a line's nominal width and a point's nominal size are one pixel.
#include "mapper/shading/line_properties.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace xvrml::mapper {
namespace {

constexpr float mostPixels = 1000;

template <class T> const T* propertyOf(const NodeRef& node) {
  return nodeCast<T>(renderedNode(node.get()));
}

float pixels(float size) {
  return std::isfinite(size) && size > 0 ? std::min(size, mostPixels) : 1;
}

// The size of a point at distance 0. Attenuation with distance is left out.
float pointSize(const nodes::PointProperties& p) {
  const float near = p.attenuation.x > 0 ? p.pointSizeScaleFactor / std::sqrt(p.attenuation.x)
                                         : p.pointSizeScaleFactor;
  return pixels(std::min(std::max(near, p.pointSizeMinValue), p.pointSizeMaxValue));
}

} // namespace

LineSizes lineSizes(const nodes::Appearance* appearance) {
  LineSizes sizes;
  if (!appearance) return sizes;
  if (const auto* lines = propertyOf<nodes::LineProperties>(appearance->lineProperties))
    if (lines->applied) sizes.line = pixels(lines->linewidthScaleFactor);
  if (const auto* points = propertyOf<nodes::PointProperties>(appearance->pointProperties))
    sizes.point = pointSize(*points);
  return sizes;
}

void warnOfLines(const nodes::Appearance* appearance, World& world) {
  if (!appearance) return;
  if (const auto* lines = propertyOf<nodes::LineProperties>(appearance->lineProperties);
      lines && lines->applied && lines->linetype != 1)
    world.diagnostics.warn(lines->source, "LineProperties: linetype is " +
                                              std::to_string(lines->linetype) +
                                              "; only 1, solid lines, can be drawn");
  if (const auto* points = propertyOf<nodes::PointProperties>(appearance->pointProperties);
      points && (points->attenuation.y != 0 || points->attenuation.z != 0))
    world.diagnostics.warn(points->source,
                           "PointProperties: points do not get smaller with their distance; the "
                           "size at distance 0 is used");
}

void warnOfFaces(const nodes::Appearance* appearance, World& world) {
  if (!appearance) return;
  if (const auto* fill = propertyOf<nodes::FillProperties>(appearance->fillProperties);
      fill && fill->hatched)
    world.diagnostics.warn(fill->source, "FillProperties: the hatching is not drawn");
  Node* back = renderedNode(appearance->backMaterial.get());
  Node* front = renderedNode(appearance->material.get());
  if (back && !(nodeCast<nodes::Material>(back) && nodeCast<nodes::Material>(front)))
    world.diagnostics.warn(back->source,
                           "backMaterial: a back of its own can be drawn if material and "
                           "backMaterial are Materials; here both sides have material");
}

} // namespace xvrml::mapper
