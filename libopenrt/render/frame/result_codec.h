// result_codec.h: results of jobs as bytes, exactly: of a pixel's sums what the frame's channels
// need, field by field, each as one value if all pixels have the same, as floats where nothing is
// lost, else as doubles. Without rays, faults and seconds. [any]
//
// A tile: 9 doubles (Ledger), then each field of all pixels, row by row: a byte, then what it says
// (0: one value; 1: floats; 2: all values as they are). Light: 9 doubles, then runs of the
// picture's numbers: how many zeros, how many numbers follow, these; zeros at the end are left out.
// Little-endian, not aligned.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/frame/job.h"
#include "scene/scene.h"

namespace openrt {

std::vector<std::byte> encodeResult(const edit::FrameSettingsT& frame, const Job& job,
                                    const JobResult& result);
// False: not what a job like this makes for a frame like this. bytes: from anywhere.
bool decodeResult(const edit::FrameSettingsT& frame, const Job& job, const Tile& tile,
                  std::span<const std::byte> bytes, JobResult& result);

} // namespace openrt
