// interaction.h: the viewer's part of a running world: what is bound, where the viewer is, what the pointer is over. One per
// engine, which owns it; behaviours reach it through their Events. [the browser's thread]
#pragma once

#include "behaviour/binding.h"
#include "behaviour/viewer.h"
#include "event/engine.h"

namespace xvrml {

class Interaction final : public EngineObserver {
 public:
  explicit Interaction(Engine& engine) : engine(engine), viewer(engine, binding), binding(engine, viewer) {}

  void began(const Scope& scope) override;
  void changed(Node& node, const FieldInfo& field) override;
  void forgotten(const Node& node) override;
  void ticked() override;
  bool settled() override;

  Engine& engine;
  Viewer viewer;
  Binding binding;

 private:
  uint64_t structure_ = 0; // of the engine, when it was last looked at
  bool moved_ = true;      // something that may carry the viewer has changed
};

std::unique_ptr<EngineObserver> makeInteraction(Engine& engine);
inline Interaction& interactionOf(Events& events) { return static_cast<Interaction&>(*static_cast<Engine&>(events).observer); }

} // namespace xvrml
