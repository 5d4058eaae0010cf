// interaction.cpp: passes the engine's notifications on to the parts that depend on them.
#include "behaviour/viewer/interaction.h"

#include "behaviour/named_fields.h"

namespace xvrml {

std::unique_ptr<EngineObserver> makeInteraction(Engine& engine) {
  return std::make_unique<Interaction>(engine);
}

void Interaction::began(const Scope& scope) {
  this->scope = &scope;
  navigation.resetMotion();
  binding.bindFirst(scope);
}

void Interaction::changed(Node& node, const FieldInfo& field) {
  switch (field.change) {
  case Change::transform:
  case Change::geometry:
  case Change::children: picker.changed(node); break;
  default: break;
  }
  if (isField<"viewAll">(node, field) && &node == binding.bound().viewpoint) viewer.showAll();
  moved_ |= field.change == Change::transform || field.change == Change::view ||
            field.change == Change::children;
}

void Interaction::forgotten(const Node& node) {
  picker.forgotten(node);
  binding.forget(node);
  navigation.forget(node);
  pointer.forget(node);
  keyboard.forget(node);
}

void Interaction::ticked() {
  navigation.ticked();
  viewer.ticked();
}

bool Interaction::settled() {
  bool sent = false;
  if (structure_ != engine.structure()) {
    structure_ = engine.structure();
    sent = binding.dropAbsent();
    sent |= pointer.dropAbsent();
  }
  if (std::exchange(moved_, false)) viewer.settled();
  // Regions that a jump leaves or enters send their events at the time of the binding (clause
  // 6.53).
  if (viewer.takeJump()) {
    navigation.resetMotion();
    engine.lookNow();
    sent = true;
  }
  return sent;
}

} // namespace xvrml
