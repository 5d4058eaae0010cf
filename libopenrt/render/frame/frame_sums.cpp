// frame_sums.cpp: when kept sums belong together, and how they are added.
#include "render/frame/frame_sums.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>

#include <xxhash.h>

#include "render/film/error.h"
#include "render/flush_denormals.h"
#include "render/frame/result_codec.h"
#include "render/wave/light_stride.h"
#include "scene/quality.h"

namespace openrt {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw SumsError(why); }

// A property of frames, beside quality settings, that sums depend on, with its name in messages.
struct Setting {
  const char* name;
  std::string (*value)(const edit::FrameSettingsT& frame);
};
template <auto member> std::string text(const edit::FrameSettingsT& frame) {
  return std::to_string(frame.*member);
}
// Names are not told in messages, as there may be many: their hash is.
std::string textOfNames(const edit::FrameSettingsT& frame) {
  const std::vector<uint32_t>& names = frame.unitedNames;
  return std::to_string(XXH3_64bits(names.data(), names.size() * sizeof(uint32_t)));
}
using F = edit::FrameSettingsT;
constexpr Setting settings[] = {
    {"width", text<&F::width>},
    {"height", text<&F::height>},
    {"set of channels", text<&F::channels>},
    {"x of its rectangle", text<&F::scissorX>},
    {"y of its rectangle", text<&F::scissorY>},
    {"width of its rectangle", text<&F::scissorWidth>},
    {"height of its rectangle", text<&F::scissorHeight>},
    {"table of united names", textOfNames},
};

void checkIdentity(const SumsIdentity& a, const SumsIdentity& b, const char* here) {
  if (a.version != b.version)
    refuse("it was made by version " + a.version + ", " + here + " by version " + b.version);
  if (a.isa != b.isa)
    refuse("it was made with the instruction set " + a.isa + ", " + here + " with " + b.isa +
           "; choose one that both have");
  if (a.kernel != b.kernel)
    refuse("it was made with " + a.kernel + ", " + here + " with " + b.kernel);
}

void checkSettings(const edit::FrameSettingsT& a, const edit::FrameSettingsT& b, const char* here) {
  const auto refuseOther = [here](const char* name, const std::string& one,
                                  const std::string& other) {
    refuse(std::string("it was made with another ") + name + " (" + one + ") than " + here + " (" +
           other + ")");
  };
  for (const Setting& s : settings)
    if (s.value(a) != s.value(b)) refuseOther(s.name, s.value(a), s.value(b));
  for (const QualitySetting& s : qualitySettings())
    if (s.get && !s.mayDiffer && s.get(a) != s.get(b))
      refuseOther(s.info.name, qualityText(s.info, s.get(a)), qualityText(s.info, s.get(b)));
}

void checkScene(const SumsIdentity& a, const SumsIdentity& b, const char* here) {
  // A headlight moves with the view, so that the world differs then, too.
  const std::string what = a.view == b.view     ? "world"
                           : a.world == b.world ? "view"
                                                : "view or world";
  if (!(a.view == b.view && a.world == b.world))
    refuse("it is of another " + what + " than " + here);
}

// Refuses what a frame with more samples than the sums cannot use.
void checkLonger(const FrameSums& sums, const edit::FrameSettingsT& frame,
                 const FrameFacts& facts) {
  const uint32_t had = sums.frame.samples, wanted = frame.samples;
  const std::string both =
      std::to_string(had) + " samples a pixel, and " + std::to_string(wanted) + " are wanted: ";
  if (wanted < had) refuse("it is of a picture of " + both + "it cannot get fewer");
  if (frame.targetError > 0)
    refuse("it is of a picture of " + both + "with a target error the number cannot change");
  if (had < fewestOfLeaves)
    refuse("it is of a picture of " + both + "only one of at least " +
           std::to_string(fewestOfLeaves) + " samples can get more");
  const Replicates old = replicatesOf(sums.frame, had, frame.seed),
                   now = replicatesOf(frame, wanted, frame.seed);
  if (!(old == now))
    refuse("it is of a picture of " + both + "error bars of the longer one need replicates of " +
           std::to_string(now.size()) + " samples, the file has those of " +
           std::to_string(old.size()) + "; add another seed instead");
  if (sums.facts.guide == FrameFacts::unknownGuide || facts.guide == FrameFacts::unknownGuide)
    refuse("it is of a picture of " + both +
           "only without a cluster can a picture get more; add another seed instead");
  if (sums.facts.guide != facts.guide)
    refuse("it is of a picture of " + both +
           "photons guide its paths, and their number depends on that of the samples; add another "
           "seed instead");
}

