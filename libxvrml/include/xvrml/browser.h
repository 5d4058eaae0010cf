// browser.h: a running VRML world: time, events, live editing, and the Browser object that Scripts
// and programs see (ISO/IEC 14772-1 4.12.10). It has no clock, no window and no threads: time is an
// argument, input is handed in, what changed is handed out. The same calls with the same arguments
// give the same world. [one thread: the one that made it]
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "xvrml/behaviour.h"
#include "xvrml/camera.h"
#include "xvrml/change.h"
#include "xvrml/viewer.h"
#include "xvrml/world.h"

namespace xvrml {

// What Scripts have done since the world began.
struct ScriptCounts {
  uint64_t scripts = 0; // that have become part of the world
  uint64_t started = 0; // whose program has been found and has begun
  uint64_t waiting = 0; // that are still to be started, or are starting in their processes
  uint64_t calls = 0;   // of their functions
  double seconds = 0;   // that the world has waited for these
};

struct BrowserOptions {
  uint64_t maximumEvents = 1'000'000; // of one cascade
  bool runScripts = true;
  std::string scriptPath;    // folders of script engines, separated by colons, before
                             // $XVRML_SCRIPT_PATH and the installed one
  bool trustScripts = false; // Scripts may use engines whose programs can do whatever the user can
  bool allowNetwork = false; // tells script engines that their programs may use the network
  uint64_t scriptSteps = 1'000'000'000; // that one call into a Script may take, as its engine
                                        // counts them; then it is stopped
  double scriptSeconds =
      2; // for the same: of the processor if the program has a process of its own, else on the wall
  uint64_t scriptMemory = 256 << 20; // bytes that one Script's program may use
  // Programs of untrusted worlds run in processes of their own, which can do nothing but compute;
  // never: in this one, where one that does not end, or takes all memory, takes the program with
  // it; always: trusted ones, too, as far as they can.
  enum class Isolation : uint8_t {
    automatic,
    never,
    always
  } scriptIsolation = Isolation::automatic;
  // Seconds that a call waits for a Script in a process of its own; what it sends later belongs to
  // a later tick. 0: as long as it runs, so that the same input gives the same world on any
  // machine.
  double scriptPatience = 0;
  std::function<void(const std::string& text)>
      print; // what Scripts print; null: notes in world().diagnostics
  // loadUrl asks here first: true: the application has taken care of it. base: file that relative
  // URLs are relative to.
  std::function<bool(const std::vector<std::string>& urls,
                     const std::vector<std::string>& parameters, const std::string& base)>
      loadUrl;
};

// Time 0 of a Browser in the world's own time, which is seconds since 1970-01-01 00:00 UTC (ISO/IEC
// 14772-1 4.11.2): the beginning of 24 October 2024. A fixed number keeps pictures reproducible.
// Most cycleIntervals divide it (2^9 3^3 5^3 7 11 13), so that a TimeSensor with startTime 0 and
// loop TRUE is at the beginning of a cycle (decision 0014).
inline constexpr double worldEpoch = 1'729'728'000;

// More options. A later version that adds members reads them only if size tells that the program
// knows them.
struct RunOptions {
  size_t size = sizeof(RunOptions);
  double epoch = worldEpoch; // time 0 in seconds since 1970; 0: the times of this class are seconds
                             // since 1970 themselves
  // Every Script may send to other nodes and change routes, as the browsers of 1997 let them; else
  // only those with directOutput TRUE (6.40).
  bool directOutputAlways = false;
  // Seconds of processor time that calls of all Scripts may take together while scriptPatience is 0
  // (ten times as many on the wall), and as many again for each second that the world's time moves
  // on. Then all Scripts are stopped, with one error.
  double worldScriptSeconds = 30;
  // Called after each Script that has been started, on the browser's thread, within its constructor
  // too: to show how far it is.
  std::function<void(const ScriptCounts& counts)> onScriptStart;
};

class Browser {
 public:
  // Takes a loaded world over: sensors, Scripts, bindables and routes come alive at time `start`.
  // The first tick shows the world at that time. All times of this class are seconds after the
  // epoch; nodes and Scripts see epoch + time.
  explicit Browser(std::unique_ptr<World> world, BrowserOptions options = {}, double start = 0);
  Browser(std::unique_ptr<World> world, BrowserOptions options, double start,
          const RunOptions& run);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  World& world();
  Events& events();
  double now() const;   // seconds after epoch()
  double epoch() const; // seconds since 1970; startTime = epoch() + now() is "at once"
  // Time has come to `time` (seconds after epoch(), not before now()): sensors send, routes carry,
  // Scripts run, until nothing is left to do.
  void tick(double time);
  // What changed since the last call; for OpenRTMapper::update. Another world (generation()) begins
  // with an empty list.
  FieldChanges takeChanges();
  bool hasChanges() const;      // takeChanges would return some
  ScriptCounts scripts() const; // what its Scripts have done so far
  // Grows by one with every world that takes the place of the former (loadUrl, replaceWorld): make
  // a new mapper.
  uint64_t generation() const;

