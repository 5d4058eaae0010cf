#include "live_appear.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "libpicture/live.h"

using namespace picture;
using Clock = std::chrono::steady_clock;
using State = LiveRenderer::State;

namespace {

constexpr int side = 1000; // squares each way: two million triangles

double milliseconds(Clock::time_point begin, Clock::time_point end) {
  return 1000 * std::chrono::duration<double>(end - begin).count();
}

double height(int i, int j) { return (i * 7 + j * 3) % 11 * .002; }

std::string faces() {
  std::string points, index;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      points += fmt::format("{:.3f} {:.3f} {:.3f},", i * .004, height(i, j), j * .004);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const int a = j * (side + 1) + i, b = a + side + 1;
      index += fmt::format("{} {} {} -1 {} {} {} -1 ", a, b, b + 1, a, b + 1, a + 1);
    }
  return fmt::format(
      "Shape {{ appearance Appearance {{ material Material {{ }} }} geometry "
      "IndexedFaceSet {{ coord Coordinate {{ point [ {} ] }} coordIndex [ {} ] }} }}",
      points, index);
}

std::string terrain() {
  std::string heights;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) heights += fmt::format("{:.3f} ", height(i, j));
  return fmt::format("Shape {{ appearance Appearance {{ material Material {{ }} }} geometry "
                     "ElevationGrid {{ xDimension {0} zDimension {0} xSpacing .004 zSpacing .004 "
                     "height [ {1} ] }} }}",
                     side + 1, heights);
}

std::string shapes(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += fmt::format("Transform {{ translation {} {} 0 children Shape {{ appearance Appearance "
                        "{{ material Material {{ diffuseColor .{} .5 .3 }} }} geometry "
                        "IndexedFaceSet {{ coord Coordinate {{ point [ 0 0 0, .02 0 0, .02 .02 {} "
                        "] }} coordIndex [ 0 1 2 -1 ] }} }} }}\n",
                        i % 173 * .025, i / 173 * .025, 10 + i % 89, i * 1e-6);
  return text;
}

class Appearance {
 public:
  Appearance(const std::string& content, int threads)
      : browser_(xvrml::loadWorldFromMemory(
                     "#VRML V2.0 utf8\nViewpoint { position 0 1 6 }\n"
                     "Shape { appearance Appearance { material Material { } } geometry Box { } }\n"
                     "DEF S Switch { choice Transform { translation -2 -1.5 -2 children [\n" +
                         content + "] } }\n",
                     "appears.wrl"),
                 running()),
        live_(browser_, settings(threads)) {}

  bool run(const char* name) {
    for (int i = 0; i < 30; ++i) step();
    const uint64_t before = last_.stats.scene.triangles;
    longest_ = steps_ = mapping_ = 0;
    const Clock::time_point begin = Clock::now();
    browser_.set(*browser_.node("S"), "whichChoice", xvrml::Value(int32_t(0)));
    double seen = 0;
    for (int after = 0; after < 30;) {
      step();
      if (milliseconds(begin, Clock::now()) > 120'000) break;
      if (last_.outdated || last_.stats.scene.triangles == before) continue;
      if (after++ == 0) seen = milliseconds(begin, end_);
    }
    fmt::print("{:<34} longest gap {:5.0f} ms, of the browser {:5.0f} ms, of mapping {:5.0f} ms; "
               "seen after {:5.0f} ms\n",
               name, longest_, steps_, mapping_, seen);
    return seen > 0;
  }

 private:
  static xvrml::BrowserOptions running() {
    xvrml::BrowserOptions options;
    options.scriptPatience = .05; // as in a window
    return options;
  }
  static RenderSettings settings(int threads) {
    RenderSettings settings;
    settings.threads = threads;
    settings.channels = RT_RGBA;
    return settings;
  }

  // Moves the viewer, draws a preview, and notes how long both took.
  void step() {
    const Clock::time_point begin = Clock::now();
    browser_.tick(time_ += 1. / 30);
    browser_.navigate({.ahead = number_ % 60 < 30 ? .2 : -.2, .turn = .1}, 1. / 30);
    const Clock::time_point moved = Clock::now();
    LiveFrame frame;
    frame.width = 400;
    frame.height = 300;
    frame.purpose = LiveFrame::Purpose::preview;
    frame.lightStride = 4;
    frame.view.viewer = browser_.camera(4. / 3);
    live_.start(frame);
    const auto nap = [] { std::this_thread::sleep_for(std::chrono::microseconds(200)); };
    while (live_.state() == State::mapping) nap();
    const Clock::time_point mapped = Clock::now();
    while (live_.state() != State::idle) nap();
    for (LivePicture picture; live_.look(picture);) last_ = picture;
    const Clock::time_point end = Clock::now();
    if (number_++ > 0) longest_ = std::max(longest_, milliseconds(end_, end));
    steps_ = std::max(steps_, milliseconds(begin, moved));
    mapping_ = std::max(mapping_, milliseconds(moved, mapped));
    end_ = end;
  }

  xvrml::Browser browser_;
  LiveRenderer live_;
  LivePicture last_;
  Clock::time_point end_;
  double time_ = 0, longest_ = 0, steps_ = 0, mapping_ = 0; // the last three in ms
  int number_ = 0;
};

} // namespace

bool measureAppearance(int threads) {
  bool good = Appearance(faces(), threads).run("faces, 2,000,000 triangles");
  good &= Appearance(terrain(), threads).run("ElevationGrid, 2,000,000 triangles");
  good &= Appearance(shapes(30'000), threads).run("30,000 Shapes");
  return Appearance(shapes(4'096), threads).run("4,096 Shapes") && good;
}
