// sums.cpp: Moments about another point: (x + c)^m by the binomial theorem.
#include "render/film/sums.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "openrt/openrt.h"
#include "render/film/error.h"

namespace openrt {
namespace {

static_assert(std::is_trivially_copyable_v<PixelSums> &&
              std::is_standard_layout_v<PixelSums>); // kept as bytes

// Of each pixel's sums only the part that is gathered is kept: there may be one for each pixel of
// the picture.
size_t keptBytes(const Gathering& g) {
  if (g.error) return sizeof(PixelSums);
  if (g.surface) return offsetof(PixelSums, closed);
  return g.spread ? offsetof(PixelSums, normal) : offsetof(PixelSums, first);
}

// What errors are told by: change: of the differences of l.
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
    const double d = size * change[k], s1 = l.closed[k], s2 = l.closed2[k],
                 s3 = l.closed3[k]; // d: of a replicate's sum
    s.closed[k] += s1 + r * d;
    s.closed2[k] += s2 + d * (2 * s1 + r * d);
    s.closed3[k] += s3 + d * (3 * s2 + d * (3 * s1 + r * d));
    s.closed4[k] += l.closed4[k] + d * (4 * s3 + d * (6 * s2 + d * (4 * s1 + r * d)));
  }
}

} // namespace

Gathering gatheringOf(const edit::FrameSettingsT& frame) {
  Gathering g;
  g.error = wantsError(frame);
  g.spread = g.error || (frame.channels & RT_VARIANCE);
  g.surface = frame.channels & (RT_NORMAL | RT_ALBEDO);
  return g;
}

void startSums(std::vector<PixelSums>& sums, size_t pixels, const Gathering& gathering) {
  if (sums.size() != pixels) return sums.assign(pixels, {});
  const size_t bytes = keptBytes(gathering);
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

void PixelSums::merge(const PixelSums& l, const Gathering& gathering, const Replicates& parts) {
  for (int k = 0; k < 4; k++) rgba[k] += l.rgba[k];
  for (int k = 0; k < 3 && gathering.surface; k++) {
    normal[k] += l.normal[k];
    albedo[k] += l.albedo[k];
  }
  if (gathering.spread) {
    const double n = l.samples;
    double c[3]; // what has to be added to the differences
    for (int k = 0; k < 3; k++) {
      c[k] = l.first[k] - first[k];
      delta[k] += l.delta[k] + n * c[k];
      delta2[k] += l.delta2[k] + c[k] * (2 * l.delta[k] + n * c[k]);
    }
    if (gathering.error) mergeTails(*this, l, c, double(parts.size()));
  }
  samples += l.samples;
  replicates += l.replicates;
  // Larger than its leaves: none of it is closed yet.
  if (gathering.error && parts.many() && replicates == 0 && samples == parts.size())
    closeReplicate();
}

void SumBlock::append(const SumBlock& later, const Gathering& gathering,
                      const Replicates& replicates) {
  for (size_t i = 0; i < sums.size(); i++) sums[i].merge(later.sums[i], gathering, replicates);
  ledger.add(later.ledger);
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

void TileSums::unpack(const Kept& from, SumBlock& to, const Gathering& gathering) {
  const size_t bytes = keptBytes(gathering);
  to.first = from.first;
  to.count = from.count;
  to.ledger = from.ledger;
  to.sums.resize(from.bytes.size() / bytes);
  for (size_t i = 0; i < to.sums.size(); i++)
    std::memcpy(static_cast<void*>(&to.sums[i]), &from.bytes[i * bytes], bytes);
}

void TileSums::join(SumBlock& block, const Gathering& gathering, const Replicates& replicates) {
  SumBlock other;
  for (;;) {
    const auto sibling = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) {
      return siblings(k.first, k.count, block.first, block.count) ||
             siblings(block.first, block.count, k.first, k.count);
    });
    if (sibling == kept_.end()) return;
    unpack(*sibling, other, gathering);
    kept_.erase(sibling);
    if (other.first < block.first) std::swap(other, block);
    block.append(other, gathering, replicates);
  }
}

void TileSums::keep(const SumBlock& block, const Gathering& gathering) {
  const size_t bytes = keptBytes(gathering);
  Kept kept{block.first, block.count, block.ledger,
            std::vector<std::byte>(block.sums.size() * bytes)};
  for (size_t i = 0; i < block.sums.size(); i++)
    std::memcpy(&kept.bytes[i * bytes], &block.sums[i], bytes);
  const auto place = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Kept& k) { return k.first > block.first; });
  kept_.insert(place, std::move(kept));
}

uint32_t TileSums::reach(const SumBlock* block) const {
  uint32_t at = block && block->first == 0 ? block->count : 0;
  for (const Kept& kept : kept_) {
    if (kept.first == at) at += kept.count;
    if (block && block->first == at) at += block->count;
  }
  return at;
}

const SumBlock* TileSums::fold(const SumBlock* block, SumBlock& out, const Gathering& gathering,
                               const Replicates& replicates) const {
  if (block && block->first == 0 && (kept_.empty() || kept_.front().first != block->count))
    return block;
  uint32_t at = 0;
  SumBlock next;
  const auto take = [&](const SumBlock& b) {
    if (at == 0)
      out = b;
    else
      out.append(b, gathering, replicates);
    at = b.end();
  };
  if (block && block->first == 0) take(*block);
  for (const Kept& kept : kept_) {
    if (block && at != 0 && block->first == at) take(*block);
    if (kept.first != at) break;
    unpack(kept, next, gathering);
    take(next);
  }
  if (block && at != 0 && block->first == at) take(*block);
  return at ? &out : nullptr;
}

} // namespace openrt
