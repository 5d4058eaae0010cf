// renderer.cpp: see renderer.h.
#include "picture/renderer.h"

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "picture/radiance.h"

namespace picture {

namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A configuration value of rtNewContext.
std::string quoted(const std::string& key, const std::string& value) {
  if (value.find('"') != value.npos) throw RenderError(fmt::format("{}: a double quote is not possible in {}", key, value));
  return fmt::format(" {}=\"{}\"", key, value);
}

std::string contextConfiguration(const RenderSettings& settings) {
  std::string config = fmt::format("backend={} threads={}", settings.backend, settings.threads);
  if (!settings.record.empty()) config += quoted("record", settings.record);
  if (!settings.shaderPath.empty()) config += quoted("shaderpath", settings.shaderPath);
  return config;
}

void throwOnError(const char* doing) {
  if (rtGetError() != RT_NO_ERROR) throw RenderError(fmt::format("{}: {}", doing, rtGetErrorMessage()));
}

} // namespace

// What happened to the world since the last call, handed from the browser's thread to the render thread.
struct News {
  bool otherWorld = false;
  xvrml::FieldChanges changes;
  xvrml::BoundNodes bound;
  xvrml::CameraSettings camera;
};

struct Renderer::Impl {
  xvrml::World* world;     // as it stands; with a browser: the one that it runs
  xvrml::Browser* browser; // null: the world stands still
  RenderSettings settings;
  Watch watch;

  // On the render thread.
  std::unique_ptr<xvrml::OpenRTMapper> mapper;
  double meshSeconds = 0;
  bool pluginMissing = false, memoryExhausted = false;
  RTid environment = 0;
  std::mutex heardMutex;
  std::vector<std::string> heard;

  // Between the threads. `task` is set by the caller and cleared by the render thread when it is done.
  std::mutex mutex;
  std::condition_variable changed;
  std::function<void()> task;
  std::exception_ptr failure;
  bool ending = false;
  RTcontext context = nullptr;
  std::atomic<bool> cancelled{false};
  std::thread thread;

  std::optional<xvrml::CameraSettings> viewer; // of a running world, where a Viewpoint is bound
  uint64_t generation = 0;                     // of the browser's world that the mapper shows

  Impl(xvrml::World* w, xvrml::Browser* b, const RenderSettings& s, Watch x)
      : world(w), browser(b), settings(s), watch(std::move(x)) {}

  // Errors of calls become diagnostics in the mapper; here only what the exit code depends on.
  static void note(RTenum error, const char*, void* user) {
    auto& impl = *static_cast<Impl*>(user);
    impl.pluginMissing |= error == RT_PLUGIN_ERROR;
    impl.memoryExhausted |= error == RT_OUT_OF_MEMORY;
  }

  // What the engine says: shaders that cannot be rendered, answers that were not finite. Called on render threads too.
  static void listen(int level, const char* text, void* user) {
    auto& impl = *static_cast<Impl*>(user);
    constexpr size_t most = 100;
    const std::lock_guard lock(impl.heardMutex);
    if (level >= 2 && impl.heard.size() < most) impl.heard.emplace_back(text);
  }
  void passOn() {
    std::vector<std::string> news;
    {
      const std::lock_guard lock(heardMutex);
      news.swap(heard);
    }
    for (const std::string& text : news) world->diagnostics.warn({}, text);
  }

