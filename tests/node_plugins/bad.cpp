// bad.cpp: node plug-ins that must be refused, each for the reason that its FAULT_... macro names.
#include "xvrml/node_plugin.h"
#include "xvrml/nodes.h"

using namespace xvrml;

namespace {

constexpr NodeRow row = {"Box", "geometry",
                         "bad", Standard::none,
                         "",    "A name that is taken.",
                         {},    createNode<nodes::Box>};
void registered(const NodeType&) {}
bool render(Renderer&, Node&, const RenderState&, Visit&) { return false; }
const NodePluginRow rows[] = {{&row, nullptr, registered, render}};

#ifdef FAULT_MAGIC
constexpr uint32_t magic = 1;
#else
constexpr uint32_t magic = nodePluginMagic;
#endif
#ifdef FAULT_MAJOR
constexpr uint32_t major = nodePluginMajor + 1;
#else
constexpr uint32_t major = nodePluginMajor;
#endif
#ifdef FAULT_MINOR
constexpr uint32_t minor = nodePluginMinor + 1;
#else
constexpr uint32_t minor = nodePluginMinor;
#endif
#ifdef FAULT_SIZE
constexpr uint32_t size = 8;
#else
constexpr uint32_t size = sizeof(NodePlugin);
#endif
#ifdef FAULT_ABI
constexpr const char* abi = "another library";
#else
constexpr const char* abi = XVRML_CXX_ABI;
#endif
#ifdef FAULT_SIZES
constexpr uint32_t nodeSize = nodePluginSizes[0] + 8;
#else
constexpr uint32_t nodeSize = nodePluginSizes[0];
#endif

} // namespace

#ifndef FAULT_NONE
XVRML_NODE_PLUGIN = {magic,
                     major,
                     minor,
                     size,
                     abi,
                     {nodeSize, nodePluginSizes[1], nodePluginSizes[2], nodePluginSizes[3],
                      nodePluginSizes[4], nodePluginSizes[5], nodePluginSizes[6],
                      nodePluginSizes[7], nodePluginSizes[8], nodePluginSizes[9]},
                     1,
                     rows};
#else
extern "C" const void* somethingElse();
extern "C" const void* somethingElse() { return rows; }
#endif
