#include "session/picture_loop.h"

#include <algorithm>
#include <cstring>

namespace vv {

namespace {

using Purpose = picture::LiveFrame::Purpose;

// Seconds in which previews still follow each other when nothing moves any more. They are larger
// and accumulate, so that the still picture begins over a good one.
constexpr double settlingTime = 0.35;

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
         (isRefining() && (frame_.width != width_ || frame_.height != height_));
}

// A world without sampled light needs no larger preview than one of full size.
bool PictureLoop::isSettled(double now) const {
  if (motion_ == Motion::samples) return true;
  if (phase_ == Phase::settling) return now >= settlingEnds_;
  return picture::lightOf(facts_.stats, true) == picture::Pacing::Light::direct &&
         frame_.width >= width_ && frame_.height >= height_;
}

// Moving frames overlap where the renderer permits it. A frame of what has stopped is cancelled
// instead, but not before the first picture, so that it comes early.
PictureLoop::Decision PictureLoop::decide(bool outdated, const Fit& fit, double now,
                                          Need need) const {
  const RendererState state = renderer_.state();
  const Decision following = need == Need::stillPicture ? Decision::refine : Decision::move;
  switch (state) {
  case RendererState::mapping: return Decision::wait;
  case RendererState::rendering:
  case RendererState::ready:
    if (!outdated) return Decision::wait;
    if (isMoving()) return state == RendererState::ready ? following : Decision::wait;
    return hasShown() || fit.isWanted() ? Decision::cancel : Decision::wait;
  case RendererState::idle: break;
  }
  if (outdated || cancelled_) return following;
  if (isRefining() && !(isStillLost_ && need == Need::stillPicture)) return Decision::wait;
  if (need == Need::stillPicture) return Decision::refine;
  return isSettled(now) ? Decision::refine : Decision::settle;
}

void PictureLoop::advance(const Pilot& pilot, Fit& fit, double now, Need need) {
  if (width_ <= 0) return;
  if (taker_.isBusy()) return advanceStill(pilot, fit);
  if (!watched_ && hasShown()) return;
  switch (decide(isOutdated(pilot, fit), fit, now, need)) {
  case Decision::wait: break;
  case Decision::cancel:
    renderer_.cancel();
    cancelled_ = true;
    break;
  case Decision::move: start(Phase::moving, pilot, fit, now); break;
  case Decision::settle:
    if (isMoving()) settlingEnds_ = now + settlingTime;
    start(Phase::settling, pilot, fit, now);
    break;
  case Decision::refine: start(Phase::refining, pilot, fit, now); break;
  }
}

bool PictureLoop::isDrawing() const {
  const RendererState state = renderer_.state();
  return isMoving() && (state == RendererState::mapping || state == RendererState::rendering);
}

bool PictureLoop::copyStill(picture::Picture& picture) {
  uint64_t number = 0;
  return hasStill() && renderer_.copy(picture, &number) && number == number_;
}

bool PictureLoop::isFinished(const Pilot& pilot) const {
  return isRefining() && still_ == Progress::finished && isIdle() && !browser_.hasChanges() &&
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

picture::FrameSize PictureLoop::sizeOf(Phase phase) {
  const int samples = options_.render.samples;
  if (phase == Phase::settling) return pacing_.settle(width_, height_, samples);
  return pacing_.next(width_, height_, phase == Phase::moving, samples,
                      picture::lightOf(facts_.stats, motion_ == Motion::rebuilt));
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
  frame_ = sizeOf(phase);
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = frame_.samples;
  frame.lightStride = frame_.lightStride;
  frame.purpose = phase == Phase::refining     ? Purpose::still
                  : motion_ == Motion::rebuilt ? Purpose::preview
                                               : Purpose::rawPreview;
  still_ = Progress::none;
  isStillLost_ = false;
  cancelled_ = false;
  if (hasStarted()) phase_ = phase; // even if the renderer throws; a first frame is tried again
  number_ = renderer_.start(frame);
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
  if (taker_.isRendering()) return;
  if (!isIdle()) {
    renderer_.cancel();
    cancelled_ = true;
    return;
  }
  followHeadlight(pilot);
  taker_.start([&](double aspect) { return stillViewOf(pilot, aspect); });
  still_ = Progress::none;
  isStillLost_ = true;
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

bool PictureLoop::look(picture::LivePicture& picture) {
  if (taker_.isRendering()) {
    taker_.look();
    return false;
  }
  if (!renderer_.look(picture)) return false;
  // Partial pictures are not shown over the previous one while something moves: that would tear.
  const bool shown = picture.finished || !hasShown() || !isMoving();
  shown_ = Shown::something;
  failure_.clear();
  facts_.width = picture.width;
  facts_.height = picture.height;
  facts_.samples = picture.samples;
  facts_.finished = picture.finished;
  facts_.preview = picture.preview;
  facts_.purpose = picture.purpose;
  if (picture.purpose == Purpose::still && picture.number == number_ && picture.covered == 1)
    still_ = picture.finished ? Progress::finished : Progress::covered;
  if (picture.finished) {
    pacing_.took({picture.width, picture.height, 1, picture.lightStride}, picture.seconds,
                 picture.alone, picture.overhead, picture.samples, picture.rebuilding);
    facts_.stats = picture.stats;
    facts_.map = picture.map;
  }
  return shown;
}

// A failure of many frames in a row is told once.
std::string PictureLoop::takeFailure() {
  if (taker_.isRendering()) return {}; // the failure belongs to a program
  std::string failure = renderer_.takeFailure();
  if (failure == failure_) return {};
  return failure.empty() ? failure : failure_ = std::move(failure);
}

} // namespace vv
