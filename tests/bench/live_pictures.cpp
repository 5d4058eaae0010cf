// live_pictures.cpp: does what vv's window does, without a window. Measures frames per second
// during motion, the picture sizes that this takes, the delay until a change of the camera is
// visible, and the cost of progressive refinement. Worlds: the arguments, or a few of
// examples/scenes.
//
//   bench_live [--size=WxH] [--fps=N] [--threads=N] [--seconds=N] [WORLD...]
//
// It measures how long pictures stand still when much appears (live_appear.h):
//
//   bench_live --appear [--threads=N]
//
// On a cluster it alternates between overlapping frames and one frame at a time, both paced like
// the window and at full size as often as possible:
//
//   bench_live --workers=HOST:PORT,... [--local-threads=N] ...
//
// For live_flip.py it shows a scripted turn and keeps the pictures, and renders the true pictures
// of some of its instants (live_show.h):
//
//   bench_live --show=DIR [--raw] [--denoiser=own|oidn|auto] [--speed=RADIANS] [--steps=N]
//              [--frame=WxH[xS[xK]]] [--still=S] ... WORLD
//   bench_live --converge=DIR --at=N,N,... [--speed=RADIANS] [--spp=N] [--error=E] [--seed=N] ...
//              WORLD
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "libpicture/cluster.h"
#include "libpicture/live.h"
#include "libpicture/live/pacing.h"
#include "libpicture/live/reconstruction.h"
#include "live_appear.h"
#include "live_show.h"

using namespace picture;
using Clock = std::chrono::steady_clock;
using State = LiveRenderer::State;

namespace {

struct Options {
  int width = 800, height = 600, threads = 0;
  double fps = 30, seconds = 4;
  ClusterSettings cluster;
  std::vector<std::string> worlds;
  bool appear = false;
  ShowOptions show;         // its folder is empty: not asked for
  ConvergeOptions converge; // the same
};

// Reads the options of --show and --converge. Returns false for others.
bool readShow(const std::string& a, Options& o) {
  const char* const text = a.c_str();
  if (a.starts_with("--show=")) return o.show.folder = a.substr(7), true;
  if (a.starts_with("--converge=")) return o.converge.folder = a.substr(11), true;
  if (a == "--raw") return o.show.raw = true;
  if (a == "--denoiser=own") return true;
  if (a == "--denoiser=oidn" || a == "--denoiser=auto") {
    o.show.denoiser = a.ends_with("oidn") ? Denoiser::oidn : Denoiser::automatic;
    return true;
  }
  if (a.starts_with("--at=")) {
    std::istringstream list(a.substr(5));
    for (std::string one; std::getline(list, one, ',');)
      o.converge.instants.push_back(std::atoi(one.c_str()));
    return true;
  }
  if (std::sscanf(text, "--speed=%lf", &o.show.speed) == 1) {
    o.converge.speed = o.show.speed;
    return true;
  }
  FrameSize& frame = o.show.frame;
  return std::sscanf(text, "--frame=%dx%dx%dx%d", &frame.width, &frame.height, &frame.samples,
                     &frame.lightStride) >= 2 ||
         std::sscanf(text, "--steps=%d", &o.show.steps) == 1 ||
         std::sscanf(text, "--still=%d", &o.show.stillSamples) == 1 ||
         std::sscanf(text, "--spp=%d", &o.converge.samples) == 1 ||
         std::sscanf(text, "--error=%lf", &o.converge.error) == 1 ||
         std::sscanf(text, "--seed=%d", &o.converge.seed) == 1;
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}
void nap() { std::this_thread::sleep_for(std::chrono::microseconds(500)); }

Options read(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; i++) {
    const std::string a = argv[i];
    if (readShow(a, o)) continue;
    if (a == "--appear") {
      o.appear = true;
      continue;
    }
    if (std::sscanf(a.c_str(), "--size=%dx%d", &o.width, &o.height) == 2) continue;
    if (std::sscanf(a.c_str(), "--fps=%lf", &o.fps) == 1 ||
        std::sscanf(a.c_str(), "--seconds=%lf", &o.seconds) == 1)
      continue;
    if (std::sscanf(a.c_str(), "--local-threads=%d", &o.cluster.localThreads) == 1) continue;
    if (a.starts_with("--workers=")) {
      o.cluster.workers = a.substr(a.find('=') + 1);
      continue;
    }
    if (std::sscanf(a.c_str(), "--threads=%d", &o.threads) == 1 || a.starts_with("--benchmark_"))
      continue; // an option of `make bench`
    o.worlds.push_back(a);
  }
  o.show.width = o.converge.width = o.width;
  o.show.height = o.converge.height = o.height;
  o.show.threads = o.converge.threads = o.threads;
  o.show.fps = o.converge.fps = o.fps;
  o.show.seconds = o.seconds;
  if (o.worlds.empty())
    for (const char* name : {"board", "globe", "still_life", "headlight", "car", "chess"})
      if (const std::string path = fmt::format("examples/scenes/{}.wrl", name);
          std::filesystem::exists(path))
        o.worlds.push_back(path);
  return o;
}

