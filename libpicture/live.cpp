// live.cpp: The browser's thread and the render thread meet in `state`: who has the
// world, and in `mutex`: the frame that is wanted and those that have ended. The settings are the
// browser's thread's but for the time of mapping; what belongs to a frame in flight is in its
// Flight.
#include "libpicture/live.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
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

// Looking takes time that light could be traced in: a part of it at most, and not more often than
// anybody sees.
constexpr double leastBetweenLooks = 0.008, restPerLook = 8; // seconds; as long as that many looks
constexpr uint32_t shownChannels = RT_RGBA | RT_SAMPLES;
constexpr size_t mostOverlapping = 2;
// How often it is asked whether a frame has ended behind which another one may still be started:
// who waits for it cannot do that.
constexpr std::chrono::milliseconds patience(1);

struct Wanted {
  LiveFrame frame;
  News news;
  Clock::time_point started;
};

// A frame that was begun, and what can be said of it only then.
struct Flight {
  RenderSettings settings;
  Clock::time_point started; // by start()
  xvrml::MapStats map;
  std::vector<std::string> names;
};

// A frame that has come to its end, or as far as it got.
struct Made {
  Picture picture;
  RenderResult result;           // without the picture
  double seconds = 0, alone = 0; // as in LivePicture
  bool whole = false;
};

bool all(const std::vector<float>& samples, float least) {
  return std::all_of(samples.begin(), samples.end(), [least](float s) { return s >= least; });
}

