// load_state.h: what the files of one world share while it is loaded: options, counters, and lists
// of what is still to be done.
#pragma once

#include <unordered_map>
#include <unordered_set>

#include "base/budget.h"
#include "xvrml/world.h"

namespace xvrml {

// What a loaded world takes beside its nodes, in bytes: estimates for glibc's allocator on 64 bits.
inline constexpr uint64_t bytesOfRoute = 250, bytesOfName = 120, bytesOfDeclaration = 400,
                          bytesOfPrototype = 1000, bytesOfConnection = 120;

struct LoadState {
  World& world;
  const LoadOptions& options;
  Diagnostics& diagnostics;
  Budget& budget; // of the world, and of one that this one becomes part of
  // Nodes USEd within their own DEF. A connection of a prototype must not make such a node its own
  // descendant (4.4.4).
  std::unordered_set<const Node*> entered;
  bool anyRoots = false; // of createVrmlFromString: what it makes goes into any field, geometries
                         // into `geometry`
  bool full = false;     // the budget has refused a node: said once
  uint64_t routes = 0,
           scripts = 0; // made so far: a file without either can be shared by its Inlines
  // Scripts and prototype instances whose fields may hold what they are part of: those of
  // World::cyclic.
  std::unordered_set<const Node*> cycleHolders;
};

// A file's graph, and those of its nodes that are not complete when it has been parsed. Prototype
// bodies are not among them: their copies will be.
struct ParsedFile {
  Scope scope;
  std::vector<NodeRef> instances; // prototype instances to expand
  std::vector<NodeRef> inlines;   // Inline nodes to load
};

} // namespace xvrml
