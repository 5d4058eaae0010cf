// result_codec.h: lossless encoding of job results as bytes. The encoder writes only those fields
// of a pixel's sums that the frame's channels need. It writes each field of all pixels as one value
// if they all have the same, as floats if that loses nothing, else as doubles. Ray counts, faults
// and seconds are not encoded. [any]
//
// A tile: 11 doubles (Ledger), then each field of all pixels, row by row: a byte for the form (0:
// one value; 1: floats; 2: all values as they are) and the values. With RT_COVERAGE, the number of
// HitCounts and these follow.
// Light: 9 doubles, then runs of the picture's numbers: the number of zeros, the number of values
// that follow, these values. Zeros at the end are left out.
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
// Decodes a result. Returns false if the bytes, which may come from anywhere, are not a result of
// such a job for such a frame.
bool decodeResult(const edit::FrameSettingsT& frame, const Job& job, const Tile& tile,
                  std::span<const std::byte> bytes, JobResult& result);

} // namespace openrt
