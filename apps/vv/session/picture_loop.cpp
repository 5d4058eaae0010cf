#include "session/picture_loop.h"

#include <algorithm>
#include <cstring>

namespace vv {

namespace {

bool equal(const xvrml::CameraSettings& a, const xvrml::CameraSettings& b) {
  return std::memcmp(a.matrix, b.matrix, sizeof a.matrix) == 0 && a.fovy == b.fovy &&
         a.height == b.height && a.shader == b.shader;
}

} // namespace

PictureLoop::PictureLoop(SharedRenderer& shared, const Options& options, uint32_t viewer)
    : shared_(shared), renderer_(shared.live), options_(options), viewer_(viewer),
      pacing_(options.fps) {}

void PictureLoop::resize(int width, int height) {
  width_ = std::max(1, width);
  height_ = std::max(1, height);
}

// --- Decisions ---

bool PictureLoop::isOutdated(const Pilot& pilot, const Fit& fit) const {
  return phase_ == Phase::unstarted || fit.isWanted() || !equal(pilot.camera(), camera_) ||
         shared_.isOutdated(world_) || pilot.headlight() != headlight_ ||
         (!isMoving() && (frame_.width != width_ || frame_.height != height_));
}

PictureLoop::Need PictureLoop::need(const Pilot& pilot, const Fit& fit) const {
  if (width_ <= 0) return Need::nothing;
  if (isOutdated(pilot, fit)) return Need::change;
  return isMoving() || isInterrupted() ? Need::refinement : Need::nothing;
}

bool PictureLoop::isInterrupted() const {
  return phase_ == Phase::refining && !ended_ && shared_.cancellations() != cancellations_;
}

// Moving frames overlap where the renderer permits it. A frame that is refined is cancelled
// instead, but not before the first picture, so that it comes early. Both hold for the frames of
// other viewers, too.
PictureLoop::Decision PictureLoop::decide(Need need, const Fit& fit) const {
  const RendererState state = renderer_.state();
  switch (state) {
  case RendererState::mapping: return Decision::wait;
  case RendererState::rendering:
  case RendererState::ready:
    if (need != Need::change) return Decision::wait;
    if (shared_.isMoving()) return state == RendererState::ready ? Decision::move : Decision::wait;
    return shared_.viewer() != viewer_ || hasShown() || fit.isWanted() ? Decision::cancel
                                                                       : Decision::wait;
  case RendererState::idle: break;
  }
  return need == Need::change       ? Decision::move
         : need == Need::refinement ? Decision::refine
                                    : Decision::wait;
}

void PictureLoop::advance(const Pilot& pilot, Fit& fit, double now) {
  switch (decide(need(pilot, fit), fit)) {
  case Decision::wait: break;
  case Decision::cancel: shared_.cancel(); break;
  case Decision::move: start(Phase::moving, pilot, fit, now); break;
  case Decision::refine: start(Phase::refining, pilot, fit, now); break;
  }
}

bool PictureLoop::isDrawing() const {
  const RendererState state = renderer_.state();
  return isMoving() && (state == RendererState::mapping || state == RendererState::rendering);
}

bool PictureLoop::isFinished(const Pilot& pilot) const {
  return phase_ == Phase::refining && shared_.isIdle() && !isInterrupted() &&
         !shared_.isOutdated(world_) && equal(pilot.camera(), camera_);
}

bool PictureLoop::isRefining(const Pilot& pilot, const Fit& fit) const {
  return phase_ == Phase::refining && shared_.viewer() == viewer_ && !shared_.isIdle() &&
         !isInterrupted() && !isOutdated(pilot, fit);
}

// --- Frames ---

picture::View PictureLoop::viewOf(const Pilot& pilot, const Fit& fit) const {
  picture::View view;
  view.shader = options_.view.shader;
  const bool presenting = fit.isWanted() && fit.direction() == Fit::Direction::initial;
  if (const auto initial = presenting ? pilot.initialView(options_.view) : std::nullopt)
    return *initial;
  if (presenting && phase_ == Phase::unstarted) {
    view.fit = true;
    view.fov = options_.view.fov;
  } else {
    view.viewer = pilot.camera();
  }
  return view;
}

xvrml::MapOptions::Headlight PictureLoop::headlightFor(const Pilot& pilot) const {
  const auto on = xvrml::MapOptions::Headlight::on, off = xvrml::MapOptions::Headlight::off;
  const std::optional<bool> chosen = pilot.headlight();
  return !chosen ? options_.render.headlight : *chosen ? on : off;
}

picture::LiveFrame PictureLoop::frameFor(const Pilot& pilot) const {
  picture::LiveFrame frame;
  frame.view.shader = options_.view.shader;
  frame.view.viewer = pilot.camera();
  frame.width = width_;
  frame.height = height_;
  frame.samples = options_.render.samples;
  frame.viewer = viewer_;
  return frame;
}

// The renderer keeps the headlight of its last frame, which may have been another viewer's.
void PictureLoop::followHeadlight(const Pilot& pilot) {
  headlight_ = pilot.headlight();
  const auto wanted = headlightFor(pilot);
  renderer_.change([&](picture::RenderSettings& s) { s.headlight = wanted; });
}

void PictureLoop::start(Phase phase, const Pilot& pilot, Fit& fit, double now) {
  picture::LiveFrame frame;
  frame.view = viewOf(pilot, fit);
  camera_ = pilot.camera();
  followHeadlight(pilot);
  const bool moving = phase == Phase::moving;
  if (moving && isMoving() && now > lastStart_)
    gap_ = gap_ <= 0 ? now - lastStart_ : .9 * gap_ + .1 * (now - lastStart_);
  if (!moving) gap_ = 0;
  lastStart_ = now;
  frame_ = pacing_.next(width_, height_, moving, options_.render.samples);
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = frame_.samples;
  frame.viewer = viewer_;
  if (hasStarted()) phase_ = phase; // even if the renderer throws; a first frame is tried again
  ended_ = false;
  cancellations_ = shared_.cancellations();
  world_ = shared_.start(frame, moving);
  phase_ = phase;
  fit.begin();
}

bool PictureLoop::placeViewer(Pilot& pilot, Fit& fit) const {
  if (fit.state() != Fit::State::mapping) return false;
  const bool initial = fit.direction() == Fit::Direction::initial;
  if (const auto view = initial ? pilot.initialView(options_.view) : std::nullopt)
    pilot.present(renderer_.cameraOf(*view, pilot.aspect()), renderer_.upOf(*view));
  else
    pilot.frameAll(renderer_.bounds());
  fit.end();
  return true;
}

bool PictureLoop::note(const picture::LivePicture& picture) {
  // Partial pictures are not shown over the previous one while something moves: that would tear.
  const bool shown = picture.finished || !hasShown() || !isMoving();
  shown_ = Shown::something;
  facts_.width = picture.width;
  facts_.height = picture.height;
  facts_.samples = picture.samples;
  facts_.finished = picture.finished;
  if (picture.finished) {
    ended_ = true;
    pacing_.took({picture.width, picture.height, 1}, picture.seconds, picture.alone,
                 picture.overhead, picture.samples);
    facts_.stats = picture.stats;
    facts_.map = picture.map;
  }
  return shown;
}

} // namespace vv
