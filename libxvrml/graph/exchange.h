// exchange.h: what a file shares with the files around and within it by the statements IMPORT and
// EXPORT of X3D (ISO/IEC 19775-1 4.4.6, 7.2.5). The builder fills it in, the loader and the event
// engine resolve it, the writers write it again. [the thread that owns the world]
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/world.h"

namespace xvrml {

struct Exchange {
  // IMPORT inlineName.exported AS local. The name belongs to routes alone.
  struct Import {
    NodeRef inlineNode;
    std::string exported, local;
    SourcePosition source;
    bool reported = false; // a message has said that the Inline exports no such node
  };
  // EXPORT name AS exported
  struct Export {
    NodeRef node;
    std::string exported;
  };
  // One end of a route: a node of this file, or the number of an import.
  struct End {
    NodeRef node; // null: imported
    size_t import = 0;
    std::string field; // as written
  };
  struct ImportedRoute {
    End from, to;
    SourcePosition source;
    bool reported = false; // a message has said that there are no such events
  };
  std::vector<Import> imports;
  std::vector<Export> exports;
  std::vector<ImportedRoute> routes; // those with an imported end
};

// Returns the node that the content of an Inline exports under a name. Null: there is none, or the
// Inline has no content.
Node* exportedNode(const Node& inlineNode, std::string_view name);

// The two ends of a route whose nodes exist.
struct ResolvedRoute {
  Node *from, *to;
  const FieldInfo *out, *in;
};
// Returns the routes of a file that can be connected, those of one Inline or of all (null). Imports
// and routes that are wrong, although the Inlines have their content, are reported once.
std::vector<ResolvedRoute> resolveImports(Exchange& exchange, const Node* inlineNode,
                                          Diagnostics& diagnostics);

// Return and set what a world's own file shares; null: nothing. It lives as long as the world.
std::shared_ptr<Exchange> exchangeOf(const World& world);
void setExchange(const World& world, std::shared_ptr<Exchange> exchange);
void forgetExchange(const World& world) noexcept; // called by the world's destructor

} // namespace xvrml
