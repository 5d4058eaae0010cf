// objects.h: Declares the C++ side of the Python classes World and Node. All members are used with
// the GIL held, except where a comment says otherwise.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "gil.h"
#include "libpicture/live.h"
#include "libpicture/renderer.h"
#include "libpicture/shader_rules.h"
#include "xvrml/browser.h"
#include "xvrml/edit.h"
#include "xvrml/world.h"

namespace py = pybind11;

// Upper limit of the times and epochs of worlds, in seconds: about three thousand years.
inline constexpr double latestTime = 1e11;

// The locks of a world, shared with the objects that Scripts see of it. A thread may hold both, and
// each recursively, because callbacks use nodes. Release the GIL while waiting, and lock `drawing`
// before `graph`.
struct WorldObject;
using WorldMutex = TrackedMutex<std::recursive_mutex>;
struct WorldLocks {
  WorldObject* callbacks = nullptr; // delivers the recorded events to callbacks; null: nobody does
  WorldMutex drawing;               // held while a picture is rendered, and for every change
  WorldMutex graph;                 // held for every change, and while fields are read
  // Renders for the world's views (viewer.h); null: no view is open. Its thread reads the world
  // while its state is `mapping`, and whoever takes `drawing` waits for the end of that.
  std::unique_ptr<picture::LiveRenderer> live;
};
using LocksPtr = std::shared_ptr<WorldLocks>;

using WorldPtr = std::shared_ptr<WorldObject>;
struct Viewers;

// A world. It is static until its time or its events are first used; from then on a Browser runs
// it. A WorldObject may also stand for nodes that are not in a world yet ("loose"). It ends with
// these nodes, or joins a world together with them.
struct WorldObject : std::enable_shared_from_this<WorldObject> {
  std::unique_ptr<xvrml::World> world;     // the world while it is static
  std::unique_ptr<xvrml::Browser> running; // the browser that runs the world
  // The world that these loose nodes have joined; null: none.
  WorldPtr joined;
  int rank = 0; // longest chain of joins that leads here, for loose nodes
  // Fields that are sent as events when the world begins to run.
  std::vector<std::pair<xvrml::NodeRef, std::string>> initialEvents;
  std::shared_ptr<xvrml::Editor> editor; // edits the world's file; null: it has not been edited
  int openSteps = 0;                     // steps of the editor that are open
  LocksPtr locks = std::make_shared<WorldLocks>();
  std::shared_ptr<Viewers> viewers; // the open views of the world (viewer.h); null: none
  uint64_t edits = 0;               // grows whenever Python may have changed the world

  virtual ~WorldObject();
  virtual xvrml::World& graph(); // raises ValueError for loose nodes
  // Returns the browser that runs the world; null: it is static.
  virtual xvrml::Browser* browser() { return running.get(); }
  // Returns why Python may not change the world now; null: it may.
  virtual const char* frozen() const { return nullptr; }
  virtual bool loose() const { return !world && !running && !joined; }
  // Makes the world run, from time 0 on.
  xvrml::Browser& live();
  void run(std::unique_ptr<xvrml::World> made, const xvrml::BrowserOptions& options, double start,
           const xvrml::RunOptions& more = {});
  // Changes a running world: calls `work` without the GIL, then the callbacks of the events it
  // caused. Raises the first exception of a callback.
  void change(const std::function<void()>& work);
  virtual std::shared_ptr<picture::Renderer> renderer(const picture::RenderSettings& settings,
                                                      picture::ProgressCallback watch);
  // Releases what is kept for the next picture, including the cluster's context. [GIL not needed]
  void releaseRenderer();

  // Takes the locks. Changing takes both, after checking that changes are permitted.
  struct Changing {
    std::unique_lock<WorldMutex> drawing, graph;
  };
  Changing lock();
  // Does the same, but returns nothing instead of waiting for another thread or for a view's frame
  // to have read the world.
  std::optional<Changing> tryLock();
  std::unique_lock<WorldMutex> lockGraph();
  std::unique_lock<WorldMutex> lockDrawing();
  // True while this thread renders a picture; progress callbacks must not change the world then.
  bool isRenderingHere = false;
  // Shapes have got shaders by rules, and the last preset whose rules did.
  bool shadersGiven = false;
  std::string presetGiven;

  // Calls callback(value, time) after the event has been processed, on the thread that caused it.
  uint64_t listen(const xvrml::NodeRef& node, const std::string& event, py::function callback);
  void unlisten(xvrml::Node& node, uint64_t number);

  // Releases a node that Python no longer holds. The node is destroyed later if another thread is
  // changing the world. [GIL not needed]
  void drop(xvrml::NodeRef node) noexcept;

 private:
  struct PendingEvent {
    uint64_t callback;
    xvrml::Value value;
    double time;
  };
  void deliver();
  void destroyDropped() noexcept; // destroys dropped nodes; the lock of the graph is held
  // renderer of the last picture; destroyed before the browser
  std::shared_ptr<picture::Renderer> renderer_;
  picture::RenderSettings rendererSettings_;
  std::vector<PendingEvent> pendingEvents_; // events without their callbacks called yet, in order
  int depth_ = 0;                           // nesting depth of change()
  bool delivering_ = false;
  std::mutex droppedMutex_;
  std::vector<xvrml::NodeRef> dropped_;
};

