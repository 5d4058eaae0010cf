// trial_blocks.h: blocks of pixels over the whole picture, in which a trial renders paths before a
// frame. [render]
#pragma once

#include "render/wave/tiles.h"
#include "scene/scene.h"

namespace openrt {

// Pixels along an edge of a block.
inline constexpr uint32_t trialBlockEdge = 4;

// Returns block i of a low-discrepancy sequence over the picture.
Tile trialBlock(const edit::FrameSettingsT& frame, uint32_t i);
// Makes the settings of a frame those of its trials, which need the variance of its samples.
void prepareTrial(edit::FrameSettingsT& frame);

} // namespace openrt
