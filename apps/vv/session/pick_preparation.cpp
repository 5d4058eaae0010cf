#include "session/pick_preparation.h"

#include <exception>

namespace vv {

PickPreparation::~PickPreparation() {
  if (thread_.joinable()) thread_.join();
}

void PickPreparation::begin(xvrml::Browser& browser, const xvrml::CameraSettings& camera) {
  if (state_ != State::waiting) return;
  state_ = State::running;
  thread_ = std::thread([this, &browser, camera] {
    const double* m = camera.matrix;
    const double origin[] = {m[12], m[13], m[14]}, direction[] = {-m[8], -m[9], -m[10]};
    try {
      xvrml::PickHit hit;
      browser.pick(origin, direction, {}, hit);
    } catch (const std::exception&) {} // out of memory: the next user of the structures reports it
    state_ = State::done;
  });
}

} // namespace vv
