#include "render/surface/continue_paths.h"

#include "render/surface/bsdf_choice.h"
#include "render/surface/lobes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/surface/continue_paths.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/directions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// Weights below 0 and weights that are not finite count as 0.
Lanes checkedWeight(const float* from) {
  const Lanes zero = lanesOf(0), w = load(from);
  return select(hn::And(w > zero, isFinite(w)), w, zero);
}

struct Compressed { // appends the lanes where a condition holds to arrays
  Mask condition;
  size_t at;
  void operator()(Lanes v, float* to) const {
    hn::CompressStore(v, condition, LanesTag(), to + at);
  }
  void operator()(Bits v, uint32_t* to) const {
    hn::CompressStore(v, hn::RebindMask(BitsTag(), condition), BitsTag(), to + at);
  }
  void operator()(const LaneVec& v, float* const to[3]) const {
    (*this)(v.x, to[0]);
    (*this)(v.y, to[1]);
    (*this)(v.z, to[2]);
  }
};

Bits gatherBits(const uint32_t* from, Indices index) {
  const hn::RebindToSigned<LanesTag> tag;
  return hn::BitCast(BitsTag(),
                     hn::GatherIndex(tag, reinterpret_cast<const int32_t*>(from), index));
}

} // namespace

// Returns the number of rays written behind the end of the queue.
size_t appendRays(const Continuation& from, uint32_t* laneOf, const RayQueue& queue) {
  const RtsHits& hits = from.points->hits;
  const PathStates& states = *from.states;
  const PathStates& to = queue.states();
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const LaneVec none{zero, zero, zero};
  const size_t begin = queue.size();
  size_t end = begin;
  for (uint32_t i = 0; i < hits.count; i += width()) {
    const Mask present = hn::FirstN(LanesTag(), hits.count - i);
    const Indices lane = indicesFrom(from.order, i, hits.count);
    const LaneVec weight{checkedWeight(from.lobe->weight[0] + i),
                         checkedWeight(from.lobe->weight[1] + i),
                         checkedWeight(from.lobe->weight[2] + i)};
    const LaneVec throughput = gather(states.throughput, lane);
    const Lanes carried = largest(weight * throughput);
    const Mask wanted = hn::And(present, carried > zero);
    if (from.selectionProbability) store(select(wanted, one, zero), from.selectionProbability + i);
    const LaneVec direction = load(from.samples->direction, i), n = load(from.lobe->normal, i),
                  g = load(hits.geometric, i);
    const Lanes pdf = load(from.samples->pdf + i);
    // The sample must be on the same side of the facet as of the lobe's normal.
    const Lanes towards = dot(direction, g);
    Mask valid = hn::And(dot(direction, n) > zero, towards > zero);
    if (from.transmits) valid = hn::Or(valid, hn::AndNot(dot(direction, n) > zero, towards < zero));
    valid = hn::And(hn::And(wanted, valid), pdf > zero);
    const Lanes kept = min(one, carried / lanesOf(certainThroughput));
    valid = hn::And(valid, load(from.survival + i) < kept);
    if (hn::AllFalse(LanesTag(), valid)) continue;
    const LaneVec value = load(from.samples->value, i);
    const LaneVec position = load(hits.position, i),
                  side = select(towards > zero, one, lanesOf(-1)) * g;
    const Lanes error = load(from.points->error + i);
    const Bits flags = gatherBits(states.flags, lane);
    const Bits pathClass = hn::And(flags, bitsOf(PathFlags::classBits));
    const auto first = hn::Eq(pathClass, bitsOf(uint32_t(PathClass::specularFirst)));
    const Bits newClass = hn::IfThenElse(first, pathClass, bitsOf(uint32_t(PathClass::diffuse)));
    const Bits cleared =
        hn::AndNot(bitsOf(PathFlags::classBits | PathFlags::specularSinceDiffuseBit), flags);
    const Compressed append{valid, end};
    append(offsetPoint(position, side, error), queue.origin());
    append(direction, queue.direction());
    // The order of operations is that of spawnRays(): weight over probability, times throughput.
    const LaneVec left{weight.x * value.x / kept, weight.y * value.y / kept,
                       weight.z * value.z / kept};
    append(throughput * left, to.throughput);
    append(load(hits.distance + i), to.travelled);
    append(gatherBits(states.path, lane), to.path);
    append(gatherBits(states.branch, lane), to.branch);
    append(pdf, to.pdf);
    append(offsetPoint(position, g, error), to.previousPosition);
    append(from.transmits ? none : g, to.previousNormal);
    append(hn::Or(hn::Or(cleared, newClass),
                  bitsOf(PathFlags::scatteredBit | PathFlags::deflectedBit)),
           to.flags);
    Compressed{valid, end - begin}(hn::BitCast(BitsTag(), lane), laneOf);
    end += hn::CountTrue(LanesTag(), valid);
  }
  return end - begin;
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace openrt {

HWY_EXPORT(appendRays);

void continuePaths(const Continuation& from, uint32_t* laneOf, RayQueue& queue) {
  queue.reserve(from.points->hits.count);
  const size_t begin = queue.size(), count = HWY_DYNAMIC_DISPATCH(appendRays)(from, laneOf, queue);
  for (size_t i = 0; i < count; i++)
    queue.states().media[begin + i] = from.states->media[laneOf[i]];
  queue.add(count);
}

} // namespace openrt
#endif
