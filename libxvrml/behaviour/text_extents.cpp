// text_extents.cpp: the outputs of Text that X3D adds: lineBounds, textBounds and origin (ISO/IEC
// 19775-1 15.4.2). They are sent at the first tick and whenever the text changes. Text of files of
// VRML97 has no such outputs and sends nothing.
#include "behaviour/builtin.h"
#include "behaviour/named_fields.h"
#include "geometry/text/text_extent.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

void sendExtents(Events& events, Node& node) {
  TextExtent extent = extentOf(static_cast<nodes::Text&>(node));
  sendFrom<"lineBounds">(events, node, std::move(extent.lines));
  sendFrom<"textBounds">(events, node, extent.text);
  sendFrom<"origin">(events, node, extent.origin);
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  if (versionOf(node).isX3d()) events.wantTicks(node, true);
  return nullptr;
}

void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  if (versionOf(node).isX3d() && in.change == Change::geometry) sendExtents(events, node);
}

void tick(Events& events, Node& node) {
  events.wantTicks(node, false);
  sendExtents(events, node);
}

} // namespace

void addTextBehaviours(const AddBehaviour& add) {
  Behaviour text;
  text.begin = begin;
  text.receive = receive;
  text.tick = tick;
  add(*findNodeType("Text"), text);
}

} // namespace xvrml
