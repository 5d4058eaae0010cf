// keyboard.h: the keyboard of the world: KeySensor and StringSensor (ISO/IEC 19775-1 clause 21).
// One of them at a time is active. Keys that move the viewer are not its business (navigation.h).
// [the browser's thread]
#pragma once

#include <string_view>

#include "event/engine.h"

namespace xvrml {

class Keyboard {
 public:
  explicit Keyboard(Engine& engine) : engine_(engine) {}

  // Passes a key to the active sensor, within a cascade. The names are those of Browser::worldKey.
  // Returns false if there is no sensor or no such key.
  bool key(std::string_view name, bool pressed);
  // Returns whether a sensor of the scene is active.
  bool senses() const;
  // Makes a sensor the active one. The one before it gets an event enabled FALSE (21.2).
  void activate(Node& sensor);
  // Ends what activate() began; nothing if another sensor is active.
  void deactivate(Node& sensor);
  void forget(const Node& node);

 private:
  Engine& engine_;
  Node* active_ = nullptr;
};

// Returns the bytes of the first character of a text that is not empty; 1 if it is no UTF-8.
size_t utf8Length(std::string_view text);

} // namespace xvrml
