#include "run/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "libpicture/compare/differences.h"
#include "libpicture/compare/drawing.h"
#include "process/messages.h"
#include "report/comparison_report.h"
#include "run/outputs.h"
#include "run/picture_files.h"

namespace vv {

namespace {

using picture::Picture;

[[noreturn]] void refuse(const std::string& why) { throw Failure{exitInput, "vv compare: " + why}; }

Picture read(const std::string& path) {
  Picture picture;
  try {
    picture = picture::readPicture(path, RT_ERROR | RT_TRUST | RT_VARIANCE | RT_SAMPLES);
  } catch (const picture::InputError& error) { refuse(error.what()); }
  if (picture.note.find("biased") != picture.note.npos)
    refuse(fmt::format("{} says that it is {}: its noise cannot be judged", path, picture.note));
  if (picture.linear) return picture;
  std::vector<float>& rgba = picture.planes.at(RT_RGBA);
  for (size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 < 3) rgba[i] *= rgba[i | 3];
  return picture;
}

// Gives a picture the channels error and trust by its channel variance. samples: per pixel; none:
// those of the channel samples, or if there is none, the variance is that of the pixel.
void setErrors(Picture& picture, const std::string& path, std::optional<int> samples) {
  const auto variance = picture.planes.find(RT_VARIANCE), counts = picture.planes.find(RT_SAMPLES);
  if (variance == picture.planes.end())
    refuse(
        fmt::format("--variance: {} has no channels variance.R, variance.G and variance.B", path));
  constexpr float fewest = 8; // samples that a variance is trusted of, as in error bars
  const size_t pixels = picture.planes.at(RT_RGBA).size() / 4;
  std::vector<float>&error = picture.planes[RT_ERROR], &trust = picture.planes[RT_TRUST];
  error.assign(3 * pixels, 0);
  trust.assign(pixels, 0);
  for (size_t i = 0; i < pixels; ++i) {
    const bool counted = !samples && counts != picture.planes.end();
    const float n = samples ? float(*samples) : counted ? counts->second[i] : 1;
    bool known = (!samples && !counted) || n >= fewest;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const float v = variance->second[k] / std::max(1.0f, n);
      error[k] = float(picture::halfWidthOfNormal) * std::sqrt(std::max(0.0f, v));
      known = known && v >= 0 && std::isfinite(v); // false for NaN
    }
    // Samples without any variance say nothing about light that they have missed.
    trust[i] = known && error[3 * i] + error[3 * i + 1] + error[3 * i + 2] > 0;
  }
}

void checkAlike(const Comparison& c) {
  const Picture &a = c.a, &b = c.b;
  if (a.width != b.width || a.height != b.height)
    refuse(fmt::format("{} has {}x{} pixels, {} {}x{}", c.paths[0], a.width, a.height, c.paths[1],
                       b.width, b.height));
  if (a.linear != b.linear)
    refuse(fmt::format("{} has radiance, {} colours of 8 bits for screens: only like can be "
                       "compared with like",
                       c.paths[a.linear ? 0 : 1], c.paths[a.linear ? 1 : 0]));
  if (a.width < picture::fewestSide || a.height < picture::fewestSide)
    refuse(fmt::format("{} has {}x{} pixels: at least {}x{} were expected", c.paths[0], a.width,
                       a.height, picture::fewestSide, picture::fewestSide));
}

} // namespace

int runCompare(const Options& options) {
  checkOutputs(options);
  const CompareOptions& given = options.compared;
  Comparison c{{given.files[0], given.files[1]}, read(given.files[0]), read(given.files[1])};
  checkAlike(c);
  if (options.isGiven("--variance")) {
    setErrors(c.a, c.paths[0], given.samples ? std::optional((*given.samples)[0]) : std::nullopt);
    setErrors(c.b, c.paths[1], given.samples ? std::optional((*given.samples)[1]) : std::nullopt);
  }
  c.noise = given.samples && (*given.samples)[0] == (*given.samples)[1] ? picture::Noise::equal
                                                                        : picture::Noise::unknown;
  c.test = picture::testNoise(c.a, c.b, c.noise);
  c.difference = picture::compare(c.b.planes.at(RT_RGBA), c.a.planes.at(RT_RGBA));
  c.flip = picture::flipOf(c.a, c.b);
  if (!options.outputs.empty()) {
    const std::vector<float> errors = picture::standardErrors(c.a, c.b);
    for (const Output& output : options.outputs)
      writeOutput(
          output, output.path,
          output.format->encode(picture::drawErrors(c.a, errors, output.format->appliesCurve)));
  }
  writeOut(options.json ? comparisonJson(c) : comparisonText(c));
  return c.test.isSame ? exitDone : exitProblems;
}

} // namespace vv
