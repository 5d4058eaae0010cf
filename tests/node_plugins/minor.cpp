// minor.cpp: a node plug-in as nodegen wrote it for minor version MINOR of the interface, with a
// node Pictures0 or Pictures1. No field says that it holds URLs: minor 0 had no word for it.
#include <cstddef>

#include "xvrml/node_plugin.h"

using namespace xvrml;

namespace {

struct Pictures : Node {
  using Node::Node;
  MFString url, frontUrl, words;
};

#pragma GCC diagnostic ignored "-Winvalid-offsetof" // one base, not virtual

constexpr FieldRow described(const char* name, size_t offset) {
  return {name, FieldType::MFString, Access::exposedField, Change::none, 0, uint32_t(offset), {},
          "",   "Strings."};
}

constexpr FieldRow fields[] = {described("url", offsetof(Pictures, url)),
                               described("frontUrl", offsetof(Pictures, frontUrl)),
                               described("words", offsetof(Pictures, words))};
constexpr NodeRow row = {MINOR == 0 ? "Pictures0" : "Pictures1",
                         "child",
                         "minor",
                         "",
                         "A node with strings.",
                         fields,
                         createNode<Pictures>};
void registered(const NodeType&) {}
const NodePluginRow rows[] = {{&row, nullptr, registered}};

} // namespace

XVRML_NODE_PLUGIN = {nodePluginMagic,
                     nodePluginMajor,
                     MINOR,
                     sizeof(NodePlugin),
                     XVRML_CXX_ABI,
                     {nodePluginSizes[0], nodePluginSizes[1], nodePluginSizes[2],
                      nodePluginSizes[3], nodePluginSizes[4], nodePluginSizes[5],
                      nodePluginSizes[6], nodePluginSizes[7]},
                     1,
                     rows};
