// estimate.cpp: Finds what one frame alone tells about its noise. Smooth shading, textures that the
// albedo explains and the edges of sharp shadows are not noise: such pixels have neighbours like
// themselves. A sampled pixel rarely has.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/estimate.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// A part of the picture is noisy if more than this fraction of its pixels is unlike its neighbours;
// entirely if that many more are. Among samples that are either light or dark, 14 % are.
constexpr float fewUnlike = 0.1f, moreUnlike = 0.2f;
// It is not if the samples in the pixels explain at most this part of their deviations from their
// neighbours; noise explains all, and the edges of anti-aliased shadows up to half.
constexpr float fewExplained = 0.4f, moreExplained = 0.4f;
constexpr float fewestPixels = 16; // fewest pixels of a shape
// Samples are limited to so many standard deviations of the samples around them.
constexpr float limitSpread = 32;

inline Lanes count(Mask condition) { return hn::IfThenElseZero(condition, lanesOf(1)); }
inline Mask areAlike(Lanes a, Lanes b) {
  return abs(a - b) <= max(abs(a), abs(b)) * lanesOf(alikeFraction) + lanesOf(alikeAmount);
}

// The sums of a least-squares fit of a plane through the pixel's own nearness.
struct Fit {
  Lanes xx, xy, yy, xd, yd;

  // Written out: see Around in spread.cpp.
  Fit() : xx(lanesOf(0)), xy(lanesOf(0)), yy(lanesOf(0)), xd(lanesOf(0)), yd(lanesOf(0)) {}
  void add(Mask valid, Lanes x, Lanes y, Lanes d) {
    xx = xx + hn::IfThenElseZero(valid, x * x);
    xy = xy + hn::IfThenElseZero(valid, x * y);
    yy = yy + hn::IfThenElseZero(valid, y * y);
    xd = xd + hn::IfThenElseZero(valid, x * d);
    yd = yd + hn::IfThenElseZero(valid, y * d);
  }
  void solve(Lanes& slopeX, Lanes& slopeY) const {
    const Lanes a = xx + lanesOf(0.02f), b = yy + lanesOf(0.02f); // so that one neighbour is enough
    const Lanes per = lanesOf(1) / (a * b - xy * xy);
    slopeX = (xd * b - yd * xy) * per;
    slopeY = (yd * a - xd * xy) * per;
  }
};

// Sums over the neighbours of a pixel on the same surface.
struct Around8 {
  Lanes neighbours, luma, variance;
};

// Stores how far a luma is from the mean of its neighbours', and how far noise would bring it.
inline void storeDeviation(const Around8& sums, Lanes luma, Lanes variance, size_t i, Work& work) {
  const Lanes several = max(sums.neighbours, lanesOf(1)), zero = lanesOf(0);
  const Lanes difference = luma - sums.luma / several;
  const Lanes scale =
      hn::IfThenElseZero(sums.neighbours > zero, sums.neighbours / (sums.neighbours + lanesOf(1)));
  store(difference * difference * scale, work.deviation.data() + i);
  const Lanes noise = (variance + sums.variance / (several * several)) * scale;
  store(select(variance >= zero, noise, lanesOf(Reading::unknown)), work.expected.data() + i);
}

void compareRow(const Reading& reading, int y, Moment& now, Work& work) {
  // Opposite neighbours follow one another.
  constexpr int around[8][2] = {{-1, 0},  {1, 0}, {0, -1}, {0, 1},
                                {-1, -1}, {1, 1}, {-1, 1}, {1, -1}};
  const Layout& layout = now.layout;
  Guides& guides = now.guides;
  const float *name = guides.name.data(), *near = guides.nearness.data(),
              *luma = reading.light.x.data(), *variance = reading.variance.data(),
              *offsetX = guides.offsetX.data(), *offsetY = guides.offsetY.data();
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i), ownNear = load(near + i), ownLuma = load(luma + i),
                ownX = load(offsetX + i), ownY = load(offsetY + i);
    const LaneVec ownNormal = load(guides.normal, i);
    Fit fit;
    Lanes neighbours = lanesOf(0), sum = lanesOf(0), most = lanesOf(0), alike = lanesOf(0),
          straight = lanesOf(0), variances = lanesOf(0);
    Mask oppositeValid = hn::FirstN(LanesTag(), 0);
    Lanes opposite = lanesOf(0);
    for (int k = 0; k < 8; k++) {
      const int dx = around[k][0], dy = around[k][1];
      const size_t j = i + size_t(ptrdiff_t(layout.stride) * dy + dx);
      const Lanes other = load(luma + j);
      const Mask same = load(name + j) == ownName;
      neighbours = neighbours + count(same);
      sum = sum + hn::IfThenElseZero(same, other);
      variances = variances + hn::IfThenElseZero(same, load(variance + j));
      most = max(most, hn::IfThenElseZero(same, other));
      alike = alike + count(hn::And(same, areAlike(other, ownLuma)));
      if (k % 2 == 1)
        straight = straight + count(hn::And(hn::And(same, oppositeValid),
                                            areAlike((other + opposite) * lanesOf(0.5f), ownLuma)));
      oppositeValid = same;
      opposite = other;
      fit.add(hn::And(same, dot(load(guides.normal, j), ownNormal) > lanesOf(0.9f)),
              lanesOf(float(dx)) + load(offsetX + j) - ownX,
              lanesOf(float(dy)) + load(offsetY + j) - ownY, load(near + j) - ownNear);
    }
    Lanes slopeX, slopeY;
    fit.solve(slopeX, slopeY);
    store(slopeX, guides.slopeX.data() + i);
    store(slopeY, guides.slopeY.data() + i);
    storeDeviation({neighbours, sum, variances}, ownLuma, load(variance + i), i, work);
    const Mask explained =
        hn::Or(hn::Or(alike >= lanesOf(3), alike + alike >= neighbours), straight >= lanesOf(2));
    const Mask lonely =
        hn::And(hn::And(neighbours >= lanesOf(5), alike < lanesOf(1)), ownLuma > most + most);
    const Lanes verdict = load(work.verdict.data() + i);
    store(select(verdict >= lanesOf(0), verdict,
                 select(explained, lanesOf(0), select(lonely, lanesOf(lonelyWeight), lanesOf(1)))),
          work.unlike.data() + i);
  }
}

