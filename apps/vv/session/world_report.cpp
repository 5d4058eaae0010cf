#include "session/world_report.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <utility>

#include <fmt/format.h>

#include "edit/report.h"
#include "libpicture/false_colour.h"
#include "libpicture/files/atomic_file.h"
#include "libpicture/files/formats.h"
#include "process/messages.h"
#include "report/describe.h"

namespace vv {

namespace fs = std::filesystem;

namespace {

// Identifies reports among those who ask for pictures.
constexpr uint64_t asker = uint64_t(1) << 40;

bool exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

// Returns a free name for the page and the table, without their suffixes: "FOLDER/world-report",
// then "FOLDER/world-report-2" and so on.
std::string freeReportName(const std::string& world) {
  const fs::path file(world == "-" ? "vv" : world);
  const std::string stem = (file.parent_path() / file.stem()).string() + "-report";
  for (int i = 1; i < 100'000; ++i) {
    const std::string name = i == 1 ? stem : fmt::format("{}-{}", stem, i);
    if (!exists(name + ".html") && !exists(name + ".csv")) return name;
  }
  return stem;
}

// A picture of the report that is still to be encoded.
struct Shot {
  ReportPicture text;
  picture::Picture picture;
};

// Returns a picture as it is shown.
Shot shotOf(std::string title, const picture::Picture& picture,
            const std::optional<double>& falseColour, std::string command = "") {
  Shot shot{{std::move(title), "", 0, 0, std::move(command)},
            falseColour
                ? picture::falseColours(picture, *falseColour > 0 ? falseColour : std::nullopt)
                : picture::withChannels(picture, RT_RGBA)};
  shot.text.width = shot.picture.width;
  shot.text.height = shot.picture.height;
  return shot;
}

// Encodes the pictures and writes or delivers both files. Returns what the user is told. [a thread
// of its own]
std::string write(Report report, const std::vector<Shot>& shots, const std::string& world,
                  const WorldReport::Deliver& deliver) {
  try {
    for (const Shot& shot : shots) {
      report.pictures.push_back(shot.text);
      report.pictures.back().png = picture::encodePng(shot.picture);
    }
    if (deliver) return deliver(reportPage(report), reportTable(report));
    const std::string name = freeReportName(world);
    picture::writeRegularFile(name + ".csv", reportTable(report));
    try {
      picture::writeRegularFile(name + ".html", reportPage(report));
    } catch (...) { // there is a whole report or none
      std::error_code error;
      fs::remove(name + ".csv", error);
      throw;
    }
    return fmt::format("report saved as {0}.html and {0}.csv", name);
  } catch (const std::bad_alloc&) {
    return "no report: not enough memory";
  } catch (const std::exception& error) { return fmt::format("no report: {}", error.what()); }
}

} // namespace

struct WorldReport::Work {
  std::string message;
  bool waits = false;             // for the picture
  bool isDelivered = false;       // there are no files
  uint64_t edits = 0;             // Editor::changes() when it was begun
  bool isEdited = false;          // it is given up because of edits
  int samples = 0;                // that the picture gets
  std::future<std::string> files; // valid: they are being written
};

WorldReport::WorldReport() : work_(std::make_shared<Work>()) {}
WorldReport::~WorldReport() = default;

void WorldReport::begin(Session& session, const Probes& probes, const picture::Picture* before,
                        const std::vector<std::string>& arguments, Deliver deliver) {
  if (work_->waits) return giveUp(session);
  if (work_->files.valid()) return;
  WorldEditor& editor = session.editor();
  const xvrml::World& world = session.browser().world();
  Report report;
  report.world = world.path;
  report.program = "vv " + version();
  report.isUnsaved = editor.isChanged();
  report.problems = world.diagnostics.errors() + world.diagnostics.warnings();
  report.probes = probes.all();
  report.changes = probes.differences();
  report.fields = editor.editor().changedFields();
  const std::optional<double> falseColour = session.pilot().falseColour();
  std::vector<Shot> shots;
  if (before) shots.push_back(shotOf("Before (A)", *before, falseColour));
  work_->waits = true;
  work_->isDelivered = deliver != nullptr;
  work_->isEdited = false;
  work_->edits = editor.editor().changes();
  work_->samples = session.pictures().stillOf(session.pilot()).samples;
  session.capture(
      0, asker,
      [work = work_, report, shots, falseColour, command = session.command(arguments),
       path = world.path, deliver](const picture::Picture* made) mutable {
        work->waits = false;
        if (!made) {
          work->message = work->isEdited
                              ? "no report: the world was edited while its picture was interrupted"
                              : "no report: its picture was given up";
          if (!work->isDelivered) say("vv: " + work->message);
          return;
        }
        shots.push_back(
            shotOf(shots.empty() ? "The view" : "Now (B)", *made, falseColour, command));
        work->files = std::async(std::launch::async, write, std::move(report), std::move(shots),
                                 path, deliver);
      },
      true);
}

bool WorldReport::isWaiting() const { return work_->waits; }

void WorldReport::giveUp(Session& session) {
  if (work_->waits) session.captures().giveUp(asker);
}

// A picture that gives way to users who move is that of the world when it begins anew.
std::string WorldReport::progress(Session& session) const {
  if (work_->waits && session.captures().isPostponed()) {
    work_->isEdited = session.editor().editor().changes() != work_->edits;
    if (!work_->isEdited) return "Report: waits until nobody moves; Escape gives it up";
    session.captures().giveUp(asker);
  }
  if (work_->waits)
    return fmt::format("Report: its picture has {:.0f} of {} samples; Escape gives it up",
                       session.captures().samples(), work_->samples);
  return work_->files.valid() ? "Report: the files are being written" : "";
}

void WorldReport::reset() {
  if (work_->files.valid()) earlier_.push_back(work_);
  work_ = std::make_shared<Work>();
}

// Takes the message of files that have been written.
void WorldReport::finish(Work& work) {
  if (!work.files.valid() ||
      work.files.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  work.message = work.files.get();
  if (!work.isDelivered) say("vv: " + work.message);
}

std::string WorldReport::takeMessage() {
  for (const std::shared_ptr<Work>& one : earlier_) finish(*one);
  finish(*work_);
  std::string message = std::exchange(work_->message, {});
  for (const std::shared_ptr<Work>& one : earlier_)
    if (message.empty()) message = std::exchange(one->message, {});
  std::erase_if(earlier_, [](const std::shared_ptr<Work>& one) {
    return !one->files.valid() && one->message.empty();
  });
  return message;
}

} // namespace vv
