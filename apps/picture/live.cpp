// live.cpp: see live.h. The browser's thread and the render thread meet in `state_`: who has the world, and in `mutex_`: the
// frame that is wanted and the one that is finished.
#include "picture/live.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "picture/stage.h"

namespace picture {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Looking takes time that light could be traced in: a part of it at most, and not more often than anybody sees.
constexpr double leastBetweenLooks = 0.008, restPerLook = 8; // seconds; as long as that many looks
constexpr uint32_t shownChannels = RT_RGBA | RT_SAMPLES;

struct Wanted {
  LiveFrame frame;
  News news;
  Clock::time_point started;
};

// A frame that has come to its end, or as far as it got.
struct Made {
  Picture picture;
  RenderResult result; // without the picture
  double seconds = 0;  // from start() on
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
      const size_t from = row * size_t(before.width) + size_t(x) * size_t(before.width) / size_t(out.width);
      std::copy_n(before.rgb.begin() + std::ptrdiff_t(3 * from), 3, out.rgb.begin() + std::ptrdiff_t(3 * pixel));
    }
}

} // namespace

struct LiveRenderer::Impl {
  RenderSettings given; // width, height and samples are the frames'
  Stage stage;
  std::atomic<State> state{State::idle};
  std::atomic<bool> cancelled{false};

  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Wanted> wanted;
  bool ending = false, ended = false;
  std::shared_ptr<const Made> made; // the last one
  std::string failure;

  // The browser's thread alone.
  Clock::time_point started;
  std::shared_ptr<const Made> shown; // the last one that look() has given
  float progress = 0;                // of the frame in flight when it was looked at
  Clock::time_point nextLook;        // at a frame in flight, not before
  Picture seen;                      // working storage of look()
  LivePicture before;                // what look() has given last: size and rgb

  std::thread thread;

  Impl(xvrml::Browser& browser, const RenderSettings& settings) : given(settings), stage(browser.world(), &browser, settings) {
    given.progressive = true;
  }

  // --- The render thread ---
  void loop() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return wanted || ending; });
      if (ending) break;
      Wanted frame = *std::exchange(wanted, {});
      lock.unlock();
      std::shared_ptr<Made> result;
      std::string wrong;
      try {
        const Clock::time_point begin = frame.started;
        map(std::move(frame));
        state.store(State::rendering, std::memory_order_release);
        result = render();
        if (result) result->seconds = secondsSince(begin);
      } catch (const std::bad_alloc&) { wrong = "not enough memory"; } catch (const std::exception& e) {
        wrong = e.what();
      } catch (...) { wrong = "it could not be rendered"; }
      if (state == State::mapping) stage.close(); // half mapped: the next frame begins anew
      lock.lock();
      if (result) made = std::move(result);
      failure = std::move(wrong);
      state.store(State::idle, std::memory_order_release);
    }
    lock.unlock();
    stage.close();
    lock.lock();
    ended = true;
    changed.notify_all();
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
  }

  std::shared_ptr<Made> render() {
    if (cancelled) return nullptr; // not even begun
    auto result = std::make_shared<Made>();
    rtRender();
    throwOnError("rendering");
    stage.readChannels(result->picture);
    stage.describe(result->result);
    result->whole = !cancelled || all(result->picture.planes.at(RT_SAMPLES), float(stage.settings.samples));
    return result;
  }

  // --- The browser's thread ---
  // Again and again: a cancellation before the frame has begun would be lost.
  void cancelAgain() {
    const RTcontext context = stage.context();
    if (cancelled && context && state == State::rendering) rtCancel(context);
  }

  std::shared_ptr<const Made> last() {
    const std::lock_guard lock(mutex);
    return made;
  }

  void start(const LiveFrame& frame) {
    if (state != State::idle) throw std::logic_error("a frame is in flight");
    stage.passOn();
    stage.settings = given;
    stage.settings.width = frame.width, stage.settings.height = frame.height;
    stage.settings.samples = frame.samples, stage.settings.progressive = given.progressive && frame.samples > 1;
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
      state = State::mapping;
    }
    changed.notify_all();
  }

  void end() {
    std::unique_lock lock(mutex);
    ending = true;
    cancelled = true;
    changed.notify_all();
    while (!changed.wait_for(lock, std::chrono::milliseconds(5), [&] { return ended; })) cancelAgain();
    lock.unlock();
    thread.join();
  }

  void show(const Picture& picture, LivePicture& out) {
    const std::vector<float>& samples = picture.planes.at(RT_SAMPLES);
    out = {};
    out.width = picture.width, out.height = picture.height;
    out.rgb = displayBytes(picture);
    double sum = 0;
    size_t covered = 0;
    for (const float s : samples) sum += double(s), covered += s > 0;
    out.samples = sum / double(samples.size());
    out.covered = double(covered) / double(samples.size());
    if (covered < samples.size()) fillFrom(before, samples, out);
    before.width = out.width, before.height = out.height, before.rgb = out.rgb;
  }

  bool look(LivePicture& out) {
    stage.passOn();
    cancelAgain();
    const std::shared_ptr<const Made> finished = last();
    if (state == State::rendering && lookAhead(out)) {
      shown = finished; // it is older
      return true;
    }
    if (!finished || finished == shown) return false;
    show(finished->picture, out);
    out.seconds = finished->seconds;
    out.finished = finished->whole;
    out.ended = true;
    out.overhead = std::max(0.0, finished->seconds - finished->result.stats.renderSeconds);
    out.map = finished->result.map, out.stats = finished->result.stats;
    shown = finished;
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
    if (!std::any_of(seen.planes[RT_SAMPLES].begin(), seen.planes[RT_SAMPLES].end(), [](float s) { return s > 0; })) return false;
    show(seen, out);
    const double took = secondsSince(begin), rest = std::max(leastBetweenLooks, restPerLook * took);
    nextLook = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(rest));
    out.seconds = secondsSince(started);
    return true;
  }

  bool copy(Picture& out) {
    const std::shared_ptr<const Made> finished = last();
    const bool flying = state == State::rendering && stage.snapshot(out, stage.settings.channels);
    if (!flying || (finished && !all(out.planes[RT_SAMPLES], 1))) {
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

LiveRenderer::State LiveRenderer::state() const {
  impl_->cancelAgain();
  return impl_->state.load(std::memory_order_acquire);
}

void LiveRenderer::start(const LiveFrame& frame) { impl_->start(frame); }

void LiveRenderer::cancel() {
  if (impl_->state == State::idle) return;
  impl_->cancelled = true;
  impl_->cancelAgain();
}

bool LiveRenderer::look(LivePicture& picture) { return impl_->look(picture); }

bool LiveRenderer::copy(Picture& picture) { return impl_->copy(picture); }

void LiveRenderer::change(const std::function<void(RenderSettings&)>& change) { change(impl_->given); }

const std::vector<xvrml::ViewpointInfo>& LiveRenderer::viewpoints() const {
  static const std::vector<xvrml::ViewpointInfo> none;
  return impl_->stage.mapper() ? impl_->stage.mapper()->viewpoints() : none;
}

xvrml::Bounds LiveRenderer::bounds() const { return impl_->stage.mapper() ? impl_->stage.mapper()->bounds() : xvrml::Bounds{}; }

std::string LiveRenderer::takeFailure() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->failure, {});
}

} // namespace picture
