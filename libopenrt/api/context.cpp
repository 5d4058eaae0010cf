// context.cpp: creates and closes a context, and commits, starts and finishes its frames. Runs on
// the application's thread, except cancel, progress, snapshot, workers and the log sink.
#include "api/context.h"

#include <utility>

#include "api/geometry/transform.h"
#include "scene/sums_error.h"

namespace openrt {

void LogSink::set(RTlogCallback callback, void* user) {
  const std::lock_guard lock(mutex_);
  callback_ = callback;
  user_ = user;
}

void LogSink::forward(int level, const char* message, void* self) {
  LogSink& sink = *static_cast<LogSink*>(self);
  const std::lock_guard lock(sink.mutex_);
  if (!sink.callback_) return;
  try {
    sink.callback_(level, message, sink.user_);
  } catch (...) { // an exception of the application must not unwind render threads
  }
}

Context::Context(const ContextConfig& config) : Context(config, nullptr) { makeBackend(config); }

Context::Context(const ContextConfig& config, std::unique_ptr<Backend> backend)
    : registry_(std::make_unique<ShaderRegistry>(shaderFolders(config.shaderPath))),
      backend_(std::move(backend)) {}

Context::~Context() { close(); }

void Context::makeBackend(const ContextConfig& config) {
  BackendOptions options;
  options.threads = config.threads;
  options.isa = config.isa;
  options.lightSamples = config.lightSamples;
  options.file = config.backend == BackendKind::Record ? config.file : config.record;
  options.shaders = registry_.get();
  options.log = LogSink::forward;
  options.logUser = &log;
  options.diagnose = config.debug;
  switch (config.backend) {
  case BackendKind::Local: backend_ = makeLocalBackend(options); break;
  case BackendKind::Null: backend_ = makeNullBackend(options); break;
  case BackendKind::Record: backend_ = makeRecordBackend(options); break;
  case BackendKind::Cluster: backend_ = makeClusterBackend(options, config.cluster); break;
  }
  if (config.debug) backend_ = makeDebugBackend(options, std::move(backend_));
  if (!config.record.empty()) backend_ = makeTeeBackend(options, std::move(backend_));
}

std::exception_ptr Context::close() noexcept {
  if (!open_) return nullptr;
  try {
    if (!inFlight_.empty()) abandonFrames();
  } catch (...) { // the backend is destroyed even if its frame failed
  }
  std::exception_ptr wrong;
  try {
    if (backend_) backend_->finish();
  } catch (...) { wrong = std::current_exception(); }
  // A backend waits for its threads when it is destroyed. One of them may be in the application's
  // log callback, which may ask for the progress: so this happens without the lock.
  std::unique_ptr<Backend> backend;
  {
    const std::lock_guard lock(backendMutex_);
    open_ = false;
    backend = std::move(backend_);
  }
  backend.reset();
  inFlight_.clear();
  unsent_.clear();
  definition.reset();
  scene = SceneState();
  registry_.reset();
  return wrong;
}

Definition& Context::openDefinition() {
  require(definition.has_value(), RT_INVALID_OPERATION,
          "only allowed between rtBeginObject and rtEndObject");
  return *definition;
}

void Context::requireOutsideList() const {
  require(!definition || !definition->builder.inList(), RT_INVALID_OPERATION,
          "not allowed between rtBegin and rtEnd");
}

void Context::requireOutsideDefinition() const {
  require(!definition, RT_INVALID_OPERATION, "not allowed between rtBeginObject and rtEndObject");
}

GeometryState Context::latch(edit::Primitive primitive) {
  scene.requireKind(boundShader, RTS_SURFACE);
  GeometryState state{boundShader, name, matrices.top(), cull, clockwise, 1, texGen, {}};
  if (primitive == edit::Primitive::Lines) {
    state.width = lineWidth;
    state.stipple = stipple;
  }
  if (primitive == edit::Primitive::Points) state.width = pointSize;
  return state;
}

const RtsClass& Context::findClass(std::string_view className, std::string_view library) const {
  try {
    return registry_->find(className, library);
  } catch (const std::bad_alloc&) { throw; } catch (const std::exception& e) {
    fail(RT_PLUGIN_ERROR, e.what());
  }
}

int Context::reloadShaders(const char* function) {
  std::vector<std::string> problems;
  const int reloaded = registry_->reload(problems);
  if (reloaded > 0)
    scene.shadersReloaded([&](const std::string& name, const std::string& library) {
      return &registry_->find(name, library);
    });
  std::erase_if(
      parameterArrays,
      [&](ParameterArray& array) { // drops arrays whose parameter no longer varies over geometry
        const RtsClass& table = *scene.shaderClass(array.shaderClass).table;
        VaryingParameter& own = array.from.parameter;
        array.from.declared = &table.params[own.index];
        const uint8_t frequency =
            table.frequency ? table.frequency[own.index] : uint8_t(RTS_PER_SHADER);
        own.perVertex = frequency == RTS_PER_VERTEX;
        return frequency == RTS_PER_SHADER;
      });
  for (const std::string& problem : problems)
    errors.record(RT_PLUGIN_ERROR, function, problem.c_str());
  return reloaded;
}

RTid Context::stockCamera(const char* className, RTid& cached) {
  if (cached && scene.shaders.find(cached)) return cached;
  const RtsClass& table = findClass(className, "");
  if (table.kind != RTS_CAMERA)
    fail(RT_PLUGIN_ERROR, std::string("the stock class ") + className + " is not a camera class");
  return cached = scene.newShader(scene.newShaderClass(table, className, ""));
}

// Applies the edits to the backend. If the backend throws, the next commit sends the same edits
// again.
void Context::commit() {
  unsent_.reserve(unsent_.size() + 1);
  unsent_.push_back(scene.takeCommit(true));
  while (!unsent_.empty()) {
    backend_->apply(unsent_.front());
    if (keepsSums_) digest_.add(*unsent_.front());
    unsent_.erase(unsent_.begin());
    everCommitted_ = true;
  }
}

void Context::start() {
  const edit::FrameSettingsT settings = scene.frame;
  inFlight_.push_back(settings);
  try {
    if (keepsSums_)
      backend_->keepSums({true, digest_.value(), std::exchange(continueFrom_, nullptr)});
    backend_->start();
  } catch (...) {
    inFlight_.pop_back();
    throw;
  }
  started_++;
}

bool Context::takeCancelRequest() {
  const std::lock_guard lock(backendMutex_);
  return std::exchange(cancelled_, false);
}

// Commits and starts a frame. A cancel() during the commit or the build is meant for this frame,
// which the backend does not know yet, so it is repeated after the start.
void Context::begin() {
  backend_->setPatience(patience);
  commit();
  start();
  if (takeCancelRequest()) backend_->cancel();
}

void Context::finishOldest() {
  const edit::FrameSettingsT settings = inFlight_.front();
  const uint64_t number = started_ - inFlight_.size() + 1;
  inFlight_.pop_front();
  backend_->wait();
  finished_ = settings;
  finishedFrameNumber_ = number;
}

// Cancels and finishes all frames in flight. Then throws the first error, if any.
void Context::abandonFrames() {
  backend_->cancel();
  std::exception_ptr problem;
  while (!inFlight_.empty()) {
    try {
      finishOldest();
    } catch (...) {
      if (!problem) problem = std::current_exception();
    }
  }
  if (problem) std::rethrow_exception(problem);
}

void Context::swapBuffers() {
  require(scene.frame.width > 0, RT_INVALID_OPERATION, "no frame buffer: call rtFrameBuffer first");
  const bool pipelines = backend_->pipelines();
  if (!pipelines && !inFlight_.empty()) finishOldest();
  takeCancelRequest();
  begin(); // if the backend pipelines, the last jobs of the previous frame may still be outstanding
  while (pipelines && inFlight_.size() > framesInFlight) finishOldest();
}

bool Context::finishFrame() {
  if (inFlight_.empty()) return false;
  finishOldest();
  return true;
}

void Context::render() {
  require(scene.frame.width > 0, RT_INVALID_OPERATION, "no frame buffer: call rtFrameBuffer first");
  takeCancelRequest();
  if (!inFlight_.empty()) abandonFrames();
  begin();
  finishOldest();
}

void Context::cancel() {
  const std::lock_guard lock(backendMutex_);
  cancelled_ = true;
  if (backend_) backend_->cancel();
}

bool Context::snapshot(RTenum channel, std::span<float> out) {
  const std::lock_guard lock(backendMutex_);
  return backend_ && backend_->snapshot(channel, out);
}

// The digest knows only what is committed from now on.
void Context::keepSums(bool keep) {
  if (keep && !keepsSums_ && everCommitted_)
    throw SumsError("sums must be kept from the first commit on");
  if (!backend_->keepSums({keep, digest_.value(), nullptr}))
    throw SumsError("this backend keeps no sums");
  keepsSums_ = keep;
}

void Context::continueFrom(std::shared_ptr<const FrameSums> sums) {
  require(keepsSums_, RT_INVALID_OPERATION, "call rtKeepSums first");
  continueFrom_ = std::move(sums);
}

std::shared_ptr<FrameSums> Context::sums() {
  const std::lock_guard lock(backendMutex_);
  return backend_ ? backend_->sums() : nullptr;
}

std::vector<RTworker> Context::workers() {
  const std::lock_guard lock(backendMutex_);
  return backend_ ? backend_->workers() : std::vector<RTworker>();
}

float Context::progress() {
  const std::lock_guard lock(backendMutex_);
  return backend_ ? backend_->progress() : 0;
}

const edit::FrameSettingsT& Context::finishedFrame() const {
  require(finished_.has_value(), RT_INVALID_OPERATION, "no frame is finished yet");
  return *finished_;
}

} // namespace openrt
