// world_object.cpp: what is behind the Python class World: how it comes alive, who may change it
// when, callbacks after events.
#include <algorithm>
#include <filesystem>
#include <utility>

#include <dlfcn.h>

#include "objects.h"

using namespace xvrml;

namespace {

constexpr int maximumRounds = 1000; // of callbacks that make events that call back

struct Count {
  int& number;
  explicit Count(int& n) : number(n) { ++number; }
  ~Count() { --number; }
};

// In a wheel the engine for Scripts in Python lies beside this module, where no program without a
// Python finds it.
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
  drawing_.reset();
  running.reset(); // Scripts are shut down
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
  const MakingBrowser making(locks); // its Scripts begin at once
  locks->callbacks = this;
  change([&] {
    running = std::make_unique<Browser>(std::move(made), withOwnEngines(options), start, more);
    for (const auto& [node, field] : std::exchange(early, {}))
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
  WorldObject* own = locks->callbacks; // a Script's nodes are of a world that this module may know
  if (own && depth_ == 0 && own->depth_ == 0 && !own->delivering_) own->deliver();
}

std::shared_ptr<picture::Renderer> WorldObject::renderer(const picture::RenderSettings& settings,
                                                         picture::Watch watch) {
  if (depth_ > 0)
    throw picture::RenderError("a Script cannot render: the events are still under way");
  if (!running) return std::make_shared<picture::Renderer>(graph(), settings, std::move(watch));
  if (drawing_ && drawn_ == settings) {
    drawing_->setWatch(std::move(watch));
    return drawing_;
  }
  drawing_.reset(); // one renderer a browser: it takes the changes
  drawing_ = std::make_shared<picture::Renderer>(*running, settings, std::move(watch));
  drawn_ = settings;
  return drawing_;
}

void WorldObject::rest() {
  drawing_.reset();
  drawn_.cluster.reset();
}

WorldObject::Changing WorldObject::lock() {
  Changing locked;
  {
    const ReleaseGil release;
    locked.drawing = std::unique_lock(locks->drawing);
    locked.graph = std::unique_lock(locks->graph);
    sweep();
  }
  if (drawingNow)
    throw py::value_error("the world cannot be changed while a picture of it is made");
  if (const char* why = frozen()) throw py::value_error(why);
  return locked;
}

std::unique_lock<WorldMutex> WorldObject::lockGraph() {
  const ReleaseGil release;
  return std::unique_lock(locks->graph);
}

std::unique_lock<WorldMutex> WorldObject::lockDrawing() {
  const ReleaseGil release;
  return std::unique_lock(locks->drawing);
}

uint64_t WorldObject::listen(const NodeRef& node, const std::string& event, py::function callback) {
  Browser& browser = live();
  const auto locked = lock();
  const auto number = std::make_shared<uint64_t>(0);
  *number =
      browser.listen(*node, event, [this, number](Node&, const FieldInfo&, const Value& value) {
        heard_.push_back({*number, value, running->now()});
      });
  // Callbacks belong to the Python object, where the garbage collector sees them: what they refer
  // to may be the world itself.
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

// One call after the other, those of later events too, until none is left.
void WorldObject::deliver() {
  if (heard_.empty()) return;
  struct Delivering {
    WorldObject& world;
    explicit Delivering(WorldObject& w) : world(w) { world.delivering_ = true; }
    ~Delivering() {
      world.delivering_ = false;
      world.heard_.clear(); // after an exception the rest is not called
    }
  } const delivering(*this);
  const WorldPtr self = shared_from_this();
  for (int round = 0; !heard_.empty(); ++round) {
    if (round == maximumRounds)
      throw std::runtime_error("callbacks keep making events that call them");
    for (const Heard& one : std::exchange(heard_, {})) {
      py::dict own = py::cast(self).attr("__dict__");
      if (!own.contains("_callbacks")) return;
      const py::object callback = own["_callbacks"].attr("get")(one.callback);
      if (!callback.is_none())
        callback(toPython(one.value, self), one.time); // unlisten() may have come first
    }
  }
}

void WorldObject::sweep() noexcept {
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
