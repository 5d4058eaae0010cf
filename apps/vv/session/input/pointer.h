// pointer.h: Keeps the pointer on a running world: its place, and what its button drags. It sends
// the pointer's ray to the world's sensors; Pilot moves the viewer. [the browser's thread]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "session/input/input.h"
#include "xvrml/browser.h"

namespace vv {

class Pointer;

// A world has one pointer. If several people use it, it belongs to the one who moved last, and to
// nobody else while a sensor is dragged.
struct SharedPointer {
  Pointer* holder = nullptr; // null: nobody points
};
std::shared_ptr<SharedPointer> makeSharedPointer();

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
  struct Ray {
    double origin[3], direction[3];
  };
  struct Eye {
    xvrml::CameraSettings camera;
    double aspect = 1;
    // Returns the ray to a place of the picture. A camera shader may have others.
    Ray rayAt(double x, double y) const;
  };
  struct Way {
    double x = 0, y = 0; // in picture coordinates
  };

  // eye: is called for every ray, because an event may move the viewer.
  Pointer(xvrml::Browser& browser, std::function<Eye()> eye, std::shared_ptr<SharedPointer> shared)
      : browser_(browser), eye_(std::move(eye)), shared_(std::move(shared)) {}
  ~Pointer();
  Pointer(const Pointer&) = delete; // the shared pointer refers to its holder
  Pointer& operator=(const Pointer&) = delete;

  // Moves the pointer, without an effect on the world, and takes the world's pointer if it is free.
  // Returns the distance to its last place.
  Way moveTo(double x, double y);
  // Sends the pointer to the sensors. Does nothing while somebody else has the world's pointer.
  void send();
  // Begins a drag, unless another button has begun one.
  void press(const InputEvent& event);
  // Ends the drag that the same button has begun.
  void release(const InputEvent& event);
  void leave();

  Place place() const { return place_; }
  const std::shared_ptr<SharedPointer>& shared() const { return shared_; }
  Drag drag() const { return drag_; }
  bool isOverSensor() const { return place_ == Place::overSensor; }
  // Returns the button that began the drag; shift and control stand for other buttons.
  Button button() const;
  // Returns the distance from the press.
  Way sincePress() const { return {x_ - pressed_.x, y_ - pressed_.y}; }

 private:
  void take();

  xvrml::Browser& browser_;
  std::function<Eye()> eye_;
  std::shared_ptr<SharedPointer> shared_;
  Place place_ = Place::outside;
  Drag drag_ = Drag::none;
  double x_ = 0, y_ = 0;
  InputEvent pressed_; // the event that began the drag
};

} // namespace vv
