// pilot.h: what a hand does to a running world: the pointer on its sensors, navigation by mouse and
// keys, viewpoints, pausing. The same steps and events give the same world, whether a window is
// there or not. [the browser's thread]
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>

#include "libpicture/camera.h"
#include "window/input/keys.h"
#include "xvrml/browser.h"

namespace vv {

const char* navigationName(xvrml::Navigation type);

class Pilot {
 public:
  // start: the world's time at session time 0. fov: degrees, instead of the viewpoints'.
  Pilot(xvrml::Browser& browser, double start, std::optional<double> fov);

  // The session's time has come to `seconds`, not before the last one: the world's follows unless
  // it is paused, held keys and drags move the viewer.
  void step(double seconds);
  // Returns what is the window's business (frameAll and beginAgain among it: they need the world's
  // extent); none: it has been taken care of.
  Action handle(const InputEvent& event);

  void setAspect(double aspect); // of the picture, width / height
  double aspect() const { return aspect_; }
  // The whole world in view, seen in the direction of now. bounds: of the world as it is.
  void frameAll(const xvrml::Bounds& bounds);
  // Where the first picture is taken from. True if the whole world is to be framed: a fitted camera
  // is asked for, or there is no Viewpoint. Throws Failure if there is no such viewpoint.
  bool begin(const picture::View& view, const std::string& viewpoint);
  // From here on the viewer glides from one Viewpoint to the next.
  void smooth();
  // By DEF name, description or number from 0; false if there is none.
  bool bindViewpoint(const std::string& name);
  void putAt(const xvrml::CameraSettings& camera); // where another session was
  // The view that the world begins with where no Viewpoint says it, and the axis that is up in it.
  void present(const xvrml::CameraSettings& camera, xvrml::Axis up);
  // What that view is asked for by, from the options' view; nothing where a bound Viewpoint gives
  // the direction: frameAll() then.
  std::optional<picture::View> beginning(const picture::View& view) const;

  xvrml::CameraSettings camera() const;
  bool paused() const { return paused_; }
  std::optional<bool> headlight() const { return headlight_; } // as the user has switched it
  bool touched() const { return touched_; }                    // the user has moved the viewer
  bool overSensor() const { return overSensor_; }
  std::string hint() const; // of the Anchor under the pointer
  std::string takeMessage() { return std::exchange(message_, {}); }

 private:
  void point(bool button);
  void press(const InputEvent& event);
  void release(const InputEvent& event);
  void drag(double x, double y);
  void wheel(const InputEvent& event);
  Action press(Action action);
  void move(double seconds);
  void navigate(const xvrml::NavigationInput& input, double seconds);
  void jumpTo(size_t number);
  void choose(xvrml::Navigation type, const char* name);
  bool hasHeadlight() const;

  xvrml::Browser& browser_;
  double start_, session_ = 0,
                 lost_ = 0; // lost: seconds of the session in which the world's time stood still
  std::optional<double> fov_;
  double aspect_ = 4.0 / 3;
  bool paused_ = false, touched_ = false;
  bool falls_ = false; // gravity acts: the user has walked
  std::optional<bool> headlight_;

  // The pointer.
  enum class Drag : uint8_t { none, sensor, view };
  bool inside_ = false, overSensor_ = false;
  double x_ = 0, y_ = 0;
  Drag drag_ = Drag::none;
  InputEvent pressed_; // what began the drag
  std::set<std::string> held_;
  bool shift_ = false, alt_ = false;
  std::string message_;
};

} // namespace vv
