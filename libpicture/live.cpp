// live.cpp: Implements LiveRenderer. The browser's thread and the render thread share two things:
// `state`, which says who may use the world, and, under `mutex`, the requested frame and the ended
// frames. The settings belong to the browser's thread except while mapping; each frame in flight
// has its own copy in its FrameInFlight. The render thread rebuilds previews (`previews`) when
// their frame has ended; the browser's thread makes display bytes (`display`).
//
// A preview is rebuilt before its frame counts as ended. A thread of its own would not make the
// frame rate higher: rebuilding uses all processors, as rendering does, and with a cluster the
// other frame in flight is rendered by the workers meanwhile.
//
// Longer than 500 lines because both threads work on the state of one frame.
#include "libpicture/live.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "libpicture/live/display.h"
#include "libpicture/live/preview_settings.h"
#include "libpicture/live/previews.h"
#include "libpicture/stage.h"
#include "system/memory.h"

namespace picture {

namespace {

using Purpose = LiveFrame::Purpose;
using Clock = std::chrono::steady_clock;
double between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}
double secondsSince(Clock::time_point start) { return between(start, Clock::now()); }

// Polling a frame takes time from tracing. These limits bound that time, and polls are not more
// frequent than a display shows.
// seconds between polls; pause after a poll, in multiples of its duration
constexpr double minPollInterval = 0.008, pausePerPoll = 8;
constexpr uint32_t shownChannels = RT_RGBA | RT_SAMPLES;
constexpr size_t maxOverlapping = 2;
// Worlds with more triangles are shown by the z-buffer before they are prepared for rays, which
// takes longer (docs/benchmarks.md, "The fast view").
constexpr uint64_t fewTriangles = 200'000;
// Seconds that a preview waits while structures are built, before it shows the world without the
// last changes. Most changes take less.
constexpr double previewPatience = 0.02;
// Poll interval for ended frames while another frame may still be started. The render thread cannot
// block on a frame then.
constexpr std::chrono::milliseconds patience(1);

struct FrameRequest {
  live::ShownFrame facts;
  View view;
  WorldChanges worldChanges;
  Clock::time_point started;
  double denoising = 0; // seconds that the denoiser may take
};

struct MeasureRequest {
  LiveMeasure what;
  RenderSettings settings;
  WorldChanges worldChanges;
};

// A frame that has begun, and the facts that are known only at its start.
struct FrameInFlight {
  live::ShownFrame facts;
  RenderSettings settings;
  Clock::time_point started; // when start() was called
  xvrml::MapStats map;
  std::vector<std::string> names; // the names of a still frame
  live::FrameCamera camera;
  live::WorldStep step;
  double denoising = 0; // seconds that the denoiser may take
  bool behind = false;  // see OpenRTMapper::isBehind()
};

// A frame that has finished or was cancelled.
struct EndedFrame {
  live::ShownFrame facts;
  Picture picture;     // a preview: the rebuilt picture
  RenderResult result; // the picture in it is empty
  // see LivePicture
  double seconds = 0, alone = 0, rebuilding = 0, showing = 0;
  std::string denoisedBy; // see LivePicture
  bool whole = false;
  bool outdated = false; // see LivePicture
};

bool all(const std::vector<float>& samples, float least) {
  return std::all_of(samples.begin(), samples.end(), [least](float s) { return s >= least; });
}

// Returns the settings of a frame. given: those of a still picture.
RenderSettings settingsOf(const RenderSettings& given, const LiveFrame& frame) {
  RenderSettings settings = given;
  settings.width = frame.width;
  settings.height = frame.height;
  settings.samples = frame.samples;
  settings.progressive = given.progressive && frame.samples > 1;
  settings.channels |= shownChannels;
  settings.quality.set(RT_VIEW, int32_t(frame.viewer & 0x7fffffff)); // viewers take turns
  return settings;
}

// Changes the settings of a frame to those of a preview. number: that of the frame.
void makePreview(RenderSettings& settings, Purpose purpose, int lightStride, uint64_t number) {
  settings.channels = shownChannels;
  settings.progressive = false;
  settings.error = settings.timeLimit = 0;
  live::drawFreshSamples(settings, number);
  if (purpose != Purpose::preview) return;
  live::askForGuides(settings);
  settings.quality.set(RT_LIGHT_STRIDE, lightStride);
}

} // namespace

