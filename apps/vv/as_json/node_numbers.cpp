#include "as_json/node_numbers.h"

#include <fmt/format.h>

#include "as_json/json_line.h"

namespace vv::json {

uint64_t NodeNumbers::of(const xvrml::NodeRef& node) {
  if (const auto found = numbers_.find(node.get()); found != numbers_.end()) return found->second;
  if (nodes_.size() >= most_)
    throw CommandError("limit", fmt::format("this client has nodes={} numbers of nodes; release "
                                            "those that it needs no more",
                                            most_));
  nodes_.emplace(++last_, node);
  numbers_.emplace(node.get(), last_);
  return last_;
}

xvrml::NodeRef NodeNumbers::find(uint64_t number) const {
  const auto found = nodes_.find(number);
  return found == nodes_.end() ? xvrml::NodeRef() : found->second;
}

bool NodeNumbers::release(uint64_t number) {
  const auto found = nodes_.find(number);
  if (found == nodes_.end()) return false;
  numbers_.erase(found->second.get());
  nodes_.erase(found);
  return true;
}

void NodeNumbers::releaseAll() {
  numbers_.clear();
  nodes_.clear();
}

} // namespace vv::json
