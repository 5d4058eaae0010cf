#include "edit/probes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "csv_field.h"
#include "holm.h"
#include "printable.h"

namespace vv {

namespace {

// How far a probe may lie off the surface that is seen there, as a part of its distance.
constexpr double tolerance = 2e-3;

bool readsIlluminance(const Probe& probe) {
  return probe.sensor && probe.sensor->quantity == picture::Quantity::illuminance;
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

void read(Probe& probe, xvrml::Browser& browser, const picture::Picture& picture,
          const EditView& view) {
  double x = 0, y = 0;
  if (!xvrml::projectPoint(view.camera, view.aspect, probe.point.data(), x, y) ||
      std::max(std::abs(x), std::abs(y)) >= 1) {
    probe.state = Probe::State::outside;
  } else if (!isSeen(browser, view, x, y, probe.point)) {
    probe.state = Probe::State::hidden;
  } else {
    probe.now = picture::readPlace(picture, x, y);
    probe.state = Probe::State::read;
  }
}

void readArea(Probe& probe, const picture::Picture& picture, const EditView& view) {
  if (probe.area->view != view) {
    probe.state = Probe::State::otherView;
    return;
  }
  probe.area->reading = readRegion(picture, probe.area->region);
  probe.now = probe.area->reading.mean;
  probe.state = Probe::State::read;
}

// Returns a name in one line, of at most Probe::mostNameBytes, without half a character at its end.
std::string shortName(std::string_view text) {
  std::string name = printable(text);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  size_t size = std::min(name.size(), Probe::mostNameBytes);
  while (size < name.size() && (static_cast<unsigned char>(name[size]) & 0xc0) == 0x80) --size;
  name.resize(size);
  return name;
}

} // namespace

std::string titleOf(const Probe& probe) {
  return probe.name.empty() ? std::to_string(probe.number)
                            : fmt::format("{} {}", probe.number, probe.name);
}
const char* quantityOf(const Probe& probe) {
  return readsIlluminance(probe) ? "illuminance" : "luminance";
}
const char* unitOf(const Probe& probe) { return readsIlluminance(probe) ? "lx" : "cd/m2"; }

std::string lightText(const picture::PixelReading& light, const char* unit) {
  const auto luminance = double(light.luminance), halfWidth = double(light.luminanceHalfWidth);
  return (luminance > halfWidth
              ? fmt::format("{:.4g} {} +- {:.2g} %", luminance, unit, 100 * halfWidth / luminance)
              : fmt::format("{:.4g} +- {:.2g} {}", luminance, halfWidth, unit)) +
         (light.trusted ? "  trusted" : "  not trusted");
}

std::string probeText(const Probe& probe, const std::optional<Difference>& change) {
  std::string text = fmt::format("{}  {}", titleOf(probe), probe.isMean() ? "mean " : "");
  switch (probe.state) {
  case Probe::State::waiting:
    return text + (probe.sensor ? "is being measured" : "waits for a still picture");
  case Probe::State::hidden: return text + "not seen from here";
  case Probe::State::outside: return text + "outside of the picture";
  case Probe::State::otherView: return text + "of another view";
  case Probe::State::read: break;
  }
  text += lightText(probe.now, unitOf(probe));
  if (const MeanReading* const several = probe.several())
    text += fmt::format("  {:.4g} to {:.4g}, uniformity {:.3g}", several->least, several->most,
                        several->uniformity());
  if (change)
    text += fmt::format("   B - A: {:+.3g} +- {:.2g}, {}", change->value, change->halfWidth,
                        change->isSignificant                          ? "significant"
                        : change->value == 0 && change->halfWidth == 0 ? "unchanged"
                                                                       : "not yet certain");
  return text;
}

std::string pointerText(const PointerReading& pointer, bool isReadable) {
  if (!pointer.seen) return "";
  if (!pointer.light)
    return (isReadable ? "waits for a still picture\n" : "V measures the light here\n") +
           *pointer.seen;
  const picture::PixelReading& light = *pointer.light;
  std::string text = lightText(light, "cd/m2") + "\nradiance";
  for (size_t i = 0; i < 3; ++i)
    text += fmt::format("  {} {:.3g} +- {:.2g}", "RGB"[i], light.radiance[i], light.halfWidth[i]);
  return text + "\n" + *pointer.seen;
}

void Probes::add(const std::array<double, 3>& point, std::string seen) {
  Probe probe;
  probe.number = ++last_;
  probe.point = point;
  probe.seen = std::move(seen);
  probes_.push_back(probe);
}

void Probes::addSensor(const picture::PlacedSensor& sensor, std::string seen) {
  std::array<double, 3> middle{};
  for (size_t k = 0; k < 3; ++k)
    middle[k] = sensor.first[k] + (sensor.columns - 1) * sensor.column[k] / 2 +
                (sensor.rows - 1) * sensor.row[k] / 2;
  add(middle, std::move(seen));
  probes_.back().sensor = sensor;
}

void Probes::add(const Region& region, const EditView& view) {
  add({0, 0, 0});
  probes_.back().area = {region, view, {}};
}

void Probes::rename(int number, std::string_view name) {
  for (Probe& probe : probes_)
    if (probe.number == number) probe.name = shortName(name);
}

bool Probes::readPictures() const {
  return std::any_of(probes_.begin(), probes_.end(),
                     [](const Probe& one) { return !one.sensor.has_value(); });
}

bool Probes::isWaiting() const {
  return std::any_of(probes_.begin(), probes_.end(), [](const Probe& one) {
    return !one.sensor && one.state == Probe::State::waiting;
  });
}

void Probes::clear() {
  probes_.clear();
  last_ = 0;
}

void Probes::read(xvrml::Browser& browser, const picture::Picture& picture, const EditView& view) {
  view_ = view;
  for (Probe& probe : probes_)
    if (probe.area)
      readArea(probe, picture, view);
    else if (!probe.sensor)
      vv::read(probe, browser, picture, view);
}

std::vector<picture::PlacedSensor> Probes::waitingSensors() const {
  std::vector<picture::PlacedSensor> sensors;
  for (const Probe& probe : probes_)
    if (probe.sensor && probe.state == Probe::State::waiting) {
      sensors.push_back(*probe.sensor);
      sensors.back().name = std::to_string(probe.number);
    }
  return sensors;
}

void Probes::take(const std::vector<picture::Measurement>& readings) {
  for (const picture::Measurement& reading : readings)
    for (Probe& probe : probes_) {
      if (!probe.sensor || std::to_string(probe.number) != reading.sensor.name) continue;
      // All probes may have been removed meanwhile, and numbers begin anew.
      if (!std::equal(std::begin(reading.sensor.first), std::end(reading.sensor.first),
                      std::begin(probe.sensor->first)))
        continue;
      const MeanReading mean = meanOf(reading.value.size(), [&reading](size_t i) {
        picture::PixelReading point;
        point.luminance = reading.value[i];
        point.luminanceHalfWidth = reading.halfWidth[i];
        point.samples = reading.samples[i];
        point.trusted = reading.trusted[i] != 0;
        return point;
      });
      probe.now = mean.mean;
      if (probe.isMean()) probe.points = mean;
      probe.state = Probe::State::read;
    }
}

void Probes::expire() {
  for (Probe& probe : probes_)
    if (!probe.sensor) probe.state = Probe::State::waiting;
}

void Probes::expireSensors() {
  for (Probe& probe : probes_)
    if (probe.sensor) probe.state = Probe::State::waiting;
}

void Probes::keep() {
  kept_ = view_;
  for (Probe& probe : probes_) {
    probe.hasBefore = probe.state == Probe::State::read;
    if (probe.hasBefore) probe.before = probe.now;
  }
}

std::vector<std::optional<Difference>> Probes::differences() const {
  std::vector<std::optional<Difference>> all(probes_.size());
  std::vector<double> chances;
  std::vector<size_t> judged;
  for (size_t i = 0; i < probes_.size(); ++i) {
    const Probe& probe = probes_[i];
    if (!probe.hasBefore || probe.state != Probe::State::read) continue;
    if (!probe.sensor && view_ != kept_) continue;
    all[i] = differenceBetween(probe.before, probe.now);
    // An interval that cannot be trusted proves nothing.
    if (!probe.now.trusted || !probe.before.trusted) continue;
    chances.push_back(all[i]->chance);
    judged.push_back(i);
  }
  for (const size_t i : holm::significantOf(chances, changeLevel))
    all[judged[i]]->isSignificant = true;
  return all;
}

std::string Probes::csv() const {
  std::string text =
      "probe,x,y,z,quantity,unit,value,half_width,trusted,before,before_half_width,difference,"
      "difference_half_width,significant,left,top,width,height,least,most,"
      "uniformity,name\n";
  const std::vector<std::optional<Difference>> changes = differences();
  for (size_t i = 0; i < probes_.size(); ++i) {
    const Probe& probe = probes_[i];
    const bool isRead = probe.state == Probe::State::read;
    text += probe.area ? fmt::format("{},,,", probe.number)
                       : fmt::format("{},{:.9g},{:.9g},{:.9g}", probe.number, probe.point[0],
                                     probe.point[1], probe.point[2]);
    text += fmt::format(",{},{}", quantityOf(probe), unitOf(probe));
    text += isRead ? fmt::format(",{:.9g},{:.9g},{}", probe.now.luminance,
                                 probe.now.luminanceHalfWidth, probe.now.trusted)
                   : ",,,";
    text += changes[i] ? fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{}", probe.before.luminance,
                                     probe.before.luminanceHalfWidth, changes[i]->value,
                                     changes[i]->halfWidth, changes[i]->isSignificant)
                       : ",,,,,";
    const PixelRectangle* const pixels = probe.area ? &probe.area->reading.pixels : nullptr;
    text += pixels && isRead ? fmt::format(",{},{},{},{}", pixels->left, pixels->top, pixels->width,
                                           pixels->height)
                             : ",,,,";
    const MeanReading* const several = probe.several();
    text += several && isRead ? fmt::format(",{:.9g},{:.9g},{:.9g}", several->least, several->most,
                                            several->uniformity())
                              : ",,,";
    text += "," + (probe.name.empty() ? "" : csvField(probe.name)) + "\n";
  }
  return text;
}

} // namespace vv
