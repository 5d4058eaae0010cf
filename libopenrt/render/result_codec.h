// result_codec.h: results of jobs as bytes, exactly: of a pixel's sums what the frame's channels need, field by field, each as
// one value if all pixels have the same, as floats where nothing is lost, else as doubles. [any]
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/job.h"
#include "scene/scene.h"

namespace openrt {

std::vector<std::byte> encodeResult(const edit::FrameSettingsT& frame, const Job& job, const JobResult& result);
// False: not what a job like this makes for a frame like this. bytes: from anywhere.
bool decodeResult(const edit::FrameSettingsT& frame, const Job& job, const Tile& tile, std::span<const std::byte> bytes,
                  JobResult& result);

} // namespace openrt
