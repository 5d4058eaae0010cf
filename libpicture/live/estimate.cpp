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
constexpr float fewestPixels = 16; // fewest pixels of a shape
// Samples are limited to so many standard deviations of the samples around them.
constexpr float limitSpread = 32;

inline Lanes count(Mask condition) { return where(condition, all(1)); }
inline Mask areAlike(Lanes a, Lanes b) {
  return absolute(a - b) <=
         larger(absolute(a), absolute(b)) * all(alikeFraction) + all(alikeAmount);
}

// The sums of a least-squares fit of a plane through the pixel's own nearness.
struct Fit {
  Lanes xx, xy, yy, xd, yd;

  // Written out: see Around in spread.cpp.
  Fit() : xx(all(0)), xy(all(0)), yy(all(0)), xd(all(0)), yd(all(0)) {}
  void add(Mask valid, Lanes x, Lanes y, Lanes d) {
    xx = xx + where(valid, x * x);
    xy = xy + where(valid, x * y);
    yy = yy + where(valid, y * y);
    xd = xd + where(valid, x * d);
    yd = yd + where(valid, y * d);
  }
  void solve(Lanes& slopeX, Lanes& slopeY) const {
    const Lanes a = xx + all(0.02f), b = yy + all(0.02f); // so that one neighbour is enough
    const Lanes per = all(1) / (a * b - xy * xy);
    slopeX = (xd * b - yd * xy) * per;
    slopeY = (yd * a - xd * xy) * per;
  }
};

void compareRow(const Reading& reading, int y, Moment& now, Work& work) {
  // Opposite neighbours follow one another.
  constexpr int around[8][2] = {{-1, 0},  {1, 0}, {0, -1}, {0, 1},
                                {-1, -1}, {1, 1}, {-1, 1}, {1, -1}};
  const Layout& layout = now.layout;
  Guides& guides = now.guides;
  const float *name = guides.name.data(), *near = guides.nearness.data(),
              *luma = reading.light.x.data(), *offsetX = guides.offsetX.data(),
              *offsetY = guides.offsetY.data();
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i), ownNear = load(near + i), ownLuma = load(luma + i),
                ownX = load(offsetX + i), ownY = load(offsetY + i);
    const Lanes3 ownNormal = load(guides.normal, i);
    Fit fit;
    Lanes neighbours = all(0), sum = all(0), most = all(0), alike = all(0), straight = all(0);
    Mask oppositeValid = hn::FirstN(Tag(), 0);
    Lanes opposite = all(0);
    for (int k = 0; k < 8; k++) {
      const int dx = around[k][0], dy = around[k][1];
      const size_t j = i + size_t(ptrdiff_t(layout.stride) * dy + dx);
      const Lanes other = load(luma + j);
      const Mask same = load(name + j) == ownName;
      neighbours = neighbours + count(same);
      sum = sum + where(same, other);
      most = larger(most, where(same, other));
      alike = alike + count(both(same, areAlike(other, ownLuma)));
      if (k % 2 == 1)
        straight = straight + count(both(both(same, oppositeValid),
                                         areAlike((other + opposite) * all(0.5f), ownLuma)));
      oppositeValid = same;
      opposite = other;
      fit.add(both(same, dot(load(guides.normal, j), ownNormal) > all(0.9f)),
              all(float(dx)) + load(offsetX + j) - ownX, all(float(dy)) + load(offsetY + j) - ownY,
              load(near + j) - ownNear);
    }
    Lanes slopeX, slopeY;
    fit.solve(slopeX, slopeY);
    store(slopeX, guides.slopeX.data() + i);
    store(slopeY, guides.slopeY.data() + i);
    const Lanes difference = ownLuma - sum / larger(neighbours, all(1));
    store(
        where(neighbours > all(0), difference * difference * (neighbours / (neighbours + all(1)))),
        work.deviation.data() + i);
    const Mask explained =
        either(either(alike >= all(3), alike + alike >= neighbours), straight >= all(2));
    const Mask lonely = both(both(neighbours >= all(5), alike < all(1)), ownLuma > most + most);
    const Lanes verdict = load(work.verdict.data() + i);
    store(select(verdict >= all(0), verdict,
                 select(explained, all(0), select(lonely, all(lonelyWeight), all(1)))),
          work.unlike.data() + i);
  }
}

void estimateRow(const Reading& reading, int y, const Moment& now, Work& work) {
  constexpr int reach = 3;
  const Layout& layout = now.layout;
  const float *name = now.guides.name.data(), *luma = reading.light.x.data(),
              *deviation = work.deviation.data(), *unlike = work.unlike.data();
  const size_t row = layout.row(y);
  // 7 x 7 cells of several pixels are a large part of the picture: its shapes are judged apart.
  const Mask anyShape = now.block == 1 ? all(0) < all(1) : all(1) < all(0);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i), ownLuma = load(luma + i);
    Lanes pixels = all(0), sum = all(0), squares = all(0), deviations = all(0), odd = all(0),
          calm = all(0);
    for (int dy = -reach; dy <= reach; dy++)
      for (int dx = -reach; dx <= reach; dx++) {
        const size_t j = i + size_t(ptrdiff_t(layout.stride) * dy + dx);
        const Mask same = load(name + j) == ownName;
        const Lanes other = where(same, load(luma + j));
        pixels = pixels + count(same);
        sum = sum + other;
        squares = squares + other * other;
        deviations = deviations + where(same, load(deviation + j));
        odd = odd + where(either(same, anyShape), load(unlike + j));
        calm = calm + count(both(same, load(work.verdict.data() + j) == all(0)));
      }
    store(deviations / larger(pixels, all(1)), work.variance.data() + i);
    const Lanes fraction =
        odd * select(anyShape, all(1.0f / 49), all(1) / larger(pixels, all(fewestPixels)));
    store(clamped((fraction - all(fewUnlike)) * all(1 / moreUnlike), all(0), all(1)),
          work.noise.data() + i);
    store(calm / larger(pixels, all(1)), work.calm.data() + i);
    // The pixel itself does not widen its own limit.
    const Lanes others = larger(pixels - all(1), all(1));
    const Lanes mean = (sum - ownLuma) / others;
    const Lanes spread = larger((squares - ownLuma * ownLuma) / others - mean * mean, all(0));
    store(select(pixels > all(4), mean + all(limitSpread) * hn::Sqrt(spread), all(1e30f)),
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
