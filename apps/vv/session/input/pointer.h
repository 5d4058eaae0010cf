// pointer.h: Keeps the pointer on a running world: its place, and what its button drags. It sends
// the pointer's ray to the world's sensors; Pilot moves the viewer. [the browser's thread]
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "session/input/input.h"
#include "xvrml/browser.h"

namespace vv {

class Pointer {
 public:
  // send() tells inside from overSensor, in every drag; leave() alone leads to outside.
  enum class Place : uint8_t { outside, inside, overSensor };
  // press() begins a drag. release() and leave() end it, and so does another world.
  enum class Drag : uint8_t {
    none,
    sensor, // the world's sensors get the pointer with its button
    view    // the viewer moves; the sensors get nothing
  };
  // The camera that the pointer's rays start from.
  struct Eye {
    xvrml::CameraSettings camera;
    double aspect = 1;
  };
  struct Way {
    double x = 0, y = 0; // in picture coordinates
  };

  // eye: is called for every ray, because an event may move the viewer.
  Pointer(xvrml::Browser& browser, std::function<Eye()> eye)
      : browser_(browser), eye_(std::move(eye)) {}

  // Moves the pointer, without an effect on the world. Returns the distance to its last place.
  Way moveTo(double x, double y);
  // Sends the pointer to the sensors.
  void send();
  // Begins a drag, unless another button has begun one.
  void press(const InputEvent& event);
  // Ends the drag that the same button has begun.
  void release(const InputEvent& event);
  void leave();

  Place place() const { return place_; }
  Drag drag() const { return drag_; }
  bool isOverSensor() const { return place_ == Place::overSensor; }
  // Returns the button that began the drag; shift and control stand for other buttons.
  Button button() const;
  // Returns the distance from the press.
  Way sincePress() const { return {x_ - pressed_.x, y_ - pressed_.y}; }

 private:
  xvrml::Browser& browser_;
  std::function<Eye()> eye_;
  Place place_ = Place::outside;
  Drag drag_ = Drag::none;
  double x_ = 0, y_ = 0;
  InputEvent pressed_; // the event that began the drag
};

} // namespace vv
