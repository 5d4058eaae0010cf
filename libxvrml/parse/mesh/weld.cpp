// weld.cpp: a hash table with open addressing, which holds numbers of points.
#include "parse/mesh/weld.h"

#include <bit>

namespace xvrml {
namespace {

constexpr uint32_t empty = UINT32_MAX;

uint64_t tableSize(uint64_t points) { return std::bit_ceil(points + points / 2 + 16); }

// Mixes the bits of three numbers (the finalizer of MurmurHash3, Appleby 2011). Adding 0 makes -0
// and 0 equal.
uint64_t hashOf(const Vec3f& p) {
  const auto bits = [](float f) { return uint64_t(std::bit_cast<uint32_t>(f + 0.0f)); };
  uint64_t h = (bits(p.x) << 32 | bits(p.y)) ^ (bits(p.z) * 0x9e3779b97f4a7c15);
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccd;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53;
  return h ^ (h >> 33);
}

} // namespace

uint64_t weldBytes(uint64_t points) { return (tableSize(points) + points) * sizeof(uint32_t); }

std::vector<uint32_t> weldPoints(std::vector<Vec3f>& points) {
  std::vector<uint32_t> table(tableSize(points.size()), empty), index(points.size());
  const size_t mask = table.size() - 1;
  uint32_t kept = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3f point = points[i];
    size_t slot = hashOf(point) & mask;
    while (table[slot] != empty && !(points[table[slot]] == point)) slot = (slot + 1) & mask;
    if (table[slot] == empty) {
      points[kept] = point;
      table[slot] = kept++;
    }
    index[i] = table[slot];
  }
  points.resize(kept);
  return index;
}

} // namespace xvrml
