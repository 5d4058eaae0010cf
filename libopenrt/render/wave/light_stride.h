// light_stride.h: Chooses the pixels of a frame in which light is followed (RT_LIGHT_STRIDE).
// [render]
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace openrt {

// Returns the edge in pixels of the blocks in which one pixel gets light; 1: all pixels do.
uint32_t lightStrideOf(const edit::FrameSettingsT& frame);

// Returns whether a pixel gets light. Every block of stride x stride pixels has one that does.
// Blocks differ in it, so that no pattern shows, and consecutive seeds visit all pixels of a block.
bool isLit(uint32_t x, uint32_t y, uint32_t stride, uint32_t seed);

} // namespace openrt
