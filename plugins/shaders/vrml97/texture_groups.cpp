// texture_groups.cpp: samples the textures of a batch. Most batches have one texture and are
// sampled in place. The lanes of other batches are sorted by texture in scratch memory, so the cost
// does not grow with the number of textures. [render]
#include "vrml97/texture_groups.h"

#include <algorithm>

#include "vrml97/batch.h"

namespace vrml97 {
namespace {

bool sameEverywhere(const RtsTexture* texture, uint32_t count) {
  uint32_t different = 0;
  for (uint32_t i = 0; i < count; i++) different |= texture[i] ^ texture[0];
  return different == 0;
}

// Writes the lanes that have a texture, sorted by texture and lane, and returns their number.
uint32_t sortedKeys(const TexturePlaces& places, uint64_t* keys) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < places.count; i++)
    if (places.texture[i] != 0) keys[n++] = uint64_t(places.texture[i]) << 32 | i;
  std::sort(keys, keys + n);
  return n;
}

void sampleOne(const RtsHost* host, RtsBatch* batch, RtsTexture texture, uint32_t n,
               const float* const at[3], float* const rgba[4]) {
  if (at[2])
    host->sampleVolume(batch, texture, n, at, rgba);
  else
    host->sample(batch, texture, n, at, rgba);
}

} // namespace

void sampleGroups(const RtsHost* host, RtsBatch* batch, const TexturePlaces& places,
                  float* const rgba[4], uint32_t* components) {
  if (places.count == 0) return;
  if (sameEverywhere(places.texture, places.count)) {
    if (places.texture[0] == 0) return;
    sampleOne(host, batch, places.texture[0], places.count, places.at, rgba);
    std::fill_n(components, places.count, host->components(host, places.texture[0]));
    return;
  }
  auto* keys = reinterpret_cast<uint64_t*>(host->scratch(batch, 2 * wholeLanes(places.count)));
  const uint32_t n = sortedKeys(places, keys);
  const int coordinates = places.at[2] ? 3 : 2;
  float *color[4], *packed[3] = {};
  for (float*& c : color) c = host->scratch(batch, wholeLanes(places.count));
  for (int k = 0; k < coordinates; k++) packed[k] = host->scratch(batch, wholeLanes(places.count));
  for (uint32_t begin = 0, end; begin < n; begin = end) {
    const auto texture = static_cast<RtsTexture>(keys[begin] >> 32);
    for (end = begin; end < n && keys[end] >> 32 == texture; end++)
      for (int k = 0; k < coordinates; k++)
        packed[k][end - begin] = places.at[k][uint32_t(keys[end])];
    const uint32_t size = end - begin;
    for (int k = 0; k < coordinates; k++) // the padding repeats the last lane
      std::fill(packed[k] + size, packed[k] + wholeLanes(size), packed[k][size - 1]);
    sampleOne(host, batch, texture, size, packed, color);
    const uint32_t parts = host->components(host, texture);
    for (uint32_t k = 0; k < size; k++) {
      const auto lane = uint32_t(keys[begin + k]);
      for (int c = 0; c < 4; c++) rgba[c][lane] = color[c][k];
      components[lane] = parts;
    }
  }
}

} // namespace vrml97
