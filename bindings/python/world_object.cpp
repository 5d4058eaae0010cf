// world_object.cpp: Implements WorldObject: starting a world, the locks for its changes, and
// callbacks after events.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <utility>

#include <dlfcn.h>

#include "objects.h"

using namespace xvrml;

namespace {

constexpr int maximumRounds = 1000; // limit for callbacks that cause events with callbacks

struct Count {
  int& number;
  explicit Count(int& n) : number(n) { ++number; }
  ~Count() { --number; }
};

// Waits until the views' frame has read the world. The caller holds `drawing`, so that no other
// frame begins. [GIL not held]
void waitForReading(const WorldLocks& locks) {
  while (locks.live && locks.live->state() == picture::LiveRenderer::State::mapping)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Adds the folder of this module to the script engines' path: a wheel contains the engine for
// Scripts in Python there, so that programs without Python do not find it.
BrowserOptions withOwnEngines(BrowserOptions options) {
  static const char here = 0;
  std::error_code error;
  Dl_info info{};
  if (dladdr(&here, &info) == 0 || !info.dli_fname) return options;
  const std::filesystem::path folder = std::filesystem::canonical(
      std::filesystem::path(info.dli_fname).parent_path() / "scripts", error);
  if (!error) options.scriptPath += (options.scriptPath.empty() ? "" : ":") + folder.string();
  return options;
}

} // namespace

WorldObject::~WorldObject() {
  const Browser* ending = running.get();
  if (locks->callbacks == this) locks->callbacks = nullptr;
  dropped_.clear();
  editor.reset();
  if (ending) locks->live.reset();
  renderer_.reset();
  running.reset(); // shuts down the Scripts
  if (ending) scriptsLock(ending, nullptr);
}

World& WorldObject::graph() {
  if (running) return running->world();
  if (!world) throw py::value_error("the node is in no world yet");
  return *world;
}

Browser& WorldObject::live() {
  if (!running) {
    const auto locked = lock();
    if (world) run(std::move(world), {}, 0);
  }
  if (!running) throw py::value_error("the node is in no world yet");
  return *running;
}

void WorldObject::run(std::unique_ptr<World> made, const BrowserOptions& options, double start,
                      const RunOptions& more) {
  const MakingBrowser making(locks); // its Scripts start at once
  locks->callbacks = this;
  change([&] {
    running = std::make_unique<Browser>(std::move(made), withOwnEngines(options), start, more);
    if (editor) editor->run(*running);
    for (const auto& [node, field] : std::exchange(initialEvents, {}))
      running->set(*node, field, running->get(*node, field));
  });
  scriptsLock(running.get(), locks);
}

void WorldObject::change(const std::function<void()>& work) {
  std::exception_ptr failure;
  {
    const Count here(depth_);
    const ReleaseGil release;
    try {
      work();
    } catch (...) { failure = std::current_exception(); }
  }
  if (failure) std::rethrow_exception(failure);
  WorldObject* own = locks->callbacks; // a Script's nodes may belong to a world of this module
  if (own && own->viewers) wakeViews(*own->viewers);
  if (own && depth_ == 0 && own->depth_ == 0 && !own->delivering_) own->deliver();
}

std::shared_ptr<picture::Renderer> WorldObject::renderer(const picture::RenderSettings& settings,
                                                         picture::ProgressCallback watch) {
  if (depth_ > 0)
    throw picture::RenderError("a Script cannot render: the events are still under way");
  if (!running) return std::make_shared<picture::Renderer>(graph(), settings, std::move(watch));
  if (renderer_ && !locks->live && rendererSettings_ == settings) {
    renderer_->setProgressCallback(std::move(watch));
    return renderer_;
  }
  // Only one renderer per browser: it consumes the changes. The views make another one afterwards.
  renderer_.reset();
  locks->live.reset();
  renderer_ = std::make_shared<picture::Renderer>(*running, settings, std::move(watch));
  rendererSettings_ = settings;
  return renderer_;
}

void WorldObject::releaseRenderer() {
  renderer_.reset();
  rendererSettings_.cluster.reset();
}

WorldObject::Changing WorldObject::lock() {
  Changing locked;
  {
    const ReleaseGil release;
    locked.drawing = std::unique_lock(locks->drawing);
    waitForReading(*locks);
    locked.graph = std::unique_lock(locks->graph);
    destroyDropped();
  }
  if (isRenderingHere)
    throw py::value_error("the world cannot be changed while a picture of it is made");
  if (const char* why = frozen()) throw py::value_error(why);
  ++edits;
  return locked;
}

std::optional<WorldObject::Changing> WorldObject::tryLock() {
  Changing locked;
  locked.drawing = std::unique_lock(locks->drawing, std::try_to_lock);
  if (!locked.drawing) return {};
  if (locks->live && locks->live->state() == picture::LiveRenderer::State::mapping) return {};
  locked.graph = std::unique_lock(locks->graph, std::try_to_lock);
  if (!locked.graph || isRenderingHere) return {};
  destroyDropped();
  return locked;
}

std::unique_lock<WorldMutex> WorldObject::lockGraph() {
  const ReleaseGil release;
  return std::unique_lock(locks->graph);
}

std::unique_lock<WorldMutex> WorldObject::lockDrawing() {
  const ReleaseGil release;
  std::unique_lock drawing(locks->drawing);
  waitForReading(*locks);
  return drawing;
}

uint64_t WorldObject::listen(const NodeRef& node, const std::string& event, py::function callback) {
  Browser& browser = live();
  const auto locked = lock();
  const auto number = std::make_shared<uint64_t>(0);
  *number =
      browser.listen(*node, event, [this, number](Node&, const FieldInfo&, const Value& value) {
        pendingEvents_.push_back({*number, value, running->now()});
      });
  // Callbacks belong to the Python object, so that the garbage collector sees them: they may refer
  // to the world itself.
  py::dict own = py::cast(shared_from_this()).attr("__dict__");
  if (!own.contains("_callbacks")) own["_callbacks"] = py::dict();
  own["_callbacks"][py::int_(*number)] = std::move(callback);
  return *number;
}

void WorldObject::unlisten(Node& node, uint64_t number) {
  Browser& browser = live();
  const auto locked = lock();
  browser.unlisten(node, number);
  py::dict own = py::cast(shared_from_this()).attr("__dict__");
  if (own.contains("_callbacks")) own["_callbacks"].attr("pop")(number, py::none());
}

// Calls the callbacks one after the other, including those of later events, until none is left.
void WorldObject::deliver() {
  if (pendingEvents_.empty()) return;
  struct Delivering {
    WorldObject& world;
    explicit Delivering(WorldObject& w) : world(w) { world.delivering_ = true; }
    ~Delivering() {
      world.delivering_ = false;
      world.pendingEvents_.clear(); // after an exception, the remaining callbacks are dropped
    }
  } const delivering(*this);
  const WorldPtr self = shared_from_this();
  for (int round = 0; !pendingEvents_.empty(); ++round) {
    if (round == maximumRounds)
      throw std::runtime_error("callbacks keep making events that call them");
    for (const PendingEvent& one : std::exchange(pendingEvents_, {})) {
      py::dict own = py::cast(self).attr("__dict__");
      if (!own.contains("_callbacks")) return;
      const py::object callback = own["_callbacks"].attr("get")(one.callback);
      // null if unlisten() was called meanwhile
      if (!callback.is_none()) callback(toPython(one.value, self), one.time);
    }
  }
}

void WorldObject::destroyDropped() noexcept {
  std::vector<NodeRef> ended;
  {
    const std::scoped_lock lock(droppedMutex_);
    ended.swap(dropped_);
  }
}

void WorldObject::drop(NodeRef node) noexcept {
  WorldObject* at = this;
  while (at->joined) at = at->joined.get();
  if (std::unique_lock lock(at->locks->graph, std::try_to_lock); lock.owns_lock()) {
    node = {};
    return;
  }
  const std::scoped_lock lock(at->droppedMutex_);
  try {
    at->dropped_.push_back(std::move(node));
  } catch (...) { node = {}; }
}
