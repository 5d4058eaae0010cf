// pilot.h: Applies user input to a running world: the pointer on its sensors, navigation by mouse
// and keys, viewpoints, pausing. The same steps and events give the same world, with or without a
// window. A world has one pilot that moves its viewer, and may have more that move guests.
// [the browser's thread]
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "libpicture/camera.h"
#include "session/input/keys.h"
#include "session/input/pointer.h"
#include "session/input/world_keys.h"
#include "session/viewer.h"
#include "session/world_time.h"
#include "xvrml/browser.h"

namespace vv {

const char* navigationName(xvrml::Navigation type);

// Wide because every way to move the viewer, by keys, pointer or programs, is a function here.
class Pilot {
 public:
  // start: the world's time at session time 0. The projection of `view` (fov, ortho) replaces that
  // of the Viewpoints.
  Pilot(xvrml::Browser& browser, double start, const picture::View& view);
  // Makes the pilot of a guest, who begins where the viewer of `leader` is and shares the world's
  // pointer and time with it.
  explicit Pilot(const Pilot& leader, xvrml::Browser& browser);
  Pilot(const Pilot&) = delete; // the pointer refers to its pilot
  Pilot& operator=(const Pilot&) = delete;

  // Advances the session to `seconds`, which must not decrease. The world's time follows unless it
  // is paused. Held keys and drags move the viewer.
  void step(double seconds);
  // Handles an event. Returns the action that is left to the window (including frameAll and
  // beginAgain, which need the world's extent), or none.
  Action handle(const InputEvent& event);
  // Keys that count as the window's while the world is held: those that the world does not get, or
  // also those that both get.
  enum class Keys : uint8_t { ofWindow, shared };
  // Returns the action that handle() leaves to the window, for an event that does not reach the
  // world; for other events none. Changes nothing.
  Action windowAction(const InputEvent& event, Keys keys = Keys::ofWindow) const;

  void setAspect(double aspect); // width / height of the picture
  double aspect() const { return aspect_; }
  // Goes to a camera that shows the whole world in the current direction.
  void frameAll(const xvrml::CameraSettings& around);
  // Sets the camera of the first picture. Returns true if the whole world is to be shown: a fitted
  // camera was requested, or there is no Viewpoint. Throws Failure if the viewpoint does not exist.
  bool begin(const picture::View& view, const std::string& viewpoint);
  // Animates the viewer between Viewpoints from now on.
  void animateTransitions();
  // Binds a viewpoint by DEF name, description or number from 0; returns false if there is none.
  bool bindViewpoint(const std::string& name);
  // Does the same at once, without the animated transition.
  bool jumpToViewpoint(const std::string& name);
  // Pauses the world's time or lets it go on.
  void setPaused(bool paused);
  // Lets the world run for these seconds, in steps of 1/fps, although it is paused.
  void skip(double seconds, double fps);
  void putAt(const xvrml::CameraSettings& camera); // restores the camera of another session
  // Lets the user show false colours. given: the end of their scale in cd/m2, or 0 if pictures
  // choose it, and they are shown at once; none: pictures choose it when the user wants them.
  void allowFalseColours(std::optional<double> given);
  // Sets the initial view of a world without a Viewpoint, and its up axis.
  void present(const xvrml::CameraSettings& camera, xvrml::Axis up);
  // Returns the request for that initial view, from the options' view. Returns nothing if a bound
  // Viewpoint gives the direction; frameAll() applies then.
  std::optional<picture::View> initialView(const picture::View& view) const;

  xvrml::CameraSettings camera() const { return camera(aspect_); }
  xvrml::CameraSettings camera(double aspect) const; // the same for a picture of another shape
  // Finds what is seen at a place of the picture. hit.distance: in metres. Returns false if nothing
  // is there. Camera shaders have rays of their own, which this does not follow.
  bool pick(double x, double y, xvrml::PickHit& hit) const;
  bool paused() const { return time_.isPaused(); }
  // the user's choice; none: not switched
  std::optional<bool> headlight() const { return headlight_; }
  double exposure() const { return exposure_; } // stops that the user has added
  // Tells whether pictures have light that can be measured, and not colours for screens. false for
  // vv serve, whose ServedWorld knows it.
  bool hasLight() const { return scaleEnd_.has_value(); }
  // the end of the scale of false colours, or 0 if pictures choose it; none: own colours are shown
  std::optional<double> falseColour() const {
    return showsFalseColours_ ? scaleEnd_ : std::nullopt;
  }
  bool hasViewerMoved() const { return touched_; } // the user has moved the viewer
  bool overSensor() const { return pointer_.isOverSensor(); }
  xvrml::Navigation navigation() const { return viewer_->navigation(); }
  // The Viewpoint that the viewer stands at; null: none.
  const xvrml::Node* viewpoint() const { return viewer_->viewpoint(); }
  // Tells whether input that is held down moves the viewer: keys, or the pointer while walking.
  bool isSteering() const;
  // Returns the description of the Anchor or sensor under the pointer.
  std::string hint() const;
  std::string takeMessage() { return std::exchange(message_, {}); }

 private:
  Pointer::Eye eye() const { return {camera(), aspect_}; }
  void fitTo(const xvrml::CameraSettings& camera); // places the viewer
  void drag(const Pointer::Way& way);
  void wheel(const InputEvent& event);
  Action press(Action action);
  void move(double seconds);
  void navigate(const xvrml::NavigationInput& input, double seconds);
  void jumpTo(size_t number);
  void choose(xvrml::Navigation type, const char* name);
  bool hasHeadlight() const;

  xvrml::Browser& browser_;
  std::unique_ptr<Viewer> viewer_;
  WorldTime time_;
  Pointer pointer_;
  std::optional<double> fov_, ortho_;
  // The projection of a view that shows all, and the Viewpoint that the viewer had then. It
  // replaces that of the Viewpoint if one of them is parallel.
  struct Fitted {
    const xvrml::Node* viewpoint;
    double fovy, height; // as in CameraSettings
  };
  std::optional<Fitted> fitted_;
  double aspect_ = 4.0 / 3;
  bool touched_ = false;
  bool animates_ = false;    // the viewer moves gradually between Viewpoints
  bool gravityActs_ = false; // gravity acts, because the user has walked
  std::optional<bool> headlight_;
  double exposure_ = 0;
  std::optional<double> scaleEnd_; // end of the scale, 0: chosen by pictures; none: not allowed
  bool showsFalseColours_ = false;
  std::set<std::string> held_; // keys that are held down
  WorldKeys worldKeys_;        // keys that the world's sensors get
  bool shift_ = false, alt_ = false;
  std::string message_;
};

} // namespace vv
