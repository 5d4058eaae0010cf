// texture_mapping.h: default texture coordinates of an IndexedFaceSet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// Returns one default texture coordinate per point (clause 6.23). S runs along the longest side of
// the bounding box of the points in `indices`, T along the second longest. Both are divided by the
// longest side. Equal sides are taken in the order X, Y, Z.
std::vector<Vec2f> defaultTextureMapping(std::span<const Vec3f> points,
                                         std::span<const uint32_t> indices);

} // namespace xvrml
