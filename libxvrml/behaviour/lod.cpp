// lod.cpp: activeLevel_changed of LOD, X3D's level_changed (ISO/IEC 19775-1 23.4.3): the number of
// the level that the viewer's distance chooses. It is found once a tick, whether anything is drawn
// or not. An LOD at several places tells that of the first path to it.
#include "behaviour/lod.h"

#include "behaviour/named_fields.h"
#include "behaviour/viewer/interaction.h"
#include "event/hierarchy.h"
#include "geometry/descend.h"

namespace xvrml {
namespace {

struct State : NodeState {
  int32_t level = -1;
};

// Only an LOD whose level somebody reads is measured: worlds may have thousands of others.
bool isListenedTo(const Node& node) {
  const FieldInfo* const out = fieldNamed<"activeLevel_changed">(node);
  const Participant* part = liveOf(node)->part.get();
  if (!part) return false;
  for (const Link& link : part->links)
    if (link.out == out) return true;
  for (const auto& [number, listener] : part->listeners)
    if (listener.first == out) return true;
  return false;
}

} // namespace

void lookLod(Events& events, Node& node) {
  const auto& lod = static_cast<nodes::LOD&>(node);
  if (lod.level.empty() || !isListenedTo(node)) return;
  const std::vector<Path> paths = pathsTo(node, 1);
  if (paths.empty()) return;
  const Matrix view = interactionOf(events).viewer.view();
  Path above = paths[0];
  above.pop_back();
  const auto level = int32_t(levelFor(lod, Picker::toWorld(above, view), view));
  auto& state = static_cast<State&>(*events.state(node));
  if (std::exchange(state.level, level) != level)
    sendFrom<"activeLevel_changed">(events, node, level);
}

std::unique_ptr<NodeState> beginLod(Events& events, Node& node) {
  events.wantLooks(node, true);
  return std::make_unique<State>();
}

} // namespace xvrml
