// interaction.h: the viewer's part of a running world: the bound nodes, the viewer's position, the
// pointer. Each engine owns one; behaviours reach it through their Events. [the browser's thread]
#pragma once

#include "behaviour/viewer/binding.h"
#include "behaviour/viewer/keyboard.h"
#include "behaviour/viewer/navigation.h"
#include "behaviour/viewer/pick.h"
#include "behaviour/viewer/pointer.h"
#include "behaviour/viewer/viewer.h"
#include "event/engine.h"

namespace xvrml {

class Interaction final : public EngineObserver {
 public:
  explicit Interaction(Engine& engine)
      : engine(engine), viewer(engine, binding), binding(engine, viewer), picker(engine),
        pointer(*this), navigation(*this), keyboard(engine) {}

  void began(const Scope& scope) override;
  void changed(Node& node, const FieldInfo& field) override;
  void forgotten(const Node& node) override;
  void ticked() override;
  bool settled() override;

  Engine& engine;
  Viewer viewer;
  Binding binding;
  Picker picker;
  Pointer pointer;
  Navigator navigation;
  Keyboard keyboard;
  const Scope* scope = nullptr; // the world's scope; null before the world has begun
  double aspect = 4.0 / 3;      // width / height of the picture
  // Sounds in the scene when Engine::structure() was soundsStructure (see hearing.cpp).
  std::vector<Node*> sounds;
  uint64_t soundsStructure = ~uint64_t(0);

 private:
  uint64_t structure_ = 0; // Engine::structure() when it was last checked
  bool moved_ = true;      // something that may move the viewer has changed
};

std::unique_ptr<EngineObserver> makeInteraction(Engine& engine);
inline Interaction& interactionOf(Events& events) {
  return static_cast<Interaction&>(*Engine::of(events).observer);
}

} // namespace xvrml
