// accumulate.cpp: Finds each pixel's surface in the frame before and adds this frame's illumination
// to what was accumulated there.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/accumulate.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/past-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

constexpr float mostFrames = 16;     // older light is not worth what has changed since
constexpr float recentFrames = 5;    // frames in Accumulated::recent
constexpr float recentSpread = 2;    // standard deviations around it that are allowed
constexpr float noiseMemory = 0.96f; // how much of Accumulated::noise stays from frame to frame
// The same where more of the samples around than that fraction are like what was shown.
constexpr float calmMemory = 0.5f, mostSteady = 0.85f;
constexpr float forgottenNoise = 0.02f;
constexpr float firmFrames = 4; // from here on the variance over time is trusted
constexpr float certainty = 3;  // a change counts from sqrt(3) standard deviations on

inline LaneVec mixed(const LaneVec& old, const LaneVec& fresh, Lanes part) {
  return old + (fresh - old) * part;
}
inline Lanes mixed(Lanes old, Lanes fresh, Lanes part) { return old + (fresh - old) * part; }

// Lowers the luma of samples beyond the limit, with their colour.
inline LaneVec limited(const LaneVec& light, Lanes limit) {
  const Lanes scale =
      hn::IfThenElseZero(light.x > lanesOf(0), limit / max(light.x, lanesOf(1e-20f)));
  return light * select(light.x > limit, scale, lanesOf(1));
}

void recallRow(const Reading& reading, int y, const Moment& before, Moment& now, Work& work) {
  const Layout& layout = now.layout;
  const Accumulated& old = before.accumulated;
  Accumulated& fresh = now.accumulated;
  const size_t row = layout.row(y);
  double found = 0;
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes pastX = load(reading.pastX.data() + i), pastY = load(reading.pastY.data() + i);
    const Lanes slope =
        abs(load(now.guides.slopeX.data() + i)) + abs(load(now.guides.slopeY.data() + i));
    const Expected expected = expectedAt(now, before, reading, slope, i);
    Taps taps = tapsAround(before, expected, pastX, pastY);
    searchAround(before, expected, pastX, pastY, taps);
    const LaneVec light = taps.of(old.light);
    const Lanes frames = taps.of(old.frames);
    store(light, fresh.light, i);
    store(taps.of(old.recent), fresh.recent, i);
    store(taps.of(old.mean), fresh.mean.data() + i);
    store(taps.of(old.square), fresh.square.data() + i);
    store(taps.of(old.noise), fresh.noise.data() + i);
    store(frames, fresh.frames.data() + i);

    const Mask some = load(now.guides.name.data() + i) >= lanesOf(0);
    const Lanes noisy = load(work.noise.data() + i) + load(fresh.noise.data() + i);
    const Mask known = hn::And(hn::And(taps.found, some), noisy > lanesOf(0));
    const LaneVec sample = limited(load(reading.light, i), load(work.limit.data() + i));
    store(hn::IfThenElseZero(known, sample.x - light.x), work.change.data() + i);
    store(hn::IfThenElseZero(known, light.x), work.level.data() + i);
    // The variance over time counts, too: a frame that happens to lack light looks less noisy.
    const Lanes mean = load(fresh.mean.data() + i);
    const Lanes overTime = load(fresh.square.data() + i) - mean * mean;
    store(hn::IfThenElseZero(known, max(load(work.variance.data() + i), overTime)),
          work.doubt.data() + i);

    float lanes[Layout::widest];
    store(hn::IfThenElseZero(hn::And(taps.found, hn::And(some, presentFrom(x, layout.width))),
                             lanesOf(1)),
          lanes);
    for (int k = 0; k < width(); k++) found += double(lanes[k]);
  }
  work.found[size_t(y)] = found;
}

void changeRow(const ChangePass& pass, int y, const Moment& now) {
  constexpr float weights[2] = {0.5f, 0.25f};
  const Layout& layout = now.layout;
  const float* name = now.guides.name.data();
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i);
    Lanes sums[3] = {lanesOf(0), lanesOf(0), lanesOf(0)};
    for (int dy = -1; dy <= 1; dy++)
      for (int dx = -1; dx <= 1; dx++) {
        const size_t j = i + size_t((ptrdiff_t(layout.stride) * dy + dx) * pass.step);
        const float weight = weights[std::abs(dx)] * weights[std::abs(dy)];
        const Mask same = load(name + j) == ownName;
        for (int k = 0; k < 3; k++)
          sums[k] = sums[k] + hn::IfThenElseZero(same, load(pass.from[k]->data() + j)) *
                                  lanesOf(k == 2 ? weight * weight : weight);
      }
    for (int k = 0; k < 3; k++) store(sums[k], pass.to[k]->data() + i);
  }
}

