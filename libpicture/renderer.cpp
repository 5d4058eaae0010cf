#include "libpicture/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "libpicture/cluster.h"
#include "libpicture/live/film_history.h"
#include "libpicture/live/oidn.h"
#include "libpicture/live/preview_settings.h"
#include "libpicture/luminaires.h"
#include "libpicture/measure.h"
#include "libpicture/stage.h"
#include "libpicture/sums.h"
#include "number_text.h"

namespace picture {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int maxInFlight = 64;
// pixelBytes: approximate bytes per pixel; inFlightBytes: limit for all frames in flight
constexpr size_t inFlightBytes = size_t(2) << 30, pixelBytes = 128;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A frame that is set up or has begun, and the facts that are known only at its start.
struct FrameInFlight {
  RenderSettings settings;
  RenderResult result{};   // without pixels and statistics; the camera still has its shader
  bool otherWorld = false; // the first frame of another world
  int64_t number = 0;      // in its film
};

// denoisedBy: the library that has filtered the picture; "": none has.
std::string previewNote(int samples, const std::string& denoisedBy) {
  return fmt::format("preview: rebuilt from {} sample{} per pixel{}{}, biased", samples,
                     samples == 1 ? "" : "s", denoisedBy.empty() ? "" : " by ", denoisedBy);
}

std::unique_ptr<live::OidnFilter> newDenoiser(int threads) {
  checkDenoiser(Denoiser::oidn);
  try {
    return std::make_unique<live::OidnFilter>(live::OidnLibrary::find(), threads,
                                              live::OidnQuality::high);
  } catch (const live::OidnError& error) { throw RenderError(error.what()); }
}

} // namespace

bool isWorthProgressive(const RenderSettings& settings) {
  constexpr int samples = 64;
  constexpr int64_t pixels = int64_t(2) << 20;
  return !settings.cluster && settings.samples >= samples &&
         int64_t(settings.width) * settings.height <= pixels;
}

std::string whyNoCrop(const RenderSettings& settings) {
  const Crop& c = settings.crop;
  if (c.width == 0) return "";
  if (settings.preview) return "previews are rebuilt from the pixels around, which are not made";
  if (settings.error > 0)
    return "with a target error the samples are shared out over the whole picture; without one a "
           "part has the bytes of the whole";
  const bool touches =
      c.x == 0 || c.y == 0 || c.x + c.width == settings.width || c.y + c.height == settings.height;
  if (touches && (settings.channels & (RT_ERROR | RT_TRUST)))
    return "errors at the border of the picture follow from the colours of the whole picture; the "
           "channels error and trust need a part that does not touch it";
  return "";
}

struct Renderer::Impl {
  Stage stage;
  ProgressCallback watch;

  // Shared by both threads. The caller sets `task`; the render thread clears it when the task is
  // done.
  std::mutex mutex;
  std::condition_variable changed;
  std::function<void()> task;
  std::exception_ptr failure;
  bool ending = false, leaving = false;
  std::string wrong; // error when the context was closed; empty: none
  std::atomic<bool> cancelled{false};
  std::atomic<const char*> doing{""}; // Renderer::stage
  std::thread thread;

  // Used by the calling thread, and by the render thread while the calling thread waits.
  std::deque<FrameInFlight> inFlight;
  Clock::time_point lastEnd;                  // when the last frame ended
  std::optional<live::FilmHistory> history;   // none before the first preview
  std::unique_ptr<live::OidnFilter> denoiser; // none before the first preview with it
  Sums continueFrom;                          // begins the next frame; may be none
  int64_t nextNumber = 0;  // the number that the next frame has if nobody says one
  bool otherWorld = false; // the browser shows another world than in the last frame

  Impl(xvrml::World& world, xvrml::Browser* browser, const RenderSettings& settings,
       ProgressCallback w)
      : stage(world, browser, settings), watch(std::move(w)) {}

