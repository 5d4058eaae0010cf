// doubt.h: Says where a denoised picture is not to be believed: where it leaves the error bars of
// the picture before. It needs no knowledge of the denoiser. Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

// The channel of a denoised picture that says it: how many half-widths of the 99 % interval its
// colour is away from the middle, for the colour that is farthest, at most 99. Above 1 it is
// doubtful. notJudged: the pixel has no interval that can be trusted.
inline constexpr uint32_t doubtBit = 1u << 31; // no channel of OpenRT
inline constexpr float notJudged = -1;

struct DoubtCounts {
  uint64_t pixels = 0, judged = 0, doubtful = 0;
  // Returns the share of the judged pixels that are doubtful; 1 if none is judged, because nothing
  // speaks for the picture then.
  double share() const { return judged ? double(doubtful) / double(judged) : 1; }
};

// Returns the doubt of each pixel. raw: has rgba, error and trust; denoised: rgba of the same size.
//
// An interval counts as no narrower than a difference that nobody sees: a hundred-and-twenty-eighth
// of the pixel's brightest colour, and a thousandth of the picture's mean.
std::vector<float> doubtOf(const Picture& raw, const std::vector<float>& denoised);
DoubtCounts countDoubt(const std::vector<float>& doubt);

} // namespace picture
