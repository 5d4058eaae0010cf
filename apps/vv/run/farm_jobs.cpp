#include "run/farm_jobs.h"

#include <algorithm>

#include <fmt/format.h>

#include "libpicture/live/film_history.h"
#include "process/exit_codes.h"
#include "run/job_cuts.h"
#include "run/timeline.h"
#include "run/view_requests.h"
#include "start/world_clock.h"
#include "steady_clock.h"

namespace vv {

namespace {

constexpr size_t probes = 9;           // frames that are drawn, from the first to the last
constexpr double longestProbe = 60;    // seconds; frames after it cost as much as the last one
constexpr int shrink = 4;              // a probe's picture is smaller by this factor
constexpr int probeSamples = 4;        // at most
constexpr int samplesOfError = 64;     // for --error, which says no number
constexpr size_t mostFrames = 1000000; // the longest sequence that is cut

// Returns the settings of a small picture for a probe; `factor` is what the true one costs more.
picture::RenderSettings probeSettings(const Options& options, double& factor) {
  picture::RenderSettings settings = options.render;
  const auto small = [](int side) { return std::max(1, side / shrink); };
  const int wanted = settings.error > 0 ? samplesOfError : std::max(1, settings.samples);
  const double whole = double(settings.width) * settings.height * wanted;
  settings.width = small(settings.width);
  settings.height = small(settings.height);
  settings.crop = {};
  settings.samples = std::min(wanted, probeSamples);
  settings.error = settings.timeLimit = 0;
  settings.preview = false;
  settings.channels = RT_RGBA;
  settings.record.clear();
  settings.cluster.reset();
  factor = whole / (double(settings.width) * settings.height * settings.samples);
  return settings;
}

// Sets the costs of all frames from those of the probed ones, by straight lines between them.
void fillIn(const std::vector<std::pair<size_t, double>>& probed, std::vector<double>& frames) {
  size_t next = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    while (next < probed.size() && probed[next].first < i) ++next;
    if (next == 0 || next == probed.size()) {
      frames[i] = probed[next == 0 ? 0 : next - 1].second;
      continue;
    }
    const auto& [a, before] = probed[next - 1];
    const auto& [b, after] = probed[next];
    frames[i] = before + (after - before) * double(i - a) / double(b - a);
  }
}

// Adds what previews cost: frames that are drawn for their history alone.
void addHistory(const Options& options, SequenceCosts& costs) {
  using picture::live::FilmHistory;
  if (!options.render.preview) return;
  costs.block = FilmHistory::period;
  costs.history = double(FilmHistory::period);
  const auto between = double(std::min<long long>(options.frames->step, 2 * FilmHistory::period));
  for (double& cost : costs.frames) cost *= between;
  costs.history /= between;
}

SequenceCosts probe(const Options& options, const Timeline& timeline, xvrml::Browser& browser) {
  double factor = 1;
  const double begin = steadySeconds();
  const picture::RenderSettings settings = probeSettings(options, factor);
  SequenceCosts costs;
  costs.start = browser.world().times.parse + browser.world().times.load;
  uint64_t steps = 0;
  double stepping = 0;
  WorldClock clock(
      [&](double time) {
        browser.tick(time);
        ++steps;
      },
      options.fps);
  picture::Renderer renderer(browser, settings);
  std::vector<std::pair<size_t, double>> probed;
  const size_t count = timeline.size(), wanted = std::min(count, probes);
  for (size_t k = 0; k < wanted; ++k) {
    const size_t i = wanted == 1 ? 0 : k * (count - 1) / (wanted - 1);
    const double before = steadySeconds();
    if (!clock.advance(timeline[i].time)) break;
    stepping += steadySeconds() - before;
    double seconds = 0;
    for (const PictureRequest& request :
         chooseRequests(options, options.view, renderer.viewpoints(), i == 0)) {
      const double start = steadySeconds();
      const picture::RenderResult result = renderer.render(request.view);
      const double fixed = steadySeconds() - start - result.renderSeconds;
      if (k == 0) costs.start += fixed; // the first picture builds what stands still
      seconds += factor * result.renderSeconds + (k == 0 ? 0 : fixed);
    }
    probed.emplace_back(i, seconds);
    if (steadySeconds() - begin > longestProbe) break;
  }
  if (probed.empty()) throw Failure{exitInterrupted, "interrupted before the first picture"};
  costs.step = steps > 0 ? stepping / double(steps) : 0;
  costs.frames.resize(count);
  fillIn(probed, costs.frames);
  addHistory(options, costs);
  return costs;
}

} // namespace

std::string farmJobs(const Options& options, const std::vector<std::string>& words,
                     xvrml::Browser& browser) {
  const Timeline timeline(options);
  if (timeline.size() > mostFrames)
    throw UsageError(fmt::format("--jobs: at most {} frames are cut into jobs", mostFrames));
  std::vector<long long> numbers;
  for (size_t i = 0; i < timeline.size(); ++i) numbers.push_back(*timeline[i].frame);
  const SequenceCosts costs = probe(options, timeline, browser);
  std::string lines;
  for (const auto& [first, last] : cutIntoJobs(costs, numbers, size_t(options.farmJobs))) {
    FrameRange range = *options.frames;
    range.first = numbers[first];
    range.last = numbers[last];
    lines += jobCommand(words, range) + "\n";
  }
  return lines;
}

} // namespace vv