  void loop() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return task || ending; });
      if (!task) break;
      lock.unlock();
      try {
        task();
      } catch (...) { failure = std::current_exception(); }
      doing = "";
      lock.lock();
      task = nullptr;
      changed.notify_all();
    }
    lock.unlock();
    wrong = stage.close(leaving);
  }

  // Runs `work` on the render thread and calls the progress callback meanwhile.
  void run(std::function<void()> work) {
    std::exception_ptr stopped;
    std::unique_lock lock(mutex);
    failure = nullptr;
    task = std::move(work);
    changed.notify_all();
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return !task; })) {
      const RTcontext context = stage.context();
      // Cancel repeatedly: a cancellation before the frame has started would be lost.
      if (cancelled && context) rtCancel(context);
      if (!watch || stopped) continue;
      const float progress = context ? rtProgress(context) : 0;
      lock.unlock();
      try {
        if (watch(progress)) cancelled = true;
      } catch (...) {
        stopped = std::current_exception();
        cancelled = true;
      }
      lock.lock();
    }
    if (stopped) std::rethrow_exception(stopped);
    if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
  }

  void apply(const WorldChanges& worldChanges) {
    stage.apply(worldChanges);
    otherWorld |= worldChanges.otherWorld;
  }

  // Maps the world for a view and sets up its frame. Returns what is known before the frame begins.
  FrameInFlight setUp(const View& view, std::optional<int64_t> number = {}) {
    const auto begin = Clock::now();
    if (stage.settings.raster)
      stage.place(view);
    else
      stage.prepare(view);
    FrameInFlight frame;
    frame.number = number.value_or(nextNumber);
    nextNumber = frame.number + 1;
    RenderResult& result = frame.result;
    // meshes are built once, with the first picture
    result.mapSeconds = secondsSince(begin) + stage.takeMeshSeconds();
    result.map = stage.mapper()->stats();
    result.camera = stage.shown();
    frame.otherWorld = std::exchange(otherWorld, false);
    frame.settings = stage.settings;
    if (frame.settings.preview) {
      live::drawFreshSamples(frame.settings, uint64_t(frame.number));
      live::askForGuides(frame.settings);
      if (frame.settings.samples > 1) frame.settings.channels |= RT_VARIANCE; // tells the noise
    }
    // The guides of a preview have names, too, but nobody asks for their nodes.
    if (hasNames(frame.settings.channels)) result.picture.names = stage.mapper()->names();
    if (hasNames(stage.settings.channels)) result.nodes = stage.mapper()->nodes();
    if (frame.settings.raster) return frame;
    stage.setUpFrame(frame.settings);
    if (inFlight.empty()) lastEnd = Clock::now();
    if (const Sums sums = std::exchange(continueFrom, Sums())) rtContinueFrom(sums.get());
    return frame;
  }

  // Completes the result of a frame that has ended.
  RenderResult complete(FrameInFlight frame) {
    throwOnError("rendering");
    RenderResult result = std::move(frame.result);
    // for overlapping frames: the time since the previous frame ended
    result.renderSeconds = secondsSince(lastEnd);
    lastEnd = Clock::now();
    stage.reportMessages(); // safe here: the browser's thread is waiting
    result.interrupted = cancelled;
    if (!frame.settings.raster) stage.readChannels(frame.settings, result.picture);
    rebuild(frame, result);
    result.hasCameraShader = std::exchange(result.camera.shader, nullptr) != nullptr;
    stage.describe(frame.settings, result);
    if (frame.settings.preview) result.stats.error = {}; // that of the samples
    if (frame.settings.raster) result.stats.scene.triangles = result.map.triangles;
    return result;
  }

  // Replaces the samples of a frame by the picture that is rebuilt from them, if it is a preview.
  void rebuild(const FrameInFlight& frame, RenderResult& result) {
    const RenderSettings& settings = frame.settings;
    if (frame.otherWorld && history) history->reset();
    if (!settings.preview || result.interrupted) return;
    if (!history) history.emplace(settings.threads);
    if (settings.denoiser == Denoiser::oidn && !denoiser) denoiser = newDenoiser(settings.threads);
    Picture rebuilt =
        history->add(frame.number, result.picture,
                     {result.camera, double(settings.width) / settings.height}, denoiser.get());
    const live::Reconstruction::Facts& facts = history->facts();
    if (!facts.problem.empty()) throw RenderError(facts.problem);
    if (denoiser) rebuilt.denoisedBy = denoiser->name();
    rebuilt.note = previewNote(settings.samples, rebuilt.denoisedBy);
    result.sampled = std::exchange(result.picture, std::move(rebuilt));
    result.denoiseSeconds = facts.denoising;
    result.renderSeconds += facts.seconds - facts.denoising;
    lastEnd = Clock::now();
  }

  // Draws a frame by the z-buffer.
  void rasterize(FrameInFlight& frame) {
    lastEnd = Clock::now();
    stage.rasterize(frame.result.picture);
  }

  RenderResult render(const View& view) {
    FrameInFlight frame = setUp(view);
    if (frame.settings.raster)
      rasterize(frame);
    else
      rtRender();
    return complete(std::move(frame));
  }

  void start(const View& view, std::optional<int64_t> number) {
    doing = "mapping";
    FrameInFlight frame = setUp(view, number);
    if (frame.settings.raster) {
      rasterize(frame);
    } else {
      rtQuality(RT_FRAMES_IN_FLIGHT, maxInFlight);
      doing = "building";
      rtSwapBuffers();
    }
    doing = "";
    throwOnError("rendering");
    inFlight.push_back(std::move(frame));
  }

  RenderResult finish() {
    FrameInFlight frame = std::move(inFlight.front());
    inFlight.pop_front();
    if (!frame.settings.raster) rtFinishFrame();
    return complete(std::move(frame));
  }

  void measure(const View& view, std::vector<Measurement>& out) {
    doing = "mapping";
    stage.prepareSensors(view);
    const std::vector<PlacedSensor> sensors = stage.placeSensors();
    doing = "";
    out = stage.measure(sensors, stage.settings, cancelled);
    stage.reportMessages(); // safe here: the browser's thread is waiting
  }
};

