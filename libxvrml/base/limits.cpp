// limits.cpp: the table of limits by name, for messages and for `vv --limit NAME=VALUE`. [any
// thread]
#include "xvrml/limits.h"

#include <array>

namespace xvrml {
namespace {

constexpr std::array<LimitInfo, 13> table = {{
    {"nesting", &Limits::nesting, "depth of nodes within nodes and of statements"},
    {"protoDepth", &Limits::protoDepth, "depth of prototypes that instantiate prototypes"},
    {"inlineDepth", &Limits::inlineDepth,
     "depth of files within files, and of Scripts that Scripts make"},
    {"expandedNodes", &Limits::expandedNodes, "nodes after all prototypes and USEs are expanded"},
    {"worldBytes", &Limits::worldBytes,
     "estimated memory of everything made from a world's files; 0: an eighth of the machine's"},
    {"interfaceFields", &Limits::interfaceFields,
     "declarations of one PROTO, EXTERNPROTO or Script"},
    {"stringBytes", &Limits::stringBytes, "bytes of one string"},
    {"arrayElements", &Limits::arrayElements, "numbers in one multiple-valued field"},
    {"fileBytes", &Limits::fileBytes, "bytes of one file, unpacked"},
    {"inflateRatio", &Limits::inflateRatio,
     "unpacked over packed size of a file above 1 MiB unpacked"},
    {"inflateBytes", &Limits::inflateBytes, "bytes a packed file may unpack to"},
    {"imagePixels", &Limits::imagePixels, "pixels of one image"},
    {"triangles", &Limits::triangles, "triangles made by one geometry node"},
}};
static_assert(sizeof(Limits) == table.size() * sizeof(uint64_t), "every limit has a row");

} // namespace

std::span<const LimitInfo> limitTable() { return table; }

bool setLimit(Limits& limits, std::string_view name, uint64_t value) {
  for (const LimitInfo& info : table) {
    if (info.name != name) continue;
    limits.*info.value = value;
    return true;
  }
  return false;
}

} // namespace xvrml
