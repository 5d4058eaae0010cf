// hierarchy.h: the transformation hierarchy of a running world (clause 4.4.4): children and paths.
// A prototype instance has the first node of its body as its child, an Inline the nodes it loaded.
// Scripts have no children. [the browser's thread]
#pragma once

#include "event/live.h"
#include "geometry/matrix.h"

namespace xvrml {

// Appends the children of a node, in the order of its fields. A node that is held twice appears
// twice.
void childrenInHierarchy(Node& node, std::vector<Node*>& out);

// Appends those of these children that have a place in the scene below the node. A node of the
// role `listing` only names others (appendPlaced): a LoadSensor watches nodes that stand elsewhere.
void childrenInScene(Node& node, std::vector<Node*>& out);

// The nodes from a root of the world to a node, prototype instances and Inlines included.
using Path = std::vector<Node*>;

// Returns all paths from the roots to a node that is part of the world, in no particular order, at
// most `limit`. Empty if no path leads to it.
std::vector<Path> pathsTo(const Node& node, size_t limit = 1000);

// Returns true if a path leads from a root of the world to the node.
bool isInScene(const Node& node);

// Returns the matrix of a path: the product of its Transforms. It maps the coordinates of the last
// node's children to the world. Billboards are taken as not rotated.
Matrix localToWorld(const Path& path);

// Returns false if a Switch on the path has chosen another child. LODs count as showing any level.
bool isChosen(const Path& path);

} // namespace xvrml
