#include "render/surface/continue_paths.h"

#include "render/wave/sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface/continue_paths.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/compress-inl.h"
#include "render/lanes/directions-inl.h"
#include "render/lanes/hash-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// Marks the number of a hit whose next ray leads behind the surface.
constexpr uint32_t behindBit = 1u << 31;

Lanes whereOrZero(Mask condition, Lanes v) { return hn::IfThenElseZero(condition, v); }

// Returns the weight of the lobe in the colours of the sample. Components below 0 and those that
// are not finite count as 0.
LaneVec weightAt(const SampleArrays& sample, uint32_t i) {
  const auto component = [&](uint32_t k) {
    if (sample.colour && sample.colour != k + 1) return lanesOf(0);
    return checked(load(sample.lobe->weight[k] + i));
  };
  return {component(0), component(1), component(2)};
}
Lanes loadOrOne(const float* from, uint32_t i) { return from ? load(from + i) : lanesOf(1); }
Lanes loadOrZero(const float* from, uint32_t i) { return from ? load(from + i) : lanesOf(0); }

Bits splitsOf(Bits flags) {
  return hn::And(hn::ShiftRight<PathFlags::splitsShift>(flags), bitsOf(PathFlags::mostSplits));
}

// Returns where one of several samples is selected, because the path has split often enough.
Mask selectsOne(const Continuation& paths, Bits samples, Indices lane) {
  const BitsMask several = hn::Gt(samples, bitsOf(1));
  if (hn::AllFalse(BitsTag(), several)) return maskOf(several);
  const Bits flags = gather(paths.states->flags, lane);
  return maskOf(hn::And(several, hn::Gt(splitsOf(flags), bitsOf(mostSplits - 1))));
}

// Returns the branches that the rays of the samples belong to. number: samples of the hit before.
Bits branchesAfter(const Continuation& paths, Bits branch, Bits number) {
  const BitsMask first = hn::Eq(number, bitsOf(0));
  if (hn::AllTrue(BitsTag(), first)) return branch;
  return hn::IfThenElse(first, branch,
                        hash(branch + number, bitsOf(openrt::hash(paths.level + 1))));
}

// Returns the facts of the paths after a sample has been followed.
Bits flagsAfter(const SampleArrays& sample, Bits flags, Bits samples) {
  const BitsMask adds =
      hn::And(hn::Gt(samples, bitsOf(1)), hn::Ne(splitsOf(flags), bitsOf(PathFlags::mostSplits)));
  flags = flags + hn::IfThenElseZero(adds, bitsOf(1u << PathFlags::splitsShift));
  if (sample.colour) flags = hn::Or(flags, bitsOf(sample.colour << PathFlags::channelShift));
  if (!sample.deflected) return flags + bitsOf(1u << PathFlags::passagesShift);
  if (sample.lobe->coat) {
    const BitsMask first = hn::Eq(hn::And(flags, bitsOf(PathFlags::scatteredBit)), bitsOf(0));
    flags = hn::Or(flags, hn::IfThenElseZero(first, bitsOf(PathFlags::reflectedBit)));
  }
  const auto is = [&](PathClass pathClass) {
    return hn::Eq(hn::And(flags, bitsOf(PathFlags::classBits)), bitsOf(uint32_t(pathClass)));
  };
  const auto bitsOfClass = [](PathClass pathClass) { return bitsOf(uint32_t(pathClass)); };
  const Bits first = bitsOfClass(PathClass::specularFirst);
  const BitsMask scattered = hn::Ne(hn::And(flags, bitsOf(PathFlags::scatteredBit)), bitsOf(0));
  const Bits rest = hn::AndNot(
      bitsOf(PathFlags::classBits | PathFlags::specularSinceDiffuseBit | PathFlags::connectableBit),
      flags);
  if (sample.pdf) {
    const BitsMask behind = is(PathClass::specularFirst);
    return hn::AndNot(bitsOf(PathFlags::passedUnsampledBit), rest) |
           bitsOf(PathFlags::deflectedBit | PathFlags::scatteredBit) |
           hn::IfThenElseZero(hn::AndNot(scattered, behind), bitsOf(PathFlags::connectableBit)) |
           hn::IfThenElse(behind, first, bitsOfClass(PathClass::diffuse));
  }
  return rest | bitsOf(PathFlags::deflectedBit) |
         hn::IfThenElseZero(scattered, bitsOf(PathFlags::specularSinceDiffuseBit)) |
         hn::IfThenElse(hn::Or(is(PathClass::undeflected), is(PathClass::specularFirst)), first,
                        bitsOfClass(PathClass::caustic));
}