  void loop() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return task || ending; });
      if (!task) break;
      lock.unlock();
      try {
        task();
      } catch (...) { failure = std::current_exception(); }
      lock.lock();
      task = nullptr;
      changed.notify_all();
    }
    lock.unlock();
    mapper.reset();
    rtDeleteContext(context);
  }

  // Runs `work` on the render thread; meanwhile calls the watch.
  void run(std::function<void()> work) {
    std::exception_ptr stopped;
    std::unique_lock lock(mutex);
    failure = nullptr;
    task = std::move(work);
    changed.notify_all();
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return !task; })) {
      // Again and again: a cancellation before the frame has started would be lost.
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

  void start() {
    const std::string config = contextConfiguration(settings);
    RTcontext made = rtNewContext(config.c_str());
    if (!made) {
      rtGetError();
      throw RenderError(fmt::format("no ray tracing context: {}", rtGetErrorMessage()));
    }
    {
      std::lock_guard lock(mutex);
      context = made;
    }
    rtErrorCallback(note, this);
    rtLogCallback(listen, this);
    makeMapper();
  }

  void makeMapper() {
    const auto begin = Clock::now();
    xvrml::MapOptions options;
    options.linearColor = settings.linear;
    options.headlight = settings.headlight;
    options.aspect = double(settings.width) / settings.height;
    mapper.reset(); // before the next one: both would own the context's scene
    mapper = std::make_unique<xvrml::OpenRTMapper>(*world, options);
    meshSeconds += secondsSince(begin);
  }

  // On the browser's thread.
  News collect() {
    News news;
    if (!browser) return news;
    news.changes = browser->takeChanges();
    news.otherWorld = std::exchange(generation, browser->generation()) != browser->generation();
    if (news.otherWorld) world = &browser->world();
    news.bound = browser->bound();
    news.camera = browser->camera(double(settings.width) / settings.height);
    return news;
  }

  void apply(const News& news) {
    if (!browser) return;
    if (news.otherWorld)
      makeMapper();
    else
      mapper->update(news.changes);
    mapper->bind(news.bound);
    viewer.reset();
    if (news.bound.viewpoint) viewer = news.camera;
  }

  // The viewer of a running world, unless another view is asked for.
  View seenBy(View view) const {
    view.viewer = viewer;
    return view;
  }

  void setUpFrame() {
    rtFrameBuffer(settings.width, settings.height, settings.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, settings.samples);
    rtQuality(RT_MAX_DEPTH, settings.depth);
    rtQuality(RT_SEED, settings.seed);
    rtQuality(RT_SHADOWS, settings.shadows ? 1 : 0);
    rtQuality(RT_TRANSPORT, settings.transport);
    rtQualityf(RT_TARGET_ERROR, settings.error);
    rtQualityf(RT_TIME_LIMIT, settings.timeLimit);
    if (settings.energyCut >= 0) rtQualityf(RT_ENERGY_CUT, settings.energyCut);
    rtQualityf(RT_CLAMP, settings.clamp);
    throwOnError("frame");
  }

  void describe(Picture& picture) {
    picture.width = settings.width;
    picture.height = settings.height;
    picture.linear = settings.linear;
    if (settings.channels & RT_NAME) picture.names = mapper->names();
  }

  bool snapshot(Picture& picture) {
    for (const Channel& channel : channelTable()) {
      if (!(settings.channels & channel.bit)) continue;
      std::vector<float>& plane = picture.planes[channel.bit];
      plane.resize(size_t(settings.width) * size_t(settings.height) * size_t(channel.components));
      if (!rtSnapshot(context, channel.bit, plane.data(), plane.size())) return false;
    }
    describe(picture); // a frame is in flight: the render thread waits for it and leaves the mapper alone
    return true;
  }

  void readChannels(Picture& picture) {
    describe(picture);
    for (const Channel& channel : channelTable()) {
      if (!(settings.channels & channel.bit)) continue;
      std::vector<float>& plane = picture.planes[channel.bit];
      plane.resize(size_t(settings.width) * size_t(settings.height) * size_t(channel.components));
      rtReadPixels(channel.bit, plane.data(), plane.size());
      throwOnError("reading the picture");
    }
  }

  // Light from all around that the user gives. The mapper sets its own when that has changed.
  void useEnvironment() {
    if (settings.environment.empty()) return;
    if (environment == 0) {
      const Radiance around = readRadiance(settings.environment);
      RTid texture = 0;
      rtGenTextures(1, &texture);
      rtBindTexture(texture);
      rtTexImage2D(3, around.width, around.height, RT_FLOAT, around.rgb.data());
      rtTexParameteri(RT_TEXTURE_WRAP_T, RT_CLAMP_TO_EDGE);
      environment = rtNewShader(rtNewShaderClass("EnvironmentMap", nullptr));
      rtBindShader(environment);
      rtParameterTexture(rtParameterHandle("texture"), texture);
      rtParameter1f(rtParameterHandle("intensity"), float(settings.environmentIntensity));
      rtBindShader(0);
    }
    rtLoadIdentity();
    rtUseEnvironment(environment);
    throwOnError("environment");
  }

  void prepare(const View& view) {
    mapper->map(chooseCamera(*mapper, seenBy(view), double(settings.width) / settings.height));
    useEnvironment();
    if (memoryExhausted) throw std::bad_alloc();
  }

  void render(const View& view, RenderResult& result) {
    auto start = Clock::now();
    prepare(view);
    result.mapSeconds = secondsSince(start) + std::exchange(meshSeconds, 0); // meshes are made once, with the first picture
    setUpFrame();
    start = Clock::now();
    rtRender();
    throwOnError("rendering");
    result.renderSeconds = secondsSince(start);
    passOn();
    result.interrupted = cancelled;
    readChannels(result.picture);
    result.map = mapper->stats();
    result.missing = pluginMissing || result.map.missingTextures > 0;
    result.stats.size = sizeof result.stats;
    rtGetStats(&result.stats);
  }
};

