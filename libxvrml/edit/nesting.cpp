#include "edit/nesting.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "xvrml/node_map.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// The nodes below some roots, each behind all that it holds. A node that holds itself, as Scripts
// and instances may, counts as if it did not.
class Graph {
 public:
  explicit Graph(std::vector<Node*> roots) : roots_(std::move(roots)) {
    struct Open {
      Node* node;
      bool isEntered;
    };
    SeenNodes seen;
    std::vector<Open> open;
    for (Node* root : roots_) open.push_back({root, false});
    while (!open.empty()) {
      const Open one = open.back();
      open.pop_back();
      if (!one.node) continue;
      if (one.isEntered) {
        ranks_.insert(one.node, uint32_t(nodes_.size()));
        nodes_.push_back(one.node);
      } else if (seen.insert(one.node)) {
        open.push_back({one.node, true});
        for (Node* child : childrenOf(*one.node)) open.push_back({child, false});
      }
    }
  }

  // Returns how many nodes stand in each other at most.
  uint64_t height() {
    std::vector<uint64_t> heights(nodes_.size(), 1);
    uint64_t highest = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      forEachBelow(i, [&](size_t child) { heights[i] = std::max(heights[i], heights[child] + 1); });
      highest = std::max(highest, heights[i]);
    }
    return highest;
  }

  // Returns in how many nodes a node stands at most, itself included; 0: it is not there.
  uint64_t depthOf(const Node& node) {
    const uint32_t* const rank = ranks_.find(&node);
    if (!rank) return 0;
    std::vector<uint64_t> depths(nodes_.size(), 1);
    for (size_t i = nodes_.size(); i-- > *rank;)
      forEachBelow(i, [&](size_t child) { depths[child] = std::max(depths[child], depths[i] + 1); });
    return depths[*rank];
  }

 private:
  const std::vector<Node*>& childrenOf(const Node& node) {
    children_.clear();
    appendChildren(node, children_);
    return children_;
  }
  template <class Visit> void forEachBelow(size_t i, const Visit& visit) {
    for (const Node* child : childrenOf(*nodes_[i]))
      if (const uint32_t* const rank = ranks_.find(child); rank && *rank < i) visit(*rank);
  }

  std::vector<Node*> roots_, nodes_, children_;
  NodeMap<uint32_t> ranks_; // places in nodes_
};

uint64_t heightOf(Node& node) { return Graph(std::vector<Node*>{&node}).height(); }

} // namespace

void Nesting::measure(const Scope& scope) { deepest_ = Graph(rootsOf(scope)).height(); }

bool Nesting::admits(const Scope& scope, const Node* parent, Node& node, uint64_t most) {
  admitted_ = &node;
  height_ = heightOf(node);
  if (!parent) return height_ <= most;
  if (deepest_ + height_ <= most) return true;
  Graph graph(rootsOf(scope));
  deepest_ = graph.height();
  return graph.depthOf(*parent) + height_ <= most;
}

void Nesting::note(Node& node) {
  deepest_ += std::exchange(admitted_, nullptr) == &node ? height_ : heightOf(node);
}

} // namespace xvrml
