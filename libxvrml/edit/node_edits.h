// node_edits.h: the edits of nodes and names that an editor's edits consist of. Each changes the
// document and the live world alike, as a part of the open step. Internal; the thread that owns the
// world.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "edit/edited_file.h"
#include "edit/history.h"

namespace xvrml {

class NodeEdits {
 public:
  NodeEdits(EditedFile& file, History& history) : file_(file), history_(history) {}

  // Puts a node at a place. In an SFNode, the routes of the node that stood there go with it.
  // Throws EditError if nodes would stand too deep in each other.
  void place(const Slot& slot, const Twin& node);
  // Takes the node at a place out, and returns it.
  Twin take(const Slot& slot);
  // Throws EditError if a node may not stand at a place, because of its type or because it would
  // become a part of itself.
  static void checkPlace(const Slot& slot, const Twin& node);
  void rename(const Twin& node, const std::string& name);
  // Gives a node a name if it has none.
  void ensureName(const Twin& node);
  // Gives the nodes of a text that has been read names that no other node has. No edit.
  void nameFreshly(const Twin& root);
  // Removes the routes whose nodes do not stand in the file any more.
  void dropRoutes();

 private:
  void setSingle(const Slot& slot, const Twin& node);
  void changeList(const Slot& slot, const Twin& node, bool inserts);
  // The nodes with names in a node that stands in the file, itself included, and how much memory
  // all of its nodes take, about.
  struct Named {
    std::vector<Twin> twins;
    uint64_t bytes = 0;
  };
  Named namedIn(const Twin& root);
  void giveToLast(Scope& scope, const std::string& name);
  void updateNames(const std::vector<Twin>& named);

  EditedFile& file_;
  History& history_;
};

} // namespace xvrml
