// live.cpp: Implements LiveRenderer. The browser's thread and the render thread share two things:
// `state`, which says who may use the world, and, under `mutex`, the requested frame and the ended
// frames. The settings belong to the browser's thread except while mapping; each frame in flight
// has its own copy in its FrameInFlight.
#include "libpicture/live.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "libpicture/stage.h"

namespace picture {

namespace {

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
// Poll interval for ended frames while another frame may still be started. The render thread cannot
// block on a frame then.
constexpr std::chrono::milliseconds patience(1);

struct FrameRequest {
  LiveFrame frame;
  WorldChanges worldChanges;
  Clock::time_point started;
};

// A frame that has begun, and the facts that are known only at its start.
struct FrameInFlight {
  RenderSettings settings;
  uint32_t viewer;
  Clock::time_point started; // when start() was called
  xvrml::MapStats map;
  std::vector<std::string> names;
};

// A frame that has finished or was cancelled.
struct EndedFrame {
  Picture picture;
  RenderResult result;           // the picture in it is empty
  double seconds = 0, alone = 0; // see LivePicture
  uint32_t viewer = 0;
  bool whole = false;
};

bool all(const std::vector<float>& samples, float least) {
  return std::all_of(samples.begin(), samples.end(), [least](float s) { return s >= least; });
}

// Fills pixels without a sample from the same place of the previous picture, whatever its size.
void fillFrom(const LivePicture& before, const std::vector<float>& samples, LivePicture& out) {
  if (before.rgb.empty()) return;
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const size_t pixel = size_t(y) * size_t(out.width) + size_t(x);
      if (samples[pixel] > 0) continue;
      const size_t row = size_t(y) * size_t(before.height) / size_t(out.height);
      const size_t from =
          row * size_t(before.width) + size_t(x) * size_t(before.width) / size_t(out.width);
      std::copy_n(before.rgb.begin() + std::ptrdiff_t(3 * from), 3,
                  out.rgb.begin() + std::ptrdiff_t(3 * pixel));
    }
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
  bool ending = false;
  std::shared_ptr<const EndedFrame> lastEnded; // the last frame that ended
  // Ended frames that look() has not returned yet; at most as many as may be in flight.
  std::deque<std::shared_ptr<const EndedFrame>> unpolled;
  std::string failure;

  // Used by the render thread only.
  std::deque<FrameInFlight> inFlight; // frames in flight, oldest first
  Clock::time_point lastEnd;

  // Used by the browser's thread only.
  Clock::time_point started;
  float progress = 0;         // progress of the frame in flight at the last poll
  Clock::time_point nextPoll; // earliest time of the next poll of a frame in flight
  Picture scratch;            // scratch storage of look()
  uint32_t viewer = 0;        // of the frame that was started last
  // For each viewer: size and rgb of the last picture that look() returned.
  std::map<uint32_t, LivePicture> before;

  std::thread thread;

  Impl(xvrml::Browser& browser, const RenderSettings& settings)
      : given(settings), stage(browser.world(), &browser, settings),
        most(settings.cluster ? maxOverlapping : 1) {
    given.progressive = true;
  }

  // --- The render thread ---
  //
  // Waits for the oldest frame only when no other frame may be started; waiting earlier would delay
  // the newer one.
  void loop() {
    const auto hasWork = [this] { return requested || ending; };
    std::unique_lock lock(mutex);
    while (!ending) {
      if (requested) {
        FrameRequest frame = *std::exchange(requested, {});
        lock.unlock();
        std::string wrong = failureOf([&] { begin(std::move(frame)); });
        lock.lock();
        updateState(std::move(wrong));
      } else if (inFlight.empty()) {
        changed.wait(lock, hasWork);
      } else if (inFlight.size() < most && !cancelled && rtProgress(stage.context()) < 1) {
        changed.wait_for(lock, patience, hasWork);
      } else {
        lock.unlock();
        std::shared_ptr<const EndedFrame> result;
        std::string wrong = failureOf([&] { result = finish(); });
        lock.lock();
        if (result) {
          lastEnded = result;
          unpolled.push_back(std::move(result));
          if (unpolled.size() > most) unpolled.pop_front();
        }
        updateState(std::move(wrong));
      }
    }
    lock.unlock();
    stage.close();
  }

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
  void updateState(std::string wrong) {
    if (!wrong.empty()) failure = std::move(wrong);
    framesInFlight = inFlight.size() + (requested ? 1 : 0);
    if (requested) return;
    const State now = inFlight.empty()         ? State::idle
                      : inFlight.size() < most ? State::ready
                                               : State::rendering;
    state.store(now, std::memory_order_release);
  }

