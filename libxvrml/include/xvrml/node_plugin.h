// node_plugin.h: node types that come from shared libraries. A plug-in exports one constant,
// xvrmlNodePlugin; nodegen writes it, and the author gives each node its `implementation`
// (docs/node-plugins.md). Plug-ins are C++ and are built with the headers of the host's own
// version: what must agree is compared before anything of a plug-in runs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/behaviour.h"
#include "xvrml/node_table.h"

namespace xvrml {

// What a node of a plug-in does and how it is drawn; each may be left out.
struct NodeImplementation {
  Behaviour behaviour;
  // The standard nodes that the node stands for: an IndexedFaceSet for a geometry, a Transform for
  // something with children. It is asked again when a field has changed; what is the same as before
  // stays. Must be a function of the node's fields alone, hold the field's own nodes rather than
  // copies, and not the node itself. Null: nothing is drawn.  [the thread that owns the world]
  NodeRef (*expand)(const Node& node) = nullptr;
};

// A row a node type. Written by nodegen.
struct NodePluginRow {
  const NodeRow* row;
  const NodeImplementation* implementation;
  void (*registered)(const NodeType& type); // tells the plug-in its type and number in the registry
};

// ASCII "XVNP".
inline constexpr uint32_t nodePluginMagic = 0x58564e50;
// Hosts take plug-ins of their own major version and a minor version that is not greater.
inline constexpr uint32_t nodePluginMajor = 1, nodePluginMinor = 0;

// Which C++ library the values are laid out by, and how large the types are that both sides share.
#if defined(_LIBCPP_VERSION)
#define XVRML_CXX_ABI "libc++"
#elif defined(_GLIBCXX_USE_CXX11_ABI) && _GLIBCXX_USE_CXX11_ABI
#define XVRML_CXX_ABI "libstdc++ cxx11"
#else
#define XVRML_CXX_ABI "libstdc++"
#endif
inline constexpr uint32_t nodePluginSizes[] = {
    sizeof(Node),     sizeof(Value),     sizeof(NodeType),           sizeof(FieldInfo),
    sizeof(FieldRow), sizeof(Behaviour), sizeof(NodeImplementation), sizeof(NodeRow)};

struct NodePlugin {
  uint32_t magic;        // nodePluginMagic
  uint32_t major, minor; // of this interface
  uint32_t size;         // sizeof(NodePlugin)
  const char* abi;       // XVRML_CXX_ABI
  uint32_t sizes[8];     // nodePluginSizes
  uint32_t count;
  const NodePluginRow* rows;
};

inline constexpr const char* nodePluginSymbol = "xvrmlNodePlugin";
#define XVRML_NODE_PLUGIN                                                                          \
  extern "C" __attribute__((visibility("default"))) const ::xvrml::NodePlugin xvrmlNodePlugin

// --- For programs ---

// Where plug-ins are looked for: the folders given (separated by colons), those of
// $XVRML_NODE_PATH, then xvrml/nodes beside the library and beside the program, and in ../lib. What
// another user owns, may write or replace is refused.
std::vector<std::string> nodePluginFolders(std::string_view first);

// Loads all plug-ins (*.so) of these folders, in the order of the folders and of their names; one
// that is loaded already is passed over. Returns a line for each that is refused: what it is, and
// what was expected. Node types stay for ever: call it before worlds are loaded.  [any thread]
std::vector<std::string> loadNodePlugins(std::string_view first = {});

} // namespace xvrml
