#include "session/picture_loop.h"

#include <algorithm>
#include <cmath>

#include "libpicture/live/denoise_choice.h"
#include "libpicture/pixel_reading.h"

namespace vv {

namespace {

using Purpose = picture::LiveFrame::Purpose;

// Seconds in which previews still follow each other when nothing moves any more. They are larger
// and accumulate, so that the still picture begins over a good one.
constexpr double settlingTime = 0.35;

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
  return phase_ == Phase::unstarted || fit.isWanted() || pilot.camera() != camera_ ||
         (isBehind_ && !isRefining()) || shared_.isOutdated(world_) ||
         pilot.headlight() != headlight_ || pilot.exposure() != exposure_ ||
         pilot.falseColour() != falseColour_ ||
         (isRefining() && (frame_.width != width_ || frame_.height != height_));
}

// A world without sampled light needs no better preview than one of full size with light
// everywhere.
bool PictureLoop::isSettled(double now) const {
  if (motion_ == Motion::samples) return true;
  if (phase_ == Phase::settling) return now >= settlingEnds_;
  return picture::lightOf(facts_.stats, false) == picture::Pacing::Light::direct &&
         frame_.width >= previewSide(width_) && frame_.height >= previewSide(height_) &&
         frame_.lightStride == 1;
}

bool PictureLoop::isInterrupted() const {
  return isRefining() && still_ != Progress::finished && shared_.cancellations() != cancellations_;
}

PictureLoop::Urgency PictureLoop::urgency(const Pilot& pilot, const Fit& fit) const {
  if (width_ <= 0) return Urgency::nothing;
  if (cancelled_ || isOutdated(pilot, fit)) return Urgency::change;
  return isRefining() && !isInterrupted() ? Urgency::nothing : Urgency::quality;
}

// Moving frames overlap where the renderer permits it. A frame of what has stopped is cancelled
// instead, but not before the first picture, so that it comes early. That holds for the frames of
// other viewers, too.
PictureLoop::Decision PictureLoop::decide(bool outdated, const Fit& fit, double now,
                                          Need need) const {
  const RendererState state = renderer_.state();
  const Decision following = need == Need::stillPicture ? Decision::refine : Decision::move;
  switch (state) {
  case RendererState::mapping: return Decision::wait;
  case RendererState::rendering:
  case RendererState::ready:
    if (!outdated) return Decision::wait;
    if (shared_.isMoving()) return state == RendererState::ready ? following : Decision::wait;
    return shared_.viewer() != viewer_ || hasShown() || fit.isWanted() ? Decision::cancel
                                                                       : Decision::wait;
  case RendererState::idle: break;
  }
  if (outdated || cancelled_) return following;
  if (isRefining() && !isInterrupted() && !(isStillLost_ && need == Need::stillPicture))
    return Decision::wait;
  if (isInterrupted() || need == Need::stillPicture) return Decision::refine;
  return isSettled(now) ? Decision::refine : Decision::settle;
}

void PictureLoop::advance(const Pilot& pilot, Fit& fit, double now, Need need) {
  if (width_ <= 0) return;
  if (taker_.isBusy()) return advanceStill(pilot, fit);
  if (!watched_ && hasShown()) return;
  // The values of a finished picture are there: other colours of them need no frame.
  if (pilot.falseColour() != falseColour_ && isFinished(pilot) &&
      renderer_.recolour(number_, pilot.falseColour()))
    falseColour_ = pilot.falseColour();
  switch (decide(isOutdated(pilot, fit), fit, now, need)) {
  case Decision::wait: break;
  case Decision::cancel:
    shared_.cancel();
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

void PictureLoop::wantReadings(Readings when) {
  readings_ = picture::readingChannels;
  if (when == Readings::later || std::exchange(isReadable_, true)) return;
  shared_.cancel(); // the frame in flight, or the last one, does not have them
  cancelled_ = true;
}

bool PictureLoop::isFinished(const Pilot& pilot) const {
  return isRefining() && still_ == Progress::finished && !shared_.isOutdated(world_) &&
         pilot.camera() == camera_;
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

xvrml::MapOptions::Headlight PictureLoop::headlightOf(const Pilot& pilot) const {
  const auto on = xvrml::MapOptions::Headlight::on, off = xvrml::MapOptions::Headlight::off;
  const std::optional<bool> chosen = pilot.headlight();
  return !chosen ? options_.render.headlight : *chosen ? on : off;
}

picture::ViewTransform PictureLoop::transformOf(const Pilot& pilot) const {
  picture::ViewTransform view = shared_.view;
  view.exposure =
      std::clamp(view.exposure + pilot.exposure(), -picture::mostExposure, picture::mostExposure);
  return view;
}

// The renderer still has these of its last frame, which may have been another viewer's.
void PictureLoop::followHeadlight(const Pilot& pilot) {
  headlight_ = pilot.headlight();
  exposure_ = pilot.exposure();
  renderer_.change([&](picture::RenderSettings& s) {
    s.headlight = headlightOf(pilot);
    s.channels |= readings_;
    s.view = transformOf(pilot);
  });
}

picture::LiveFrame PictureLoop::stillOf(const Pilot& pilot) const {
  picture::LiveFrame frame;
  frame.view.shader = options_.view.shader;
  frame.view.viewer = pilot.camera();
  frame.width = width_;
  frame.height = height_;
  frame.samples = options_.render.samples;
  frame.viewer = viewer_;
  return frame;
}

picture::FrameSize PictureLoop::sizeOf(Phase phase) {
  const int samples = options_.render.samples;
  if (phase == Phase::settling)
    return pacing_.settle(previewSide(width_), previewSide(height_), samples);
  const auto light = picture::lightOf(facts_.stats, motion_ == Motion::rebuilt);
  if (phase == Phase::moving)
    return pacing_.next(previewSide(width_), previewSide(height_), true, samples, light);
  return pacing_.next(width_, height_, false, samples, light);
}

int PictureLoop::previewSide(int side) const {
  const double pixels = double(width_) * height_;
  if (!(mostPreviewPixels_ > 0) || pixels <= mostPreviewPixels_) return side;
  return std::max(1, int(side * std::sqrt(mostPreviewPixels_ / pixels)));
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
  if (moving && !isMoving()) motionBegan_ = now;
  lastStart_ = now;
  frame_ = sizeOf(phase);
  frame.width = frame_.width;
  frame.height = frame_.height;
  frame.samples = frame_.samples;
  frame.lightStride = frame_.lightStride;
  frame.denoising =
      moving ? picture::live::denoisingInMotion(options_.fps) : picture::live::denoisingAtRest;
  frame.purpose = phase == Phase::refining     ? Purpose::still
                  : motion_ == Motion::rebuilt ? Purpose::preview
                                               : Purpose::rawPreview;
  frame.viewer = viewer_;
  frame.falseColour = falseColour_ = pilot.falseColour();
  const picture::FrameSize shown = pacing_.shown(previewSide(width_), previewSide(height_));
  frame.shownWidth = shown.width;
  frame.shownHeight = shown.height;
  still_ = Progress::none;
  isStillLost_ = false;
  cancelled_ = false;
  isReadable_ = readings_ != 0;
  cancellations_ = shared_.cancellations();
  if (hasStarted()) phase_ = phase; // even if the renderer throws; a first frame is tried again
  number_ = shared_.start(frame, moving);
  world_ = shared_.world();
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
  if (!shared_.isIdle()) {
    shared_.cancel();
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
    pilot.frameAll(renderer_.cameraAround(pilot.camera(), pilot.aspect()));
  fit.end();
  return true;
}

bool PictureLoop::lookForStill() {
  if (!taker_.isRendering()) return false;
  taker_.look();
  return true;
}

bool PictureLoop::note(const picture::LivePicture& picture) {
  if (picture.raster) return !hasShown(); // the first picture of the frame is still to come
  // Partial pictures are not shown over the previous one while something moves: that would tear.
  const bool shown = picture.finished || !hasShown() || !isMoving();
  shown_ = Shown::something;
  failure_.clear();
  facts_.width = picture.width;
  facts_.height = picture.height;
  facts_.samples = picture.samples;
  facts_.finished = picture.finished;
  facts_.preview = picture.preview;
  facts_.denoisedBy = picture.denoisedBy;
  facts_.purpose = picture.purpose;
  facts_.scaleEnd = picture.scaleEnd;
  if (picture.purpose == Purpose::still && picture.number == number_ && picture.covered == 1)
    still_ = picture.finished ? Progress::finished : Progress::covered;
  if (picture.finished) {
    isBehind_ = picture.outdated;
    pacing_.took({picture.width, picture.height, 1, picture.lightStride}, picture.seconds,
                 picture.alone, picture.overhead, picture.samples, picture.rebuilding,
                 picture.showing);
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
