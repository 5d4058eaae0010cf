#include "report/comparison_report.h"

#include <cmath>

#include <fmt/format.h>

#include "printable.h"

namespace vv {

namespace {

using picture::ChangedPlace;
using picture::Comparison;
using picture::Noise;

// Says what the noise was taken from.
std::string noiseText(const Comparison& c) {
  std::string text = c.noise == Noise::equal
                         ? "both pictures have as many samples"
                         : "the samples of the pictures may differ (--samples N,N finds more)";
  text += c.usesErrorBars()
              ? fmt::format("; {} pixels are judged by their error bars", c.test.pixels)
              : "; its size is estimated from the differences themselves";
  return text;
}

std::string placeText(const ChangedPlace& place) {
  std::string size = fmt::format("{:+.4g}", place.change);
  if (place.before > 0) size += fmt::format(" ({:+.3g} %)", 100 * place.change / place.before);
  return fmt::format("{}x{} pixels at {},{}: {} {}, chance {:.1g}", place.width, place.height,
                     place.x, place.y, changedColour(place), size, place.chance);
}

// Lists the changes that would have been found.
std::string leastText(const Comparison& c) {
  std::string text;
  for (const picture::SmallestChange& one : c.test.least)
    if (std::isfinite(one.change))
      text += fmt::format("{}{}x{} pixels {:.2g}", text.empty() ? "" : ", ", one.width, one.height,
                          one.change);
  return text.empty() ? "nothing: the pictures are too small" : text;
}

} // namespace

std::string comparisonText(const Comparison& c) {
  const picture::NoiseTest& test = c.test;
  const picture::Difference& d = c.difference;
  std::string text = fmt::format("{} and {}: {}x{} pixels of {}\n", printable(c.names[0]),
                                 printable(c.names[1]), c.pictures[0].width, c.pictures[0].height,
                                 c.pictures[0].linear ? "radiance" : "display colours");
  text += test.different == 0 && test.notFinite == 0 ? "same      yes: there is no difference"
          : test.isSame ? "same      yes: noise explains all differences"
          : test.found  ? fmt::format("same      no: noise does not explain {} of {} tests",
                                      test.found, test.squares + test.pixels)
                        : fmt::format("same      no: {} pixels are finite in one picture alone",
                                      test.oneSided);
  text += fmt::format(" (false alarms: {:g})\n", picture::falseAlarmRate);
  for (const ChangedPlace& place : test.changes) text += "change    " + placeText(place) + "\n";
  text += "noise     " + noiseText(c) + "\n";
  text += fmt::format("different {:.4g} % of the pixels\n",
                      100 * double(test.different) /
                          (double(c.pictures[0].width) * c.pictures[0].height));
  if (test.correlation > 1.1)
    text += fmt::format("filter    neighbours are alike: a sum of pixels has {:.2g} times the "
                        "variance\n",
                        test.correlation);
  if (test.isSmooth)
    text += "smooth    differences are alike over several pixels: a change, or the pictures were "
            "denoised, and then false alarms are not bounded\n";
  text += "would find  changes of " + leastText(c) + "\n";
  text += fmt::format("bias      {:+.4g} +- {:.2g}\n", d.bias, c.biasInterval());
  text += fmt::format("rmse      {:.4g}, relMSE {:.4g}, largest difference {:.4g}\n", d.rmse,
                      d.relMse, d.largest);
  text += fmt::format("flip      {:.4g}{}\n", c.flip.mean,
                      c.flip.exposures ? fmt::format(", {} exposures", c.flip.exposures) : "");
  if (test.notFinite)
    text += fmt::format("left out  {} pixels that are not finite\n", test.notFinite);
  return text;
}

} // namespace vv
