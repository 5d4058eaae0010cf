#include "libpicture/live/display.h"

#include <algorithm>
#include <cmath>

#include "libpicture/false_colour.h"
#include "libpicture/neighbours.h"

namespace picture::live {

namespace {

// A still picture stands alone once it has a quarter of its samples, or this many.
constexpr double enoughSamples = 64;
// It also fades in by time, from `fadeBegins` to `fadeEnds` seconds after its start, so that what
// is shown is unbiased soon. A picture of fewer samples than `leastSamples` is not shown alone
// before it is finished: it would be worse than the preview.
constexpr double fadeBegins = 0.5, fadeEnds = 4, leastSamples = 4;

// Returns a mixture of two bytes; weight: that of the second one, 0 to 256.
int mix(int a, int b, int weight) { return (a * (256 - weight) + b * weight + 128) >> 8; }

// Mixes a picture over another one of the same size, with at most the weights of `fade`. Pixels
// without a sample show the lower one. Returns whether anything of the lower one is left.
bool fadeIn(const std::vector<uint8_t>& below, const std::vector<float>& samples, double weight,
            const Fade& fade, int width, std::vector<uint8_t>& rgb) {
  bool left = false;
  for (size_t pixel = 0; pixel < samples.size();) {
    const Fade::Row limits(fade, int(pixel / size_t(width)));
    for (int x = 0; x < width; ++x, ++pixel) {
      const int w = samples[pixel] > 0 ? int(std::lround(std::min(weight, limits(x)) * 256)) : 0;
      if (w == 256) continue;
      left = true;
      for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) rgb[i] = uint8_t(mix(below[i], rgb[i], w));
    }
  }
  return left;
}

// Sets `samples` and `covered`.
void count(const std::vector<float>& samples, LivePicture& out) {
  double sum = 0;
  size_t covered = 0;
  for (const float s : samples) {
    sum += double(s);
    covered += s > 0;
  }
  out.samples = sum / double(samples.size());
  out.covered = double(covered) / double(samples.size());
}

} // namespace

double stillWeight(double samples, int wanted, double seconds) {
  const double enough = std::clamp(wanted / 4.0, 1.0, enoughSamples);
  const double byTime =
      std::min((seconds - fadeBegins) / (fadeEnds - fadeBegins), samples / leastSamples);
  return std::clamp(std::max(samples / enough, byTime), 0.0, 1.0);
}

std::vector<uint8_t> scaled(const std::vector<uint8_t>& rgb, int width, int height, int newWidth,
                            int newHeight) {
  if (width == newWidth && height == newHeight) return rgb;
  const std::vector<Neighbours> columns = neighbours(width, newWidth),
                                rows = neighbours(height, newHeight);
  std::vector<uint8_t> out(3 * size_t(newWidth) * size_t(newHeight));
  // Weights of bytes are in 1/256.
  const auto weightOf = [](const Neighbours& one) { return int(one.weight * 256); };
  auto to = out.begin();
  for (const Neighbours& row : rows) {
    const uint8_t* const above = rgb.data() + 3 * row.first * size_t(width);
    const uint8_t* const under = rgb.data() + 3 * row.second * size_t(width);
    const int down = weightOf(row);
    for (const Neighbours& column : columns) {
      const int right = weightOf(column);
      for (size_t c = 0; c < 3; ++c) {
        const size_t a = 3 * column.first + c, b = 3 * column.second + c;
        *to++ = uint8_t(mix(mix(above[a], above[b], right), mix(under[a], under[b], right), down));
      }
    }
  }
  return out;
}

double Display::scaleEndOf(const Picture& picture, const ShownFrame& frame, bool whole,
                           Viewer& viewer) {
  if (!frame.falseColour) return viewer.fitting = 0;
  if (*frame.falseColour > 0) return *frame.falseColour;
  const bool still = frame.purpose == LiveFrame::Purpose::still;
  if (whole && (still || viewer.fitting <= 0)) viewer.fitting = mostLuminance(picture);
  return viewer.fitting > 0 ? viewer.fitting : mostLuminance(picture);
}

void Display::show(const Picture& picture, const ShownFrame& frame, bool whole, double seconds,
                   LivePicture& out) {
  const std::vector<float>& samples = picture.planes.at(RT_SAMPLES);
  out.width = picture.width;
  out.height = picture.height;
  Viewer& viewer = viewers_.of(frame.viewer);
  out.scaleEnd = scaleEndOf(picture, frame, whole, viewer);
  out.shownWidth = picture.width;
  out.shownHeight = picture.height;
  if (frame.falseColour) {
    const bool enlarges = whole && frame.purpose != LiveFrame::Purpose::still &&
                          frame.shownWidth > 0 && frame.shownHeight > 0;
    if (enlarges) {
      out.shownWidth = frame.shownWidth;
      out.shownHeight = frame.shownHeight;
    }
    out.rgb = displayBytes(
        falseColours(picture, out.scaleEnd, Legend::apart, out.shownWidth, out.shownHeight));
  } else {
    out.rgb = displayBytes(picture);
  }
  count(samples, out);
  out.preview = frame.purpose == LiveFrame::Purpose::preview;

  if (frame.number != viewer.belowFrame) {
    viewer.belowFrame = frame.number;
    viewer.below = {};
    if (!whole && !viewer.last.rgb.empty())
      viewer.below = {
          out.width, out.height,
          scaled(viewer.last.rgb, viewer.last.width, viewer.last.height, out.width, out.height),
          viewer.last.preview};
    if (!viewer.below.rgb.empty()) viewer.fade.begin(out.width, out.height);
  }
  if (!whole && !viewer.below.rgb.empty()) {
    const bool fades = frame.purpose == LiveFrame::Purpose::still && viewer.below.preview;
    const double weight = fades ? stillWeight(out.samples, frame.samples, seconds) : 1;
    if (fades && out.covered == 1)
      viewer.fade.learn(viewer.below.rgb, out.rgb, out.samples, weight);
    if (fadeIn(viewer.below.rgb, samples, weight, viewer.fade, out.width, out.rgb))
      out.preview = viewer.below.preview;
  }
  viewer.last = {out.shownWidth, out.shownHeight, out.rgb, out.preview};
  if (whole) {
    viewer.below = {};
    viewer.fade = {};
  }
}

} // namespace picture::live
