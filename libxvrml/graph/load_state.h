// load_state.h: the state that all files of one world share while it is loaded: options, counters,
// and work still to be done.
#pragma once

#include <span>
#include <unordered_map>
#include <unordered_set>

#include "base/budget.h"
#include "base/globe.h"
#include "graph/exchange.h"
#include "xvrml/world.h"

namespace xvrml {

// Memory of a loaded world beside its nodes, in bytes. Estimates for glibc's allocator on 64 bits.
inline constexpr uint64_t bytesOfRoute = 250, bytesOfName = 120, bytesOfDeclaration = 400,
                          bytesOfPrototype = 1000, bytesOfConnection = 120;

struct TextLayout;

struct LoadState {
  World& world;
  const LoadOptions& options;
  Diagnostics& diagnostics;
  Budget& budget; // budget of the world, or of the world that this one becomes part of
  // Nodes USEd within their own DEF. An IS connection must not make such a node its own descendant
  // (4.4.4).
  std::unordered_set<const Node*> selfContaining;
  // For createVrmlFromString: roots of any type are accepted, because they may be added to any
  // field.
  bool anyRoots = false;
  // Prototypes that the world's own file may use without a declaration.
  std::span<const ProtoPtr> known = {};
  // Not null: the reader of the world's own file records there where everything stands.
  TextLayout* layout = nullptr;
  // Holds what the places on a globe count from; all files share it.
  GlobeOriginPtr globe = std::make_shared<GlobeOrigin>();
  bool full = false; // the budget has refused a node; reported once
  // Counts so far. Inlines can share a file that has neither routes nor Scripts.
  uint64_t routes = 0, scripts = 0;
  // Scripts and prototype instances whose fields may hold a node that they are part of; the same
  // nodes as in World::cyclic.
  std::unordered_set<const Node*> cycleHolders;
};

// The graph of a file, and its nodes that parsing leaves incomplete. Nodes in prototype bodies are
// not listed, because only their copies are completed.
struct ParsedFile {
  FileHead head;
  Scope scope;
  std::vector<NodeRef> instances;     // prototype instances to expand
  std::vector<NodeRef> inlines;       // Inline nodes to load
  std::shared_ptr<Exchange> exchange; // null: the file neither imports nor exports
};

} // namespace xvrml