struct LiveRenderer::Impl {
  RenderSettings given; // width, height and samples are overwritten for each frame
  Stage stage;
  const size_t most; // maximum number of frames in flight
  std::atomic<State> state{State::idle};
  std::atomic<size_t> framesInFlight{0}; // number of frames started and not ended
  // the frames in flight are cancelled; none starts until they have ended
  std::atomic<bool> cancelled{false};

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<FrameRequest> requested;
  std::optional<MeasureRequest> toMeasure; // no frame is requested or in flight then
  std::optional<LiveReadings> readings;
  bool ending = false;
  std::shared_ptr<const EndedFrame> lastStill; // the last still frame that ended
  // Ended frames that look() has not returned yet; at most as many as may be in flight.
  std::deque<std::shared_ptr<const EndedFrame>> unpolled;
  std::string failure;
  std::optional<Picture> fastView; // the fast view that look() has not returned yet
  std::vector<uint32_t> left;      // viewers whose accumulated frames are to be freed
  bool released = false;           // those of all viewers are

  // Used by the render thread only.
  std::deque<FrameInFlight> inFlight; // frames in flight, oldest first
  Clock::time_point lastEnd;
  live::WorldSteps steps;
  live::Previews previews;
  std::string unrebuilt;  // why the last preview could not be rebuilt, if that is to be told
  bool rebuilding = true; // false: the last preview could not be rebuilt

  // Used by the browser's thread only.
  live::ShownFrame current; // the frame that was started last
  bool again = false;       // look() returns the last still frame once more
  bool measures = false;    // measure() was called after it
  Clock::time_point started;
  float progress = 0;         // progress of the frame in flight at the last poll
  Clock::time_point nextPoll; // earliest time of the next poll of a frame in flight
  Picture scratch;            // scratch storage of look()
  live::Display display;

  std::thread thread;

  Impl(xvrml::Browser& browser, const RenderSettings& settings)
      : given(settings), stage(browser.world(), &browser, settings),
        most(settings.cluster ? maxOverlapping : 1), previews(settings.threads, settings.denoiser) {
    given.progressive = true;
  }

  // --- The render thread ---
  //
  // Waits for the oldest frame only when no other frame may be started; waiting earlier would delay
  // the newer one.
  void loop();

  // Tells whether kept frames are to be freed. The caller holds the mutex.
  bool isTidying() const { return !left.empty() || (released && isIdle()); }
  bool isIdle() const { return inFlight.empty() && !requested && !toMeasure; }

  // Frees what viewers who have left had accumulated, or all viewers.
  void tidy(std::unique_lock<std::mutex>& lock);

  template <class Work> std::string failureOf(const Work& work) {
    try {
      work();
      return {};
    } catch (const std::bad_alloc&) {
      return "not enough memory";
    } catch (const std::exception& e) { return e.what(); } catch (...) {
      return "the picture could not be rendered";
    }
  }

  // Updates the state after a frame has begun or ended. A frame requested meanwhile keeps its
  // state. The caller holds the mutex.
  void updateState(std::string wrong);
  void begin(FrameRequest frame);

  // Applies changes of the world to the context, which is made anew where there is none.
  // patient: see Stage::apply().
  void apply(WorldChanges worldChanges, bool patient);

  // Reads sensors.
  std::vector<Measurement> read(MeasureRequest request);

  // Draws the world by the z-buffer for look(). The picture is left out if it fails.
  void drawFastView(const FrameRequest& frame);

  // Maps the world for a frame. All references to nodes are released when this returns, because the
  // browser uses the nodes from then on.
  void map(FrameRequest frame);