Tile tileOf(const FrameSums& sums, uint32_t number) { return TileGrid(sums.frame).at(number); }

bool hasErrors(const edit::FrameSettingsT& frame) {
  return wantsError(frame) || (frame.samples > 1 && (frame.channels & RT_VARIANCE));
}

// Merges two neighbouring blocks of seeds, as their pictures are added.
SeedSums append(const FrameSums& of, const SeedSums& a, const SeedSums& b) {
  const RequiredSums required = requiredSums(of.frame);
  SeedSums out;
  out.first = a.first;
  out.count = a.count + b.count;
  out.light = a.light;
  out.lightRays = a.lightRays;
  out.lightRays.add(b.lightRays);
  LightImage::merge(out.light, b.light,
                    hasErrors(of.frame) ? LightImage::Kept::pixels : LightImage::Kept::means);
  for (uint32_t i = 0; i < a.tiles.size(); i++) {
    SumBlock left, right;
    const KeptBlock& block = a.tiles[i].at(0);
    decodeSeeds(of.frame, tileOf(of, i), a, block, left);
    decodeSeeds(of.frame, tileOf(of, i), b, b.tiles[i].at(0), right);
    left.append(right, required, block.replicates);
    KeptBlock both{block.replicates, 0, block.count, left.rays, nullptr};
    JobResult result;
    result.sums = std::move(left.sums);
    result.hits = std::move(left.hits);
    result.ledger = left.ledger;
    both.bytes = std::make_shared<const std::vector<std::byte>>(
        encodeResult(of.frame, jobOf(i, both), result));
    out.tiles.push_back({std::move(both)});
  }
  return out;
}

} // namespace

Job jobOf(uint32_t tile, const KeptBlock& block) {
  return {Job::Kind::samples, false, tile, block.first, block.count, block.replicates};
}

void decodeSeeds(const edit::FrameSettingsT& frame, const Tile& tile, const SeedSums& seeds,
                 const KeptBlock& block, SumBlock& out) {
  JobResult result;
  if (!decodeResult(frame, jobOf(0, block), tile, *block.bytes, result)) refuse("it is damaged");
  out = {block.first,   block.count, std::move(result.sums),
         result.ledger, block.rays,  std::move(result.hits)};
  out.ledger.samples *= seeds.count;
  for (PixelSums& s : out.sums) {
    s.samples *= seeds.count;
    s.replicates *= seeds.count;
  }
}

bool isBlockOf(const KeptBlock& block, uint32_t samplesOfSums, uint32_t samples) {
  if (samples == samplesOfSums) return true;
  const uint32_t end = block.first + block.count;
  return end < fewestOfLeaves ? std::has_single_bit(end) : end % fewestOfLeaves == 0;
}

void checkContinues(const FrameSums& sums, const edit::FrameSettingsT& frame,
                    const FrameFacts& facts, const SumsIdentity& identity) {
  constexpr const char* here = "this picture";
  checkIdentity(sums.identity, identity, here);
  checkScene(sums.identity, identity, here);
  if (sums.condensed || sums.seeds.size() != 1)
    refuse("it has the sums of finished pictures alone, with which vv merge works");
  checkSettings(sums.frame, frame, here);
  if (sums.frame.seed != frame.seed)
    refuse("it is of the seed " + std::to_string(sums.frame.seed) + ", and " +
           std::to_string(frame.seed) + " is wanted");
  if (sums.facts.camera != facts.camera || sums.facts.lamps != facts.lamps)
    refuse("it is of another world than this picture");
  if (sums.frame.samples != frame.samples) checkLonger(sums, frame, facts);
}