class Looking {
 public:
  Looking(const std::string& path, const Options& options, std::shared_ptr<Cluster> cluster)
      : options_(options), browser_(xvrml::loadWorld(path)),
        live_(browser_, settings(options, std::move(cluster))), path_(path) {
    first_ = Clock::now();
    LiveFrame frame = whole(1);
    frame.view.fit = browser_.viewpoints().empty();
    const LivePicture picture = finish(frame);
    firstPicture_ = picture.seconds;
    camera_ = browser_.camera(double(options.width) / options.height);
    if (frame.view.fit) {
      const xvrml::Bounds b = live_.bounds();
      const double size = std::max({b.maximum[0] - b.minimum[0], b.maximum[1] - b.minimum[1], .01});
      for (int k = 0; k < 3; k++)
        camera_.matrix[12 + k] = (b.minimum[k] + b.maximum[k]) / 2 + (k == 2 ? 1.5 * size : 0);
    }
  }

  // The viewer turns back and forth. Frames follow each other; each shows the viewer's position at
  // its start.
  void move() {
    Pacing pacing(options_.fps);
    Pacing::Light light = Pacing::Light::sparse; // until the first picture tells
    std::vector<double> intervals, latencies;
    std::vector<FrameSize> sizes;
    double overhead = 0;
    const Clock::time_point begin = Clock::now();
    double last = 0;
    while (secondsSince(begin) < options_.seconds) {
      const double asked = secondsSince(begin);
      const FrameSize size = pacing.next(options_.width, options_.height, true, 64, light);
      LiveFrame frame = whole(size.samples);
      frame.lightStride = size.lightStride;
      frame.width = size.width;
      frame.height = size.height;
      frame.view.viewer = turned(.2 * std::sin(asked));
      frame.purpose = LiveFrame::Purpose::preview;
      const FrameSize shown = pacing.shown(options_.width, options_.height);
      frame.shownWidth = shown.width;
      frame.shownHeight = shown.height;
      const LivePicture picture = finish(frame);
      light = lightOf(picture.stats, true);
      pacing.took(size, picture.seconds, picture.alone, picture.overhead, picture.samples,
                  picture.rebuilding, picture.showing);
      const double now = secondsSince(begin);
      const double frameTime = 1 / options_.fps;
      if (now - last < frameTime)
        std::this_thread::sleep_for(std::chrono::duration<double>(frameTime - (now - last)));
      if (asked > options_.seconds / 4) { // when the rate has settled
        intervals.push_back(std::max(now - last, frameTime));
        latencies.push_back(now - asked);
        sizes.push_back(size);
        overhead += picture.overhead;
      }
      last = secondsSince(begin);
    }
    if (sizes.empty()) return;
    const FrameSize typical = sizes[sizes.size() / 2];
    fmt::print("  moving      {:5.1f} frames/s at {}x{}, {} samples; change to picture {:.0f} ms "
               "(longest {:.0f}), of these {:.1f} ms before light is traced; {} sizes\n",
               double(intervals.size()) / sum(intervals), typical.width, typical.height,
               typical.samples, 1000 * sum(latencies) / double(latencies.size()),
               1000 * *std::max_element(latencies.begin(), latencies.end()),
               1000 * overhead / double(sizes.size()), changes(sizes) + 1);
  }

