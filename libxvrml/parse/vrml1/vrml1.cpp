// vrml1.cpp: reads the text into a tree, and converts the tree.
#include "parse/vrml1/vrml1.h"

#include <algorithm>

#include "graph/expander.h"
#include "parse/vrml1/converter.h"
#include "parse/vrml1/reader.h"

namespace xvrml {
namespace {

// Forgets the names of nodes that the graph did not need, such as normals that are too few.
void dropUnusedNames(Scope& scope) {
  std::vector<Node*> roots, nodes;
  for (const NodeRef& root : scope.roots) roots.push_back(root.get());
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes(roots, nodes, index);
  std::erase_if(scope.names, [&](const auto& one) { return !index.contains(one.second.get()); });
}

} // namespace

void readVrml1(Locator& locator, LoadState& state, ParsedFile& file, uint64_t depthLimit) {
  using namespace vrml1;
  const Limits& limits = state.options.limits;
  const uint64_t nesting = std::min(limits.nesting, depthLimit);
  const uint64_t before = state.budget.used();
  const Tree tree = Reader(locator, limits, state.budget, nesting).read();
  const uint64_t ofTree = state.budget.used() - std::min(before, state.budget.used());
  Graph graph(locator, state, file);
  file.scope.roots = Converter(graph, nesting).convert(tree);
  dropUnusedNames(file.scope);
  state.budget.give(ofTree); // the tree ends here
}

} // namespace xvrml
