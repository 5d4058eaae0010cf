// channels.h: the channels of a picture (openrt.h) and their floats per pixel, in one table for the
// front end and the film.
#pragma once

#include <cstdint>
#include <iterator>

#include "openrt/openrt.h"

namespace openrt {

// Names in a pixel of RT_COVERAGE.
inline constexpr uint32_t coverageNames = 8;

struct ChannelInfo {
  uint32_t bit;
  uint32_t components;   // floats per pixel
  bool firstHit = false; // it tells about what a sample hits first
};
// In the order of their bits.
inline constexpr ChannelInfo channelTable[] = {
    {RT_RGBA, 4},
    {RT_DEPTH, 1, true},
    {RT_NORMAL, 3, true},
    {RT_ALBEDO, 3, true},
    {RT_POSITION, 3, true},
    {RT_NAME, 1, true},
    {RT_SAMPLES, 1},
    {RT_VARIANCE, 3},
    {RT_ERROR, 3},
    {RT_TRUST, 1},
    {RT_MOTION, 3, true},
    {RT_REFLECTION, 3},
    {RT_COVERAGE, 2 * coverageNames, true},
};
inline constexpr uint32_t channelBits = std::size(channelTable);
inline constexpr uint32_t allChannels = (1u << channelBits) - 1;
static_assert(channelTable[channelBits - 1].bit == 1u << (channelBits - 1));

inline constexpr uint32_t firstHitChannels = [] {
  uint32_t channels = 0;
  for (const ChannelInfo& info : channelTable)
    if (info.firstHit) channels |= info.bit;
  return channels;
}();

// Returns the floats per pixel of one channel; 0 if there is no such channel.
constexpr uint32_t channelComponents(uint32_t channel) {
  for (const ChannelInfo& info : channelTable)
    if (info.bit == channel) return info.components;
  return 0;
}

} // namespace openrt
