// names.h: the DEF names of one scope that is written: which nodes need one, and which have been
// written. Used by the writers, on their thread.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "xvrml/world.h"

namespace xvrml {

// Returns a name that the parsers of VRML97 and of X3D accept. The file's own spelling stays if
// they do.
std::string nameText(const std::string& name);

class Names {
 public:
  // Nodes that are used more than once, also by a route, get a name if they have none.
  Names(const std::vector<Node*>& roots, const std::vector<Route>& routes);

  // Marks a node as written. Returns false if it has been written before.
  bool begin(const Node* node) { return written_.insert(node).second; }
  bool isWritten(const Node* node) const { return written_.contains(node); }
  // Returns null for a node without a name.
  const std::string* find(const Node* node) const {
    const auto found = names_.find(node);
    return found == names_.end() ? nullptr : &found->second;
  }
  // Returns whether the name refers to several nodes, one after the other.
  bool isRepeated(const Node* node) const {
    const std::string* name = find(node);
    return name && repeated_.contains(*name);
  }

 private:
  std::unordered_map<const Node*, std::string> names_;
  std::unordered_set<std::string> repeated_;
  std::unordered_set<const Node*> written_;
};

} // namespace xvrml