  // --- Fields and events ---
  // The node that a DEF name of the file means; null if there is none.
  NodeRef node(std::string_view name) const;
  // Sends an event to an exposedField or eventIn (a cascade at now()), or sets a field directly.
  // False if there is no such field or the value is of another type.
  bool set(Node& node, std::string_view field, Value value);
  // The value of a field or exposedField, or the last one an eventOut sent. Throws
  // std::invalid_argument if there is none.
  Value get(const Node& node, std::string_view field) const;
  // Calls back whenever an eventOut or exposedField has sent. Returns a number for unlisten; 0 if
  // there is no such event.
  using Callback = std::function<void(Node& node, const FieldInfo& out, const Value& value)>;
  uint64_t listen(Node& node, std::string_view out, Callback callback);
  void unlisten(Node& node, uint64_t number);

  // --- The viewer ---
  BoundNodes bound() const;
  // Where the viewer is: the bound Viewpoint, and how far navigation has led away from it. aspect:
  // width / height.
  CameraSettings camera(double aspect) const;
  // Puts the viewer somewhere else, as navigation does. view: camera to world, column-major,
  // rotation and translation only; one that is not finite is not taken.
  void placeViewer(const double view[16]);
  // The direction in the world that is up for navigation while no Viewpoint is bound; 0 1 0 at
  // first. A vector that is not finite or has no length is not taken.
  void setUp(const double up[3]);
  // Seconds of the world's time in which the picture follows when the viewer jumps to another
  // Viewpoint; 0, as at first: at once.
  void setTransition(double seconds);
  std::vector<ViewpointName>
  viewpoints() const; // in the order of the files, Inlines and prototypes included
  bool bindViewpoint(
      std::string_view name); // by its DEF name or else its description; false if there is none
  // The nearest thing along a ray; false if there is none.
  bool pick(const double origin[3], const double direction[3], const PickOptions& options,
            PickHit& hit);
  // The pointer is at (x, y) of the picture, from -1 at the left and bottom to 1 at the right and
  // top; button: it is pressed. Sensors send at now().
  void pointer(double x, double y, bool button);
  void setAspect(double aspect); // of the picture that pointer and VisibilitySensors mean, width /
                                 // height; 4/3 at first
  void pointerRay(const double origin[3], const double direction[3], bool button); // in the world
  void pointerLeave(); // it is outside of the picture, released
  std::vector<NodeRef>
  sensorsAtPointer() const; // pointing sensors and Anchors that it is over, or that have grabbed it
  // Does what a click on an Anchor does (6.2): binds the Viewpoint that its first url names
  // (#name), else calls back; without a callback as loadUrl.
  void activate(Node& anchor);
  // Its urls lead elsewhere. [within pointer or activate, outside of cascades]
  void onAnchor(std::function<void(Node& anchor)> callback);
  // Moves the viewer for a time. Between ticks: what the user does at now(). dt: seconds.
  void navigate(const NavigationInput& input, double dt);
  void key(Key key, bool pressed); // ticks move the viewer while arrows are held
  Navigation navigation() const;   // the way of moving in use
  bool setNavigation(
      Navigation type); // false if the bound NavigationInfo does not allow it; then its first holds

  // --- The Browser object (4.12.10) ---
  std::string name() const;
  std::string version() const;
  double currentSpeed() const;     // metres per second
  double currentFrameRate() const; // what setFrameRate said last; 0 at first
  void setFrameRate(double framesPerSecond);
  std::string worldUrl() const;
  void setDescription(std::string text);
  std::string description() const;
  // Nodes of a text, which has names, prototypes and routes of its own and needs no header. They
  // are part of the world at once, though nowhere in its scene; routes live as long as the nodes
  // they start from. What is wrong in the text is in world().diagnostics. Throws LoadError if
  // nothing of it can be used.
  MFNode createVrmlFromString(std::string_view text);
  // The three below wait for the end of the cascade if one is under way. base: file that relative
  // URLs are relative to; "": the world's. Sends the nodes of the first file that can be read as an
  // MFNode to an eventIn, in a cascade of its own.
  void createVrmlFromUrl(const std::vector<std::string>& urls, Node& node, std::string_view eventIn,
                         const std::string& base = "");
  // Another world instead of this one; "#name" and "file#name" bind a viewpoint. If none can be
  // read all stays as it is.
  void loadUrl(const std::vector<std::string>& urls,
               const std::vector<std::string>& parameters = {}, const std::string& base = "");
  // These nodes, with what hangs below them and what their routes lead to, instead of all others.
  void replaceWorld(const MFNode& nodes);

  // --- Editing ---
  NodeRef createNode(std::string_view type); // with default fields; throws std::invalid_argument
                                             // for an unknown type
  void addRoot(NodeRef node);
  void removeRoot(Node& node);
  // Loads the content of an Inline that has none yet (LoadOptions::loadInlines), or of all that are
  // in the world, and what these bring in. Returns how many got some; what could not be read is in
  // the diagnostics.
  bool loadInline(Node& inlineNode);
  uint64_t loadInlines();
  bool addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  bool deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
