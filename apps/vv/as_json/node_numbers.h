// node_numbers.h: The numbers under which one client knows nodes. A node keeps its number until the
// client releases it, and is kept alive as long. Numbers are never used again. [the browser's
// thread]
#pragma once

#include <cstdint>
#include <unordered_map>

#include "xvrml/node.h"

namespace vv::json {

class NodeNumbers {
 public:
  // most: numbers that are not released.
  explicit NodeNumbers(size_t most) : most_(most) {}

  // Returns the number of a node; a new one if it has none. Throws CommandError ("limit").
  uint64_t of(const xvrml::NodeRef& node);
  // Returns null if the number was not given out or has been released.
  xvrml::NodeRef find(uint64_t number) const;
  // Returns false if there is no such number.
  bool release(uint64_t number);
  void releaseAll();
  size_t size() const { return nodes_.size(); }

 private:
  size_t most_;
  std::unordered_map<uint64_t, xvrml::NodeRef> nodes_;
  std::unordered_map<const xvrml::Node*, uint64_t> numbers_;
  uint64_t last_ = 0;
};

} // namespace vv::json
