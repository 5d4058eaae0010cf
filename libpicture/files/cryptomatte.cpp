#include "libpicture/files/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>

#include <fmt/format.h>

#include "libpicture/files/json_text.h"
#include "openrt/openrt.h"

namespace picture {

namespace {

constexpr std::string_view layerName = "CryptoObject"; // the planes' names begin with it

uint32_t murmurHash3(std::string_view bytes) {
  constexpr uint32_t c1 = 0xcc9e2d51u, c2 = 0x1b873593u;
  const auto mix = [](uint32_t k) { return std::rotl(k * c1, 15) * c2; };
  uint32_t hash = 0;
  size_t i = 0;
  for (; i + 4 <= bytes.size(); i += 4) {
    uint32_t block; // little-endian, as all supported machines are
    std::memcpy(&block, bytes.data() + i, sizeof block);
    hash = std::rotl(hash ^ mix(block), 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t k = bytes.size(); k > i; k--) tail = tail << 8 | static_cast<uint8_t>(bytes[k - 1]);
  hash ^= mix(tail);
  hash ^= uint32_t(bytes.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

// Returns the name of a number; where the picture has no names, the number itself.
std::string nameOf(const Picture& picture, size_t number) {
  return number < picture.names.size() ? asUtf8(picture.names[number]) : std::to_string(number);
}

} // namespace

uint32_t cryptomatteHash(std::string_view name) {
  const uint32_t hash = murmurHash3(name), exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::vector<float> cryptomatteLayers(const Picture& picture) {
  std::vector<float> hashes; // by number
  for (size_t i = 0; i < picture.names.size(); ++i)
    hashes.push_back(std::bit_cast<float>(cryptomatteHash(nameOf(picture, i))));
  const auto hashOf = [&](float number) {
    const auto i = size_t(number);
    return i < hashes.size() ? hashes[i]
                             : std::bit_cast<float>(cryptomatteHash(nameOf(picture, i)));
  };
  std::vector<float> layers = picture.planes.at(RT_COVERAGE);
  const auto components = size_t(findChannel("cryptomatte")->components);
  using Pair = std::pair<float, float>; // hash and share
  std::vector<Pair> pairs;
  for (size_t begin = 0; begin < layers.size(); begin += components) {
    pairs.clear();
    for (size_t i = begin; i < begin + components && layers[i + 1] > 0; i += 2) {
      const float hash = hashOf(layers[i]);
      const auto same = std::find_if(pairs.begin(), pairs.end(),
                                     [&](const Pair& pair) { return pair.first == hash; });
      if (same == pairs.end())
        pairs.emplace_back(hash, layers[i + 1]);
      else
        same->second += layers[i + 1];
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.second > b.second; });
    pairs.resize(components / 2);
    for (size_t i = 0; i < pairs.size(); ++i) {
      layers[begin + 2 * i] = pairs[i].first;
      layers[begin + 2 * i + 1] = pairs[i].second;
    }
  }
  return layers;
}

std::vector<std::pair<std::string, std::string>> cryptomatteAttributes(const Picture& picture) {
  std::set<std::string> names;
  for (size_t i = 0; i < picture.names.size(); ++i) names.insert(nameOf(picture, i));
  if (picture.names.empty()) {
    const std::vector<float>& plane = picture.planes.at(RT_COVERAGE);
    std::set<float> numbers;
    for (size_t i = 0; i < plane.size(); i += 2) numbers.insert(plane[i]);
    for (const float number : numbers) names.insert(nameOf(picture, size_t(number)));
    names.erase("0");
  }
  names.erase("");
  std::string manifest = "{";
  for (const std::string& name : names)
    manifest += fmt::format("{}{}:\"{:08x}\"", manifest.size() > 1 ? "," : "", jsonText(name),
                            cryptomatteHash(name));
  manifest += '}';
  // The layer is identified by the first seven digits of the hash of its name.
  const std::string key =
      fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", cryptomatteHash(layerName)));
  return {{key + "name", std::string(layerName)},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", manifest}};
}

} // namespace picture
