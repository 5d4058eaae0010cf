#include "report/comparison_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/compare/differences.h"
#include "printable.h"

namespace vv {

namespace {

using Json = nlohmann::ordered_json;
using picture::ChangedPlace;
using picture::Noise;

constexpr const char* colourNames[] = {"red", "green", "blue", "luminance"};

bool knowsErrors(const Comparison& c) { return picture::hasErrors(c.a) && picture::hasErrors(c.b); }

// Says what the noise was taken from.
std::string noiseText(const Comparison& c) {
  std::string text = c.noise == Noise::equal
                         ? "both pictures have as many samples"
                         : "the samples of the pictures may differ (--samples N,N finds more)";
  text += knowsErrors(c) ? fmt::format("; {} pixels are judged by their error bars", c.test.pixels)
                         : "; its size is estimated from the differences themselves";
  return text;
}

std::string placeText(const ChangedPlace& place) {
  std::string size = fmt::format("{:+.4g}", place.change);
  if (place.before > 0) size += fmt::format(" ({:+.3g} %)", 100 * place.change / place.before);
  return fmt::format("{}x{} pixels at {},{}: {} {}, chance {:.1g}", place.width, place.height,
                     place.x, place.y, colourNames[place.colour], size, place.chance);
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

double biasInterval(const Comparison& c) {
  return c.difference.biasInterval * std::sqrt(c.test.correlation);
}

} // namespace

std::string comparisonText(const Comparison& c) {
  const picture::NoiseTest& test = c.test;
  const picture::Difference& d = c.difference;
  std::string text =
      fmt::format("{} and {}: {}x{} pixels of {}\n", printable(c.paths[0]), printable(c.paths[1]),
                  c.a.width, c.a.height, c.a.linear ? "radiance" : "display colours");
  text += test.isSame ? "same      yes: noise explains all differences"
                      : fmt::format("same      no: noise does not explain {} of {} tests",
                                    test.found, test.squares + test.pixels);
  text += fmt::format(" (false alarms: {:g})\n", picture::falseAlarmRate);
  for (const ChangedPlace& place : test.changes) text += "change    " + placeText(place) + "\n";
  text += "noise     " + noiseText(c) + "\n";
  text += fmt::format("different {:.4g} % of the pixels\n",
                      100 * double(test.different) / (double(c.a.width) * c.a.height));
  if (test.correlation > 1.1)
    text += fmt::format("filter    neighbours are alike: a sum of pixels has {:.2g} times the "
                        "variance\n",
                        test.correlation);
  if (test.isSmooth)
    text += "smooth    differences are alike over several pixels: a change, or the pictures were "
            "denoised, and then false alarms are not bounded\n";
  text += "would find  changes of " + leastText(c) + "\n";
  text += fmt::format("bias      {:+.4g} +- {:.2g}\n", d.bias, biasInterval(c));
  text += fmt::format("rmse      {:.4g}, relMSE {:.4g}, largest difference {:.4g}\n", d.rmse,
                      d.relMse, d.largest);
  text += fmt::format("flip      {:.4g}{}\n", c.flip.mean,
                      c.flip.exposures ? fmt::format(", {} exposures", c.flip.exposures) : "");
  if (test.notFinite)
    text += fmt::format("left out  {} pixels that are not finite\n", test.notFinite);
  return text;
}

std::string comparisonJson(const Comparison& c) {
  const picture::NoiseTest& test = c.test;
  Json changes = Json::array(), least = Json::array();
  for (const ChangedPlace& one : test.changes)
    changes.push_back({{"x", one.x},
                       {"y", one.y},
                       {"width", one.width},
                       {"height", one.height},
                       {"colour", colourNames[one.colour]},
                       {"before", one.before},
                       {"change", one.change},
                       {"chance", one.chance}});
  for (const picture::SmallestChange& one : test.least)
    least.push_back({{"width", one.width},
                     {"height", one.height},
                     {"change", std::isfinite(one.change) ? Json(one.change) : Json(nullptr)}});
  Json json = {
      {"pictures", {c.paths[0], c.paths[1]}},
      {"width", c.a.width},
      {"height", c.a.height},
      {"radiance", c.a.linear},
      {"same", test.isSame},
      {"false_alarms", picture::falseAlarmRate},
      {"tests", {{"squares", test.squares}, {"pixels", test.pixels}, {"found", test.found}}},
      {"changes", std::move(changes)},
      {"equal_noise", c.noise == Noise::equal},
      {"error_bars", knowsErrors(c)},
      {"correlation", test.correlation},
      {"smooth", test.isSmooth},
      {"would_find", std::move(least)},
      {"bias", c.difference.bias},
      {"bias_interval", biasInterval(c)},
      {"rmse", c.difference.rmse},
      {"rel_mse", c.difference.relMse},
      {"largest", c.difference.largest},
      {"flip", c.flip.mean},
      {"flip_exposures", c.flip.exposures},
      {"different", test.different},
      {"not_finite", test.notFinite}};
  return printableJson(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

} // namespace vv
