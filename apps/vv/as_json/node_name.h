// node_name.h: Says how a client names nodes and their fields. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace vv::json {

// A node as a client names it: a DEF name of the world, or a number that the client was given.
using NodeName = std::variant<std::string, uint64_t>;
std::string shownNode(const NodeName& name);

struct FieldName {
  NodeName node;
  std::string field;
};

} // namespace vv::json