  // Waits for the oldest frame and returns it; null: a preview that was cancelled.
  std::shared_ptr<const EndedFrame> finish();

  // Replaces the samples of a preview by the rebuilt picture. If that fails, the samples are shown
  // as they are, and the reason is told once until it succeeds again.
  void rebuild(const FrameInFlight& flight, EndedFrame& frame);

  // --- The browser's thread ---
  State now() const;
  void cancel();
  std::shared_ptr<const EndedFrame> still();
  std::shared_ptr<const EndedFrame> nextUnpolled();

  // Tells whether the frame in flight is the one that was started last, so that the stage has its
  // settings.
  bool alone() const;
  uint64_t start(const LiveFrame& frame);
  void measure(const LiveMeasure& measure);
  void end();
  void forget(uint32_t viewer);
  void release();

  void show(const Picture& picture, const live::ShownFrame& frame, bool whole, double seconds,
            LivePicture& out);
  bool takeFastView(LivePicture& out);
  bool look(LivePicture& out);
  bool recolour(uint64_t number, std::optional<double> falseColour);

  // Returns the frame in flight, if it has new samples.
  bool pollInFlight(LivePicture& out);

  bool copy(Picture& out, uint64_t* number);
};

void LiveRenderer::Impl::loop() {
  const auto hasWork = [this] { return requested || toMeasure || ending || isTidying(); };
  std::unique_lock lock(mutex);
  while (!ending) {
    if (isTidying()) {
      tidy(lock);
    } else if (requested) {
      FrameRequest frame = *std::exchange(requested, {});
      lock.unlock();
      std::string wrong = failureOf([&] { begin(std::move(frame)); });
      if (!wrong.empty()) steps.beginAnew(); // what the next frame's RT_MOTION means is unknown
      lock.lock();
      updateState(std::move(wrong));
    } else if (toMeasure) {
      MeasureRequest request = *std::exchange(toMeasure, {});
      lock.unlock();
      LiveReadings made;
      made.failure = failureOf([&] { made.sensors = read(std::move(request)); });
      lock.lock();
      readings = std::move(made);
      updateState({});
    } else if (inFlight.empty()) {
      changed.wait(lock, hasWork);
    } else if (inFlight.size() < most && !cancelled && rtProgress(stage.context()) < 1) {
      changed.wait_for(lock, patience, hasWork);
    } else {
      lock.unlock();
      std::shared_ptr<const EndedFrame> result;
      std::string wrong = failureOf([&] { result = finish(); });
      if (wrong.empty()) wrong = std::exchange(unrebuilt, {});
      lock.lock();
      if (result) {
        if (result->facts.purpose == Purpose::still) lastStill = result;
        unpolled.push_back(std::move(result));
        if (unpolled.size() > most) unpolled.pop_front();
      }
      updateState(std::move(wrong));
    }
  }
  lock.unlock();
  stage.close();
}

void LiveRenderer::Impl::tidy(std::unique_lock<std::mutex>& lock) {
  const std::vector<uint32_t> viewers = std::exchange(left, {});
  const bool all = isIdle() && std::exchange(released, false);
  lock.unlock();
  for (const uint32_t viewer : viewers) previews.forget(viewer);
  if (all) {
    previews.forgetAll();
    os::giveBackMemory();
  }
  lock.lock();
}

void LiveRenderer::Impl::updateState(std::string wrong) {
  if (!wrong.empty()) failure = std::move(wrong);
  framesInFlight = inFlight.size() + (requested ? 1 : 0);
  if (requested) return;
  const State now = inFlight.empty()         ? State::idle
                    : inFlight.size() < most ? State::ready
                                             : State::rendering;
  state.store(now, std::memory_order_release);
}

