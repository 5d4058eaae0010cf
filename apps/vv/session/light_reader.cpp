#include "session/light_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "edit/looks.h"
#include "edit/outline.h"
#include "xvrml/nodes.h"

namespace vv {

using namespace xvrml;

namespace {

struct SurfaceSeen {
  CameraRay ray;
  PickHit hit;
};
std::optional<SurfaceSeen> findSurface(WorldEditor& editor, const EditView& view, double x,
                                       double y) {
  SurfaceSeen seen{rayThrough(view.camera, view.aspect, x, y), {}};
  if (!editor.browser().pick(seen.ray.origin, seen.ray.direction, {.bothSides = true}, seen.hit))
    return std::nullopt;
  return seen;
}
SurfaceSeen surfaceAt(WorldEditor& editor, const EditView& view, double x, double y) {
  if (std::optional<SurfaceSeen> seen = findSurface(editor, view, x, y)) return *seen;
  throw EditError("there is nothing here to be measured");
}

// Returns what a probe or a pointer says of the surface that it is on.
std::string textOf(WorldEditor& editor, const SurfaceSeen& seen) {
  const PickHit& hit = seen.hit;
  std::string text;
  if (const MFNode nodes = nodesOfFile(editor.browser().world(), hit.path); !nodes.empty()) {
    text = labelOf(*nodes.back());
    if (nodeCast<nodes::Shape>(nodes.back()))
      if (const std::string look = lookOf(*nodes.back()).name; !look.empty())
        text += ", " + look.substr(0, 64);
    text += "\n";
  }
  const double distance = hit.distance * std::hypot(seen.ray.direction[0], seen.ray.direction[1],
                                                    seen.ray.direction[2]);
  // Rounding errors are shown as 0.
  const auto three = [](const std::array<double, 3>& v, double size) {
    const auto shown = [size](double x) { return std::abs(x) < 1e-6 * size ? 0 : x; };
    return fmt::format("{:.4g} {:.4g} {:.4g}", shown(v[0]), shown(v[1]), shown(v[2]));
  };
  return text + fmt::format("at {}, {:.4g} from the viewer\nnormal {}", three(hit.point, distance),
                            distance, three(hit.normal, 1));
}

} // namespace

EditView viewOf(Session& session) { return {session.pilot().camera(), session.pilot().aspect()}; }

void LightReader::addProbe(WorldEditor& editor, const EditView& view, double x, double y) {
  const SurfaceSeen seen = surfaceAt(editor, view, x, y);
  probes_.add(seen.hit.point, textOf(editor, seen));
}

void LightReader::addSensor(WorldEditor& editor, const EditView& view, double x, double y) {
  const SurfaceSeen seen = surfaceAt(editor, view, x, y);
  probes_.addSensor(
      picture::sensorAt(seen.hit.point.data(), seen.hit.normal.data(), seen.ray.direction),
      textOf(editor, seen));
}

void LightReader::keep(WorldEditor& editor, const EditView& view) {
  if (editor.browser().hasChanges()) {
    probes_.expire();
    probes_.expireSensors();
  }
  probes_.keep();
  comparison_.ask(editor.editor().changes(), view);
}

void LightReader::point(uint64_t face, double x, double y) {
  PointerReading& pointer = pointers_.try_emplace(face, PointerReading{x, y, {}, {}}).first->second;
  if (pointer.x != x || pointer.y != y) pointer = {x, y, {}, {}};
}

const PointerReading* LightReader::pointerOf(uint64_t face) const {
  const auto found = pointers_.find(face);
  return found == pointers_.end() ? nullptr : &found->second;
}

bool LightReader::update(Session& session, double seconds) {
  const EditView view = viewOf(session);
  const PictureLoop& pictures = session.pictures();
  comparison_.follow(view, pictures.width(), pictures.height(),
                     {pictures.transformOf(session.pilot()), pictures.facts().scaleEnd},
                     session.viewers().own().isOutdated());
  lookAtPointers(session, view);
  readStill(session, view, seconds);
  readSensors(session, seconds);
  return std::exchange(hasChanged_, false);
}

std::string LightReader::takeMessage() {
  std::string message = comparison_.takeMessage();
  return message.empty() ? std::exchange(message_, {}) : message;
}

void LightReader::clear() {
  probes_.clear();
  comparison_.clear();
  pointers_.clear();
  stillRead_ = nextSensors_ = 0;
  finishedRead_ = 0;
  message_.clear();
}

// Finds the surfaces that are seen where pointers rest, once for each place.
void LightReader::lookAtPointers(Session& session, const EditView& view) {
  const bool outdated = session.viewers().own().isOutdated();
  for (auto& [face, pointer] : pointers_) {
    if (outdated) {
      pointer.seen.reset();
      pointer.light.reset();
    } else if (!pointer.seen) {
      const auto surface = findSurface(session.editor(), view, pointer.x, pointer.y);
      pointer.seen = surface ? textOf(session.editor(), *surface) : "nothing is here";
      hasChanged_ = true;
    }
  }
}

bool LightReader::isPointerWaiting() const {
  return std::any_of(pointers_.begin(), pointers_.end(),
                     [](const auto& pointer) { return !pointer.second.light; });
}

// Reads the probes, the pointers and what is compared from the still picture of the world as it is,
// a few times a second.
void LightReader::readStill(Session& session, const EditView& view, double seconds) {
  // Comparing all pixels takes up to a quarter of a second for a picture of 600,000.
  const bool showsChanges = comparison_.shown() == Comparison::Shown::difference;
  const double interval = showsChanges ? 1 : 0.25;
  const bool mustRead = probes_.readPictures() || comparison_.wantsPicture() || showsChanges ||
                        comparison_.isRefined(session.pictures().number());
  if (!mustRead && (pointers_.empty() || !session.pictures().isReadable())) return;
  if (session.captures().isPending()) return; // other channels would cancel its frame
  const bool outdated = session.viewers().own().isOutdated();
  if (outdated) probes_.expire();
  if (outdated || seconds < stillRead_ + interval) return;
  if (mustRead) session.pictures().wantReadings(PictureLoop::Readings::now);
  const uint64_t number = session.pictures().number();
  const uint64_t finished = session.pictures().isFinished(session.pilot()) ? number : 0;
  if (finished != 0 && finished == finishedRead_ && !probes_.isWaiting() &&
      !comparison_.wantsPicture() && !isPointerWaiting())
    return;
  picture::Picture picture;
  if (!session.pictures().copyStill(picture) || !picture.planes.contains(RT_ERROR)) return;
  stillRead_ = seconds;
  finishedRead_ = finished;
  probes_.read(session.browser(), picture, view);
  for (auto& [face, pointer] : pointers_)
    pointer.light = picture::readPlace(picture, pointer.x, pointer.y);
  if (comparison_.take(picture, number, session.editor().editor().changes(), view, finished != 0))
    probes_.keep();
  hasChanged_ = true;
}

// Reads the probes of illuminance when the previews have ended. The still picture begins anew then.
void LightReader::readSensors(Session& session, double seconds) {
  constexpr double patience = 2; // seconds after a failure
  Measuring& measuring = session.measuring();
  if (measuring.isOutdated()) probes_.expireSensors();
  if (!session.pictures().isRefining() || session.viewers().own().isOutdated() ||
      measuring.isPending() || seconds < nextSensors_)
    return;
  const std::vector<picture::PlacedSensor> sensors = probes_.waitingSensors();
  if (sensors.empty()) return;
  measuring.want({.view = session.pictures().stillOf(session.pilot()).view,
                  .sensors = sensors,
                  .samples = measuring.samples()},
                 [this, seconds](const picture::LiveReadings& read) {
                   if (!read.failure.empty()) {
                     message_ = "not measured: " + read.failure;
                     nextSensors_ = seconds + patience;
                   }
                   probes_.take(read.sensors);
                   hasChanged_ = true;
                 });
}

} // namespace vv
