// filter.cpp: The edge-avoiding à-trous filter (H. Dammertz et al., "Edge-Avoiding À-Trous Wavelet
// Transform for fast Global Illumination Filtering", HPG 2010), guided by the variance of the
// illumination, and the step back from illumination to colours.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/filter.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

constexpr float lumaSpread = 4;  // standard deviations at which a luma is e times less alike
constexpr float normalFall = 64; // about the power of the cosine between normals
constexpr float earlySpread = 6; // more of them in the first frame
constexpr float otherName = 3;   // another shape on the same plane is exp(3) times less alike
constexpr float bspline[3] = {3.0f / 8, 1.0f / 4, 1.0f / 16};

void filterRow(const FilterPass& pass, int y, const Moment& now) {
  const Layout& layout = now.layout;
  const Guides& guides = now.guides;
  const float *name = guides.name.data(), *near = guides.nearness.data(),
              *variance = pass.variance->data();
  const size_t row = layout.row(y);
  const auto stride = ptrdiff_t(layout.stride);
  const auto step = float(pass.step);
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes ownName = load(name + i), ownNear = load(near + i);
    const Lanes slopeX = load(guides.slopeX.data() + i), slopeY = load(guides.slopeY.data() + i);
    const LaneVec own = load(*pass.from, i), normal = load(guides.normal, i);

    // The variance is itself noisy: its mean over 3 x 3 pixels judges what is alike.
    Lanes spread = load(variance + i) * lanesOf(0.25f);
    for (int k = -1; k <= 1; k += 2) {
      spread =
          spread + (load(variance + i + k) + load(variance + i + k * stride)) * lanesOf(0.125f);
      spread =
          spread + (load(variance + i + k * stride - 1) + load(variance + i + k * stride + 1)) *
                       lanesOf(0.0625f);
    }
    // Few samples are rarely like their mean: most lack the light that some have. Judged by what
    // they have in common with their neighbours they would lose it.
    const Lanes frames = max(load(now.accumulated.frames.data() + i), one);
    const Lanes tolerance = lanesOf(lumaSpread) + lanesOf(earlySpread / pass.perPixel) / frames;
    const Lanes perLuma = one / (tolerance * hn::Sqrt(spread) + lanesOf(1e-6f));
    const Lanes slope = abs(slopeX) + abs(slopeY);
    const Lanes scale = now.projection.parallel ? one : abs(ownNear);
    const Lanes perNear =
        one / (slope * lanesOf(1 + 0.1f * step) + scale * lanesOf(0.002f * step) + lanesOf(1e-20f));

    Lanes weights = lanesOf(bspline[0] * bspline[0]);
    LaneVec sum = own * weights;
    Lanes varianceSum = load(variance + i) * (weights * weights);
    for (int dy = -2; dy <= 2; dy++)
      for (int dx = -2; dx <= 2; dx++) {
        if (dx == 0 && dy == 0) continue;
        const size_t j = i + size_t((stride * dy + dx) * pass.step);
        const LaneVec other = load(*pass.from, j);
        const Lanes expected =
            ownNear + slopeX * lanesOf(float(dx) * step) + slopeY * lanesOf(float(dy) * step);
        const Lanes away = abs(load(near + j) - expected) * perNear +
                           abs(other.x - own.x) * perLuma +
                           abs(one - dot(load(guides.normal, j), normal)) * lanesOf(normalFall) +
                           select(load(name + j) == ownName, zero, lanesOf(otherName));
        const Lanes weight = hn::IfThenElseZero(
            load(name + j) >= zero,
            fallOff(away) * lanesOf(bspline[std::abs(dx)] * bspline[std::abs(dy)]));
        weights = weights + weight;
        sum = sum + other * weight;
        varianceSum = varianceSum + load(variance + j) * (weight * weight);
      }
    const Lanes per = one / weights;
    store(sum * per, *pass.to, i);
    store(varianceSum * (per * per), pass.toVariance->data() + i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(filterRow);
void filterRow(const FilterPass& pass, int y, const Moment& now) {
  HWY_DYNAMIC_DISPATCH(filterRow)(pass, y, now);
}
} // namespace picture::live
#endif