void LiveRenderer::Impl::begin(FrameRequest frame) {
  FrameInFlight flight{frame.facts, stage.settings, frame.started, {}, {}, {}, {}, frame.denoising};
  try {
    map(std::move(frame));
    flight.map = stage.mapper()->stats();
    flight.behind = stage.mapper()->isBehind();
    flight.camera = {stage.shown(), double(flight.settings.width) / flight.settings.height,
                     flight.settings.background.kind == Background::Kind::file};
    if (flight.facts.purpose == Purpose::still && hasNames(flight.settings.channels))
      flight.names = stage.mapper()->names();
  } catch (...) { // the world is only half mapped: the next frame starts with a new context
    stage.close();
    inFlight.clear();
    throw;
  }
  state.store(State::rendering, std::memory_order_release);
  if (cancelled) return; // cancelled before it began
  rtSwapBuffers();
  throwOnError("rendering");
  flight.step = steps.begin(flight.facts.viewer);
  inFlight.push_back(std::move(flight));
  if (cancelled) stage.cancel(); // a cancellation that came before the frame existed
}

void LiveRenderer::Impl::apply(WorldChanges worldChanges, bool patient) {
  if (!stage.context() || worldChanges.otherWorld)
    steps.beginAnew();
  else if (!worldChanges.changes.empty())
    steps.change();
  if (!stage.context()) {
    stage.open([this] { return cancelled.load(); });
    worldChanges.changes.clear(); // the new mapper already contains them
    worldChanges.otherWorld = false;
  }
  stage.apply(worldChanges, patient);
}

void LiveRenderer::Impl::drawFastView(const FrameRequest& frame) {
  const std::string wrong = failureOf([&] {
    stage.place(frame.view);
    Picture picture;
    stage.rasterize(picture);
    const std::lock_guard lock(mutex);
    fastView = std::move(picture);
  });
  if (!wrong.empty()) stage.warn("the fast view cannot be drawn: " + wrong);
}

void LiveRenderer::Impl::map(FrameRequest frame) {
  const bool otherWorld = !stage.context() || frame.worldChanges.otherWorld;
  const bool still = frame.facts.purpose == Purpose::still;
  apply(std::move(frame.worldChanges), !still && !given.cluster && given.record.empty());
  if (otherWorld && !frame.facts.falseColour && stage.mapper()->stats().triangles > fewTriangles)
    drawFastView(frame);
  const uint64_t moved = stage.mapper()->stats().instancesMoved;
  stage.prepare(frame.view);
  // Billboards follow the camera, without a change of the world's.
  if (stage.mapper()->stats().instancesMoved != moved) steps.change();
  stage.setUpFrame();
  rtQuality(RT_FRAMES_IN_FLIGHT, int(most)); // so that rtSwapBuffers waits for none of them
  rtQualityf(RT_PATIENCE, still ? 0 : previewPatience);
}

std::vector<Measurement> LiveRenderer::Impl::read(MeasureRequest request) {
  std::vector<PlacedSensor> sensors = std::move(request.what.sensors);
  try {
    apply(std::move(request.worldChanges), false);
    stage.prepareSensors(request.what.view);
    rtQualityf(RT_PATIENCE, 0);
    steps.beginAnew(); // RT_MOTION of the next frame begins here
    if (sensors.empty()) sensors = stage.placeSensors();
  } catch (const SensorError&) {
    throw;        // the world is mapped; a sensor has wrong fields
  } catch (...) { // as in begin()
    stage.close();
    throw;
  }
  state.store(State::rendering, std::memory_order_release);
  std::vector<Measurement> out = stage.measure(sensors, request.settings, cancelled);
  if (cancelled) throw std::runtime_error("the measurement was cancelled");
  return out;
}