// The samples of a vector of hits: how many there are, and the throughput that they are expected to
// carry together.
struct Expected {
  Bits count;
  Lanes sum;
};

// Writes to the samples of the hits from i on what each is expected to carry (`kept`), and its
// number. onlySpecular: where non-specular samples do not count.
Expected expectSamples(const BsdfSampleArrays& samples, uint32_t i, Mask present, Mask onlySpecular,
                       const LaneVec& throughput) {
  Expected all{bitsOf(0), lanesOf(0)};
  for (const SampleArrays& sample : samples) {
    const LaneVec weight = weightAt(sample, i);
    const Lanes share = loadOrOne(sample.share, i);
    Mask exists = hn::And(present, largest(weight) > lanesOf(0));
    exists = sample.pdf ? hn::AndNot(onlySpecular, exists) : hn::And(exists, share > lanesOf(0));
    const Lanes carried = whereOrZero(exists, largest(weight * share * throughput));
    store(carried, sample.kept + i);
    store(hn::IfThenElse(maskOf(exists), all.count, bitsOf(SampleArrays::lacking)),
          sample.number + i);
    all.count = all.count + bitsWhere(exists, 1);
    all.sum = all.sum + carried;
  }
  return all;
}

// Selects one of the samples of each hit, which are visited one after the other.
struct Selector {
  Mask open; // where a sample is still to be selected
  Lanes at;  // random number times the sum of what the samples carry, less what was visited

  // Returns where this sample is selected. last: where no sample follows it.
  Mask visit(Lanes carried, Mask exists, Mask last) {
    const Mask selected = hn::And(hn::And(open, exists), hn::Or(at < carried, last));
    open = hn::AndNot(selected, open);
    at = at - carried;
    return selected;
  }
};

Mask isLast(Bits number, Bits count) { return maskOf(hn::Eq(number + bitsOf(1), count)); }

} // namespace

void selectOne(const Selection& selection, const BsdfSampleArrays& samples) {
  const Points& points = *selection.points;
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  for (uint32_t i = 0; i < points.hits.count; i += width()) {
    LaneVec throughput{one, one, one};
    if (selection.throughput)
      throughput = gather(selection.throughput, indicesFrom(points.order, i, points.hits.count));
    const Mask onlySpecular =
        selection.onlySpecular ? loadMask(selection.onlySpecular + i) : noLanes();
    const Expected all =
        expectSamples(samples, i, presentFrom(i, points.hits.count), onlySpecular, throughput);
    const Mask some = all.sum > zero;
    Selector selector{some, load(selection.choice + i) * all.sum};
    const Lanes survival = selection.survival ? min(one, all.sum) : one;
    const Mask survives = selection.survival ? load(selection.survival + i) < survival : some;
    Bits number = bitsOf(SampleArrays::lacking);
    Lanes probability = zero;
    uint32_t index = 0;
    for (const SampleArrays& sample : samples) {
      const Lanes carried = load(sample.kept + i);
      const Bits before = load(sample.number + i);
      const Mask exists = hn::And(some, maskOf(hn::Ne(before, bitsOf(SampleArrays::lacking))));
      const Mask selected = selector.visit(carried, exists, isLast(before, all.count));
      const Mask follows = hn::And(hn::And(selected, survives), carried > zero);
      number = hn::IfThenElse(maskOf(follows), bitsOf(index++), number);
      probability = select(follows, carried / all.sum, probability);
    }
    store(number, selection.number + i);
    store(probability, selection.probability + i);
    store(survival, selection.survivalProbability + i);
  }
}

