// live_turn.cpp: Implements the scripted turn of bench_live.
#include "live_turn.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libpicture/renderer.h"
#include "openrt/openrt.h"
#include "xvrml/world.h"

namespace {

constexpr double swing = 0.25; // radians to each side

// Returns the median distance of what the middle third of a picture shows; 0 if it shows nothing.
double middleDepth(const picture::Picture& picture) {
  const std::vector<float>& depth = picture.planes.at(RT_DEPTH);
  std::vector<float> seen;
  for (int y = picture.height / 3; y < 2 * picture.height / 3; ++y)
    for (int x = picture.width / 3; x < 2 * picture.width / 3; ++x) {
      const float d = depth[size_t(y) * size_t(picture.width) + size_t(x)];
      if (std::isfinite(d) && d > 0) seen.push_back(d);
    }
  if (seen.empty()) return 0;
  std::nth_element(seen.begin(), seen.begin() + std::ptrdiff_t(seen.size() / 2), seen.end());
  return double(seen[seen.size() / 2]);
}

} // namespace

TurnStart findStart(const std::string& world, double aspect, int threads) {
  xvrml::Browser browser(xvrml::loadWorld(world));
  browser.tick(0);
  picture::RenderSettings settings;
  settings.height = 60;
  settings.width = std::max(1, int(settings.height * aspect));
  settings.samples = 1;
  settings.threads = threads;
  settings.channels = RT_RGBA | RT_DEPTH;
  picture::Renderer renderer(browser, settings);
  picture::View view;
  view.fit = browser.viewpoints().empty();
  TurnStart start{renderer.placeOf(view).camera};
  start.camera.shader = nullptr; // a node of the world that is about to be destroyed
  if (const double depth = middleDepth(renderer.render(view).picture); depth > 0)
    start.distance = depth;
  return start;
}

Turn::Turn(const std::string& world, const TurnStart& start, double speed, double fps)
    : browser_(xvrml::loadWorld(world)), start_(start), speed_(speed), fps_(fps) {}

void Turn::advance(int instant) {
  for (; next_ <= instant; ++next_) browser_.tick(time(next_));
}

// Turns the camera about its own up axis through the point straight ahead.
xvrml::CameraSettings Turn::camera(int instant) const {
  const double angle = swing * std::sin(speed_ * time(instant) / swing);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  xvrml::CameraSettings camera = start_.camera;
  const double* const from = start_.camera.matrix;
  for (int k = 0; k < 3; ++k) {
    const double right = from[k], back = from[8 + k];
    camera.matrix[k] = cosine * right - sine * back;
    camera.matrix[8 + k] = sine * right + cosine * back;
    camera.matrix[12 + k] += start_.distance * (camera.matrix[8 + k] - back);
  }
  return camera;
}
