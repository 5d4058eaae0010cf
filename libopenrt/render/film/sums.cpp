// sums.cpp: Merges sums. Moments are moved to another reference point by the binomial theorem, (x +
// c)^m.
#include "render/film/sums.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "render/film/error.h"
#include "scene/quality.h"

namespace openrt {
namespace {

// PixelSums are stored as bytes.
static_assert(std::is_trivially_copyable_v<PixelSums> && std::is_standard_layout_v<PixelSums>);

// Returns the bytes of PixelSums to store. Only the part that the frame needs is stored, because
// there may be one for each pixel of the picture.
size_t keptBytes(const RequiredSums& g) {
  if (g.error) return sizeof(PixelSums);
  if (g.spread) return offsetof(PixelSums, closed);
  return g.valueSums ? offsetof(PixelSums, valueSums) + g.valueSums * sizeof(double)
                     : offsetof(PixelSums, firstValues) + g.firstValues * sizeof(float);
}

// Merges the sums for error estimates. change: the shift that makes the differences of l relative
// to the reference point of s.
void mergeTails(PixelSums& s, const PixelSums& l, const double change[3], double size) {
  const double c = change[0] + change[1] + change[2], n = l.samples,
               grey1 = l.delta[0] + l.delta[1] + l.delta[2];
  s.grey[0] += l.grey[0] + c * (2 * grey1 + n * c);
  s.grey[1] += l.grey[1] + c * (3 * l.grey[0] + c * (3 * grey1 + n * c));
  s.grey[2] += l.grey[2] + c * (4 * l.grey[1] + c * (6 * l.grey[0] + c * (4 * grey1 + n * c)));
  for (int k = 0; k < 3; k++) s.largest[k] = std::max(s.largest[k], l.largest[k]);
  s.random |= l.random;
  if (l.replicates == 0) return;
  const double r = l.replicates;
  for (int k = 0; k < 3; k++) {
    // d: change of a replicate's sum
    const double d = size * change[k], s1 = l.closed[k], s2 = l.closed2[k], s3 = l.closed3[k];
    s.closed[k] += s1 + r * d;
    s.closed2[k] += s2 + d * (2 * s1 + r * d);
    s.closed3[k] += s3 + d * (3 * s2 + d * (3 * s1 + r * d));
    s.closed4[k] += l.closed4[k] + d * (4 * s3 + d * (6 * s2 + d * (4 * s1 + r * d)));
  }
}

} // namespace

RequiredSums requiredSums(const edit::FrameSettingsT& frame) {
  RequiredSums g;
  g.error = wantsError(frame);
  g.spread = g.error || (frame.channels & RT_VARIANCE);
  g.names = frame.channels & RT_COVERAGE;
  g.firstValues = placesOf(ChannelSource::firstSample, frame.channels);
  g.valueSums = placesOf(ChannelSource::mean, frame.channels);
  return g;
}

void startSums(std::vector<PixelSums>& sums, size_t pixels, const RequiredSums& required) {
  if (sums.size() != pixels) return sums.assign(pixels, {});
  const size_t bytes = keptBytes(required);
  for (PixelSums& s : sums) std::memset(static_cast<void*>(&s), 0, bytes);
}

void PixelSums::closeReplicate() {
  for (int k = 0; k < 3; k++) {
    const double sum = delta[k] - closed[k], square = sum * sum;
    closed2[k] += square;
    closed3[k] += square * sum;
    closed4[k] += square * square;
    closed[k] = delta[k];
  }
  replicates++;
}

void PixelSums::merge(const PixelSums& l, const RequiredSums& required, const Replicates& parts) {
  for (int k = 0; k < 4; k++) rgba[k] += l.rgba[k];
  for (uint32_t k = 0; k < required.valueSums; k++) valueSums[k] += l.valueSums[k];
  if (required.spread) {
    const double n = l.samples;
    double c[3]; // change of the differences
    for (int k = 0; k < 3; k++) {
      c[k] = l.first[k] - first[k];
      delta[k] += l.delta[k] + n * c[k];
      delta2[k] += l.delta2[k] + c[k] * (2 * l.delta[k] + n * c[k]);
    }
    if (required.error) mergeTails(*this, l, c, double(parts.size()));
  }
  samples += l.samples;
  replicates += l.replicates;
  // A replicate larger than its leaves has not been closed yet.
  if (required.error && parts.many() && replicates == 0 && samples == parts.size())
    closeReplicate();
}

void SumBlock::append(const SumBlock& later, const RequiredSums& required,
                      const Replicates& replicates) {
  for (size_t i = 0; i < sums.size(); i++) sums[i].merge(later.sums[i], required, replicates);
  if (required.names) hits.merge(later.hits);
  ledger.add(later.ledger);
  rays.add(later.rays);
  count += later.count;
}

uint32_t leafEnd(uint32_t first, uint32_t end, uint32_t samplesOfFrame) {
  if (samplesOfFrame < fewestOfLeaves) return end;
  const uint32_t leaf = first >= fewestOfLeaves ? fewestOfLeaves : 0;
  return std::min(end, leaf ? (first / leaf + 1) * leaf : std::bit_ceil(first + 1));
}

uint32_t blockFrom(uint32_t first, uint32_t end, uint32_t largest) {
  const uint32_t left = end - first;
  if (left <= largest && first == 0) return left;
  if (left < fewestOfLeaves) return left;
  uint32_t count = std::bit_floor(std::min(left, std::max(largest, fewestOfLeaves)));
  if (first) count = std::min(count, first & -first);
  return count;
}

uint32_t treeBlockFrom(uint32_t first, uint32_t end, uint32_t largest, uint32_t samplesOfFrame) {
  const uint32_t left = end - first;
  if (samplesOfFrame < fewestOfLeaves) return left;
  const uint32_t most = std::bit_floor(std::min(left, std::max(largest, fewestOfLeaves)));
  if (first == 0) return most;
  if (first < fewestOfLeaves) return leafEnd(first, end, samplesOfFrame) - first;
  return left < fewestOfLeaves ? left : std::min(most, first & -first);
}

void TileSums::forEach(const RequiredSums& required,
                       const std::function<void(const SumBlock& block)>& use) const {
  SumBlock block;
  for (const StoredBlock& kept : kept_) {
    unpack(kept, block, required);
    use(block);
  }
}

void TileSums::unpack(const StoredBlock& from, SumBlock& to, const RequiredSums& required) {
  const size_t bytes = keptBytes(required);
  to.first = from.first;
  to.count = from.count;
  to.ledger = from.ledger;
  to.rays = from.rays;
  to.hits = from.hits;
  to.sums.resize(from.bytes.size() / bytes);
  for (size_t i = 0; i < to.sums.size(); i++)
    std::memcpy(static_cast<void*>(&to.sums[i]), &from.bytes[i * bytes], bytes);
}

void TileSums::join(SumBlock& block, const RequiredSums& required, const Replicates& replicates) {
  SumBlock other;
  for (;;) {
    const auto sibling = std::find_if(kept_.begin(), kept_.end(), [&](const StoredBlock& k) {
      return siblings(k.first, k.count, block.first, block.count) ||
             siblings(block.first, block.count, k.first, k.count);
    });
    if (sibling == kept_.end()) return;
    unpack(*sibling, other, required);
    kept_.erase(sibling);
    if (other.first < block.first) std::swap(other, block);
    block.append(other, required, replicates);
  }
}

void TileSums::keep(const SumBlock& block, const RequiredSums& required) {
  const size_t bytes = keptBytes(required);
  StoredBlock kept{block.first, block.count, block.ledger,
                   block.rays,  block.hits,  std::vector<std::byte>(block.sums.size() * bytes)};
  for (size_t i = 0; i < block.sums.size(); i++)
    std::memcpy(&kept.bytes[i * bytes], &block.sums[i], bytes);
  const auto place = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const StoredBlock& k) { return k.first > block.first; });
  kept_.insert(place, std::move(kept));
}

uint32_t TileSums::reach(const SumBlock* block) const {
  uint32_t at = block && block->first == 0 ? block->count : 0;
  for (const StoredBlock& kept : kept_) {
    if (kept.first == at) at += kept.count;
    if (block && block->first == at) at += block->count;
  }
  return at;
}

const SumBlock* TileSums::fold(const SumBlock* block, SumBlock& out, const RequiredSums& required,
                               const Replicates& replicates) const {
  if (block && block->first == 0 && (kept_.empty() || kept_.front().first != block->count))
    return block;
  uint32_t at = 0;
  SumBlock next;
  const auto take = [&](const SumBlock& b) {
    if (at == 0)
      out = b;
    else
      out.append(b, required, replicates);
    at = b.end();
  };
  if (block && block->first == 0) take(*block);
  for (const StoredBlock& kept : kept_) {
    if (block && at != 0 && block->first == at) take(*block);
    if (kept.first != at) break;
    unpack(kept, next, required);
    take(next);
  }
  if (block && at != 0 && block->first == at) take(*block);
  return at ? &out : nullptr;
}

} // namespace openrt