void estimateRow(const Reading& reading, int y, const Moment& now, Work& work) {
  constexpr int reach = 3;
  const Layout& layout = now.layout;
  const float *name = now.guides.name.data(), *luma = reading.light.x.data(),
              *deviation = work.deviation.data(), *expected = work.expected.data(),
              *unlike = work.unlike.data();
  const size_t row = layout.row(y);
  // 7 x 7 cells of several pixels are a large part of the picture: its shapes are judged apart.
  const Mask anyShape = now.block == 1 ? lanesOf(0) < lanesOf(1) : lanesOf(1) < lanesOf(0);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i), ownLuma = load(luma + i);
    Lanes pixels = lanesOf(0), sum = lanesOf(0), squares = lanesOf(0), deviations = lanesOf(0),
          noises = lanesOf(0), odd = lanesOf(0), calm = lanesOf(0);
    for (int dy = -reach; dy <= reach; dy++)
      for (int dx = -reach; dx <= reach; dx++) {
        const size_t j = i + size_t(ptrdiff_t(layout.stride) * dy + dx);
        const Mask same = load(name + j) == ownName;
        const Lanes other = hn::IfThenElseZero(same, load(luma + j));
        pixels = pixels + count(same);
        sum = sum + other;
        squares = squares + other * other;
        deviations = deviations + hn::IfThenElseZero(same, load(deviation + j));
        noises = noises + hn::IfThenElseZero(same, load(expected + j));
        odd = odd + hn::IfThenElseZero(hn::Or(same, anyShape), load(unlike + j));
        calm = calm + count(hn::And(same, load(work.verdict.data() + j) == lanesOf(0)));
      }
    // It is detail, and no noise, as far as the samples in the pixels do not explain it.
    const Mask known = load(expected + i) >= lanesOf(0);
    store(select(known, min(deviations, noises), deviations) / max(pixels, lanesOf(1)),
          work.variance.data() + i);
    const Lanes explained = noises / max(deviations, lanesOf(1e-30f));
    const Lanes noisy =
        select(known,
               clamp((explained - lanesOf(fewExplained)) * lanesOf(1 / moreExplained), lanesOf(0),
                     lanesOf(1)),
               lanesOf(1));
    const Lanes fraction =
        odd * select(anyShape, lanesOf(1.0f / 49), lanesOf(1) / max(pixels, lanesOf(fewestPixels)));
    store(clamp((fraction - lanesOf(fewUnlike)) * lanesOf(1 / moreUnlike), lanesOf(0), lanesOf(1)) *
              noisy,
          work.noise.data() + i);
    store(calm / max(pixels, lanesOf(1)), work.calm.data() + i);
    // The pixel itself does not widen its own limit.
    const Lanes others = max(pixels - lanesOf(1), lanesOf(1));
    const Lanes mean = (sum - ownLuma) / others;
    const Lanes spread = max((squares - ownLuma * ownLuma) / others - mean * mean, lanesOf(0));
    store(
        select(pixels > lanesOf(4), mean + lanesOf(limitSpread) * hn::Sqrt(spread), lanesOf(1e30f)),
        work.limit.data() + i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(compareRow);
HWY_EXPORT(estimateRow);
void compareRow(const Reading& reading, int y, Moment& now, Work& work) {
  HWY_DYNAMIC_DISPATCH(compareRow)(reading, y, now, work);
}
void estimateRow(const Reading& reading, int y, const Moment& now, Work& work) {
  HWY_DYNAMIC_DISPATCH(estimateRow)(reading, y, now, work);
}
} // namespace picture::live
#endif