std::shared_ptr<const EndedFrame> LiveRenderer::Impl::finish() {
  FrameInFlight flight = std::move(inFlight.front());
  inFlight.pop_front();
  rtFinishFrame();
  throwOnError("rendering");
  auto result = std::make_shared<EndedFrame>();
  result->facts = flight.facts;
  // The estimate of the error takes much memory for a moment, so no other picture is kept then.
  if (flight.facts.purpose == Purpose::still) {
    const std::lock_guard lock(mutex);
    lastStill = nullptr;
  }
  stage.describe(flight.settings, result->result);
  result->outdated = flight.behind || result->result.stats.outdated != 0;
  if (result->outdated) steps.change(); // the next frame shows more of the world
  result->picture.names = std::move(flight.names);
  stage.readChannels(flight.settings, result->picture);
  result->result.map = flight.map;
  result->whole =
      !cancelled || all(result->picture.planes.at(RT_SAMPLES), float(flight.settings.samples));
  const bool still = flight.facts.purpose == Purpose::still;
  if (flight.facts.purpose == Purpose::preview && result->whole) rebuild(flight, *result);
  if (still && result->whole) previews.forget(flight.facts.viewer);
  const Clock::time_point end = Clock::now();
  result->seconds = between(flight.started, end);
  result->alone =
      between(std::max(flight.started, lastEnd), inFlight.empty() ? end : inFlight.front().started);
  lastEnd = end;
  return still || result->whole ? result : nullptr;
}

void LiveRenderer::Impl::rebuild(const FrameInFlight& flight, EndedFrame& frame) {
  const Clock::time_point begin = Clock::now();
  const std::string wrong = failureOf([&] {
    Picture rebuilt = previews.rebuild(flight.facts.viewer, frame.picture, flight.camera,
                                       flight.facts.lightStride, flight.step, flight.denoising,
                                       {flight.facts.shownWidth, flight.facts.shownHeight});
    frame.denoisedBy = previews.denoisedBy();
    frame.showing = previews.showing();
    // Every pixel is covered, also where no sample has been taken.
    const std::vector<float>& samples = frame.picture.planes[RT_SAMPLES];
    const double sum = std::accumulate(samples.begin(), samples.end(), 0.0);
    rebuilt.planes[RT_SAMPLES].assign(size_t(rebuilt.width) * size_t(rebuilt.height),
                                      float(sum / double(samples.size())));
    frame.picture = std::move(rebuilt);
  });
  frame.rebuilding = secondsSince(begin);
  if (const std::string problem = previews.takeProblem(); !problem.empty()) stage.warn(problem);
  if (!wrong.empty()) frame.facts.purpose = Purpose::rawPreview;
  if (!wrong.empty() && rebuilding) unrebuilt = "the preview cannot be rebuilt: " + wrong;
  rebuilding = wrong.empty();
}

LiveRenderer::State LiveRenderer::Impl::now() const {
  const State now = state.load(std::memory_order_acquire);
  return now == State::ready && cancelled ? State::rendering : now;
}

void LiveRenderer::Impl::cancel() {
  cancelled = true;
  stage.cancel();
}

std::shared_ptr<const EndedFrame> LiveRenderer::Impl::still() {
  const std::lock_guard lock(mutex);
  return lastStill;
}

std::shared_ptr<const EndedFrame> LiveRenderer::Impl::nextUnpolled() {
  const std::lock_guard lock(mutex);
  if (unpolled.empty()) return nullptr;
  std::shared_ptr<const EndedFrame> next = std::move(unpolled.front());
  unpolled.pop_front();
  return next;
}

bool LiveRenderer::Impl::alone() const {
  const State now = state.load(std::memory_order_acquire);
  return (now == State::rendering || now == State::ready) && framesInFlight == 1 && !measures;
}

uint64_t LiveRenderer::Impl::start(const LiveFrame& frame) {
  if (now() != State::idle && now() != State::ready) throw std::logic_error("a frame is in flight");
  stage.reportMessages();
  current = {current.number + 1, frame.purpose,     frame.viewer,     frame.samples,
             frame.lightStride,  frame.falseColour, frame.shownWidth, frame.shownHeight,
             frame.width,        frame.height};
  again = measures = false;
  stage.settings = settingsOf(given, frame);
  if (frame.purpose != Purpose::still)
    makePreview(stage.settings, frame.purpose, frame.lightStride, current.number);
  started = Clock::now();
  progress = 0;
  nextPoll = {};
  cancelled = false;
  FrameRequest next{current, frame.view, stage.collectChanges(), started, frame.denoising};
  {
    const std::lock_guard lock(mutex);
    failure.clear();
    requested = std::move(next);
    fastView.reset();
    framesInFlight++;
    state = State::mapping;
  }
  changed.notify_all();
  return current.number;
}