  // Measures as a window on a cluster works. paced: at most fps frames per second, in sizes that
  // allow it.
  void follow(bool overlapping, bool paced) {
    Pacing pacing(options_.fps);
    // A refined picture, as the user has seen before moving.
    const double refined = finish(whole(16)).seconds;
    pacing.took({options_.width, options_.height, 16}, refined, refined, 0, 16);
    const double period = paced ? 1 / options_.fps : 0, settled = options_.seconds / 4;
    std::vector<double> ends, pixels, seconds;
    double next = 0, now = 0;
    const Clock::time_point begin = Clock::now();
    LivePicture picture;
    const auto look = [&] {
      while (live_.look(picture)) {
        if (!picture.finished) continue;
        pacing.took({picture.width, picture.height, 1}, picture.seconds, picture.alone,
                    picture.overhead, picture.samples, picture.rebuilding);
        if (now < settled) continue;
        ends.push_back(now);
        seconds.push_back(picture.seconds);
        pixels.push_back(double(picture.width) * picture.height * picture.samples);
      }
    };
    for (; now < options_.seconds; now = secondsSince(begin)) {
      look();
      const State state = live_.state();
      if (now < next || (state != State::idle && (state != State::ready || !overlapping))) {
        nap();
        continue;
      }
      FrameSize size = pacing.next(options_.width, options_.height, true, 64);
      if (!paced) size = {options_.width, options_.height, 1};
      LiveFrame frame = whole(size.samples);
      frame.width = size.width;
      frame.height = size.height;
      frame.view.viewer = turned(.2 * std::sin(now));
      frame.purpose = LiveFrame::Purpose::preview;
      next = std::max(next + period, now);
      live_.start(frame);
    }
    while (live_.state() != State::idle) nap();
    while (live_.look(picture)) {}
    if (ends.size() < 2) return;
    fmt::print("  {} {:<16} {:5.1f} frames/s of {:.0f} samples; start to end {:.0f} ms\n",
               paced ? "paced" : "whole", overlapping ? "overlapping" : "one at a time",
               double(ends.size() - 1) / (ends.back() - ends.front()),
               sum(pixels) / double(pixels.size()), 1000 * sum(seconds) / double(seconds.size()));
  }

  // Measures how long a cancelled frame still runs.
  void measureCancel() {
    double most = 0, all = 0;
    constexpr int times = 10;
    for (int i = 0; i < times; i++) {
      live_.start(whole(256));
      while (live_.state() == State::mapping) nap();
      std::this_thread::sleep_for(std::chrono::milliseconds(30 + 17 * i));
      const Clock::time_point begin = Clock::now();
      live_.cancel();
      while (live_.state() != State::idle)
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      const double took = secondsSince(begin);
      most = std::max(most, took);
      all += took;
    }
    fmt::print("  given up    in {:.1f} ms (longest {:.1f})\n", 1000 * all / times, 1000 * most);
  }

  // Measures the first whole picture of a still viewer and the cost of progressive rounds.
  void refine() {
    LivePicture picture;
    finish(whole(1));
    const double one = finish(whole(1)).seconds;
    live_.start(whole(64));
    const Clock::time_point begin = Clock::now();
    double covered = 0;
    while (live_.state() != State::idle && covered == 0) {
      if (live_.look(picture) && picture.covered == 1) covered = secondsSince(begin);
      nap();
    }
    live_.cancel();
    while (live_.state() != State::idle) nap();
    fmt::print("  still       all of it after {:.0f} ms; a frame of 1 sample takes {:.0f} ms\n",
               1000 * covered, 1000 * one);
  }

  void rounds(int samples) {
    double taken[2] = {1e9, 1e9};
    for (int i = 0; i < 2; i++)
      for (const bool progressive : {false, true})
        taken[progressive] = std::min(taken[progressive], cost(samples, progressive));
    fmt::print("  {:2} samples  of half the size each way: in one go {:.2f} s of processor time, "
               "progressive {:.2f} s ({:+.1f} %)\n",
               samples, taken[0], taken[1], 100 * (taken[1] / taken[0] - 1));
  }

  void tell() const { fmt::print("{}: first picture after {:.2f} s\n", path_, firstPicture_); }

