// registry.h: adds node types to the registry that nodeTypes() and findNodeType() read.
#pragma once

#include <span>

#include "xvrml/versions.h"

namespace xvrml {

class Renderer;
struct RenderState;
enum class Visit : uint8_t;

// Appends types to the registry; the index of each must be its position there. Returns false, and
// adds nothing, if an index does not fit or a name is taken. The types must live for ever.  [any
// thread]
bool addNodeTypes(std::span<const NodeType* const> types);

// Calls the callback for a node if the renderer has those of the plug-in (NodePluginRow::render).
using RenderCall = bool (*)(Renderer& renderer, Node& node, const RenderState& state, Visit& visit);
// Keep it for the type of a plug-in. Types are added before worlds are loaded.
void setRenderCall(const NodeType& type, RenderCall call);
RenderCall renderCallOf(const NodeType& type); // null for all other types

// Returns the Shape that is drawn for a ParticleSystem (behaviour/particles/drawn.cpp), for
// NodeType::expand.  [the thread that owns the node]
NodeRef expandParticleSystem(const Node& node);

// Returns the name of the field that holds a node of this type in the XML encoding of X3D, where
// the file does not say it (containerField, ISO/IEC 19776-1): "geometry" for a Box. It is that of
// the type or of the nearest abstract type that has one, otherwise "children".  [any thread]
std::string_view containerOf(const NodeType& type);

namespace nodes {
struct AbsentNode;
}
// Returns what of a node is not done: "bodies do not move". "" for most types. [any
// thread]
std::string_view lackOf(const NodeType& type);
// Returns the row of a node of X3D, or of another browser, that the library does not have; null for
// every other name. [any thread]
const nodes::AbsentNode* findAbsentNode(std::string_view type);

namespace nodes {
// The nodes and abstract types whose description names a container. Written by nodegen.
struct Container {
  std::string_view type, field;
};
std::span<const Container> containers();

// Says what is not done of a node that the library has, as a clause of a message. Written by
// nodegen.
struct Lack {
  std::string_view type, text;
};
std::span<const Lack> lacks();

// The fields that a version of X3D describes otherwise, in the order of the types' numbers, then of
// the versions. Written by nodegen.
std::span<const FieldRevision> revisions();

// The nodes of X3D and of other browsers that the library does not have. Written by nodegen.
struct AbsentNode {
  std::string_view name;
  std::string_view origin; // the browser that has it; empty: it is X3D's
  std::string_view clause; // ISO/IEC 19775-1; empty: it is a browser's
  std::string_view kind;   // geometry, sensor, ...
  std::string_view loss;   // a clause of a message: "shapes with it are not drawn"
};
std::span<const AbsentNode> absentNodes();

// The types of all .node files, in the order of their numbers. Written by nodegen.
std::span<const NodeType* const> builtinNodeTypes();
} // namespace nodes

} // namespace xvrml
