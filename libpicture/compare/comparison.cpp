#include "libpicture/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/compare/differences.h"
#include "openrt/openrt.h"
#include "printable.h"

namespace picture {

namespace {

// Multiplies display colours by alpha: a colour that is not seen is none.
void premultiply(Picture& picture) {
  if (picture.linear) return;
  std::vector<float>& rgba = picture.planes.at(RT_RGBA);
  for (size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 < 3) rgba[i] *= rgba[i | 3];
}

// Gives a picture the channels error and trust by its channel variance. samples: per pixel; none:
// those of the channel samples, or if there is none, the variance is that of the pixel.
void setErrors(Picture& picture, const std::string& name, std::optional<int> samples) {
  const auto variance = picture.planes.find(RT_VARIANCE), counts = picture.planes.find(RT_SAMPLES);
  if (variance == picture.planes.end())
    throw CompareError(
        fmt::format("{} has no channels variance.R, variance.G and variance.B", name));
  constexpr float fewest = 8; // samples that a variance is trusted of, as in error bars
  const size_t pixels = picture.planes.at(RT_RGBA).size() / 4;
  const bool counted = !samples && counts != picture.planes.end();
  std::vector<float>&error = picture.planes[RT_ERROR], &trust = picture.planes[RT_TRUST];
  const std::vector<float> own = std::exchange(trust, std::vector<float>(pixels, 0.0f));
  error.assign(3 * pixels, 0);
  for (size_t i = 0; i < pixels; ++i) {
    const float n = samples ? float(*samples) : counted ? counts->second[i] : 1;
    bool known = ((!samples && !counted) || n >= fewest) && (own.empty() || own[i] > 0);
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const float v = variance->second[k] / std::max(1.0f, n);
      error[k] = float(halfWidthOfNormal) * std::sqrt(std::max(0.0f, v));
      known = known && v >= 0 && std::isfinite(v); // false for NaN
    }
    // Samples without any variance say nothing about light that they have missed.
    trust[i] = known && error[3 * i] + error[3 * i + 1] + error[3 * i + 2] > 0 ? 1.0f : 0.0f;
  }
}

void checkAlike(const std::array<std::string, 2>& names, const std::array<Picture, 2>& pictures) {
  const auto& [a, b] = pictures;
  for (size_t i = 0; i < 2; ++i)
    if (pictures[i].note.find("biased") != std::string::npos)
      throw CompareError(fmt::format("{} says that it is {}: its noise cannot be judged", names[i],
                                     pictures[i].note));
  if (a.width != b.width || a.height != b.height)
    throw CompareError(fmt::format("{} has {}x{} pixels, {} {}x{}", names[0], a.width, a.height,
                                   names[1], b.width, b.height));
  if (a.linear != b.linear)
    throw CompareError(fmt::format("{} has radiance, {} colours for screens: only like can be "
                                   "compared with like",
                                   names[a.linear ? 0 : 1], names[a.linear ? 1 : 0]));
  if (a.width < fewestSide || a.height < fewestSide)
    throw CompareError(fmt::format("{} has {}x{} pixels: at least {}x{} were expected", names[0],
                                   a.width, a.height, fewestSide, fewestSide));
}

} // namespace

bool Comparison::usesErrorBars() const { return hasErrors(pictures[0]) && hasErrors(pictures[1]); }

double Comparison::biasInterval() const {
  return difference.biasInterval * std::sqrt(test.correlation);
}

Picture readForComparison(const std::string& path) {
  Picture picture = readPicture(path, RT_ERROR | RT_TRUST | RT_VARIANCE | RT_SAMPLES);
  premultiply(picture);
  return picture;
}

Comparison comparisonOf(std::array<std::string, 2> names, std::array<Picture, 2> pictures,
                        const ComparisonFacts& facts) {
  checkAlike(names, pictures);
  Comparison c;
  c.names = std::move(names);
  c.pictures = std::move(pictures);
  auto& [a, b] = c.pictures;
  for (size_t i = 0; facts.byVariance && i < 2; ++i)
    setErrors(c.pictures[i], c.names[i],
              facts.samples ? std::optional((*facts.samples)[i]) : std::nullopt);
  if (facts.samples && (*facts.samples)[0] == (*facts.samples)[1]) c.noise = Noise::equal;
  c.test = testNoise(a, b, c.noise);
  if (c.test.notFinite == rgbaOf(a).size() / 4)
    throw CompareError(
        fmt::format("{} and {} have no pixel with finite numbers in both", c.names[0], c.names[1]));
  c.difference = compare(rgbaOf(b), rgbaOf(a));
  c.flip = flipOf(a, b);
  return c;
}

std::string comparisonJson(const Comparison& c) {
  using Json = nlohmann::ordered_json;
  const NoiseTest& test = c.test;
  Json changes = Json::array(), least = Json::array();
  for (const ChangedPlace& one : test.changes)
    changes.push_back({{"x", one.x},
                       {"y", one.y},
                       {"width", one.width},
                       {"height", one.height},
                       {"colour", changedColour(one)},
                       {"before", one.before},
                       {"change", one.change},
                       {"chance", one.chance}});
  for (const SmallestChange& one : test.least)
    least.push_back({{"width", one.width},
                     {"height", one.height},
                     {"change", std::isfinite(one.change) ? Json(one.change) : Json(nullptr)}});
  const Json json = {
      {"pictures", {c.names[0], c.names[1]}},
      {"width", c.pictures[0].width},
      {"height", c.pictures[0].height},
      {"radiance", c.pictures[0].linear},
      {"same", test.isSame},
      {"false_alarms", falseAlarmRate},
      {"tests", {{"squares", test.squares}, {"pixels", test.pixels}, {"found", test.found}}},
      {"changes", std::move(changes)},
      {"equal_noise", c.noise == Noise::equal},
      {"error_bars", c.usesErrorBars()},
      {"correlation", test.correlation},
      {"smooth", test.isSmooth},
      {"would_find", std::move(least)},
      {"bias", c.difference.bias},
      {"bias_interval", c.biasInterval()},
      {"rmse", c.difference.rmse},
      {"rel_mse", c.difference.relMse},
      {"largest", c.difference.largest},
      {"flip", c.flip.mean},
      {"flip_exposures", c.flip.exposures},
      {"different", test.different},
      {"not_finite", test.notFinite},
      {"one_sided", test.oneSided}};
  return printableJson(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

} // namespace picture
