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

PictureLoop::PictureLoop(xvrml::Browser& browser, const Options& options)
    : browser_(browser), options_(options), renderer_(browser, options.render),
      pacing_(options.fps) {}

void PictureLoop::resize(int width, int height) {
  width_ = std::max(1, width);
  height_ = std::max(1, height);
}

// --- Decisions ---

bool PictureLoop::isOutdated(const Pilot& pilot, const Fit& fit) const {
  return phase_ == Phase::unstarted || fit.isWanted() || !equal(pilot.camera(), camera_) ||
         browser_.hasChanges() || pilot.headlight() != headlight_ ||
         (!isMoving() && (frame_.width != width_ || frame_.height != height_));
}

// Moving frames overlap where the renderer permits it. A frame that is refined is cancelled
// instead, but not before the first picture, so that it comes early.
PictureLoop::Decision PictureLoop::decide(bool outdated, const Fit& fit) const {
  const RendererState state = renderer_.state();
  switch (state) {
  case RendererState::mapping: return Decision::wait;
  case RendererState::rendering:
  case RendererState::ready:
    if (!outdated) return Decision::wait;
    if (isMoving()) return state == RendererState::ready ? Decision::move : Decision::wait;
    return hasShown() || fit.isWanted() ? Decision::cancel : Decision::wait;
  case RendererState::idle: break;
  }
  if (outdated) return Decision::move;
  return isMoving() ? Decision::refine : Decision::wait;
}

void PictureLoop::advance(const Pilot& pilot, Fit& fit, double now) {
  if (width_ <= 0) return;
  if (still_.isBusy()) return advanceStill(pilot, fit);
  if (!watched_ && hasShown()) return;
  switch (decide(isOutdated(pilot, fit), fit)) {
  case Decision::wait: break;
  case Decision::cancel: renderer_.cancel(); break;
  case Decision::move: start(Phase::moving, pilot, fit, now); break;
  case Decision::refine: start(Phase::refining, pilot, fit, now); break;
  }
}

bool PictureLoop::isDrawing() const {
  const RendererState state = renderer_.state();
  return isMoving() && (state == RendererState::mapping || state == RendererState::rendering);
}

bool PictureLoop::isFinished(const Pilot& pilot) const {
  return phase_ == Phase::refining && isIdle() && !browser_.hasChanges() &&
         equal(pilot.camera(), camera_);
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

void PictureLoop::followHeadlight(const Pilot& pilot) {
  if (headlight_ == pilot.headlight()) return;
  headlight_ = pilot.headlight();
  const auto on = xvrml::MapOptions::Headlight::on, off = xvrml::MapOptions::Headlight::off;
  const auto wanted = !headlight_ ? options_.render.headlight : *headlight_ ? on : off;
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
  if (hasStarted()) phase_ = phase; // even if the renderer throws; a first frame is tried again
  renderer_.start(frame);
  phase_ = phase;
  fit.begin();
}

// Returns the view that `vv -o` would have: that of the options, or the viewer's place once it has
// been moved.
picture::View PictureLoop::stillViewOf(const Pilot& pilot, double aspect) const {
  picture::View view = options_.view;
  if (!pilot.hasViewerMoved()) return view;
  view = {};
  view.shader = options_.view.shader;
  view.viewer = pilot.camera(aspect);
  return view;
}

void PictureLoop::advanceStill(const Pilot& pilot, Fit& fit) {
  if (still_.isRendering()) return;
  followHeadlight(pilot);
  if (!still_.advance([&](double aspect) { return stillViewOf(pilot, aspect); })) return;
  // The next frame that is shown begins as if something had moved.
  phase_ = Phase::moving;
  frame_ = {};
  if (shown_ == Shown::something) shown_ = Shown::still;
  if (fit.isWanted()) fit.begin();
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

bool PictureLoop::look(picture::LivePicture& picture) {
  if (still_.isRendering()) {
    still_.look();
    return false;
  }
  if (!renderer_.look(picture)) return false;
  // Partial pictures are not shown over the previous one while something moves: that would tear.
  const bool shown = picture.finished || !hasShown() || !isMoving();
  shown_ = Shown::something;
  facts_.width = picture.width;
  facts_.height = picture.height;
  facts_.samples = picture.samples;
  facts_.finished = picture.finished;
  if (picture.finished) {
    pacing_.took({picture.width, picture.height, 1}, picture.seconds, picture.alone,
                 picture.overhead, picture.samples);
    facts_.stats = picture.stats;
    facts_.map = picture.map;
  }
  return shown;
}

} // namespace vv
