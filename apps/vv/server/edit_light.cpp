#include "server/edit_light.h"

#include <algorithm>

#include <fmt/format.h>

#include "edit/kept_probes.h"
#include "edit/region.h"
#include "libpicture/files/formats.h"
#include "server/light_texts.h"
#include "server/limits.h"
#include "server/texts.h"

namespace vv::server {

using namespace xvrml;

namespace {

constexpr int coverQuality = 95; // the quality of JPEG

void needLeader(bool isLeaders) {
  if (!isLeaders)
    throw EditError("this is about the picture of the page that leads: follow it first");
}

} // namespace

void EditLight::take(uint64_t page, const EditView& view, bool isLeaders,
                     const edit::LightCommand& command) {
  std::visit([&](const auto& one) { perform(page, view, isLeaders, one); }, command);
}

void EditLight::update(double now) {
  Session& session = world_.session();
  if (world_.hasLight()) session.pictures().wantReadings(PictureLoop::Readings::later);
  light_.update(session, now);
}

std::vector<std::pair<uint64_t, std::string>> EditLight::takeMessages() {
  std::vector<std::pair<uint64_t, std::string>> messages;
  if (std::string text = light_.takeMessage(); !text.empty()) messages.emplace_back(0, text);
  if (std::string text = report_.takeMessage(); !text.empty())
    messages.emplace_back(reporter_, text);
  return messages;
}

void EditLight::beginAnew() {
  light_.clear();
  report_.reset();
}

std::string EditLight::comparisonText(uint64_t page, bool isLeaders) {
  const PointerReading* const pointer = light_.pointerOf(page);
  return edit::comparisonText(light_.comparison(), isLeaders,
                              pointer ? std::optional(edit::Place{pointer->x, pointer->y})
                                      : std::nullopt);
}

std::string EditLight::pointerText(uint64_t page, bool isLeaders) const {
  const PointerReading* const pointer = isLeaders ? light_.pointerOf(page) : nullptr;
  return edit::pointerText(pointer, world_.session().pictures().isReadable());
}

uint64_t EditLight::cover() {
  const Comparison::Cover& cover = light_.comparison().cover();
  if (cover.width <= 0) return 0;
  if (std::exchange(cover_, cover.number) != cover.number) {
    coverText_.clear();
    try {
      coverText_ =
          edit::coverText(cover.width, cover.height,
                          picture::jpegOf(cover.rgb, cover.width, cover.height, coverQuality));
    } catch (const std::exception&) {} // there is no memory: pages go on without it
  }
  return coverText_.empty() ? 0 : cover_;
}

// --- Probes ---

void EditLight::needRoom() {
  if (!world_.hasLight()) throw EditError("--colour vrml97 makes colours for screens, not light");
  if (light_.probes().all().size() >= size_t(maxProbes))
    throw EditError(fmt::format("there are {} probes already (maxProbes)", maxProbes));
}

void EditLight::perform(uint64_t, const EditView& view, bool, const edit::PutProbe& put) {
  needRoom();
  WorldEditor& editor = world_.session().editor();
  if (put.illuminance)
    light_.addSensor(editor, view, put.place.x, put.place.y);
  else
    light_.addProbe(editor, view, put.place.x, put.place.y);
}

void EditLight::perform(uint64_t, const EditView& view, bool isLeaders,
                        const edit::Measure& measure) {
  needLeader(isLeaders);
  needRoom();
  light_.probes().add(regionBetween(measure.from.x, measure.from.y, measure.to.x, measure.to.y),
                      view);
}

void EditLight::perform(uint64_t, const EditView&, bool, const edit::ClearProbes&) {
  light_.probes().clear();
}

const Probe& EditLight::probeOf(int number) {
  const std::vector<Probe>& probes = light_.probes().all();
  const auto probe = std::find_if(probes.begin(), probes.end(),
                                  [&](const Probe& one) { return one.number == number; });
  if (probe == probes.end()) throw EditError("this probe has been removed");
  return *probe;
}

void EditLight::perform(uint64_t, const EditView& view, bool, const edit::KeepInWorld& keep) {
  keepInWorld(world_.session().editor(), probeOf(keep.probe), view);
}

void EditLight::perform(uint64_t, const EditView&, bool, const edit::NameProbe& name) {
  light_.probes().rename(probeOf(name.probe).number, name.name);
}

void EditLight::perform(uint64_t, const EditView&, bool, const edit::ShowSensors&) {
  needRoom();
  showSensors(world_.session().editor(), light_.probes(), size_t(maxProbes));
}

void EditLight::perform(uint64_t page, const EditView&, bool, const edit::ProbeTable&) {
  const std::string& world = world_.session().browser().world().path;
  const std::string name = downloadName(world, "-probes.csv");
  const std::string path =
      host_.offerDownload(name, "text/csv; charset=utf-8", light_.probes().csv());
  host_.sendText(page, "", savedText(path, name));
}

// --- A and what has changed since ---

void EditLight::perform(uint64_t, const EditView&, bool, const edit::KeepProbes&) {
  Session& session = world_.session();
  light_.keep(session.editor(), viewOf(session));
}

void EditLight::perform(uint64_t, const EditView&, bool isLeaders, const edit::Compare& compare) {
  using Shown = Comparison::Shown;
  constexpr Shown shown[] = {Shown::a, Shown::wiper, Shown::difference};
  needLeader(isLeaders);
  const PictureLoop& pictures = world_.session().pictures();
  const Shown what = shown[size_t(compare.what)];
  if (what == Shown::difference && double(pictures.width()) * pictures.height() > maxComparedPixels)
    throw EditError(fmt::format("the picture has more than {} pixels (maxComparedPixels): make the "
                                "page smaller",
                                maxComparedPixels));
  light_.comparison().toggle(what);
}

void EditLight::perform(uint64_t page, const EditView&, bool isLeaders,
                        const edit::PointAt& point) {
  if (point.place && isLeaders && world_.hasLight())
    light_.point(page, point.place->x, point.place->y);
  else
    light_.leave(page);
}

// --- Reports ---

std::string EditLight::progress(uint64_t page) {
  return page == reporter_ ? report_.progress(world_.session()) : "";
}

void EditLight::perform(uint64_t page, const EditView&, bool, const edit::Report&) {
  Session& session = world_.session();
  const std::string name = downloadName(session.browser().world().path, "-report");
  const auto deliver = [&host = host_, page, name](std::string html,
                                                   std::string csv) -> std::string {
    const std::string files[] = {name + ".html", name + ".csv"};
    const std::string paths[] = {
        host.offerDownload(files[0], "text/html; charset=utf-8", std::move(html)),
        host.offerDownload(files[1], "text/csv; charset=utf-8", std::move(csv))};
    host.sendText(page, "", edit::reportText(paths, files));
    return "the report is ready";
  };
  reporter_ = page;
  report_.begin(session, light_.probes(), light_.comparison().a(), arguments_, deliver);
}

} // namespace vv::server
