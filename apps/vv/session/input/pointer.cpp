#include "session/input/pointer.h"

#include <cmath>

namespace vv {

std::shared_ptr<SharedPointer> makeSharedPointer() { return std::make_shared<SharedPointer>(); }

Pointer::Ray Pointer::Eye::rayAt(double x, double y) const {
  const double* m = camera.matrix;
  const double size = camera.fovy > 0 ? std::tan(camera.fovy / 2) : camera.height / 2;
  const double across = x * size * aspect, along = y * size;
  Ray ray;
  for (int i = 0; i < 3; ++i) {
    const double aside = m[i] * across + m[4 + i] * along;
    ray.origin[i] = m[12 + i] + (camera.fovy > 0 ? 0 : aside);
    ray.direction[i] = -m[8 + i] + (camera.fovy > 0 ? aside : 0);
  }
  return ray;
}

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
  const Ray ray = eye_().rayAt(x_, y_);
  const uint64_t before = browser_.generation();
  browser_.pointerRay(ray.origin, ray.direction, drag_ == Drag::sensor);
  if (browser_.generation() != before) drag_ = Drag::none;
  place_ = browser_.sensorsAtPointer().empty() ? Place::inside : Place::overSensor;
}

void Pointer::press(const InputEvent& event) {
  if (drag_ != Drag::none) return;
  pressed_ = event;
  send();
  drag_ = event.button == Button::left && isOverSensor() ? Drag::sensor : Drag::view;
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
