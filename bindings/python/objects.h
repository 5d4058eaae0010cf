// objects.h: the C++ side of the Python classes World and Node. All members are used with the
// interpreter's lock (GIL) held, except where a comment says otherwise.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "gil.h"
#include "libpicture/renderer.h"
#include "xvrml/browser.h"
#include "xvrml/world.h"

namespace py = pybind11;

// Times and epochs of worlds are less than this, in seconds: three thousand years.
inline constexpr double latestTime = 1e11;

// What is locked for a world; shared with what Scripts see of it. A thread may hold both, and each
// twice: callbacks use nodes. Waited for without the GIL, `drawing` before `graph`.
struct WorldObject;
using WorldMutex = Awaited<std::recursive_mutex>;
struct WorldLocks {
  WorldObject* callbacks = nullptr; // who calls back what was heard; null: nobody
  WorldMutex drawing;               // while a picture is made, and for every change
  WorldMutex graph;                 // for every change, and while fields are read
};
using LocksPtr = std::shared_ptr<WorldLocks>;

using WorldPtr = std::shared_ptr<WorldObject>;

// A world: it stands still until somebody wants its time or its events; from then on a Browser runs
// it. Or the place of nodes that are in no world yet (loose): it ends with them, or joins a world
// together with them.
struct WorldObject : std::enable_shared_from_this<WorldObject> {
  std::unique_ptr<xvrml::World> world;     // of one that stands still
  std::unique_ptr<xvrml::Browser> running; // of one that runs
  WorldPtr joined;                         // of loose nodes: where they are now
  int rank = 0; // of loose nodes: joins that led here, one after the other, at most
  std::vector<std::pair<xvrml::NodeRef, std::string>>
      early; // fields that are sent as events when the world begins to run
  LocksPtr locks = std::make_shared<WorldLocks>();

  virtual ~WorldObject();
  virtual xvrml::World& graph(); // raises ValueError for loose nodes
  virtual xvrml::Browser* browser() {
    return running.get();
  } // what runs the world; null: it stands still
  virtual const char* frozen() const {
    return nullptr;
  } // why it cannot be changed from here; null: it can
  virtual bool loose() const { return !world && !running && !joined; }
  // Makes it run, from time 0 on.
  xvrml::Browser& live();
  void run(std::unique_ptr<xvrml::World> made, const xvrml::BrowserOptions& options, double start,
           const xvrml::RunOptions& more = {});
  // Changes of a running world: `work` without the GIL, then the callbacks of what it made happen.
  // Raises the first exception of a callback.
  void change(const std::function<void()>& work);
  virtual std::shared_ptr<picture::Renderer> renderer(const picture::RenderSettings& settings,
                                                      picture::Watch watch);
  void rest(); // gives up what is kept for the next picture, the cluster's context with it [GIL not
               // needed]

  // Locks; for changes both, after it was asked whether there may be some.
  struct Changing {
    std::unique_lock<WorldMutex> drawing, graph;
  };
  Changing lock();
  std::unique_lock<WorldMutex> lockGraph();
  std::unique_lock<WorldMutex> lockDrawing();
  // True while a picture is made on behalf of this very thread: callbacks for its progress must
  // leave the world alone.
  bool drawingNow = false;

  // Calls callback(value, time) after the event has been worked off, on the thread that made it
  // happen.
  uint64_t listen(const xvrml::NodeRef& node, const std::string& event, py::function callback);
  void unlisten(xvrml::Node& node, uint64_t number);

  // A node that nobody here holds any more: it must not end while another thread changes the world.
  // [GIL not needed]
  void drop(xvrml::NodeRef node) noexcept;

 private:
  struct Heard {
    uint64_t callback;
    xvrml::Value value;
    double time;
  };
  void deliver();
  void sweep() noexcept;                       // dropped nodes, under the lock of the graph
  std::shared_ptr<picture::Renderer> drawing_; // of the last picture; ends before the browser
  picture::RenderSettings drawn_;
  std::vector<Heard> heard_; // in the order of the events
  int depth_ = 0;            // calls of change() under way
  bool delivering_ = false;
  std::mutex droppedMutex_;
  std::vector<xvrml::NodeRef> dropped_;
};

// A node and where it is: the world lives as long as any of its nodes is in a variable.
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
  mutable bool heldByNone =
      false; // it was made here and was never the value of a field: no other object is of this node

 private:
  mutable WorldPtr world_;
};

// Nodes that a Script was given are of the same world as those of the Browser that runs it.
inline bool sameWorld(const WorldPtr& a, const WorldPtr& b) {
  return a == b || (a->browser() && a->browser() == b->browser());
}

// The node as an object of its class; None for null.
py::object asNode(const WorldPtr& world, const xvrml::NodeRef& node);
inline py::object asNode(const WorldPtr& world, xvrml::Node* node) {
  return asNode(world, xvrml::NodeRef(node));
}

// Text of a file may be anything; Python's own way to keep bytes that are not UTF-8.
py::str toText(const std::string& bytes);
std::string fromText(const py::handle& text);
// "; did you mean X?", or nothing.
std::string didYouMean(const std::string& name, const std::vector<std::string>& known);

// The value of a field as a Python object: numbers, tuples, read-only arrays, text, nodes.
py::object toPython(const xvrml::Value& value, const WorldPtr& world);
// The same of a node's field, its numbers where they lie if it is a list of some. [under the lock
// of the graph]
py::object fieldToPython(const NodeObject& node, const xvrml::FieldInfo& field);

// The Python object as a value of the field. Raises TypeError or ValueError naming the field and
// what it takes. Loose nodes in it are to join the owner's world, or the owner, being loose,
// theirs: joinWorlds once the value has been taken.
xvrml::Value fromPython(const py::handle& object, const xvrml::FieldInfo& field,
                        const NodeObject& owner);
void joinWorlds(const NodeObject& owner, const py::handle& object);

// Raises ValueError if the value's nodes hold the owner. [under the lock of the graph]
void refuseLoops(const NodeObject& owner, const xvrml::FieldInfo& field, const xvrml::Value& value);

// A world from a file name, bytes or a file object. Raises ParseError or OSError.
std::unique_ptr<xvrml::World> loadSource(const py::object& source, const py::object& limits,
                                         bool allowAbsolute);

// A file name: str or os.PathLike.
std::string toPath(const py::handle& path);
// An OSError with this text is raised if there is some.
void raiseOsError(const std::string& failure);

// Runs `work` without the GIL while Ctrl-C is watched for; the watch that it gets ends what is
// being done. progress: called with the fraction done; None: nobody. What stopped the work is
// raised afterwards.
void interruptible(const std::function<void(picture::Watch watch)>& work,
                   const py::object& progress = py::none());

// What the script engine of Python (plugins/script/python) uses: see script.cpp.
// A browser that is being made or runs, and what is locked for its world; null: it is no more.
void scriptsLock(const xvrml::Browser* browser, LocksPtr locks);
// From here on, on this thread: Scripts of a browser that nobody knows yet belong to the one that
// is being made.
struct MakingBrowser {
  explicit MakingBrowser(LocksPtr locks);
  ~MakingBrowser();
};
// Assigns for the Script that is running on this thread, if one is: the event leaves when its
// function returns.
bool scriptAssigns(const NodeObject& node, const std::string& field, const py::handle& value);

void defineScripts(py::module_& module);
void defineNode(py::module_& module);
void defineWorld(py::module_& module);
void defineRender(py::object worldClass);
void defineBrowser(py::module_& module);
void definePicture(py::module_& module);
void defineFilm(py::module_& module);
void defineShapes(py::module_& module);
void defineRt(py::module_& module);