Renderer::Renderer(xvrml::World& world, const RenderSettings& settings, Watch watch)
    : impl_(std::make_unique<Impl>(&world, nullptr, settings, std::move(watch))) {
  begin();
}

Renderer::Renderer(xvrml::Browser& browser, const RenderSettings& settings, Watch watch)
    : impl_(std::make_unique<Impl>(&browser.world(), &browser, settings, std::move(watch))) {
  impl_->collect(); // the mapper begins with the world as it is now
  begin();
}

void Renderer::begin() {
  impl_->thread = std::thread([impl = impl_.get()] { impl->loop(); });
  try {
    impl_->run([this] { impl_->start(); });
  } catch (...) {
    end();
    throw;
  }
}

Renderer::~Renderer() { end(); }

void Renderer::end() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->ending = true;
  }
  impl_->changed.notify_all();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void Renderer::change(const std::function<void(RenderSettings&)>& change) { change(impl_->settings); }

void Renderer::setWatch(Watch watch) { impl_->watch = std::move(watch); }

const std::vector<xvrml::ViewpointInfo>& Renderer::viewpoints() {
  const News news = impl_->collect();
  impl_->run([&] { impl_->apply(news); });
  return impl_->mapper->viewpoints();
}

xvrml::Bounds Renderer::bounds() {
  xvrml::Bounds bounds;
  const News news = impl_->collect();
  impl_->run([&] {
    impl_->apply(news);
    bounds = impl_->mapper->bounds();
  });
  return bounds;
}

void Renderer::prepare(const View& view) {
  const News news = impl_->collect();
  impl_->run([&] {
    impl_->apply(news);
    impl_->prepare(view);
  });
}

std::vector<xvrml::ExplainedObject> Renderer::explain() {
  std::vector<xvrml::ExplainedObject> objects;
  impl_->run([&] { objects = impl_->mapper->explain(); });
  return objects;
}

bool Renderer::snapshot(Picture& picture) { return impl_->context && impl_->snapshot(picture); }

RenderResult Renderer::render(const View& view) {
  if (view.viewpoint && *view.viewpoint >= viewpoints().size())
    throw RenderError(fmt::format("there is no viewpoint {}: the world has {}", *view.viewpoint, viewpoints().size()));
  RenderResult result{};
  impl_->cancelled = false;
  const News news = impl_->collect();
  impl_->run([&] {
    impl_->apply(news);
    impl_->render(view, result);
  });
  return result;
}

int findViewpoint(const std::vector<xvrml::ViewpointInfo>& viewpoints, const std::string& name) {
  for (size_t i = 0; i < viewpoints.size(); ++i)
    if (!name.empty() && viewpoints[i].name == name) return int(i);
  for (size_t i = 0; i < viewpoints.size(); ++i)
    if (!name.empty() && viewpoints[i].description == name) return int(i);
  size_t number = 0;
  auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && end == name.data() + name.size() && number < viewpoints.size()) return int(number);
  return -1;
}

} // namespace picture
