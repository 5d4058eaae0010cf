// live_show.cpp: Implements the modes of bench_live that keep pictures.
#include "live_show.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "libpicture/live.h"
#include "libpicture/live/denoise_choice.h"
#include "live_turn.h"

using namespace picture;

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr double stillSeconds = 0.5; // from the stop to the picture that is judged
// Seconds of larger previews between motion and rest, as in session/picture_loop.cpp.
constexpr double settlingTime = 0.35;
constexpr double wholeSeconds = 5; // how long the whole unbiased picture is waited for

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}
void nap() { std::this_thread::sleep_for(std::chrono::microseconds(500)); }

std::string fileOf(const std::string& folder, int instant) {
  return fmt::format("{}/{:04}.ppm", folder, instant);
}

void writePpm(const std::string& path, const LivePicture& picture) {
  std::string bytes = fmt::format("P6\n{} {}\n255\n", picture.shownWidth, picture.shownHeight);
  bytes.append(reinterpret_cast<const char*>(picture.rgb.data()), picture.rgb.size());
  writeFile(path, bytes);
}

// A picture that was shown. Times are seconds since the turn began.
struct Shown {
  int instant = 0;
  double asked = 0, shown = 0; // when its frame was started, and when it could be seen
  double processor = 0;        // seconds that all threads together worked for it
  LivePicture picture;
};

class Show {
 public:
  explicit Show(const ShowOptions& options)
      : options_(options),
        turn_(options.world,
              findStart(options.world, double(options.width) / options.height, options.threads),
              options.speed, options.fps),
        live_(turn_.browser(), settings(options)), pacing_(options.fps) {}

  void run() {
    turn_.advance(0);
    finish(frameAt(0, LiveFrame::Purpose::still, {options_.width, options_.height, 1}));
    begin_ = Clock::now();
    if (options_.steps > 0)
      for (int i = 0; i < options_.steps; ++i) show(i);
    else
      follow();
    if (shown_.empty()) throw std::runtime_error("there was no time for a picture");
    const Json still = rest();
    for (const Shown& one : shown_) writePpm(fileOf(options_.folder, one.instant), one.picture);
    writeFile(options_.folder + "/frames.json", facts(still).dump(1) + "\n");
  }

 private:
  static RenderSettings settings(const ShowOptions& options) {
    RenderSettings settings;
    settings.width = options.width;
    settings.height = options.height;
    settings.threads = options.threads;
    settings.denoiser = options.denoiser;
    return settings;
  }

  LiveFrame frameAt(int instant, LiveFrame::Purpose purpose, const FrameSize& size) {
    LiveFrame frame;
    frame.view.viewer = turn_.camera(instant);
    frame.width = size.width;
    frame.height = size.height;
    frame.samples = size.samples;
    frame.lightStride = size.lightStride;
    frame.purpose = purpose;
    const FrameSize shown = options_.steps > 0 ? FrameSize{options_.width, options_.height}
                                               : pacing_.shown(options_.width, options_.height);
    frame.shownWidth = shown.width;
    frame.shownHeight = shown.height;
    frame.denoising = live::denoisingInMotion(options_.fps);
    return frame;
  }

  // Shows the latest instant again and again, at most one picture for each.
  void follow() {
    const int last = int(options_.seconds * options_.fps);
    for (int next = 0; next <= last;) {
      const int now = int(std::floor(secondsSince(begin_) * options_.fps));
      if (now < next) {
        nap();
        continue;
      }
      next = std::min(now, last);
      show(next++);
    }
  }

  void show(int instant) {
    const FrameSize size = options_.steps > 0
                               ? options_.frame
                               : pacing_.next(options_.width, options_.height, true, 64, light_);
    Shown one;
    one.instant = instant;
    one.asked = secondsSince(begin_);
    const std::clock_t worked = std::clock();
    turn_.advance(instant);
    one.picture = finish(frameAt(instant, moving(), size));
    one.shown = secondsSince(begin_);
    one.processor = double(std::clock() - worked) / CLOCKS_PER_SEC;
    const LivePicture& p = one.picture;
    light_ = lightOf(p.stats, !options_.raw);
    pacing_.took(size, p.seconds, p.alone, p.overhead, p.samples, p.rebuilding, p.showing);
    shown_.push_back(std::move(one));
  }

  LiveFrame::Purpose moving() const {
    return options_.raw ? LiveFrame::Purpose::rawPreview : LiveFrame::Purpose::preview;
  }

  LivePicture finish(const LiveFrame& frame) {
    LivePicture picture;
    live_.start(frame);
    while (live_.state() != LiveRenderer::State::idle) nap();
    const bool made = live_.look(picture) && picture.finished;
    check();
    if (!made) throw std::runtime_error("a frame was not finished");
    return picture;
  }