void choose(const Continuation& paths, const BsdfSampleArrays& samples) {
  const uint32_t n = paths.points->hits.count;
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const Bits lacking = bitsOf(SampleArrays::lacking);
  for (uint32_t i = 0; i < n; i += width()) {
    const Mask present = presentFrom(i, n);
    const Indices lane = indicesFrom(paths.points->order, i, n);
    const LaneVec throughput = gather(paths.states->throughput, lane);
    const auto [count, sum] = expectSamples(samples, i, present, noLanes(), throughput);
    store(count, paths.count + i);
    const Mask single = maskOf(hn::Eq(count, bitsOf(1)));
    const Mask some = sum > zero;
    const Mask selects = paths.choice ? hn::And(some, selectsOne(paths, count, lane)) : noLanes();
    const bool anySelects = !hn::AllFalse(LanesTag(), selects);
    Selector selector{selects, anySelects ? load(paths.choice + i) * sum : zero};
    Mask random = selects;
    for (const SampleArrays& sample : samples) {
      const Lanes carried = load(sample.kept + i);
      const Bits number = load(sample.number + i);
      const Mask exists = hn::And(some, maskOf(hn::Ne(number, lacking)));
      Mask follows = hn::And(exists, carried > zero);
      Lanes probability = one;
      if (anySelects) {
        probability = select(selects, carried / sum, one);
        const Mask selected = selector.visit(carried, exists, isLast(number, count));
        follows = hn::And(follows, hn::Or(hn::Not(selects), selected));
      }
      if (sample.probability) store(probability, sample.probability + i);
      if (sample.selectionProbability)
        store(whereOrZero(exists, probability), sample.selectionProbability + i);
      if (!paths.survival) {
        const Mask cut = carried < lanesOf(paths.energyCut);
        store(whereOrZero(hn::AndNot(cut, follows), one), sample.kept + i);
        continue;
      }
      Lanes survival = min(one, carried / (probability * lanesOf(certainThroughput)));
      if (!sample.pdf) survival = select(single, one, survival);
      random = hn::Or(random, hn::And(follows, survival < one));
      const Mask survives = hn::And(follows, load(paths.survival + i) < survival);
      store(whereOrZero(survives, probability * survival), sample.kept + i);
    }
    store(bitsWhere(random, 1), paths.random + i);
  }
}

