// browser.h: a running VRML world: time, events, live editing, and the Browser object that Scripts
// and programs see (ISO/IEC 14772-1 4.12.10). The class has no clock, no window and no threads: the
// caller passes in time and user input and takes out the changes. The same calls with the same
// arguments give the same world. [one thread: the one that made it]
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

// Counts of what the world's Scripts have done since the world began.
struct ScriptCounts {
  uint64_t scripts = 0; // Scripts that have become part of the world
  uint64_t started = 0; // Scripts whose program was found and has begun
  uint64_t waiting = 0; // Scripts not started yet, or starting in their processes
  uint64_t calls = 0;   // calls of Script functions
  double seconds = 0;   // seconds that the world has waited for these calls
};

struct BrowserOptions {
  uint64_t maximumEvents = 1'000'000; // limit for one cascade
  bool runScripts = true;
  // Folders of script engines, separated by colons. They come before $XVRML_SCRIPT_PATH and the
  // installed folder.
  std::string scriptPath;
  bool trustScripts = false; // Scripts may use engines whose programs can do whatever the user can
  bool allowNetwork = false; // tells script engines that their programs may use the network
  // Limit for one call into a Script, counted by its engine; beyond it the Script is stopped.
  uint64_t scriptSteps = 1'000'000'000;
  // Limit for one call into a Script, in seconds of processor time. A call that waits or sleeps may
  // take 16 times as long, in a process of its own no longer.
  double scriptSeconds = 2;
  uint64_t scriptMemory = 256 << 20; // bytes that one Script's program may use
  // Selects the process for the programs of Scripts. A separate process can only compute.
  // - automatic: programs of untrusted worlds run in processes of their own.
  // - never: all programs run in this process. A program that does not end, or takes all memory,
  //   takes the application with it.
  // - always: programs of trusted worlds run in processes of their own, too, where their engine
  //   can.
  enum class Isolation : uint8_t {
    automatic,
    never,
    always
  } scriptIsolation = Isolation::automatic;
  // Seconds that all calls between two ticks together wait for Scripts in processes of their own;
  // those that are often late are not waited for in every call. Events that a Script sends later
  // belong to a later tick. 0 waits until the Script returns, so that the same input gives the same
  // world on any machine. It holds for preparing large meshes, too: see setScriptPatience().
  double scriptPatience = 0;
  // Receives the text that Scripts print; null: the text becomes notes in world().diagnostics.
  std::function<void(const std::string& text)> print;
  // loadUrl calls this first. It returns true if the application has loaded the URL itself. base:
  // the file that relative URLs are relative to.
  std::function<bool(const std::vector<std::string>& urls,
                     const std::vector<std::string>& parameters, const std::string& base)>
      loadUrl;
};

// Time 0 of a Browser as world time, in seconds since 1970-01-01 00:00 UTC (ISO/IEC 14772-1
// 4.11.2): the beginning of 24 October 2024. A fixed number keeps pictures reproducible. Most
// cycleIntervals divide it (2^9 3^3 5^3 7 11 13), so that a TimeSensor with startTime 0 and loop
// TRUE is at the beginning of a cycle (decision 0014).
inline constexpr double worldEpoch = 1'729'728'000;

// More options. A later version that adds members reads them only if `size` shows that the program
// was compiled with them.
struct RunOptions {
  size_t size = sizeof(RunOptions);
  // Time 0 in seconds since 1970. With 0, the times of this class are themselves seconds since
  // 1970.
  double epoch = worldEpoch;
  // Lets every Script send to other nodes and change routes, as the browsers of 1997 did. If false,
  // only Scripts with directOutput TRUE may (6.40).
  bool directOutputAlways = false;
  // Seconds of processor time that the calls of all Scripts may take together while scriptPatience
  // is 0; on the wall clock ten times as many. The budget grows by the same amount for each second
  // of world time. When it is used up, all Scripts are stopped with one error.
  double worldScriptSeconds = 30;
  // Called after each Script that has been started, so that an application can show progress. [the
  // browser's thread; also within the constructor]
  std::function<void(const ScriptCounts& counts)> onScriptStart;
};

