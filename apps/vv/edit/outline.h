// outline.h: The nodes of a world's file as rows of a tree. A face draws the rows that it shows.
// Only nodes that are open are walked, so that a world of a million nodes costs no more than what
// is to be seen of it. [the browser's thread, while the world can be used]
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edit/node_fields.h"
#include "xvrml/browser.h"
#include "xvrml/world.h"

namespace vv {

struct OutlineRow {
  xvrml::NodeRef node;
  int depth = 0; // 0 for roots and for what a search has found
  bool canOpen = false, isOpen = false;
  bool isUse = false; // the node stands further up, too
  PlacedNode place{}; // this one of its places

  // Returns what the row says: "LAMP  PointLight", or "geometry: Box" in a field of its own. It is
  // made when the row is drawn, because most of a million are not.
  std::string label() const;
};

// Nodes whose children are to be seen. It keeps them, so that no address comes again.
using OpenNodes = std::map<const xvrml::Node*, xvrml::NodeRef>;

class Outline {
 public:
  // Returns the rows that are to be seen, from the top.
  std::vector<OutlineRow> rows(const xvrml::World& world) const;
  // Opens a node, so that its children are to be seen, or closes it.
  void setOpen(const xvrml::NodeRef& node, bool open);
  // Opens all nodes on the way from a root to this one. Returns those that were closed, the
  // outermost first; none: it is not in the file.
  std::optional<xvrml::MFNode> reveal(xvrml::Browser& browser, xvrml::Node& node);
  // Adds to rows, which rows() has returned, those of a node that has been opened since, or takes
  // out those of one that has been closed. Reads no others. Returns false if all rows must be read
  // again: the node's row is not there, or what is in it stands elsewhere in them, too.
  bool changeRowsOf(const xvrml::Node& node, std::vector<OutlineRow>& rows) const;

  // Returns the nodes whose DEF name, type or field names have this text, in any case, in the order
  // of the file; at most `most`.
  static std::vector<OutlineRow> find(const xvrml::World& world, std::string_view text,
                                      size_t most);

 private:
  OpenNodes open_;
};

// Returns what a row says of a node: its DEF name and its type.
std::string labelOf(const xvrml::Node& node);

// Returns the nodes of a path through the scene that stand in the world's file: each is a root, or
// in a field of one before it. Bodies of prototypes and contents of Inlines are left out.
xvrml::MFNode nodesOfFile(const xvrml::World& world, const std::vector<xvrml::PickHit::Step>& path);
// Returns the nodes from a root of the file to this one, in one of its places; empty if it is not
// in the file. Cheap for nodes of the scene; for others the file is walked.
std::vector<xvrml::Node*> pathTo(xvrml::Browser& browser, xvrml::Node& node);

} // namespace vv