  void check() {
    if (const std::string wrong = live_.takeFailure(); !wrong.empty())
      throw std::runtime_error(wrong);
  }

  // Lets camera and time rest at the last instant, and keeps what is shown soon after.
  Json rest() {
    const int instant = shown_.back().instant;
    const FrameSize size{options_.width, options_.height,
                         options_.steps > 0 ? options_.stillSamples : 256};
    const LiveFrame frame = frameAt(instant, LiveFrame::Purpose::still, size);
    LivePicture picture = shown_.back().picture;
    Json whole; // seconds until all of the picture was unbiased; null: longer
    if (options_.steps > 0) {
      picture = finish(frame);
    } else {
      whole = refine(frame, picture);
    }
    writePpm(options_.folder + "/still.ppm", picture);
    return {{"instant", instant},
            {"samples", picture.samples},
            {"covered", picture.covered},
            {"whole", whole}};
  }

  // Sets `picture` to what is shown after stillSeconds.
  Json refine(const LiveFrame& frame, LivePicture& picture) {
    const Clock::time_point stop = Clock::now();
    if (!options_.raw && (rawOf(light_) != Pacing::Light::direct ||
                          picture.width < options_.width || picture.lightStride > 1))
      settle(stop, picture);
    LivePicture now;
    Json whole;
    live_.start(frame);
    for (double since = secondsSince(stop);
         since < wholeSeconds && (since < stillSeconds || whole.is_null());
         since = secondsSince(stop)) {
      if (live_.look(now)) {
        if (whole.is_null() && now.covered == 1 && !now.preview) whole = secondsSince(stop);
        if (since < stillSeconds) picture = now;
      }
      nap();
    }
    live_.cancel();
    while (live_.state() != LiveRenderer::State::idle) nap();
    check();
    return whole;
  }

  // Shows larger previews of the last instant, which accumulate, until the still picture begins.
  void settle(Clock::time_point stop, LivePicture& picture) {
    const int instant = shown_.back().instant;
    while (secondsSince(stop) < settlingTime) {
      const FrameSize size = pacing_.settle(options_.width, options_.height, 64);
      LiveFrame frame = frameAt(instant, moving(), size);
      frame.denoising = live::denoisingAtRest;
      LivePicture next = finish(frame);
      if (secondsSince(stop) < stillSeconds) picture = std::move(next);
    }
  }

  Json facts(const Json& still) const {
    Json frames = Json::array();
    for (const Shown& one : shown_)
      frames.push_back({{"instant", one.instant},
                        {"asked", one.asked},
                        {"shown", one.shown},
                        {"processor", one.processor},
                        {"width", one.picture.width},
                        {"height", one.picture.height},
                        {"samples", one.picture.samples},
                        {"light_stride", one.picture.lightStride},
                        {"preview", one.picture.preview},
                        {"shown_width", one.picture.shownWidth},
                        {"shown_height", one.picture.shownHeight},
                        {"rebuilding", one.picture.rebuilding},
                        {"showing", one.picture.showing},
                        {"denoised", one.picture.denoisedBy}});
    return {{"world", options_.world}, {"window", {options_.width, options_.height}},
            {"fps", options_.fps},     {"speed", options_.speed},
            {"raw", options_.raw},     {"steps", options_.steps},
            {"frames", frames},        {"still", still}};
  }

  const ShowOptions& options_;
  Turn turn_;
  LiveRenderer live_;
  Pacing pacing_;
  Pacing::Light light_ = Pacing::Light::sparse; // until the first picture tells
  Clock::time_point begin_;
  std::vector<Shown> shown_;
};

} // namespace

void showTurn(const ShowOptions& options) { Show(options).run(); }

void convergeTurn(const ConvergeOptions& options) {
  const double aspect = double(options.width) / options.height;
  Turn turn(options.world, findStart(options.world, aspect, options.threads), options.speed,
            options.fps);
  RenderSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.threads = options.threads;
  settings.samples = options.samples;
  settings.error = options.error;
  settings.quality.set(RT_SEED, options.seed);
  std::vector<int> instants = options.instants;
  std::sort(instants.begin(), instants.end());
  Renderer renderer(turn.browser(), settings);
  for (const int instant : instants) {
    turn.advance(instant);
    View view;
    view.viewer = turn.camera(instant);
    const RenderResult result = renderer.render(view);
    writeFile(fileOf(options.folder, instant), encodePpm(result.picture));
    fmt::print("instant {}: {:.1f} s\n", instant, result.renderSeconds);
  }
}