Renderer::Renderer(xvrml::World& world, const RenderSettings& settings, ProgressCallback watch)
    : impl_(std::make_unique<Impl>(world, nullptr, settings, std::move(watch))) {
  begin();
}

Renderer::Renderer(xvrml::Browser& browser, const RenderSettings& settings, ProgressCallback watch)
    : impl_(std::make_unique<Impl>(browser.world(), &browser, settings, std::move(watch))) {
  impl_->stage.collectChanges(); // discards them: the mapper starts from the current world
  begin();
}

void Renderer::begin() {
  impl_->thread = std::thread([impl = impl_.get()] { impl->loop(); });
  try {
    impl_->run([this] { impl_->stage.open([this] { return impl_->cancelled.load(); }); });
  } catch (...) {
    end();
    throw;
  }
}

Renderer::~Renderer() { end(); }

void Renderer::leave() {
  impl_->leaving = true;
  end();
}

void Renderer::close() {
  end();
  if (!impl_->wrong.empty()) throw RenderError(impl_->wrong, RT_IO_ERROR);
}

void Renderer::end() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->ending = true;
  }
  impl_->changed.notify_all();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void Renderer::change(const std::function<void(RenderSettings&)>& change) {
  change(impl_->stage.settings);
}

std::string Renderer::stage() const { return impl_->doing.load(); }

void Renderer::setProgressCallback(ProgressCallback watch) { impl_->watch = std::move(watch); }

const std::vector<xvrml::ViewpointInfo>& Renderer::viewpoints() {
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] { impl_->apply(worldChanges); });
  return impl_->stage.mapper()->viewpoints();
}

xvrml::Bounds Renderer::bounds() {
  xvrml::Bounds bounds;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    bounds = impl_->stage.mapper()->bounds();
  });
  return bounds;
}

xvrml::CameraSettings Renderer::cameraAround(const xvrml::CameraSettings& camera, double aspect) {
  xvrml::CameraSettings around;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    around = impl_->stage.mapper()->cameraAround(camera.matrix, camera.fovy, aspect);
  });
  return around;
}

