#include "edit/probes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vv {

namespace {

// How far a probe may lie off the surface that is seen there, as a part of its distance.
constexpr double tolerance = 2e-3;
// Half of the 95 % interval of the standard normal distribution.
constexpr double quantile = 1.959964;
constexpr double level = 0.05;

bool areEqual(const xvrml::CameraSettings& a, const xvrml::CameraSettings& b) {
  return std::equal(std::begin(a.matrix), std::end(a.matrix), std::begin(b.matrix)) &&
         a.fovy == b.fovy && a.height == b.height;
}

// Tells whether the viewer sees a point, and not something before or behind it.
bool isSeen(xvrml::Browser& browser, const EditView& view, double x, double y,
            const std::array<double, 3>& point) {
  const xvrml::CameraRay ray = xvrml::rayThrough(view.camera, view.aspect, x, y);
  xvrml::PickHit hit;
  if (!browser.pick(ray.origin, ray.direction, {.bothSides = true}, hit)) return false;
  const double distance =
      std::hypot(point[0] - ray.origin[0], point[1] - ray.origin[1], point[2] - ray.origin[2]);
  const double off =
      std::hypot(hit.point[0] - point[0], hit.point[1] - point[1], hit.point[2] - point[2]);
  return off <= tolerance * distance;
}

// Returns the probability of a difference that is at least as large, if nothing has changed.
double chanceOf(const Difference& difference) {
  if (difference.value == 0) return 1;
  if (!(difference.halfWidth > 0)) return 0;
  return std::erfc(std::abs(difference.value) / difference.halfWidth * quantile / std::sqrt(2.0));
}

} // namespace

std::string probeText(const Probe& probe, const std::optional<Difference>& change) {
  std::string text = fmt::format("{}  ", probe.number);
  switch (probe.state) {
  case Probe::State::waiting: return text + "waits for a still picture";
  case Probe::State::hidden: return text + "not seen from here";
  case Probe::State::outside: return text + "outside of the picture";
  case Probe::State::read: break;
  }
  const auto luminance = double(probe.now.luminance),
             halfWidth = double(probe.now.luminanceHalfWidth);
  text += luminance > halfWidth
              ? fmt::format("{:.4g} cd/m2 +- {:.2g} %", luminance, 100 * halfWidth / luminance)
              : fmt::format("{:.4g} +- {:.2g} cd/m2", luminance, halfWidth);
  text += probe.now.trusted ? "  trusted" : "  not trusted";
  if (change)
    text += fmt::format("   B - A: {:+.3g} +- {:.2g}, {}", change->value, change->halfWidth,
                        change->isSignificant                          ? "significant"
                        : change->value == 0 && change->halfWidth == 0 ? "unchanged"
                                                                       : "not yet certain");
  return text;
}

void Probes::add(const std::array<double, 3>& point) {
  Probe probe;
  probe.number = ++last_;
  probe.point = point;
  probes_.push_back(probe);
}

bool Probes::isWaiting() const {
  return std::any_of(probes_.begin(), probes_.end(),
                     [](const Probe& one) { return one.state == Probe::State::waiting; });
}

void Probes::clear() {
  probes_.clear();
  last_ = 0;
}

void Probes::read(xvrml::Browser& browser, const picture::Picture& picture, const EditView& view) {
  camera_ = view.camera;
  for (Probe& probe : probes_) {
    double x = 0, y = 0;
    if (!xvrml::projectPoint(view.camera, view.aspect, probe.point.data(), x, y) ||
        std::max(std::abs(x), std::abs(y)) >= 1) {
      probe.state = Probe::State::outside;
    } else if (!isSeen(browser, view, x, y, probe.point)) {
      probe.state = Probe::State::hidden;
    } else {
      probe.now =
          picture::readPixel(picture, std::min(int((1 + x) / 2 * picture.width), picture.width - 1),
                             std::min(int((1 - y) / 2 * picture.height), picture.height - 1));
      probe.state = Probe::State::read;
    }
  }
}

void Probes::expire() {
  for (Probe& probe : probes_) probe.state = Probe::State::waiting;
}

void Probes::keep() {
  kept_ = camera_;
  for (Probe& probe : probes_) {
    probe.hasBefore = probe.state == Probe::State::read;
    if (probe.hasBefore) probe.before = probe.now;
  }
}

// S. Holm, A simple sequentially rejective multiple test procedure, Scandinavian Journal of
// Statistics 6 (1979): the smallest chance of n is compared with level / n, the next with
// level / (n - 1), and so on, up to the first that is larger.
std::vector<std::optional<Difference>> Probes::differences() const {
  std::vector<std::optional<Difference>> all(probes_.size());
  std::vector<size_t> order;
  for (size_t i = 0; i < probes_.size(); ++i) {
    const Probe& probe = probes_[i];
    if (!probe.hasBefore || probe.state != Probe::State::read || !areEqual(camera_, kept_))
      continue;
    all[i] = Difference{
        double(probe.now.luminance) - double(probe.before.luminance),
        std::hypot(double(probe.now.luminanceHalfWidth), double(probe.before.luminanceHalfWidth)),
        false};
    order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&all](size_t a, size_t b) { return chanceOf(*all[a]) < chanceOf(*all[b]); });
  for (size_t i = 0; i < order.size(); ++i) {
    if (!(chanceOf(*all[order[i]]) <= level / double(order.size() - i))) break;
    // An interval that cannot be trusted proves nothing.
    const Probe& probe = probes_[order[i]];
    all[order[i]]->isSignificant = probe.now.trusted && probe.before.trusted;
  }
  return all;
}

std::string Probes::csv() const {
  std::string text = "probe,x,y,z,luminance,half_width,trusted,before,before_half_width,difference,"
                     "difference_half_width,significant\n";
  const std::vector<std::optional<Difference>> changes = differences();
  for (size_t i = 0; i < probes_.size(); ++i) {
    const Probe& probe = probes_[i];
    text += fmt::format("{},{:.9g},{:.9g},{:.9g}", probe.number, probe.point[0], probe.point[1],
                        probe.point[2]);
    text += probe.state == Probe::State::read
                ? fmt::format(",{:.9g},{:.9g},{}", probe.now.luminance,
                              probe.now.luminanceHalfWidth, probe.now.trusted)
                : ",,,";
    text += changes[i] ? fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{}", probe.before.luminance,
                                     probe.before.luminanceHalfWidth, changes[i]->value,
                                     changes[i]->halfWidth, changes[i]->isSignificant)
                       : ",,,,,";
    text += "\n";
  }
  return text;
}

} // namespace vv