void LiveRenderer::Impl::measure(const LiveMeasure& measure) {
  if (now() != State::idle) throw std::logic_error("a frame is in flight");
  stage.reportMessages();
  measures = true;
  stage.settings = given;
  stage.settings.samples = measure.samples;
  cancelled = false;
  MeasureRequest next{measure, stage.settings, stage.collectChanges()};
  {
    const std::lock_guard lock(mutex);
    toMeasure = std::move(next);
    readings.reset();
    framesInFlight++;
    state = State::mapping;
  }
  changed.notify_all();
}

void LiveRenderer::Impl::end() {
  {
    const std::lock_guard lock(mutex);
    ending = true;
  }
  cancel();
  changed.notify_all();
  thread.join();
}

void LiveRenderer::Impl::forget(uint32_t viewer) {
  display.forget(viewer);
  {
    const std::lock_guard lock(mutex);
    left.push_back(viewer);
  }
  changed.notify_all();
}

void LiveRenderer::Impl::release() {
  display = {};
  scratch = {};
  {
    const std::lock_guard lock(mutex);
    lastStill = nullptr;
    unpolled.clear();
    released = true;
  }
  changed.notify_all();
}

void LiveRenderer::Impl::show(const Picture& picture, const live::ShownFrame& frame, bool whole,
                              double seconds, LivePicture& out) {
  out = {};
  out.number = frame.number;
  out.purpose = frame.purpose;
  out.lightStride = frame.lightStride;
  out.seconds = seconds;
  out.finished = whole;
  display.show(picture, frame, whole, seconds, out);
  out.width = frame.width;
  out.height = frame.height;
}

bool LiveRenderer::Impl::takeFastView(LivePicture& out) {
  std::optional<Picture> picture;
  {
    const std::lock_guard lock(mutex);
    picture = std::exchange(fastView, {});
  }
  if (!picture) return false;
  out = {};
  out.width = out.shownWidth = picture->width;
  out.height = out.shownHeight = picture->height;
  out.rgb = displayBytes(*picture);
  out.number = current.number;
  out.purpose = current.purpose;
  out.seconds = secondsSince(started);
  out.preview = out.raster = true;
  return true;
}

bool LiveRenderer::Impl::look(LivePicture& out) {
  if (now() != State::mapping) stage.reportMessages(); // the mapper adds messages, too
  if (takeFastView(out)) return true;
  std::shared_ptr<const EndedFrame> finished = nextUnpolled();
  if (!finished && std::exchange(again, false)) finished = still();
  if (!finished) return alone() && pollInFlight(out);
  scratch = {}; // the next frame may be long in coming
  live::ShownFrame facts = finished->facts;
  if (facts.number == current.number) facts.falseColour = current.falseColour;
  show(finished->picture, facts, finished->whole, finished->seconds, out);
  out.alone = finished->alone;
  out.ended = true;
  out.outdated = finished->outdated;
  out.rebuilding = finished->rebuilding;
  out.showing = finished->showing;
  out.denoisedBy = finished->denoisedBy;
  out.overhead =
      std::max(0.0, finished->seconds - finished->rebuilding - finished->result.stats.time.render);
  out.map = finished->result.map;
  out.stats = finished->result.stats;
  return true;
}

bool LiveRenderer::Impl::recolour(uint64_t number, std::optional<double> falseColour) {
  const std::shared_ptr<const EndedFrame> finished = still();
  if (number != current.number || !finished || finished->facts.number != number || !finished->whole)
    return false;
  current.falseColour = falseColour;
  return again = true;
}

