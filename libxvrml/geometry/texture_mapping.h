// texture_mapping.h: the texture coordinates of an IndexedFaceSet that gives none.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// Default mapping of clause 6.23: S along the longest side of the bounding box of the points that
// `indices` name, T along the second, both divided by the longest; equal sides in the order X, Y,
// Z. One coordinate a point.
std::vector<Vec2f> defaultTextureMapping(std::span<const Vec3f> points,
                                         std::span<const uint32_t> indices);

} // namespace xvrml
