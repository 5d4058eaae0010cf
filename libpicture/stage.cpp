#include "libpicture/stage.h"

#include <chrono>
#include <mutex>
#include <new>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "libpicture/cluster.h"
#include "libpicture/environment_map.h"
#include "libpicture/files/radiance.h"
#include "libpicture/raster/raster.h"
#include "openrt/sums.h"

namespace picture {

namespace {

using Clock = std::chrono::steady_clock;

// Strips the call from a message: "rtRender: why" becomes "why". Used for errors of workers, which
// no call caused.
std::string withoutCall(const std::string& message) {
  const size_t colon = message.find(": ");
  return message.starts_with("rt") && colon != message.npos ? message.substr(colon + 2) : message;
}

double aspectOf(const RenderSettings& settings) { return double(settings.width) / settings.height; }

// Sets what the settings of a frame say about its whole picture.
void setFacts(const RenderSettings& frame, PictureFacts& picture) {
  picture.width = frame.width;
  picture.height = frame.height;
  picture.linear = frame.linear;
  picture.view = frame.view;
  picture.depthAlongRay = frame.quality.whole(RT_DEPTH_ALONG) == RT_DEPTH_ALONG_RAY;
  setBackdrop(frame.background, picture);
}

// Keeps the part of a picture that its settings ask for.
void keepCrop(const RenderSettings& frame, Picture& picture) {
  if (const Crop& crop = frame.crop; crop.width > 0)
    cut(picture, crop.x, crop.y, crop.width, crop.height);
}

// Returns the first number of each number's name: Shapes of one name are one object.
std::vector<uint32_t> unitedNames(const std::vector<std::string>& names) {
  std::unordered_map<std::string_view, uint32_t> first;
  std::vector<uint32_t> united;
  for (const std::string& name : names)
    united.push_back(first.try_emplace(name, uint32_t(united.size())).first->second);
  return united;
}

} // namespace

void throwOnError(const char* doing) {
  const RTenum code = rtGetError();
  if (code == RT_CLUSTER_ERROR || code == RT_SUMS_ERROR)
    throw RenderError(withoutCall(rtGetErrorMessage()), code);
  if (code != RT_NO_ERROR)
    throw RenderError(fmt::format("{}: {}", doing, rtGetErrorMessage()), code);
}

std::string contextConfiguration(const RenderSettings& settings) {
  std::string config = fmt::format(" threads={}", settings.threads);
  if (settings.isa != "auto") addQuoted(config, "isa", settings.isa);
  if (!settings.record.empty()) addQuoted(config, "record", settings.record);
  if (!settings.shaderPath.empty()) addQuoted(config, "shaderpath", settings.shaderPath);
  return config;
}

RTcontext newContext(const std::string& configuration) {
  if (const RTcontext made = rtNewContext(configuration.c_str())) return made;
  const RTenum code = rtGetError();
  throw RenderError(withoutCall(rtGetErrorMessage()), code);
}

// Only a context knows what the machine has. The names that it has accepted are kept, because
// Python checks them for each picture.
void checkIsa(const std::string& isa) {
  static std::mutex mutex;
  static std::set<std::string> accepted{"auto"};
  const std::lock_guard lock(mutex);
  if (accepted.contains(isa)) return;
  std::string configuration = "threads=1";
  addQuoted(configuration, "isa", isa);
  const RTcontext before = rtGetCurrent();
  const RTcontext made = rtNewContext(configuration.c_str());
  if (!made) {
    const RTenum code = rtGetError();
    const std::string message = withoutCall(rtGetErrorMessage()), key = "isa=" + isa + ": ";
    throw RenderError(message.starts_with(key) ? message.substr(key.size()) : message, code);
  }
  rtDeleteContext(made);
  rtMakeCurrent(before);
  accepted.insert(isa);
}

Stage::Stage(xvrml::World& world, xvrml::Browser* browser, const RenderSettings& s)
    : settings(s), world_(&world), browser_(browser) {}

// Records only what the exit code depends on. The mapper turns errors of calls into diagnostics.
void Stage::note(RTenum error, const char*, void* self) {
  auto& stage = *static_cast<Stage*>(self);
  stage.pluginMissing_ |= error == RT_PLUGIN_ERROR;
  stage.memoryExhausted_ |= error == RT_OUT_OF_MEMORY;
}

// Receives the engine's messages: shaders that cannot be rendered, results that are not finite.
// [any thread, also render threads]
void Stage::listen(int level, const char* text, void* self) {
  if (level >= 2) static_cast<Stage*>(self)->warn(text);
}

void Stage::warn(std::string text) {
  constexpr size_t most = 100;
  const std::lock_guard lock(messagesMutex_);
  if (messages_.size() < most) messages_.push_back(std::move(text));
}

void Stage::reportMessages() {
  std::vector<std::string> messages;
  {
    const std::lock_guard lock(messagesMutex_);
    messages.swap(messages_);
  }
  for (const std::string& text : messages) world_->diagnostics.warn({}, text);
}

void Stage::open(const std::function<bool()>& stop) {
  if (settings.cluster) {
    const auto listener = [this](int level, const char* text) { listen(level, text, this); };
    const RTcontext lent = settings.cluster->borrow(listener, stop);
    if (!lent)
      throw RenderError("interrupted while the cluster was still rendering another picture");
    borrowed_ = true;
    context_ = lent;
  } else {
    context_ =
        newContext("backend=" + (settings.raster ? "null" : settings.backend) +
                   contextConfiguration(settings) + (lightSamples ? "" : " lightsamples=off"));
    rtLogCallback(listen, this);
  }
  rtErrorCallback(note, this);
  if (settings.keepSums) {
    rtKeepSums(1);
    throwOnError("keeping the sums");
  }
  try {
    makeMapper();
  } catch (...) {
    close();
    throw;
  }
}

void Stage::cancel() {
  const std::lock_guard lock(closingMutex_);
  if (const RTcontext context = context_) rtCancel(context);
}

std::string Stage::close(bool leaveMapper) {
  if (borrowed_) rtCancel(context_); // nobody will see this frame
  if (leaveMapper && !borrowed_) static_cast<void>(mapper_.release());
  mapper_.reset();
  if (borrowed_ && environment_) {
    rtUseEnvironment(0);
    rtDeleteShader(environment_);
    rtDeleteTexture(environmentTexture_);
  }
  environment_ = environmentTexture_ = 0;
  if (borrowed_) studio_.clear();
  studio_.forget();
  const RTcontext context = [this] {
    const std::lock_guard lock(closingMutex_);
    return context_.exchange(nullptr);
  }();
  if (std::exchange(borrowed_, false)) {
    settings.cluster->giveBack();
    return "";
  }
  while (rtGetError() != RT_NO_ERROR) {}
  rtDeleteContext(context);
  return rtGetError() == RT_NO_ERROR ? "" : rtGetErrorMessage();
}

void Stage::makeMapper() {
  const auto begin = Clock::now();
  xvrml::MapOptions options;
  options.linearColor = settings.linear;
  options.headlight = settings.headlight;
  options.aspect = aspectOf(settings);
  mapper_.reset(); // destroy first: two mappers would both own the context's scene
  mapper_ = std::make_unique<xvrml::OpenRTMapper>(*world_, options);
  mapper_->setExactShapes(settings.exactShapes);
  mapper_->setThickness(settings.pointSize, settings.lineWidth);
  mapper_->setMultiplyTextures(settings.multiplyTextures);
  meshSeconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
}

double Stage::takeMeshSeconds() { return std::exchange(meshSeconds_, 0); }

WorldChanges Stage::collectChanges() {
  WorldChanges worldChanges;
  if (!browser_) return worldChanges;
  worldChanges.changes = browser_->takeChanges();
  worldChanges.otherWorld =
      std::exchange(generation_, browser_->generation()) != browser_->generation();
  if (worldChanges.otherWorld) world_ = &browser_->world();
  worldChanges.bound = browser_->bound();
  worldChanges.camera = browser_->camera(aspectOf(settings));
  return worldChanges;
}

void Stage::apply(const WorldChanges& worldChanges, bool patient) {
  if (!browser_) return;
  if (worldChanges.otherWorld) {
    makeMapper();
  } else {
    mapper_->setPatient(patient);
    mapper_->update(worldChanges.changes);
  }
  mapper_->bind(worldChanges.bound);
  bound_ = worldChanges.bound;
  viewer_.reset();
  if (worldChanges.bound.viewpoint) viewer_ = worldChanges.camera;
}

xvrml::CameraSettings Stage::cameraOf(const View& view) const {
  View seen = view;
  if (!seen.viewer) seen.viewer = viewer_;
  return chooseCamera(*mapper_, seen, aspectOf(settings));
}

bool Stage::leavesViewpointOut(const View& view) const {
  return picture::leavesViewpointOut(*mapper_, view, aspectOf(settings));
}

// Returns whether the world's Background is shown. Otherwise alpha is the coverage by shapes.
bool Stage::showsBackground() const {
  return (settings.background.kind == Background::Kind::world ||
          settings.background.kind == Background::Kind::backdrop) &&
         !settings.studio.on;
}

void Stage::place(const View& view) {
  readBackground();
  shown_ = cameraOf(view);
  pinhole_ = view.pinhole;
  if (!view.intrinsics) return;
  pinhole_ = pinholeOf(*view.intrinsics, shown_.matrix, settings.width, settings.height);
  shown_.fovy = pinhole_->fovy;
}

void Stage::prepare(const View& view) {
  using Headlight = xvrml::MapOptions::Headlight;
  const bool studio = settings.studio.on;
  mapper_->setHeadlight(studio && settings.headlight == Headlight::automatic ? Headlight::off
                                                                             : settings.headlight);
  mapper_->setModelLight(!settings.hasSurroundings() && !studio);
  mapper_->setBackground(showsBackground());
  place(view);
  mapper_->map(shown_);
  if (pinhole_) {
    rtLoadMatrixd(pinhole_->sheared);
    rtPerspective(pinhole_->fovy * 180 / std::numbers::pi);
  }
  useEnvironment();
  if (studio) {
    studio_.place(settings.studio, settings.linear, shown_, mapper_->bounds(),
                  upOf(*mapper_, view));
    throwOnError("studio");
  }
  if (memoryExhausted_) throw std::bad_alloc();
}

void Stage::rasterize(Picture& picture) const {
  RasterView view;
  view.camera = shown_;
  if (pinhole_) view.toWorld = pinhole_->sheared;
  view.width = settings.width;
  view.height = settings.height;
  view.linear = settings.linear;
  view.headlight = settings.headlight;
  view.bound = bound_;
  view.showsBackground = showsBackground();
  view.shaderPath = settings.shaderPath;
  view.threads = settings.threads;
  setFacts(settings, picture);
  picture.note = rasterNote;
  try {
    picture.planes[RT_RGBA] = picture::rasterize(*world_, view);
  } catch (const std::length_error& error) { throw RenderError(error.what()); }
  const BackgroundLayer backdrop({Background::Kind::colour, settings.studio.backdrop, {}},
                                 settings.linear); // stands for the studio
  const BackgroundLayer& behind = settings.studio.on ? backdrop : backgroundLayer_;
  behind.compositeOver(picture.planes[RT_RGBA], settings.width, settings.height);
  keepCrop(settings, picture);
}

void Stage::readBackground() {
  if (background_ == settings.background) return;
  backgroundLayer_ = BackgroundLayer(settings.background, settings.linear);
  background_ = settings.background;
}

// Sets the user's environment map or sky. The mapper replaces it with its own when the world's
// changes.
void Stage::useEnvironment() {
  if (!settings.hasSurroundings()) return;
  if (environment_ == 0) {
    const xvrml::RadianceImage around =
        settings.sky ? pictureOf(*settings.sky) : readRadiance(settings.environment);
    environment_ =
        makeEnvironmentMap(around.width, around.height, around.rgb.data(), environmentTexture_);
    rtParameter1f(rtParameterHandle("intensity"),
                  float(settings.sky ? 1 : settings.environmentIntensity));
    rtBindShader(0);
  }
  rtLoadIdentity();
  rtUseEnvironment(environment_);
  throwOnError("environment");
}

void Stage::setUpFrame(const RenderSettings& frame) {
  rtFrameBuffer(frame.width, frame.height, frame.channels);
  if (frame.channels & RT_COVERAGE) {
    const std::vector<uint32_t> united = unitedNames(mapper_->names());
    rtUniteNames(united.data(), united.size());
  }
  rtScissor(frame.crop.x, frame.crop.y, frame.crop.width, frame.crop.height);
  QualityValues quality = frame.quality;
  quality.set(RT_SAMPLES_PER_PIXEL, frame.samples);
  quality.set(RT_TARGET_ERROR, frame.error);
  quality.set(RT_TIME_LIMIT, frame.timeLimit);
  quality.set(RT_PROGRESSIVE, frame.progressive ? 1 : 0);
  applyQuality(quality);
  throwOnError("frame");
}

bool Stage::snapshot(Picture& picture, uint32_t channels) const {
  const RTcontext context = context_;
  const auto copied = [&](uint32_t channel, std::vector<float>& plane) {
    return rtSnapshot(context, channel, plane.data(), plane.size()) != 0;
  };
  if (!context) return false;
  setFacts(settings, picture);
  // Other tiles finish meanwhile. Reading RT_SAMPLES first ensures that counted samples have data.
  if (!fillChannels(picture, channels & RT_SAMPLES, copied)) return false;
  if (!fillChannels(picture, channels & ~uint32_t(RT_SAMPLES), copied)) return false;
  if (hasNames(channels)) picture.names = mapper_->names();
  if (channels & RT_RGBA)
    backgroundLayer_.compositeOver(picture.planes[RT_RGBA], settings.width, settings.height);
  keepCrop(settings, picture);
  return true;
}

void Stage::readChannels(const RenderSettings& frame, Picture& picture) const {
  setFacts(frame, picture);
  fillChannels(picture, frame.channels, [](uint32_t channel, std::vector<float>& plane) {
    rtReadPixels(channel, plane.data(), plane.size());
    throwOnError("reading the picture");
    return true;
  });
  if (frame.channels & RT_RGBA)
    backgroundLayer_.compositeOver(picture.planes[RT_RGBA], frame.width, frame.height);
  keepCrop(frame, picture);
}

void Stage::describe(const RenderSettings& frame, RenderResult& result) const {
  result.missing = pluginMissing_ || mapper_->stats().missingTextures > 0;
  result.stats.size = sizeof result.stats;
  rtGetStats(&result.stats);
  if (frame.cluster) result.workers = frame.cluster->workers();
}

} // namespace picture
