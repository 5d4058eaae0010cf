#include "run/picture_remarks.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "libpicture/files/formats.h"
#include "libpicture/transport.h"
#include "process/messages.h"
#include "report/cluster_report.h"
#include "report/hints.h"
#include "report/progress.h"

namespace vv {

namespace {

// Explains why a picture has not reached --error, from the samples that it took.
std::string whyMissed(const Options& options, const picture::RenderResult& result) {
  const auto samples = result.picture.planes.find(RT_SAMPLES);
  const auto most = float(options.render.samples);
  double full = 0, largest = 0; // share of the pixels with all samples; most samples of a pixel
  if (samples != result.picture.planes.end() && !samples->second.empty()) {
    const std::vector<float>& all = samples->second;
    full = double(std::count_if(all.begin(), all.end(), [&](float n) { return n >= most; })) /
           double(all.size());
    largest = double(*std::max_element(all.begin(), all.end()));
  }
  const bool lamps = picture::transportInfo(result.stats.transport.chosen).tracesLamps;
  const std::string paths = lamps && options.render.timeLimit <= 0
                                ? ". Paths from lamps are limited as well (docs/error-bars.md): "
                                  "--spp N without --error "
                                  "takes N of both per pixel"
                                : "";
  if (full > 0)
    return fmt::format(
        "{:.3g} % of the pixels took {} samples, the most allowed; --spp allows more{}", 100 * full,
        options.render.samples, paths);
  if (options.render.timeLimit > 0)
    return "the time limit ended the rendering; --time-limit allows more time";
  const std::string taken =
      fmt::format("its pixels took at most {:.0f} of the {} samples allowed, ", largest, most);
  if (lamps)
    return taken + "and --error alone decides how many paths from lamps are taken; --spp N "
                   "without --error takes N of both per pixel";
  return taken + "which was enough in the pilot samples that decide it, but the picture is "
                 "noisier than these; a smaller --error takes more samples";
}

// Returns the name of a picture as the beginning of a message.
std::string begin(const PictureRequest& request) {
  const std::string name = request.name.text();
  return name.empty() ? name : name + ": ";
}

} // namespace

void PictureRemarks::sayLook(const picture::RenderResult& result, bool falseColour) {
  const picture::Picture& made = result.picture;
  if (!made.note.empty() && !std::exchange(biasSaid_, true) && !options_.quiet)
    say(fmt::format("vv: {}; without {}, pictures are unbiased", made.note,
                    options_.render.raster     ? "--preview-raster"
                    : !options_.render.preview ? "--denoise"
                    : options_.denoise         ? "--preview and --denoise"
                                               : "--preview"));
  const bool shown =
      std::any_of(options_.outputs.begin(), options_.outputs.end(), [](const Output& output) {
        return output.film != picture::FilmKind::none || output.format->appliesCurve;
      });
  if (result.interrupted || options_.quiet || !shown || falseColour || brightnessSaid_) return;
  const std::string hint = tooBrightHint(made);
  brightnessSaid_ = !hint.empty();
  if (brightnessSaid_) say("vv: " + hint);
}

void PictureRemarks::sayTimes(const PictureRequest& request, const picture::RenderResult& result,
                              double writeSeconds, bool last) const {
  if (!options_.verbose) return;
  say(fmt::format("vv: {}{} triangles, mapped in {}, rendered in {}{}, written in {}",
                  begin(request), result.stats.scene.triangles, duration(result.mapSeconds),
                  duration(result.renderSeconds),
                  options_.denoise ? ", denoised in " + duration(result.denoiseSeconds) : "",
                  duration(writeSeconds)));
  if (!last) return;
  for (const std::string& line : clusterLines(result)) say(line);
  if (const xvrml::ScriptCounts counts = browser_.scripts(); counts.started > 0)
    say(fmt::format("vv: {} of {} Scripts run; {} calls took {}", counts.started, counts.scripts,
                    counts.calls, duration(counts.seconds)));
}

void PictureRemarks::sayHint(const PictureRequest& request, const picture::RenderResult& result,
                             bool last, bool idle, picture::Renderer& renderer) {
  if (options_.render.raster) return; // hints are found by rays
  // Nothing in the studio is seen before its backdrop.
  const bool studioAlone =
      options_.render.studio.on && (result.map.shapes == 0 || (idle && renderer.bounds().empty));
  // A recording has the pictures of the run alone, without those that look for a hint.
  const bool nothing =
      !options_.quiet && !result.interrupted && options_.render.record.empty() &&
      (showsNothing(result.picture) || studioAlone || mayBeUnlit(options_, result));
  anythingShown_ = anythingShown_ || !nothing;
  const bool wanted = !options_.isSequence() || (last && !anythingShown_);
  if (!nothing || !wanted || !idle) return;
  if (const std::string hint = hintFor(options_, request.view, result, renderer); !hint.empty())
    say("vv: " + hint);
}

void PictureRemarks::warnOfError(const PictureRequest& request,
                                 const picture::RenderResult& result) const {
  const RTstats& s = result.stats;
  if (options_.render.error <= 0 || result.interrupted || s.error.pixels <= 0 ||
      s.error.halfWidth <= 1.001 * options_.render.error)
    return;
  sayWarning(fmt::format("{}--error promised {:.3g} %, reached {:.3g} %: {}", begin(request),
                         100 * options_.render.error, 100 * s.error.halfWidth,
                         whyMissed(options_, result)));
}

void PictureRemarks::sayDoubt(const PictureRequest& request, const picture::RenderResult& result) {
  if (!result.doubt) return;
  const picture::DoubtCounts& doubt = *result.doubt;
  const bool tooMuch = doubt.share() > *options_.mostDoubt;
  hasDoubt_ |= tooMuch;
  const std::string text =
      doubt.judged == 0
          ? "no pixel has error bars that can be trusted, so that the denoised picture cannot be "
            "audited: --spp 32 or more gives some"
          : fmt::format(
                "{:.3g} % of {} judged pixels are doubtful: their denoised colour leaves the "
                "99 % interval of the picture before",
                100 * doubt.share(), doubt.judged);
  if (tooMuch)
    sayError(begin(request) + text);
  else if (!options_.quiet && !options_.isSequence())
    say("vv: " + begin(request) + text);
}

} // namespace vv