  void begin(FrameRequest frame) {
    FrameInFlight flight{stage.settings, frame.frame.viewer, frame.started, {}, {}};
    try {
      map(std::move(frame));
      flight.map = stage.mapper()->stats();
      if (flight.settings.channels & RT_NAME) flight.names = stage.mapper()->names();
    } catch (...) { // the world is only half mapped: the next frame starts with a new context
      stage.close();
      inFlight.clear();
      throw;
    }
    state.store(State::rendering, std::memory_order_release);
    if (cancelled) return; // cancelled before it began
    rtSwapBuffers();
    throwOnError("rendering");
    inFlight.push_back(std::move(flight));
    if (cancelled) rtCancel(stage.context()); // a cancellation that came before the frame existed
  }

  // Maps the world for a frame. All references to nodes are released when this returns, because the
  // browser uses the nodes from then on.
  void map(FrameRequest frame) {
    if (!stage.context()) {
      stage.open([this] { return cancelled.load(); });
      frame.worldChanges.changes.clear(); // the new mapper already contains them
      frame.worldChanges.otherWorld = false;
    }
    stage.apply(frame.worldChanges);
    stage.prepare(frame.frame.view);
    stage.setUpFrame();
    rtQuality(RT_FRAMES_IN_FLIGHT, int(most)); // so that rtSwapBuffers waits for none of them
  }

  // Waits for the oldest frame and returns it.
  std::shared_ptr<const EndedFrame> finish() {
    const FrameInFlight flight = std::move(inFlight.front());
    inFlight.pop_front();
    rtFinishFrame();
    throwOnError("rendering");
    auto result = std::make_shared<EndedFrame>();
    result->viewer = flight.viewer;
    stage.readChannels(flight.settings, result->picture, &flight.names);
    stage.describe(flight.settings, result->result);
    result->result.map = flight.map;
    result->whole =
        !cancelled || all(result->picture.planes.at(RT_SAMPLES), float(flight.settings.samples));
    const Clock::time_point end = Clock::now();
    result->seconds = between(flight.started, end);
    result->alone = between(std::max(flight.started, lastEnd),
                            inFlight.empty() ? end : inFlight.front().started);
    lastEnd = end;
    return result;
  }

  // --- The browser's thread ---
  State now() const {
    const State now = state.load(std::memory_order_acquire);
    return now == State::ready && cancelled ? State::rendering : now;
  }

  void cancel() {
    cancelled = true;
    if (const RTcontext context = stage.context()) rtCancel(context);
  }

  std::shared_ptr<const EndedFrame> last() {
    const std::lock_guard lock(mutex);
    return lastEnded;
  }

  std::shared_ptr<const EndedFrame> nextUnpolled() {
    const std::lock_guard lock(mutex);
    if (unpolled.empty()) return nullptr;
    std::shared_ptr<const EndedFrame> next = std::move(unpolled.front());
    unpolled.pop_front();
    return next;
  }

  // Tells whether the frame in flight is the one that was started last, so that the stage has its
  // settings.
  bool alone() const {
    const State now = state.load(std::memory_order_acquire);
    return (now == State::rendering || now == State::ready) && framesInFlight == 1;
  }

  void start(const LiveFrame& frame) {
    if (now() != State::idle && now() != State::ready)
      throw std::logic_error("a frame is in flight");
    stage.reportMessages();
    stage.settings = given;
    stage.settings.width = frame.width;
    stage.settings.height = frame.height;
    stage.settings.samples = frame.samples;
    stage.settings.progressive = given.progressive && frame.samples > 1;
    stage.settings.channels |= shownChannels;
    started = Clock::now();
    viewer = frame.viewer;
    progress = 0;
    nextPoll = {};
    cancelled = false;
    FrameRequest next{frame, stage.collectChanges(), started};
    {
      const std::lock_guard lock(mutex);
      failure.clear();
      requested = std::move(next);
      framesInFlight++;
      state = State::mapping;
    }
    changed.notify_all();
  }

