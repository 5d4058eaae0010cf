#include "session/input/pointer.h"

namespace vv {

std::shared_ptr<SharedPointer> makeSharedPointer() { return std::make_shared<SharedPointer>(); }

// The world may be gone already, so that it is told nothing.
Pointer::~Pointer() {
  if (shared_->holder == this) shared_->holder = nullptr;
}

void Pointer::take() {
  Pointer* const before = shared_->holder;
  if (before == this || (before && before->drag_ == Drag::sensor)) return;
  if (before) before->place_ = Place::inside;
  shared_->holder = this;
}

Pointer::Way Pointer::moveTo(double x, double y) {
  const Way way{x - x_, y - y_};
  x_ = x;
  y_ = y;
  if (place_ == Place::outside) place_ = Place::inside;
  take();
  return way;
}

void Pointer::send() {
  if (shared_->holder != this) return;
  const Eye eye = eye_();
  const xvrml::CameraRay ray = xvrml::rayThrough(eye.camera, eye.aspect, x_, y_);
  const uint64_t before = browser_.generation();
  browser_.pointerRay(ray.origin, ray.direction, drag_ == Drag::sensor);
  if (browser_.generation() != before) drag_ = Drag::none;
  place_ = browser_.sensorsAtPointer().empty() ? Place::inside : Place::overSensor;
}

void Pointer::press(const InputEvent& event) {
  if (drag_ != Drag::none) return;
  pressed_ = event;
  send();
  drag_ =
      event.button == Button::left && isOverSensor() && !event.forView ? Drag::sensor : Drag::view;
  if (drag_ == Drag::sensor) send();
}

void Pointer::release(const InputEvent& event) {
  if (drag_ == Drag::none || event.button != pressed_.button) return;
  drag_ = Drag::none;
  send();
}

void Pointer::leave() {
  place_ = Place::outside;
  drag_ = Drag::none;
  if (shared_->holder != this) return;
  shared_->holder = nullptr;
  browser_.pointerLeave();
}

Button Pointer::button() const {
  if (pressed_.button != Button::left) return pressed_.button;
  return pressed_.shift ? Button::right : pressed_.control ? Button::middle : Button::left;
}

} // namespace vv
