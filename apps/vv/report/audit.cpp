#include "audit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "libpicture/hit_pictures.h"
#include "libpicture/transport.h"
#include "process/messages.h"
#include "process/signals.h"

namespace vv {

namespace {

constexpr int tileEdge = 16;           // edge of the tiles in pixels; the worst tiles are reported
constexpr int referenceWorth = 16;     // samples of the reference divided by those of a picture
constexpr int referenceSeed = 1000003; // a seed outside the range of the series
constexpr int hitSeed = 2000003;       // the first seed of the pictures without light samples

picture::Picture readReference(const std::string& path, int width, int height) {
  picture::Picture picture;
  try {
    picture = picture::readExr(path);
  } catch (const std::exception& error) {
    throw Failure{exitInput, std::string("--compare: ") + error.what()};
  }
  if (picture.width != width || picture.height != height)
    throw Failure{exitInput, fmt::format("--compare: {} is {}x{}, the picture {}x{}", path,
                                         picture.width, picture.height, width, height)};
  return picture;
}

std::vector<double> coloursOf(const picture::Picture& picture) {
  const std::vector<float>& rgba = picture.planes.at(RT_RGBA);
  std::vector<double> out(rgba.size() / 4 * 3);
  for (size_t k = 0; k < out.size(); k++) out[k] = double(rgba[k / 3 * 4 + k % 3]);
  return out;
}

} // namespace

void checkReference(const Options& options) {
  if (!options.compare.empty())
    readReference(options.compare, options.render.madeWidth(), options.render.madeHeight());
}

std::string compareText(const picture::Picture& made, const std::string& path) {
  const picture::Picture reference = readReference(path, made.width, made.height);
  const picture::Difference d =
      picture::compare(made.planes.at(RT_RGBA), reference.planes.at(RT_RGBA));
  std::string text = fmt::format("compared with {}\n", path);
  text += fmt::format("rmse      {:.6g}\n", d.rmse);
  text += fmt::format("relmse    {:.6g}, {:.6g} without the highest 0.1 %\n", d.relMse,
                      d.trimmedRelMse);
  text += fmt::format("bias      {:+.6g} +- {:.6g}\n", d.bias, d.biasInterval);
  text += fmt::format("largest   {:.6g}, 99.9 % are below {:.6g}\n", d.largest, d.p999);
  if (d.notFinite) text += fmt::format("left out  {} pixels that are not finite\n", d.notFinite);
  return text;
}

picture::RenderResult Audit::render(const picture::View& view, const std::string& what) {
  if (progress_) progress_(what);
  return renderer_.render(view);
}

bool Audit::hitEmitters(picture::View view, const picture::RenderResult& made) {
  if (!made.hasCameraShader && !view.viewer) view.viewer = made.camera;
  picture::RenderSettings settings;
  renderer_.change([&](const picture::RenderSettings& s) { settings = s; });
  settings.samples = int(std::clamp(samples_, 1.0, 65536.0));
  picture::HitPictures pictures(world_, settings);
  for (int i = 0; i < referenceWorth; i++) {
    if (interrupted()) return false;
    if (progress_) progress_(fmt::format("without light samples, {} of {}", i + 1, referenceWorth));
    const int seed = options_.render.quality.whole(RT_SEED) + hitSeed + i;
    hits_.push_back(pictures.render(view, seed & 0x7fffffff));
  }
  return !interrupted();
}

bool Audit::run(const picture::View& view) {
  const int width = options_.render.width, height = options_.render.height;
  const int seed = options_.render.quality.whole(RT_SEED);
  picture::Reference reference;
  if (!options_.compare.empty()) { // read it before the rendering work
    const picture::Picture other = readReference(options_.compare, width, height);
    reference.colours = coloursOf(other);
    if (const auto bars = other.planes.find(RT_ERROR); bars != other.planes.end())
      reference.half = bars->second;
    reference_ = options_.compare + (reference.half.empty() ? "" : " with its own error bars");
  }
  std::vector<picture::Shot> shots;
  for (int i = 0; i < options_.audit; i++) {
    renderer_.change([&](picture::RenderSettings& s) {
      s.quality.set(RT_SEED, seed + i);
      s.channels = options_.render.channels | RT_ERROR | RT_TRUST | RT_SAMPLES | RT_VARIANCE;
    });
    picture::RenderResult result =
        render(view, fmt::format("picture {} of {}", i + 1, options_.audit));
    if (result.interrupted) return false;
    auto& planes = result.picture.planes;
    double samples = 0;
    for (float n : planes[RT_SAMPLES]) samples += double(n) / double(planes[RT_SAMPLES].size());
    shots.push_back({planes[RT_RGBA], planes[RT_ERROR], planes[RT_TRUST], planes[RT_VARIANCE],
                     samples, result.stats.error.mean, result.stats.error.meanInterval});
    samples_ += samples / options_.audit;
    if (i == 0) first_ = std::move(result.picture);
  }
  if (reference.colours.empty()) {
    const int most = int(std::min(65536.0, referenceWorth * samples_));
    renderer_.change([&](picture::RenderSettings& s) {
      s.quality.set(RT_SEED, (seed + referenceSeed) & 0x7fffffff);
      s.samples = most;
      s.error = 0;
      s.channels = RT_RGBA;
    });
    const picture::RenderResult result = render(view, "reference");
    if (result.interrupted) return false;
    reference.colours = coloursOf(result.picture);
    reference.worth = most / samples_;
    reference_ = fmt::format("a picture of {} samples and the other pictures of the series", most);
    // Other transports leave light out, and say so.
    const RTenum transport = result.stats.transport.chosen;
    if (picture::transportInfo(transport).tracesPaths && !hitEmitters(view, result)) return false;
  }
  if (progress_) progress_("");
  coverage_ = picture::countCoverage(shots, reference, width, height, tileEdge);
  if (hits_.empty()) return true;
  std::vector<std::vector<float>> sampled;
  for (picture::Shot& shot : shots) sampled.push_back(std::move(shot.rgba));
  missing_ = picture::findMissingLight(sampled, hits_, width, height, tileEdge);
  return true;
}

std::string Audit::whatIsWrong() const {
  const picture::Coverage& c = coverage_;
  if (missing_.any()) return "light samples miss light";
  if (c.trusted * 20 < c.pixels) return "too few pixels are trusted to say anything";
  if (c.intervals() > 0 &&
      (c.share() + c.shareInterval() < .93 || c.share() - c.shareInterval() > .97))
    return "the coverage is not what was promised";
  if (c.intervals() > 0 && c.worstTiles < .90)
    return "the coverage of the worst tiles is not what was promised";
  if (c.exact - c.exactHeld > c.exact / 100) return "exact pixels are not exact";
  const double bounds = double(c.bounds), wrongBounds = double(c.bounds - c.boundsHeld);
  if (wrongBounds > .05 * bounds + 3 * std::sqrt(.05 * .95 * bounds))
    return "upper bounds are not bounds";
  // Fewer than nine in ten pictures agree with the prediction, by more than three standard errors.
  const double shots = double(c.shots);
  if (c.promiseShare() + 3 * std::sqrt(.09 / shots) < .9)
    return "the error of the pictures is not what was promised";
  return "";
}

bool Audit::good() const { return whatIsWrong().empty(); }

std::string Audit::text() const {
  const picture::Coverage& c = coverage_;
  std::string text = fmt::format("{} pictures of {:.5g} samples a pixel against {}\n",
                                 options_.audit, samples_, reference_);
  text += fmt::format(
      "trusted     {:.1f} % of the pixels; {:.1f} % are called exact, {} of these {} wrong\n",
      100 * c.trustedShare(), 100 * double(c.exact) / double(c.pixels), c.exact - c.exactHeld,
      c.exact - c.exactHeld == 1 ? "is" : "are");
  if (c.intervals())
    text += fmt::format("coverage    {:.4f} +- {:.4f} of the trusted 95 % intervals (wanted: 0.93 "
                        "to 0.97); of all pixels {:.4f}\n",
                        c.share(), c.shareInterval(), double(c.held) / double(c.pixels));
  if (c.worstTiles < 1)
    text += fmt::format("tiles       5 % of the tiles of {}x{} pixels have a coverage below {:.3f} "
                        "(wanted: at least 0.90)\n",
                        tileEdge, tileEdge, c.worstTiles);
  if (c.bounds)
    text += fmt::format("bounds      {:.4f} of the upper bounds hold, which {:.1f} % of the pixels "
                        "have (wanted: at least 0.95)\n",
                        double(c.boundsHeld) / double(c.bounds),
                        100 * double(c.bounds) / double(c.pixels));
  text += fmt::format(
      "mean error  predicted {:.5g} +- {:.2g}, measured {:.5g}; both agree in {} of {} pictures\n",
      c.promised, c.promisedInterval, c.meanError, c.promiseHeld, c.shots);
  text +=
      fmt::format("bias        {:+.2g} +- {:.2g} of the picture's mean\n", c.bias, c.biasInterval);
  if (c.cost > 0)
    text += fmt::format("variance    {:.3g} times that of the same number of independent samples\n",
                        c.cost);
  if (!hits_.empty())
    text += fmt::format("all light   {:+.2g} +- {:.2g} of the picture's mean more without light "
                        "samples; more in {} of {} tiles\n",
                        missing_.more, missing_.interval, missing_.inTiles, missing_.tiles);
  const std::string wrong = whatIsWrong();
  return text +
         (wrong.empty() ? "the error bars hold\n" : "the error bars do not hold: " + wrong + "\n");
}

} // namespace vv