// Returns the number of rays written behind the end of the queue.
size_t appendRays(const Continuation& paths, const SampleArrays& sample, uint32_t* hitOf,
                  const RayQueue& queue) {
  const RtsHits& hits = paths.points->hits;
  const PathStates &states = *paths.states, &to = queue.states();
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const LaneVec none{zero, zero, zero};
  const bool specular = !sample.pdf;
  const size_t begin = queue.size();
  size_t end = begin;
  for (uint32_t i = 0; i < hits.count; i += width()) {
    const Lanes kept = load(sample.kept + i);
    Mask valid = hn::And(presentFrom(i, hits.count), kept > zero);
    if (hn::AllFalse(LanesTag(), valid)) continue;
    const LaneVec direction = load(sample.direction, i), g = load(hits.geometric, i);
    const Lanes towards = dot(direction, g);
    Lanes pdf = zero;
    if (!specular) {
      // The sample must be on the same side of the facet as of the lobe's normal.
      pdf = load(sample.pdf + i);
      const Mask above = dot(direction, load(sample.lobe->normal, i)) > zero;
      Mask consistent = hn::And(above, towards > zero);
      if (sample.transmits) consistent = hn::Or(consistent, hn::AndNot(above, towards < zero));
      valid = hn::And(hn::And(valid, consistent), pdf > zero);
      if (hn::AllFalse(LanesTag(), valid)) continue;
      pdf = pdf * load(sample.probability + i);
    }
    const Indices lane = indicesFrom(paths.points->order, i, hits.count);
    Bits flags = flagsAfter(sample, gather(states.flags, lane), load(paths.count + i));
    if (!sample.deflected) {
      pdf = gather(states.pdf, lane);
      const Mask lost =
          paths.unsampled ? hn::And(loadMask(paths.unsampled + i), pdf > zero) : noLanes();
      pdf = select(lost, zero, pdf);
      flags = hn::Or(flags, bitsWhere(lost, PathFlags::passedUnsampledBit));
    }
    // Mirror images have the fog of the whole path when they are found.
    const Lanes through = specular ? one : loadOrOne(paths.throughFog, i);
    valid = hn::And(valid, through > zero);
    const LaneVec weight = weightAt(sample, i) * through;
    const LaneVec carried{weight.x * loadOrOne(sample.valueOf(0), i) / kept,
                          weight.y * loadOrOne(sample.valueOf(1), i) / kept,
                          weight.z * loadOrOne(sample.valueOf(2), i) / kept};
    // A shader may return numbers so large that their product overflows. Such a path ends.
    const LaneVec throughput = gather(states.throughput, lane) * carried;
    valid = hn::And(valid, isFinite(throughput.x + throughput.y + throughput.z));
    const LaneVec position = load(hits.position, i),
                  side = select(towards > zero, one, lanesOf(-1)) * g;
    const Lanes error = load(paths.points->error + i);
    const Compressed append{valid, end};
    append(offsetPoint(position, side, error), queue.origin());
    append(direction, queue.direction());
    append(throughput, to.throughput);
    append(load(hits.distance + i), to.travelled);
    append(pdf, to.pdf);
    append(gather(states.path, lane), to.path);
    append(branchesAfter(paths, gather(states.branch, lane), load(sample.number + i)), to.branch);
    append(flags, to.flags);
    if (specular) {
      append(gather(states.previousPosition, lane), to.previousPosition);
      append(gather(states.previousNormal, lane), to.previousNormal);
      append(gather(states.unguidedWeight, lane), to.unguidedWeight);
      // No light path is connected to a surface that is seen in a mirror.
      const Lanes ratio = gather(states.lightPathRatio, lane);
      const Mask lost = hasBits(gather(states.flags, lane), PathFlags::connectableBit);
      append(sample.deflected ? select(lost, zero, ratio) : ratio, to.lightPathRatio);
      append(sample.deflected ? zero : gather(states.glossyPdf, lane), to.glossyPdf);
    } else {
      append(one, to.unguidedWeight);
      append(loadOrZero(sample.lightPathRatio, i), to.lightPathRatio);
      append(loadOrZero(sample.glossyPdf, i), to.glossyPdf);
      append(offsetPoint(position, g, error), to.previousPosition);
      append(paths.twoSided ? select(loadMask(paths.twoSided + i), none, g) : g, to.previousNormal);
    }
    Compressed{valid, end - begin}(
        hn::Or(hn::Iota(BitsTag(), i), bitsWhere(towards < zero, behindBit)), hitOf);
    end += countTrue(valid);
  }
  return end - begin;
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

HWY_EXPORT(selectOne);
HWY_EXPORT(choose);
HWY_EXPORT(appendRays);

void Selection::allocate(Arena& arena) {
  const uint32_t n = padded(points->hits.count);
  number = arena.take<uint32_t>(n);
  probability = arena.take<float>(n);
  survivalProbability = arena.take<float>(n);
}

void selectSamples(const Selection& selection, const BsdfSampleArrays& samples) {
  HWY_DYNAMIC_DISPATCH(selectOne)(selection, samples);
}

void chooseSamples(const Continuation& paths, const BsdfSampleArrays& samples) {
  HWY_DYNAMIC_DISPATCH(choose)(paths, samples);
}

void continuePaths(const Continuation& paths, const SampleArrays& sample, uint32_t* hitOf,
                   RayQueue& queue) {
  queue.reserve(paths.points->hits.count);
  const size_t begin = queue.size(),
               count = HWY_DYNAMIC_DISPATCH(appendRays)(paths, sample, hitOf, queue);
  for (size_t i = 0; i < count; i++) {
    const uint32_t hit = hitOf[i] & ~HWY_NAMESPACE::behindBit;
    const bool crosses = paths.crossing && hit != hitOf[i];
    queue.states().media[begin + i] =
        crosses ? paths.crossing[hit].behind : paths.states->media[paths.points->order[hit]];
  }
  queue.add(count);
}

} // namespace openrt
#endif
