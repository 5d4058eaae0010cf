// session_reports.cpp: Makes what a session says about itself: the command of a view, messages for
// its user, and the facts of the overlay.
#include <utility>

#include "process/messages.h"
#include "session/input/view_command.h"
#include "session/session.h"

namespace vv {

std::string Session::command(const std::vector<std::string>& arguments, uint32_t viewer) const {
  const Pilot& pilot = viewers_.findOrOwn(viewer).pilot;
  const PictureLoop& pictures = viewers_.findOrOwn(viewer).pictures;
  std::optional<bool> headlight = pilot.headlight();
  if (!headlight && options_.render.headlight != xvrml::MapOptions::Headlight::automatic)
    headlight = options_.render.headlight == xvrml::MapOptions::Headlight::on;
  std::optional<picture::ViewTransform> transform;
  if (options_.render.linear && (options_.viewGiven || pilot.exposure() != 0))
    transform = pictures.transformOf(pilot);
  xvrml::CameraSettings camera = pilot.camera();
  if (options_.view.shader) camera.shader = nullptr; // that of the arguments
  return viewCommand({browser_->world().path, camera, pictures.width(), pictures.height(),
                      browser_->now(), options_.epoch, headlight, transform, pilot.falseColour()},
                     arguments);
}

std::string Session::takeMessage() {
  const std::string pilots = own_.pilot.takeMessage();
  if (const std::string failure = own_.pictures.takeFailure(); !failure.empty()) {
    sayError(failure);
    if (saver_.isWaiting()) saver_.fail(failure);
    return failure;
  }
  if (const std::string kept = editor_.journal().takeMessage(); !kept.empty()) {
    sayWarning(kept);
    return kept;
  }
  const std::string saved = saver_.takeMessage();
  return pilots.empty() ? saved : pilots;
}

SessionFacts Session::facts(uint32_t viewer) const {
  using Showing = SessionFacts::Showing;
  const Pilot& pilot = viewers_.findOrOwn(viewer).pilot;
  const PictureLoop& pictures = viewers_.findOrOwn(viewer).pictures;
  const picture::LivePicture& picture = pictures.facts();
  const bool still = picture.purpose == picture::LiveFrame::Purpose::still;
  SessionFacts facts;
  facts.showing = picture.preview ? (still ? Showing::fading : Showing::preview)
                                  : (still ? Showing::still : Showing::samples);
  facts.denoisedBy = picture.denoisedBy;
  facts.frameRate = pictures.frameRate();
  constexpr double restless = 3;
  facts.isRestless = pictures.movingFor() > restless && !pilot.isSteering();
  facts.width = picture.width;
  facts.height = picture.height;
  facts.samples = picture.samples;
  facts.wanted = pictures.isRefining() ? options_.render.samples : 0;
  facts.stats = picture.stats;
  facts.map = picture.map;
  facts.finished = picture.finished;
  const xvrml::Diagnostics& d = browser_->world().diagnostics;
  facts.errors = d.errors();
  facts.warnings = d.warnings();
  if (!d.list().empty()) facts.lastProblem = d.list().back().text();
  facts.navigation = navigationName(pilot.navigation());
  facts.description = browser_->description();
  facts.loading = inlines_.isLoading();
  if (const auto& cluster = options_.render.cluster) {
    facts.cluster = true;
    facts.workers = cluster->workers();
  }
  return facts;
}

} // namespace vv