 private:
  static RenderSettings settings(const Options& o, std::shared_ptr<Cluster> cluster) {
    RenderSettings s;
    s.width = o.width;
    s.height = o.height;
    s.threads = o.threads;
    s.cluster = std::move(cluster);
    return s;
  }
  LiveFrame whole(int samples) const {
    LiveFrame frame;
    frame.width = options_.width;
    frame.height = options_.height;
    frame.samples = samples;
    return frame;
  }
  xvrml::CameraSettings turned(double angle) const {
    xvrml::CameraSettings c = camera_;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (int k = 0; k < 3; k++) {
      const double x = camera_.matrix[k], z = camera_.matrix[8 + k];
      c.matrix[k] = cosine * x - sine * z;
      c.matrix[8 + k] = sine * x + cosine * z;
    }
    return c;
  }
  LivePicture finish(const LiveFrame& frame) {
    LivePicture picture;
    live_.start(frame);
    while (live_.state() != State::idle) nap();
    live_.look(picture);
    if (const std::string wrong = live_.takeFailure(); !wrong.empty()) fmt::print("  {}\n", wrong);
    return picture;
  }
  // Returns the processor seconds of all threads together, because other processes may use the
  // processors.
  double cost(int samples, bool progressive) {
    live_.change([&](RenderSettings& s) { s.progressive = progressive; });
    const std::clock_t begin = std::clock();
    LiveFrame frame = whole(samples);
    frame.width = (frame.width + 1) / 2;
    frame.height = (frame.height + 1) / 2;
    finish(frame);
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    live_.change([&](RenderSettings& s) { s.progressive = true; });
    return seconds;
  }
  static double sum(const std::vector<double>& v) {
    double s = 0;
    for (const double x : v) s += x;
    return s;
  }
  static int changes(const std::vector<FrameSize>& sizes) {
    int n = 0;
    for (size_t i = 1; i < sizes.size(); i++) n += !(sizes[i] == sizes[i - 1]);
    return n;
  }

  const Options& options_;
  xvrml::Browser browser_;
  LiveRenderer live_;
  std::string path_;
  Clock::time_point first_;
  double firstPicture_ = 0;
  xvrml::CameraSettings camera_;
};

// Returns what is wrong with the options of --show and --converge; "": nothing.
std::string faultOf(const Options& o) {
  if (o.worlds.size() != 1) return "--show and --converge take one world";
  const FrameSize& frame = o.show.frame;
  if (frame.width < 1 || frame.height < 1 || frame.samples < 1)
    return "--frame: WxHxS above 0 expected";
  if (frame.lightStride < 1 || frame.lightStride > live::mostLightStride)
    return fmt::format("--frame: a light stride of 1 to {} expected", live::mostLightStride);
  if (o.width < 1 || o.height < 1) return "--size: WxH above 0 expected";
  if (!(o.fps > 0) || !(o.seconds > 0)) return "--fps, --seconds: numbers above 0 expected";
  if (o.show.steps < 0 || o.show.stillSamples < 1) return "--steps, --still: above 0 expected";
  for (const int instant : o.converge.instants)
    if (instant < 0) return "--at: instants from 0 expected";
  return "";
}

// Does something with a world. Returns false, with a message, if that fails.
bool tryWorld(const std::string& world, const std::function<void()>& use) {
  std::string fault;
  try {
    use();
    return true;
  } catch (const xvrml::LoadError& error) {
    fault = error.diagnostic.text(); // it begins with the world's name
  } catch (const std::exception& error) { fault = fmt::format("{}: {}", world, error.what()); }
  fmt::print(stderr, "bench_live: {}\n", fault);
  return false;
}

// Does what --show and --converge ask for. Returns the program's exit code.
int keepPictures(Options options) {
  if (const std::string fault = faultOf(options); !fault.empty()) {
    fmt::print(stderr, "bench_live: {}\n", fault);
    return 2;
  }
  options.show.world = options.converge.world = options.worlds[0];
  const bool done = tryWorld(options.worlds[0], [&] {
    if (!options.show.folder.empty()) showTurn(options.show);
    if (!options.converge.folder.empty()) convergeTurn(options.converge);
  });
  return done ? 0 : 1;
}

// Measures what a viewer of this world waits for.
void measureWorld(const std::string& world, const Options& options,
                  const std::shared_ptr<Cluster>& cluster) {
  Looking looking(world, options, cluster);
  looking.tell();
  for (int turn = 0; cluster && turn < 3; turn++)
    for (const bool paced : {false, true})
      for (const bool overlapping : {false, true}) looking.follow(overlapping, paced);
  if (cluster) return;
  looking.move();
  looking.measureCancel();
  looking.refine();
  looking.rounds(16);
  looking.rounds(64);
}

} // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 4096);
  const Options options = read(argc, argv);
  if (options.appear) return measureAppearance(options.threads) ? 0 : 1;
  if (!options.show.folder.empty() || !options.converge.folder.empty())
    return keepPictures(options);
  std::shared_ptr<Cluster> cluster;
  if (options.cluster.used()) {
    RenderSettings rendering;
    rendering.threads = options.threads;
    cluster = std::make_shared<Cluster>(options.cluster, rendering);
    if (!cluster->wait(1, 10)) fmt::print("no worker answers\n");
  }
  bool good = true;
  for (const std::string& world : options.worlds)
    good &= tryWorld(world, [&] { measureWorld(world, options, cluster); });
  return good ? 0 : 1;
}