// While it exists, changes of the world by this thread are rejected. Take the lock of `drawing`
// first, so that those of other threads wait.
struct Drawing {
  WorldObject& world;
  explicit Drawing(WorldObject& w) : world(w) { world.isRenderingHere = true; }
  ~Drawing() { world.isRenderingHere = false; }
};

// A node and its world. The world lives as long as a variable holds any of its nodes.
class NodeObject {
 public:
  NodeObject(WorldPtr world, xvrml::NodeRef node)
      : node(std::move(node)), world_(std::move(world)) {}
  NodeObject(const NodeObject&) = default;
  NodeObject& operator=(const NodeObject&) = delete;
  ~NodeObject() {
    if (node) world_->drop(std::move(node));
  }
  const WorldPtr& world() const {
    while (world_->joined) world_ = WorldPtr(world_->joined);
    return world_;
  }
  xvrml::NodeRef node;
  // Made from Python and never the value of a field, so no other object refers to the node.
  mutable bool isUnowned = false;

 private:
  mutable WorldPtr world_;
};

// Returns whether both are the same world. Nodes given to a Script belong to the world of the
// Browser that runs it.
inline bool sameWorld(const WorldPtr& a, const WorldPtr& b) {
  return a == b || (a->browser() && a->browser() == b->browser());
}

// Returns the node as an object of its class; None for null.
py::object asNode(const WorldPtr& world, const xvrml::NodeRef& node);
inline py::object asNode(const WorldPtr& world, xvrml::Node* node) {
  return asNode(world, xvrml::NodeRef(node));
}

// Converts text of a file. Bytes that are not UTF-8 are kept by Python's surrogateescape.
py::str toText(const std::string& bytes);
std::string fromText(const py::handle& text);
// Returns "; did you mean X?" or an empty string.
std::string didYouMean(const std::string& name, const std::vector<std::string>& known);

// Converts a field's value to a Python object: numbers, tuples, read-only arrays, text, nodes.
py::object toPython(const xvrml::Value& value, const WorldPtr& world);
// Converts a node's field; lists of numbers become views without a copy. [under the lock of the
// graph]
py::object fieldToPython(const NodeObject& node, const xvrml::FieldInfo& field);

// Converts the Python object to a value of the field. Raises TypeError or ValueError naming the
// field and the expected value. Loose nodes in the value join the owner's world; if the owner is
// loose, it joins theirs. Call joinWorlds after the value has been assigned.
xvrml::Value fromPython(const py::handle& object, const xvrml::FieldInfo& field,
                        const NodeObject& owner);
void joinWorlds(const NodeObject& owner, const py::handle& object);

// Raises ValueError if the value's nodes contain the owner. [under the lock of the graph]
void refuseLoops(const NodeObject& owner, const xvrml::FieldInfo& field, const xvrml::Value& value);

// Loads a world from a file name, bytes or a file object. Raises ParseError or OSError.
std::unique_ptr<xvrml::World> loadSource(const py::object& source, const py::object& limits,
                                         bool allowAbsolute, double stepError = 0);

// Converts a file name: str or os.PathLike.
std::string toPath(const py::handle& path);
// Raises OSError with this text unless it is empty.
void raiseOsError(const std::string& failure);

// Runs `work` without the GIL and checks for Ctrl-C; the callback that `work` receives ends its
// task early. progress: called with the fraction done; may be None. Raises afterwards what stopped
// the work.
void interruptible(const std::function<void(picture::ProgressCallback watch)>& work,
                   const py::object& progress = py::none());

// Convert the names of navigation types and keys; raise ValueError for an unknown name.
xvrml::Navigation navigationOf(const std::string& name);
const char* navigationName(xvrml::Navigation kind);
xvrml::Key keyOf(const std::string& name);

// Tells the views of a world that the world has changed. Never raises. (viewer.cpp)
void wakeViews(Viewers& viewers) noexcept;

// --- For the script engine of Python (plugins/script/python), see script.cpp ---
//
// Registers the locks of the world of a browser that is being created or runs; null: the browser
// has ended.
void scriptsLock(const xvrml::Browser* browser, LocksPtr locks);
// For its lifetime on this thread: Scripts of an unknown browser belong to the browser that is
// being created.
struct MakingBrowser {
  explicit MakingBrowser(LocksPtr locks);
  ~MakingBrowser();
};
// Assigns on behalf of the Script that is running on this thread, if there is one. The event is
// sent when the Script's function returns.
bool scriptAssigns(const NodeObject& node, const std::string& field, const py::handle& value);

void defineScripts(py::module_& module);
void defineNode(py::module_& module);
void defineWorld(py::module_& module);
void defineRender(py::object worldClass);
void defineEditor(py::module_& module, py::object worldClass);
// Gives shapes surface shaders by rules, and returns how many.
size_t applyRules(const WorldPtr& world, const std::vector<picture::ShaderRule>& rules);
void defineMeasurement(py::module_& module); // before defineWorld()
void defineBrowser(py::module_& module);
void defineViewer(py::module_& module);
void definePicture(py::module_& module);
void defineDenoise(py::module_& module); // after definePicture()
void defineCompare(py::module_& module); // after definePicture()
void defineFilm(py::module_& module);
void defineShapes(py::module_& module);
void defineRenderer(py::module_& module);   // after defineShapes()
void defineAppearance(py::module_& module); // after defineWorld()
void defineRt(py::module_& module);