void accumulateRow(const Reading& reading, int y, Moment& now, Work& work) {
  const Layout& layout = now.layout;
  Accumulated& sums = now.accumulated;
  const size_t row = layout.row(y);
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  double frames = 0;
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Mask some = load(now.guides.name.data() + i) >= zero;

    // How much brighter it has become around here: what is beyond doubt of the mean change.
    const Lanes change = load(work.change.data() + i), level = load(work.level.data() + i),
                doubt = load(work.doubt.data() + i);
    const Lanes certain =
        max(one - lanesOf(certainty) * doubt / max(change * change, lanesOf(1e-30f)), zero);
    const Lanes brighter = certain * change;
    const Lanes ratio =
        clamp(one + brighter / max(level, lanesOf(1e-20f)), lanesOf(0.25f), lanesOf(4));
    const Lanes lost = abs(brighter) / max(abs(brighter) + level, lanesOf(1e-20f));

    const Lanes count = min(load(sums.frames.data() + i) * (one - lost) + one, lanesOf(mostFrames));
    const Mask calm = load(work.calm.data() + i) > lanesOf(mostSteady);
    const Lanes remembered =
        load(sums.noise.data() + i) * select(calm, lanesOf(calmMemory), lanesOf(noiseMemory));
    const Lanes noise = max(load(work.noise.data() + i),
                            hn::IfThenElseZero(remembered > lanesOf(forgottenNoise), remembered));
    const Lanes trust = min(noise + noise, one); // 0: free of noise, nothing to average
    const Lanes part = max(one / count, one - trust),
                recentPart = max(part, lanesOf(1 / recentFrames));
    const LaneVec light = limited(
        load(reading.light, i), select(trust > zero, load(work.limit.data() + i), lanesOf(1e30f)));
    const Lanes luma = light.x;
    store(mixed(load(sums.light, i) * ratio, light, part), sums.light, i);
    store(mixed(load(sums.recent, i) * ratio, light, recentPart), sums.recent, i);
    const Lanes mean = mixed(load(sums.mean.data() + i) * ratio, luma, part),
                square = mixed(load(sums.square.data() + i) * (ratio * ratio), luma * luma, part);
    store(mean, sums.mean.data() + i);
    store(square, sums.square.data() + i);
    store(hn::IfThenElseZero(some, count), sums.frames.data() + i);
    store(hn::IfThenElseZero(some, noise), sums.noise.data() + i);

    // Variance of the accumulated illumination: over time where there are enough frames, else over
    // the neighbours.
    const Lanes overTime = max(square - mean * mean, zero) * (count / max(count - one, one));
    const Lanes overSpace = load(work.variance.data() + i);
    const Lanes firm = clamp((count - one) * lanesOf(1 / (firmFrames - 1)), zero, one);
    const Lanes early = max(overTime, overSpace);
    store(mixed(early, overTime, firm * firm) / count * trust, work.variance.data() + i);

    float lanes[Layout::widest];
    store(hn::IfThenElseZero(hn::And(some, presentFrom(x, layout.width)), count), lanes);
    for (int k = 0; k < width(); k++) frames += double(lanes[k]);
  }
  work.frames[size_t(y)] = frames;
}

void boundRow(int y, Moment& now) {
  constexpr int reach = 2;
  const Layout& layout = now.layout;
  Accumulated& sums = now.accumulated;
  const float* name = now.guides.name.data();
  const size_t row = layout.row(y);
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i);
    Lanes pixels = zero;
    LaneVec sum{zero, zero, zero}, squares{zero, zero, zero};
    for (int dy = -reach; dy <= reach; dy++)
      for (int dx = -reach; dx <= reach; dx++) {
        const size_t j = i + size_t(ptrdiff_t(layout.stride) * dy + dx);
        const Lanes same = hn::IfThenElseZero(load(name + j) == ownName, one);
        const LaneVec other = load(sums.recent, j) * same;
        pixels = pixels + same;
        sum = sum + other;
        squares = squares + other * other;
      }
    const Lanes per = one / max(pixels, one);
    const LaneVec mean = sum * per, light = load(sums.light, i);
    const LaneVec own = load(sums.recent, i); // is always allowed
    const auto bounded = [&](Lanes v, Lanes r, Lanes m, Lanes s) {
      const Lanes spread = lanesOf(recentSpread) * hn::Sqrt(max(s * per - m * m, zero));
      return clamp(v, min(m - spread, r), max(m + spread, r));
    };
    const LaneVec inside{bounded(light.x, own.x, mean.x, squares.x),
                         bounded(light.y, own.y, mean.y, squares.y),
                         bounded(light.z, own.z, mean.z, squares.z)};
    store(inside, sums.light, i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(recallRow);
HWY_EXPORT(changeRow);
HWY_EXPORT(accumulateRow);
HWY_EXPORT(boundRow);
void recallRow(const Reading& reading, int y, const Moment& before, Moment& now, Work& work) {
  HWY_DYNAMIC_DISPATCH(recallRow)(reading, y, before, now, work);
}
void changeRow(const ChangePass& pass, int y, const Moment& now) {
  HWY_DYNAMIC_DISPATCH(changeRow)(pass, y, now);
}
void accumulateRow(const Reading& reading, int y, Moment& now, Work& work) {
  HWY_DYNAMIC_DISPATCH(accumulateRow)(reading, y, now, work);
}
void boundRow(int y, Moment& now) { HWY_DYNAMIC_DISPATCH(boundRow)(y, now); }
} // namespace picture::live
#endif
