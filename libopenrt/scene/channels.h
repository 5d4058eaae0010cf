// channels.h: the channels of a picture (openrt/frame.h), a row each. The front end, the film, the
// sums, their codec and the first hits follow from the table; rtGetChannelInfo publishes it for
// files, command lines and Python.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>

#include "openrt/openrt.h"

namespace openrt {

// Names in a pixel of RT_COVERAGE.
inline constexpr uint32_t coverageNames = 8;

// Says where the floats of a pixel come from.
enum class ChannelSource : uint8_t {
  film,        // the film computes them from other sums (Film::store)
  firstSample, // they are the values of sample 0
  mean         // they are the means of the values of all samples
};

struct ChannelInfo {
  uint32_t bit;
  const char* name;   // the texts are described at RTchannelInfo
  const char* planes; // names of the floats in OpenEXR files
  ChannelSource source = ChannelSource::film;
  bool firstHit = false; // it tells about what a sample hits first
  float nothing = 0;     // the value where nothing is hit
  RTenum kind = RT_CHANNEL_NUMBERS;
  const char* text = nullptr;
  // These two follow from the others. components: floats per pixel; place: of the first one among
  // the floats of all channels with this source.
  uint32_t components = 1 + uint32_t(std::ranges::count(std::string_view(planes), ' '));
  uint32_t place = 0;
};

// In the order of their bits.
inline constexpr auto channelTable = [] {
  using enum ChannelSource;
  auto table = std::to_array<ChannelInfo>({
      {RT_RGBA, "rgba", "R G B A"},
      {RT_DEPTH, "z", "Z", firstSample, true, std::numeric_limits<float>::infinity()},
      {RT_NORMAL, "normal", "N.X N.Y N.Z", mean, true},
      {RT_ALBEDO, "albedo", "albedo.R albedo.G albedo.B", mean, true},
      {RT_POSITION, "position", "P.X P.Y P.Z", firstSample, true},
      {RT_NAME, "id", "id", firstSample, true, 0, RT_CHANNEL_NAMES},
      {.bit = RT_SAMPLES, .name = "samples", .planes = "samples", .kind = RT_CHANNEL_COUNTS},
      {RT_VARIANCE, "variance", "variance.R variance.G variance.B"},
      {.bit = RT_ERROR,
       .name = "error",
       .planes = "error.R error.G error.B",
       .text = "is the half-width of the 95 % interval of each colour"},
      {.bit = RT_TRUST,
       .name = "trust",
       .planes = "trust",
       .text = "is 1 where that interval can be trusted. With error or trust, other sample "
               "positions are used"},
      {.bit = RT_MOTION,
       .name = "motion",
       .planes = "motion.X motion.Y motion.Z",
       .source = firstSample,
       .firstHit = true,
       .text = "is how far what is seen has moved since the picture before"},
      {.bit = RT_REFLECTION,
       .name = "reflection",
       .planes = "reflection.R reflection.G reflection.B",
       .source = mean,
       .text = "is the part of the light that coats reflect: varnish, lacquer, highlights"},
      {.bit = RT_COVERAGE,
       .name = "cryptomatte",
       .planes = "CryptoObject00.R CryptoObject00.G CryptoObject00.B CryptoObject00.A "
                 "CryptoObject01.R CryptoObject01.G CryptoObject01.B CryptoObject01.A "
                 "CryptoObject02.R CryptoObject02.G CryptoObject02.B CryptoObject02.A "
                 "CryptoObject03.R CryptoObject03.G CryptoObject03.B CryptoObject03.A",
       .firstHit = true,
       .kind = RT_CHANNEL_SHARES,
       .text = "tells which Shapes cover a pixel, and how much of it each"},
      {.bit = RT_PLACE,
       .name = "place",
       .planes = "place.X place.Y",
       .source = firstSample,
       .text = "is where in the pixel its first sample was taken"},
  });
  uint32_t used[3] = {};
  for (ChannelInfo& row : table) {
    row.place = used[size_t(row.source)];
    used[size_t(row.source)] += row.components;
  }
  return table;
}();
inline constexpr uint32_t channelBits = channelTable.size();
inline constexpr uint32_t allChannels = (1u << channelBits) - 1;
static_assert([] {
  for (uint32_t i = 0; i < channelBits; i++)
    if (channelTable[i].bit != 1u << i) return false;
  return true;
}());

// Returns the row of a channel, which must exist.
constexpr const ChannelInfo& channelInfo(uint32_t channel) {
  return channelTable[size_t(std::countr_zero(channel))];
}
static_assert(channelInfo(RT_COVERAGE).components == 2 * coverageNames);

// Returns the floats per pixel of one channel; 0 if there is no such channel.
constexpr uint32_t channelComponents(uint32_t channel) {
  return std::has_single_bit(channel) && channel <= allChannels ? channelInfo(channel).components
                                                                : 0;
}

// Returns the number of places that those of the given channels need which have this source.
constexpr uint32_t placesOf(ChannelSource source, uint32_t channels = allChannels) {
  uint32_t end = 0;
  for (const ChannelInfo& row : channelTable)
    if (row.source == source && (channels & row.bit)) end = row.place + row.components;
  return end;
}

inline constexpr uint32_t firstHitChannels = [] {
  uint32_t channels = 0;
  for (const ChannelInfo& row : channelTable)
    if (row.firstHit) channels |= row.bit;
  return channels;
}();

} // namespace openrt