// A running world, as a program sees it. Wide because it is the counterpart of the Browser object
// of ISO/IEC 14772-1 4.12.10, of the viewer and of the pointing devices.
class Browser {
 public:
  // Takes over a loaded world. Sensors, Scripts, bindable nodes and routes become active at time
  // `start`; the first tick shows the world at that time. All times of this class are seconds after
  // the epoch. Nodes and Scripts see epoch + time.
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
  // Advances the world to `time` (seconds after epoch(), not before now()): sensors send events,
  // routes deliver them and Scripts run until no event is left.
  void tick(double time);
  // Returns the changes since the last call, for OpenRTMapper::update. The list starts empty when
  // another world takes this one's place (see generation()).
  FieldChanges takeChanges();
  bool hasChanges() const;      // true if takeChanges would return any
  ScriptCounts scripts() const; // what the world's Scripts have done so far
  // Changes BrowserOptions::scriptPatience from the next tick on, in seconds. Negative values and
  // NaN count as 0. Programs that are late then go on beside the world. With more than 0, a viewer
  // that moves and a pointer that hovers pass through large meshes until these are prepared for
  // rays, beside the world; pick() and the pointer's button wait for them.
  void setScriptPatience(double seconds);
  // Grows by one when another world takes the place of this one (loadUrl, replaceWorld). Make a new
  // mapper then.
  uint64_t generation() const;

  // --- Fields and events ---
  // Returns the node that a DEF name of the file refers to; null if there is none.
  NodeRef node(std::string_view name) const;
  // Sends an event to an exposedField or eventIn (a cascade at now()), or sets a field directly.
  // False if there is no such field or the value is of another type.
  bool set(Node& node, std::string_view field, Value value);
  // Returns the value of a field or exposedField, or the last value that an eventOut sent. Throws
  // std::invalid_argument if the node has no such field or event.
  Value get(const Node& node, std::string_view field) const;
  // Registers a callback for each event that an eventOut or exposedField sends. Returns a number
  // for unlisten, or 0 if there is no such event.
  using Callback = std::function<void(Node& node, const FieldInfo& out, const Value& value)>;
  uint64_t listen(Node& node, std::string_view out, Callback callback);
  void unlisten(Node& node, uint64_t number);

  // --- The viewer ---
  BoundNodes bound() const;
  // Returns the camera at the viewer's position: the bound Viewpoint, plus the navigation since it
  // was bound. aspect: width / height.
  CameraSettings camera(double aspect) const;
  // Moves the viewer to another place, as navigation does. view: camera to world, column-major,
  // rotation and translation only. A matrix with a number that is not finite is ignored.
  void placeViewer(const double view[16]);
  // Sets the direction in the world that is up for navigation while no Viewpoint is bound; 0 1 0 by
  // default. A vector that is not finite or has no length is ignored.
  void setUp(const double up[3]);
  // Sets the seconds of world time in which the camera follows when the viewer jumps to another
  // Viewpoint. With 0, the default, it jumps at once.
  void setTransition(double seconds);
  // Returns the Viewpoints in the order of the files, Inlines and prototypes included.
  std::vector<ViewpointName> viewpoints() const;
  // Binds a Viewpoint by its DEF name or else by its description. Returns false if there is none.
  bool bindViewpoint(std::string_view name);
  // Finds the nearest thing along a ray. Returns false if the ray hits nothing.
  bool pick(const double origin[3], const double direction[3], const PickOptions& options,
            PickHit& hit);
  // Finds the first place of a node in the scene. Returns false if it has none.
  bool locate(Node& node, NodePlacement& placement);
  // Places the pointer at (x, y) of the picture, from -1 at the left and bottom to 1 at the right
  // and top. button: it is pressed. Pointing sensors send at now().
  void pointer(double x, double y, bool button);
  // Sets width / height of the picture, for pointer() and VisibilitySensors; 4/3 by default.
  void setAspect(double aspect);
  // Does the same as pointer() for a ray in the world.
  void pointerRay(const double origin[3], const double direction[3], bool button);
  void pointerLeave(); // the pointer has left the picture, button released
  // Returns the pointing sensors and Anchors that the pointer is over or that have grabbed it.
  std::vector<NodeRef> sensorsAtPointer() const;
  // Does what a click on an Anchor does (6.2). If the Anchor's first url names a Viewpoint (#name),
  // it is bound. Otherwise the onAnchor callback is called, or loadUrl if none is set.
  void activate(Node& anchor);
  // Sets the callback for an Anchor whose urls lead elsewhere. [called within pointer or activate,
  // outside of cascades]
  void onAnchor(std::function<void(Node& anchor)> callback);
  // Presses or releases a key of the world's keyboard for the KeySensor or StringSensor that is
  // enabled (ISO/IEC 19775-1 21), at now(). name: the character that the key types, in UTF-8, or F1
  // to F12, Home, End, PageUp, PageDown, Up, Down, Left, Right, Shift, Control, Alt, Enter,
  // Backspace, Tab, Escape, Delete or Space. Returns false if no sensor is enabled, or for any
  // other name. The viewer does not move.
  bool worldKey(std::string_view name, bool pressed);
  // Presses and releases the key of each character of a text in UTF-8; a line feed is Enter.
  bool worldText(std::string_view text);
  bool sensesKeys() const; // a KeySensor or StringSensor in the scene is enabled
  // Moves the viewer for dt seconds, at now(). Call it between ticks.
  void navigate(const NavigationInput& input, double dt);
  void key(Key key, bool pressed); // while an arrow key is held, ticks move the viewer
  Navigation navigation() const;   // the navigation type in use
  // Sets the navigation type. Returns false if the bound NavigationInfo does not allow it; its
  // first type is used then.
  bool setNavigation(Navigation type);

