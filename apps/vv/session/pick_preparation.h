// pick_preparation.h: Builds the structures for picking and collision on a thread of its own, in
// parallel with the first picture. With millions of triangles this takes seconds, and the window
// must not wait. Owned by a session. [the browser's thread]
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "xvrml/browser.h"

namespace vv {

class PickPreparation {
 public:
  // The states follow each other in this order.
  enum class State : uint8_t {
    waiting, // nothing has been built; pointer events wait
    running, // the thread uses the browser: nothing else may use the world
    done
  };

  PickPreparation() = default;
  // Waits for the thread.
  ~PickPreparation();
  PickPreparation(const PickPreparation&) = delete;
  PickPreparation& operator=(const PickPreparation&) = delete;

  // Starts the thread, which casts a ray along the camera's direction; it does nothing in a later
  // state. The browser must outlive this object.
  void begin(xvrml::Browser& browser, const xvrml::CameraSettings& camera);
  State state() const { return state_; }

 private:
  std::atomic<State> state_{State::waiting};
  std::thread thread_;
};

} // namespace vv