Renderer::Place Renderer::placeOf(const View& view) {
  checkViewpoint(view);
  Place place;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    place.camera = impl_->stage.cameraOf(view);
    const xvrml::OpenRTMapper& mapper = *impl_->stage.mapper();
    place.up = upOf(mapper, view);
    place.leftOut = impl_->stage.leavesViewpointOut(view);
    if (!view.up && mapper.boundViewpoint() < 0) place.reason = mapper.guessUp().reason;
  });
  return place;
}

void Renderer::prepare(const View& view) {
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    impl_->stage.prepare(view);
  });
}

std::vector<xvrml::ExplainedObject> Renderer::explain() {
  std::vector<xvrml::ExplainedObject> objects;
  impl_->run([&] { objects = impl_->stage.mapper()->explain(); });
  return objects;
}

Sums Renderer::sums() const {
  const RTcontext context = impl_->stage.context();
  return context && impl_->stage.settings.keepSums ? Sums(rtGetSums(context)) : Sums();
}

void Renderer::continueFrom(const Sums& sums) { impl_->continueFrom = sums; }

bool Renderer::snapshot(Picture& picture) {
  return impl_->stage.snapshot(picture, impl_->stage.settings.channels);
}

void Renderer::checkViewpoint(const View& view) {
  if (view.viewpoint && *view.viewpoint >= viewpoints().size())
    throw RenderError(fmt::format("there is no viewpoint {}: the world has {}", *view.viewpoint,
                                  viewpoints().size()));
}

void Renderer::start(const View& view, std::optional<int64_t> frame) {
  checkViewpoint(view);
  if (impl_->inFlight.empty()) impl_->cancelled = false;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    impl_->start(view, frame);
  });
}

RenderResult Renderer::finish() {
  if (impl_->inFlight.empty()) throw RenderError("no frame is in flight");
  RenderResult result{};
  impl_->run([&] { result = impl_->finish(); });
  return result;
}

size_t Renderer::framesInFlight() const { return impl_->inFlight.size(); }

size_t Renderer::maxFramesInFlight() const {
  const RenderSettings& settings = impl_->stage.settings;
  if (!settings.cluster) return 1;
  // A frame needs memory for the sums of all its channels and for a copy of them.
  const size_t bytes = size_t(settings.width) * size_t(settings.height) * pixelBytes;
  const size_t most = std::clamp(inFlightBytes / bytes, size_t(2), size_t(maxInFlight));
  const std::string& split = settings.cluster->settings().split;
  const bool shared = split == "tiles" || split == "samples";
  return shared ? 2 : std::clamp(settings.cluster->alive() + 1, size_t(2), most);
}

RenderResult Renderer::render(const View& view) {
  checkViewpoint(view);
  RenderResult result{};
  impl_->cancelled = false;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    result = impl_->render(view);
  });
  return result;
}

std::vector<Measurement> Renderer::measure(const View& view) {
  checkViewpoint(view);
  std::vector<Measurement> out;
  impl_->cancelled = false;
  const WorldChanges worldChanges = impl_->stage.collectChanges();
  impl_->run([&] {
    impl_->apply(worldChanges);
    impl_->measure(view, out);
  });
  return out;
}

std::vector<Luminaire> Renderer::luminaires() {
  std::vector<Luminaire> out;
  impl_->run([&] { out = impl_->stage.luminaires(); });
  return out;
}

int findViewpoint(const std::vector<xvrml::ViewpointInfo>& viewpoints, const std::string& name) {
  for (size_t i = 0; i < viewpoints.size(); ++i)
    if (!name.empty() && viewpoints[i].name == name) return int(i);
  for (size_t i = 0; i < viewpoints.size(); ++i)
    if (!name.empty() && viewpoints[i].description == name) return int(i);
  size_t number = 0;
  if (isNumber(name, number) && number < viewpoints.size()) return int(number);
  return -1;
}

} // namespace picture