  void end() {
    {
      const std::lock_guard lock(mutex);
      ending = true;
    }
    cancel();
    changed.notify_all();
    thread.join();
  }

  void show(const Picture& picture, uint32_t ofViewer, LivePicture& out) {
    const std::vector<float>& samples = picture.planes.at(RT_SAMPLES);
    out = {};
    out.viewer = ofViewer;
    out.width = picture.width;
    out.height = picture.height;
    out.rgb = displayBytes(picture);
    double sum = 0;
    size_t covered = 0;
    for (const float s : samples) {
      sum += double(s);
      covered += s > 0;
    }
    out.samples = sum / double(samples.size());
    out.covered = double(covered) / double(samples.size());
    LivePicture& last = before[ofViewer];
    if (covered < samples.size()) fillFrom(last, samples, out);
    last.width = out.width;
    last.height = out.height;
    last.rgb = out.rgb;
  }

  bool look(LivePicture& out) {
    stage.reportMessages();
    const std::shared_ptr<const EndedFrame> finished = nextUnpolled();
    if (!finished) return alone() && pollInFlight(out);
    show(finished->picture, finished->viewer, out);
    out.seconds = finished->seconds;
    out.alone = finished->alone;
    out.finished = finished->whole;
    out.ended = true;
    out.overhead = std::max(0.0, finished->seconds - finished->result.stats.renderSeconds);
    out.map = finished->result.map;
    out.stats = finished->result.stats;
    return true;
  }

  // Returns the frame in flight, if it has new samples.
  bool pollInFlight(LivePicture& out) {
    const Clock::time_point begin = Clock::now();
    if (begin < nextPoll) return false;
    const RTcontext context = stage.context();
    const float now = rtProgress(context);
    if (now <= progress || !stage.snapshot(scratch, shownChannels)) return false;
    if (now < 1) progress = now; // progress is also 1 before the frame has begun
    if (!std::any_of(scratch.planes[RT_SAMPLES].begin(), scratch.planes[RT_SAMPLES].end(),
                     [](float s) { return s > 0; }))
      return false;
    show(scratch, viewer, out);
    const double took = secondsSince(begin), rest = std::max(minPollInterval, pausePerPoll * took);
    nextPoll = Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(rest));
    out.seconds = secondsSince(started);
    return true;
  }

  bool copy(Picture& out) {
    const std::shared_ptr<const EndedFrame> finished = last();
    const bool begun = alone() && stage.snapshot(out, stage.settings.channels);
    if (!begun || (finished && !all(out.planes[RT_SAMPLES], 1))) {
      if (!finished) return false;
      out = finished->picture;
    }
    if (!(given.channels & RT_SAMPLES)) out.planes.erase(RT_SAMPLES);
    if (!(given.channels & RT_RGBA)) out.planes.erase(RT_RGBA);
    return true;
  }
};

LiveRenderer::LiveRenderer(xvrml::Browser& browser, const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(browser, settings)) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->loop(); });
}

LiveRenderer::~LiveRenderer() { impl_->end(); }

LiveRenderer::State LiveRenderer::state() const { return impl_->now(); }

void LiveRenderer::start(const LiveFrame& frame) { impl_->start(frame); }

void LiveRenderer::cancel() {
  if (impl_->state != State::idle) impl_->cancel();
}

bool LiveRenderer::look(LivePicture& picture) { return impl_->look(picture); }

bool LiveRenderer::copy(Picture& picture) { return impl_->copy(picture); }

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

xvrml::Axis LiveRenderer::upOf(const View& view) const {
  return impl_->stage.mapper() ? picture::upOf(*impl_->stage.mapper(), view) : xvrml::Axis::y;
}

std::string LiveRenderer::takeFailure() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->failure, {});
}

} // namespace picture