// Pixels without a sample get what stood at their place in the picture before, whatever its size.
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
  RenderSettings given; // width, height and samples are the frames'
  Stage stage;
  const size_t most; // frames in flight
  std::atomic<State> state{State::idle};
  std::atomic<size_t> flying{0};      // started and not ended
  std::atomic<bool> cancelled{false}; // those in flight; none is begun until they have ended

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Wanted> wanted;
  bool ending = false;
  std::shared_ptr<const Made> made; // the last one
  std::deque<std::shared_ptr<const Made>>
      unseen; // that look() has not given yet: as many as may be in flight
  std::string failure;

  // The render thread alone.
  std::deque<Flight> flights; // oldest first
  Clock::time_point lastEnd;

  // The browser's thread alone.
  Clock::time_point started;
  float progress = 0;         // of the frame in flight when it was looked at
  Clock::time_point nextLook; // at a frame in flight, not before
  Picture seen;               // working storage of look()
  LivePicture before;         // what look() has given last: size and rgb

  std::thread thread;

  Impl(xvrml::Browser& browser, const RenderSettings& settings)
      : given(settings), stage(browser.world(), &browser, settings),
        most(settings.cluster ? mostOverlapping : 1) {
    given.progressive = true;
  }

  // --- The render thread ---
  // While another frame may be started the oldest one is not waited for: that would keep the newer
  // one waiting.
  void loop() {
    const auto news = [this] { return wanted || ending; };
    std::unique_lock lock(mutex);
    while (!ending) {
      if (wanted) {
        Wanted frame = *std::exchange(wanted, {});
        lock.unlock();
        std::string wrong = failureOf([&] { begin(std::move(frame)); });
        lock.lock();
        settle(std::move(wrong));
      } else if (flights.empty()) {
        changed.wait(lock, news);
      } else if (flights.size() < most && !cancelled && rtProgress(stage.context()) < 1) {
        changed.wait_for(lock, patience, news);
      } else {
        lock.unlock();
        std::shared_ptr<const Made> result;
        std::string wrong = failureOf([&] { result = finish(); });
        lock.lock();
        if (result) {
          made = result;
          unseen.push_back(std::move(result));
          if (unseen.size() > most) unseen.pop_front();
        }
        settle(std::move(wrong));
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
      return "it could not be rendered";
    }
  }

  // Under the mutex, when a frame has been begun or has ended. One that was wanted meanwhile keeps
  // its state.
  void settle(std::string wrong) {
    if (!wrong.empty()) failure = std::move(wrong);
    flying = flights.size() + (wanted ? 1 : 0);
    if (wanted) return;
    const State now = flights.empty()         ? State::idle
                      : flights.size() < most ? State::ready
                                              : State::rendering;
    state.store(now, std::memory_order_release);
  }

  void begin(Wanted frame) {
    Flight flight{stage.settings, frame.started, {}, {}};
    try {
      map(std::move(frame));
      flight.map = stage.mapper()->stats();
      if (flight.settings.channels & RT_NAME) flight.names = stage.mapper()->names();
    } catch (...) { // half mapped: the next frame begins anew
      stage.close();
      flights.clear();
      throw;
    }
    state.store(State::rendering, std::memory_order_release);
    if (cancelled) return; // not even begun
    rtSwapBuffers();
    throwOnError("rendering");
    flights.push_back(std::move(flight));
    if (cancelled) rtCancel(stage.context()); // before there was anything to be cancelled
  }

  // All that holds on to nodes is given up when this returns: from then on the browser uses them.
  void map(Wanted frame) {
    if (!stage.context()) {
      stage.open([this] { return cancelled.load(); });
      frame.news.changes.clear(); // the mapper has begun with them
      frame.news.otherWorld = false;
    }
    stage.apply(frame.news);
    stage.prepare(frame.frame.view);
    stage.setUpFrame();
    rtQuality(RT_FRAMES_IN_FLIGHT, int(most)); // then rtSwapBuffers waits for none of them
  }

  // Waits for the oldest.
  std::shared_ptr<const Made> finish() {
    const Flight flight = std::move(flights.front());
    flights.pop_front();
    rtFinishFrame();
    throwOnError("rendering");
    auto result = std::make_shared<Made>();
    stage.readChannels(flight.settings, result->picture, &flight.names);
    stage.describe(flight.settings, result->result);
    result->result.map = flight.map;
    result->whole =
        !cancelled || all(result->picture.planes.at(RT_SAMPLES), float(flight.settings.samples));
    const Clock::time_point end = Clock::now();
    result->seconds = between(flight.started, end);
    result->alone =
        between(std::max(flight.started, lastEnd), flights.empty() ? end : flights.front().started);
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

  std::shared_ptr<const Made> last() {
    const std::lock_guard lock(mutex);
    return made;
  }

  std::shared_ptr<const Made> nextUnseen() {
    const std::lock_guard lock(mutex);
    if (unseen.empty()) return nullptr;
    std::shared_ptr<const Made> next = std::move(unseen.front());
    unseen.pop_front();
    return next;
  }

  // The frame in flight is the one that was started last: the stage has its settings.
  bool alone() const {
    const State now = state.load(std::memory_order_acquire);
    return (now == State::rendering || now == State::ready) && flying == 1;
  }

  void start(const LiveFrame& frame) {
    if (now() != State::idle && now() != State::ready)
      throw std::logic_error("a frame is in flight");
    stage.passOn();
    stage.settings = given;
    stage.settings.width = frame.width;
    stage.settings.height = frame.height;
    stage.settings.samples = frame.samples;
    stage.settings.progressive = given.progressive && frame.samples > 1;
    stage.settings.channels |= shownChannels;
    started = Clock::now();
    progress = 0;
    nextLook = {};
    cancelled = false;
    Wanted next{frame, stage.collect(), started};
    {
      const std::lock_guard lock(mutex);
      failure.clear();
      wanted = std::move(next);
      flying++;
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

  void show(const Picture& picture, LivePicture& out) {
    const std::vector<float>& samples = picture.planes.at(RT_SAMPLES);
    out = {};
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
    if (covered < samples.size()) fillFrom(before, samples, out);
    before.width = out.width;
    before.height = out.height;
    before.rgb = out.rgb;
  }

  bool look(LivePicture& out) {
    stage.passOn();
    const std::shared_ptr<const Made> finished = nextUnseen();
    if (!finished) return alone() && lookAhead(out);
    show(finished->picture, out);
    out.seconds = finished->seconds;
    out.alone = finished->alone;
    out.finished = finished->whole;
    out.ended = true;
    out.overhead = std::max(0.0, finished->seconds - finished->result.stats.renderSeconds);
    out.map = finished->result.map;
    out.stats = finished->result.stats;
    return true;
  }

  // The frame in flight, if there is more of it.
  bool lookAhead(LivePicture& out) {
    const Clock::time_point begin = Clock::now();
    if (begin < nextLook) return false;
    const RTcontext context = stage.context();
    const float now = rtProgress(context);
    if (now <= progress || !stage.snapshot(seen, shownChannels)) return false;
    if (now < 1) progress = now; // 1 also before it has begun
    if (!std::any_of(seen.planes[RT_SAMPLES].begin(), seen.planes[RT_SAMPLES].end(),
                     [](float s) { return s > 0; }))
      return false;
    show(seen, out);
    const double took = secondsSince(begin), rest = std::max(leastBetweenLooks, restPerLook * took);
    nextLook = Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(rest));
    out.seconds = secondsSince(started);
    return true;
  }

  bool copy(Picture& out) {
    const std::shared_ptr<const Made> finished = last();
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