FrameSumsPtr condense(const FrameSums& sums) {
  if (sums.condensed) return std::make_shared<FrameSums>(sums);
  if (!sums.complete) refuse("its picture is not finished");
  if (sums.frame.targetError > 0)
    refuse("its picture has a target error: tiles of several such pictures differ in their "
           "replicates, and their sums cannot be added");
  if (sums.frame.measure != RT_MEASURE_NOTHING) refuse("it has the readings of sensors");
  if (lightStrideOf(sums.frame) > 1) refuse("its picture is a preview");
  const FlushDenormals flush;
  const RequiredSums required = requiredSums(sums.frame);
  auto out = std::make_shared<FrameSums>(sums);
  out->condensed = true;
  SeedSums& seeds = out->seeds[0];
  for (uint32_t i = 0; i < seeds.tiles.size(); i++) {
    std::vector<KeptBlock>& blocks = seeds.tiles[i];
    TileSums all;
    for (const KeptBlock& block : blocks) {
      SumBlock one;
      decodeSeeds(sums.frame, tileOf(sums, i), seeds, block, one);
      all.join(one, required, block.replicates);
      all.keep(one, required);
    }
    SumBlock room;
    const SumBlock* whole =
        blocks.empty() ? nullptr : all.fold(nullptr, room, required, blocks[0].replicates);
    if (!whole || whole->count != sums.frame.samples) refuse("it is damaged");
    KeptBlock block{blocks[0].replicates, 0, whole->count, whole->rays, nullptr};
    JobResult result;
    result.sums = whole->sums;
    result.hits = whole->hits;
    result.ledger = whole->ledger;
    block.bytes = std::make_shared<const std::vector<std::byte>>(
        encodeResult(sums.frame, jobOf(i, block), result));
    blocks = {std::move(block)};
  }
  return out;
}

FrameSumsPtr mergeSums(const FrameSums& first, const FrameSums& second) {
  constexpr const char* here = "the other one";
  // Messages speak of the second one, which is added to the first.
  checkIdentity(second.identity, first.identity, here);
  checkSettings(second.frame, first.frame, here);
  if (first.frame.samples != second.frame.samples)
    refuse("it has " + std::to_string(second.frame.samples) + " samples a pixel, the other one " +
           std::to_string(first.frame.samples));
  checkScene(second.identity, first.identity, here);
  const FrameSumsPtr a = condense(first), b = condense(second);
  if (a->facts.camera != b->facts.camera || a->facts.lamps != b->facts.lamps)
    refuse("it is of another world than the other one");
  const FlushDenormals flush;
  auto out = std::make_shared<FrameSums>();
  out->frame = a->frame;
  out->facts = a->facts;
  out->facts.guide = 0;
  out->identity = a->identity;
  out->complete = out->condensed = true;
  std::vector<SeedSums> blocks = a->seeds;
  blocks.insert(blocks.end(), b->seeds.begin(), b->seeds.end());
  std::sort(blocks.begin(), blocks.end(),
            [](const SeedSums& x, const SeedSums& y) { return x.first < y.first; });
  uint64_t seeds = 0;
  for (const SeedSums& block : blocks) seeds += block.count;
  if (seeds * out->frame.samples > ~uint32_t(0)) refuse("both have more samples than can be added");
  for (SeedSums& block : blocks) {
    std::vector<SeedSums>& done = out->seeds;
    if (!done.empty() && done.back().first + done.back().count > block.first)
      refuse("both have the seed " + std::to_string(block.first) +
             ": its samples would count twice");
    SeedSums next = std::move(block);
    while (!done.empty() &&
           siblings(done.back().first, done.back().count, next.first, next.count)) {
      next = append(*out, done.back(), next);
      done.pop_back();
    }
    done.push_back(std::move(next));
  }
  out->frame.seed = out->seeds[0].first;
  return out;
}

} // namespace openrt
