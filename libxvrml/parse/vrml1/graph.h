// graph.h: makes the nodes of the VRML97 graph, and counts them against the limits of the world.
// [the thread that loads]
#pragma once

#include <string>
#include <unordered_set>

#include "base/locator.h"
#include "graph/load_state.h"
#include "parse/vrml1/tree.h"

namespace xvrml::vrml1 {

class Graph {
 public:
  Graph(Locator& locator, LoadState& state, ParsedFile& file)
      : locator_(locator), state_(state), file_(file) {}

  // Makes a node that stands where `from` is written. finish() must follow when its fields are set.
  template <class T> T* make(const TreeNode& from) {
    T* node = new T;
    node->source = from.source;
    ++state_.world.nodeCount;
    if (state_.world.nodeCount > state_.options.limits.expandedNodes)
      stop(from, "the world has more nodes than limit expandedNodes=" +
                     std::to_string(state_.options.limits.expandedNodes));
    return node;
  }
  // Brings the numbers of a node into their ranges, and reserves its memory from the world's
  // budget. Returns the node.
  NodeRef finish(NodeRef node);
  template <class T> NodeRef finish(T* node) { return finish(NodeRef(node)); }

  // Gives a node the DEF name of the node that it is made from. A node that is converted several
  // times, because it is USEd in several states, gives its name to the first result.
  void name(const NodeRef& node, const TreeNode& from);
  // Adds an Inline to those that the loader fills.
  void addInline(const NodeRef& node) { file_.inlines.push_back(node); }

  // Counts a node that the traversal visits, shared ones at each use.
  void visit(const TreeNode& node);
  // Stops the conversion with an error: the rest of the file is left out.
  void stop(const TreeNode& at, const std::string& reason);
  bool isStopped() const { return stopped_; }

  // Report what is wrong with a node.
  void warn(const TreeNode& at, std::string message) { locator_.warn(at.at, std::move(message)); }
  // The same, once for each `subject`.
  void warnOnce(const TreeNode& at, const std::string& subject, std::string message) {
    if (reported_.insert(subject).second) warn(at, std::move(message));
  }

 private:
  Locator& locator_;
  LoadState& state_;
  ParsedFile& file_;
  uint64_t visits_ = 0;
  bool stopped_ = false;
  std::unordered_set<std::string> reported_;
  std::unordered_set<const TreeNode*> named_;
};

} // namespace xvrml::vrml1