bool LiveRenderer::Impl::pollInFlight(LivePicture& out) {
  const Clock::time_point begin = Clock::now();
  if (current.purpose == Purpose::preview || begin < nextPoll) return false;
  const RTcontext context = stage.context();
  const float now = rtProgress(context);
  if (now <= progress || !stage.snapshot(scratch, shownChannels)) return false;
  if (now < 1) progress = now; // progress is also 1 before the frame has begun
  if (!std::any_of(scratch.planes[RT_SAMPLES].begin(), scratch.planes[RT_SAMPLES].end(),
                   [](float s) { return s > 0; }))
    return false;
  show(scratch, current, false, secondsSince(started), out);
  const double took = secondsSince(begin), rest = std::max(minPollInterval, pausePerPoll * took);
  nextPoll = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(rest));
  return true;
}

bool LiveRenderer::Impl::copy(Picture& out, uint64_t* number) {
  const std::shared_ptr<const EndedFrame> finished = still();
  const bool begun =
      current.purpose == Purpose::still && alone() && stage.snapshot(out, stage.settings.channels);
  uint64_t copied = current.number;
  if (!begun || (finished && !all(out.planes[RT_SAMPLES], 1))) {
    if (!finished) return false;
    out = finished->picture;
    copied = finished->facts.number;
  }
  if (number) *number = copied;
  if (!(given.channels & RT_SAMPLES)) out.planes.erase(RT_SAMPLES);
  if (!(given.channels & RT_RGBA)) out.planes.erase(RT_RGBA);
  return true;
}

LiveRenderer::LiveRenderer(xvrml::Browser& browser, const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(browser, settings)) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->loop(); });
}

LiveRenderer::~LiveRenderer() { impl_->end(); }

LiveRenderer::State LiveRenderer::state() const { return impl_->now(); }

uint64_t LiveRenderer::start(const LiveFrame& frame) { return impl_->start(frame); }

void LiveRenderer::measure(const LiveMeasure& measure) { impl_->measure(measure); }

std::optional<LiveReadings> LiveRenderer::takeReadings() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->readings, std::nullopt);
}

void LiveRenderer::cancel() {
  if (impl_->state != State::idle) impl_->cancel();
}

bool LiveRenderer::look(LivePicture& picture) { return impl_->look(picture); }

bool LiveRenderer::recolour(uint64_t number, std::optional<double> falseColour) {
  return impl_->recolour(number, falseColour);
}

bool LiveRenderer::copy(Picture& picture, uint64_t* number) { return impl_->copy(picture, number); }

void LiveRenderer::forget(uint32_t viewer) { impl_->forget(viewer); }

void LiveRenderer::release() { impl_->release(); }

void LiveRenderer::change(const std::function<void(RenderSettings&)>& change) {
  change(impl_->given);
}

const std::vector<xvrml::ViewpointInfo>& LiveRenderer::viewpoints() const {
  static const std::vector<xvrml::ViewpointInfo> none;
  return impl_->stage.mapper() ? impl_->stage.mapper()->viewpoints() : none;
}

xvrml::Bounds LiveRenderer::bounds() const {
  return impl_->stage.mapper() ? impl_->stage.mapper()->bounds() : xvrml::Bounds{};
}

xvrml::CameraSettings LiveRenderer::cameraOf(const View& view, double aspect) const {
  return impl_->stage.mapper() ? chooseCamera(*impl_->stage.mapper(), view, aspect)
                               : xvrml::CameraSettings{};
}

bool LiveRenderer::leavesViewpointOut(const View& view, double aspect) const {
  return impl_->stage.mapper() && picture::leavesViewpointOut(*impl_->stage.mapper(), view, aspect);
}

xvrml::CameraSettings LiveRenderer::cameraAround(const xvrml::CameraSettings& camera,
                                                 double aspect) const {
  return impl_->stage.mapper()
             ? impl_->stage.mapper()->cameraAround(camera.matrix, camera.fovy, aspect)
             : camera;
}

xvrml::Axis LiveRenderer::upOf(const View& view) const {
  return impl_->stage.mapper() ? picture::upOf(*impl_->stage.mapper(), view) : xvrml::Axis::y;
}

std::string LiveRenderer::takeFailure() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->failure, {});
}

} // namespace picture
