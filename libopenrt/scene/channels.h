// channels.h: the channels of a picture (openrt.h) and their floats per pixel, in one table for the
// front end and the film.
#pragma once

#include <cstdint>

#include "openrt/openrt.h"

namespace openrt {

inline constexpr uint32_t allChannels = RT_RGBA | RT_DEPTH | RT_NORMAL | RT_ALBEDO | RT_POSITION |
                                        RT_NAME | RT_SAMPLES | RT_VARIANCE | RT_ERROR | RT_TRUST |
                                        RT_MOTION | RT_REFLECTION | RT_COVERAGE;
inline constexpr uint32_t channelBits = 13;
// Names in a pixel of RT_COVERAGE.
inline constexpr uint32_t coverageNames = 8;

// Returns the floats per pixel of one channel; 0 if there is no such channel.
constexpr uint32_t channelComponents(uint32_t channel) {
  switch (channel) {
  case RT_RGBA: return 4;
  case RT_COVERAGE: return 2 * coverageNames;
  case RT_NORMAL:
  case RT_ALBEDO:
  case RT_POSITION:
  case RT_MOTION:
  case RT_REFLECTION:
  case RT_VARIANCE:
  case RT_ERROR: return 3;
  case RT_DEPTH:
  case RT_NAME:
  case RT_SAMPLES:
  case RT_TRUST: return 1;
  }
  return 0;
}

} // namespace openrt