  // --- The Browser object (4.12.10) ---
  std::string name() const;
  std::string version() const;
  double currentSpeed() const;     // metres per second
  double currentFrameRate() const; // the last value given to setFrameRate; 0 at first
  void setFrameRate(double framesPerSecond);
  std::string worldUrl() const;
  void setDescription(std::string text);
  std::string description() const;
  // Makes nodes from VRML text. The text needs no header and has its own scope of names, prototypes
  // and routes. The nodes are part of the world at once, but not of its scene. Routes live as long
  // as the nodes they start from. Errors in the text are reported in world().diagnostics. Throws
  // LoadError if nothing of the text can be used. base: the file that relative URLs are relative
  // to; "" means the world's file.
  MFNode createVrmlFromString(std::string_view text, const std::string& base = "");
  // Makes an instance of a prototype, with its defaults, in the same way. Null if its name cannot
  // stand in a file.
  NodeRef createInstance(const ProtoPtr& prototype, const std::string& base = "");
  // The next three calls wait for the end of the cascade if one is under way. base: the file that
  // relative URLs are relative to; "" means the world's file.
  //
  // Sends the nodes of the first file that can be read to an eventIn as an MFNode, in a cascade of
  // its own.
  void createVrmlFromUrl(const std::vector<std::string>& urls, Node& node, std::string_view eventIn,
                         const std::string& base = "");
  // Replaces this world by another. "#name" and "file#name" bind a viewpoint. If no URL can be
  // read, this world stays as it is.
  void loadUrl(const std::vector<std::string>& urls,
               const std::vector<std::string>& parameters = {}, const std::string& base = "");
  // Replaces all nodes of the world by these, with their descendants and the targets of their
  // routes.
  void replaceWorld(const MFNode& nodes);

  // --- Editing ---
  // Returns a node with default fields. Throws std::invalid_argument for an unknown type.
  NodeRef createNode(std::string_view type);
  void addRoot(NodeRef node);
  void removeRoot(Node& node);
  // Loads the content of an Inline that has none yet (LoadOptions::loadInlines). loadInlines does
  // so for all Inlines of the world and those inside their content, and returns how many it loaded.
  // Failures are reported in the diagnostics.
  bool loadInline(Node& inlineNode);
  uint64_t loadInlines();
  bool addRoute(Node& from, std::string_view out, Node& to, std::string_view in);
  bool deleteRoute(Node& from, std::string_view out, Node& to, std::string_view in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace xvrml
