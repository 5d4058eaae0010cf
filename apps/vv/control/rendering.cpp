#include "control/rendering.h"

#include <algorithm>
#include <utility>

#include "libpicture/files/atomic_file.h"
#include "report/measure_report.h"
#include "run/outputs.h"
#include "session/saving.h"

namespace vv::control {

namespace {

void refuseScreenColours(const Options& options) {
  if (!options.render.linear)
    throw CommandError("failed", "--colour vrml97 makes colours for screens, not light");
}

// Returns the settings of a picture that a probe reads: those of the picture that is shown, with
// the samples of a finished one unless the probe says how many.
picture::RenderSettings settingsOf(const Probe& probe, const Options& options, Session& session) {
  picture::RenderSettings settings = options.render;
  settings.width = std::max(session.pictures().width(), 1);
  settings.height = std::max(session.pictures().height(), 1);
  settings.samples = probe.samples.value_or(samplesInWindow(options));
  return settings;
}

// Returns a sensor on the side of the surface that is seen at a place of the picture.
picture::PlacedSensor sensorAt(const Pick& place, Session& session) {
  const Pilot& pilot = session.pilot();
  xvrml::PickHit hit;
  if (!pilot.pick(place.x, place.y, hit)) throw CommandError("failed", "nothing is seen there");
  const xvrml::CameraRay ray = xvrml::rayThrough(pilot.camera(), pilot.aspect(), place.x, place.y);
  return picture::sensorAt(hit.point.data(), hit.normal.data(), ray.direction);
}

} // namespace

bool Rendering::makes(const Command& command) {
  return std::holds_alternative<Render>(command.action) ||
         std::holds_alternative<Probe>(command.action) ||
         std::holds_alternative<Measure>(command.action);
}

bool Rendering::isFree(Session* session) const {
  return std::holds_alternative<std::monostate>(work_) &&
         !(session && session->measuring().isPending());
}

void Rendering::begin(const Command& command, Session& session, const Describe& describe) {
  if (const auto* render = std::get_if<Render>(&command.action))
    begin(*render, session);
  else if (const auto* probe = std::get_if<Probe>(&command.action))
    begin(*probe, session, describe);
  else
    measure({}, "", std::get<Measure>(command.action).samples, session);
}

void Rendering::begin(const Render& render, Session& session) {
  static_cast<void>(formatOf(render));
  const uint32_t channels = channelsOf(render, options_.render.channels);
  if (const std::string why = picture::whyNotRegular(render.file); !why.empty())
    throw CommandError("file", "render: " + why);
  if (!render.file.empty()) protectFilesOf(session.browser().world(), render.file);
  Still still;
  still.width = render.width.value_or(options_.render.width);
  still.height = render.height.value_or(options_.render.height);
  still.samples = render.samples.value_or(options_.render.samples);
  still.channels = channels;
  session.pictures().requestStill(still);
  work_ = Picture{render, channels};
}

void Rendering::begin(const Probe& probe, Session& session, const Describe& describe) {
  refuseScreenColours(options_);
  if (probe.illuminance)
    return measure({sensorAt(probe.place, session)}, describe(probe.place), probe.samples, session);
  Probing probing = probingAt(probe, settingsOf(probe, options_, session));
  probing.hit = describe(probe.place);
  session.pictures().requestStill(probing.still);
  work_ = std::move(probing);
}

void Rendering::measure(std::vector<picture::PlacedSensor> sensors, std::string hit,
                        std::optional<int> samples, Session& session) {
  refuseScreenColours(options_);
  Reading reading{!sensors.empty(), std::move(hit),
                  std::make_shared<std::optional<picture::LiveReadings>>()};
  session.measuring().want(
      {.view = session.pictures().stillOf(session.pilot()).view,
       .sensors = std::move(sensors),
       .samples = samples.value_or(samplesOfSensors(options_))},
      [out = reading.read](const picture::LiveReadings& read) { *out = read; });
  work_ = std::move(reading);
}

std::optional<Rendering::Outcome> Rendering::follow(Session* session) {
  std::optional<Outcome> outcome;
  if (auto* encoding = std::get_if<Encoding>(&work_)) {
    if (!encoding->hasEnded()) return {};
    const Encoded encoded = encoding->take();
    outcome = Outcome{encoded.result, "render", encoded.failure};
  } else if (const auto* reading = std::get_if<Reading>(&work_)) {
    outcome = follow(*reading);
  } else if (session && !std::holds_alternative<std::monostate>(work_)) {
    if (std::optional<StillAnswer> still = session->pictures().takeStill())
      outcome = take(std::move(*still));
  }
  if (outcome) work_ = {};
  return outcome;
}

std::optional<Rendering::Outcome> Rendering::follow(const Reading& reading) {
  const std::optional<picture::LiveReadings>& read = *reading.read;
  if (!read) return {};
  if (!read->failure.empty()) return Outcome{"", "render", read->failure};
  return Outcome{reading.isProbe ? resultOf(read->sensors.at(0), reading.hit)
                                 : sensorsJson(read->sensors),
                 "", ""};
}

// Takes the picture that was asked for. Returns nothing if it is to be encoded.
std::optional<Rendering::Outcome> Rendering::take(StillAnswer still) {
  if (!still.failure.empty()) return Outcome{"", "render", still.failure};
  try {
    if (const auto* probing = std::get_if<Probing>(&work_))
      return Outcome{resultOf(*probing, still.picture), "", ""};
    const Picture made = std::get<Picture>(work_);
    work_.emplace<Encoding>(std::move(still.picture), made.channels, made.render);
    return {};
  } catch (const std::exception& error) { return Outcome{"", "limit", error.what()}; }
}

bool Rendering::waitForFile(double seconds) const {
  const auto* encoding = std::get_if<Encoding>(&work_);
  return encoding && encoding->hasEnded(seconds);
}

void Rendering::giveUp(Session* session) {
  if (session && std::holds_alternative<Reading>(work_)) session->measuring().giveUp();
  work_ = {};
}

} // namespace vv::control
