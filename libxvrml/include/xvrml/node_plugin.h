// node_plugin.h: node types from shared libraries. A plug-in exports one constant, xvrmlNodePlugin.
// nodegen writes that constant; the author writes the `implementation` of each node
// (docs/node-plugins.md). Plug-ins are C++ and must be built with the headers of the host's own
// version: the host compares versions and type sizes before any code of a plug-in runs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/behaviour.h"
#include "xvrml/node_table.h"
#include "xvrml/renderer.h"

namespace xvrml {

// The behaviour and the expansion of a plug-in's node. Each may be left out.
struct NodeImplementation {
  Behaviour behaviour;
  // Returns the standard nodes that the node stands for: an IndexedFaceSet for a geometry, a
  // Transform for a node with children. It is called again when a field has changed; parts of the
  // result that are the same nodes as before are kept. The result must depend on the node's fields
  // alone, hold the fields' own nodes rather than copies, and not hold the node itself. Null:
  // nothing is drawn.  [the thread that owns the world]
  NodeRef (*expand)(const Node& node) = nullptr;
};

// One row per node type. Written by nodegen.
struct NodePluginRow {
  const NodeRow* row;
  const NodeImplementation* implementation;
  // Tells the plug-in its type and its index in the registry.
  void (*registered)(const NodeType& type);
  // Calls the callback for the node if the renderer has those of the plug-in. Returns false if not.
  bool (*render)(Renderer& renderer, Node& node, const RenderState& state, Visit& visit);
};

// ASCII "XVNP".
inline constexpr uint32_t nodePluginMagic = 0x58564e50;
// A host accepts plug-ins of its own major version and a minor version that is not greater than its
// own.
inline constexpr uint32_t nodePluginMajor = 1, nodePluginMinor = 0;

// The C++ library that determines the layout of values, and the sizes of the types that both sides
// share.
#if defined(_LIBCPP_VERSION)
#define XVRML_CXX_ABI "libc++"
#elif defined(_GLIBCXX_USE_CXX11_ABI) && _GLIBCXX_USE_CXX11_ABI
#define XVRML_CXX_ABI "libstdc++ cxx11"
#else
#define XVRML_CXX_ABI "libstdc++"
#endif
inline constexpr uint32_t nodePluginSizes[] = {
    sizeof(Node),          sizeof(Value),      sizeof(NodeType),           sizeof(FieldInfo),
    sizeof(FieldRow),      sizeof(Behaviour),  sizeof(NodeImplementation), sizeof(NodeRow),
    sizeof(NodePluginRow), sizeof(RenderState)};

struct NodePlugin {
  uint32_t magic;        // nodePluginMagic
  uint32_t major, minor; // version of this interface
  uint32_t size;         // sizeof(NodePlugin)
  const char* abi;       // XVRML_CXX_ABI
  uint32_t sizes[10];    // nodePluginSizes
  uint32_t count;
  const NodePluginRow* rows;
};

inline constexpr const char* nodePluginSymbol = "xvrmlNodePlugin";
#define XVRML_NODE_PLUGIN                                                                          \
  extern "C" __attribute__((visibility("default"))) const ::xvrml::NodePlugin xvrmlNodePlugin

// --- For programs ---

// Returns the folders that are searched for plug-ins, in this order: `first` (separated by colons),
// $XVRML_NODE_PATH, xvrml/nodes beside the library, beside the program, and in ../lib. A folder or
// file that another user owns, may write or may replace is refused.
std::vector<std::string> nodePluginFolders(std::string_view first);

// Loads all plug-ins (*.so) of these folders, in the order of the folders and then of their names.
// A plug-in that is already loaded is skipped. Returns a line for each refused one: what it is, and
// what was expected. Node types are never unloaded; call this before worlds are loaded.  [any
// thread]
std::vector<std::string> loadNodePlugins(std::string_view first = {});

} // namespace xvrml
