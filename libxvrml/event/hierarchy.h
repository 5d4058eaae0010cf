// hierarchy.h: the transformation hierarchy of a running world (clause 4.4.4): what hangs below a
// node, and the ways that lead to it. A prototype instance holds the first node of its body, an
// Inline what it loaded; Scripts hold nothing. [the browser's thread]
#pragma once

#include "event/live.h"
#include "geometry/matrix.h"

namespace xvrml {

// Calls visit(Node&) for each node directly below, in the order of the fields; a node held twice is
// visited twice.
void childrenInHierarchy(Node& node, std::vector<Node*>& out);

using Path = std::vector<Node*>; // from a root of the world to the node, prototype instances and
                                 // Inlines included

// Every way from the roots to a node that is part of the world, in no particular order; at most
// `limit` of them. Empty if the node hangs nowhere.
std::vector<Path> pathsTo(const Node& node, size_t limit = 1000);

// True if a way leads from a root of the world to the node.
bool isInScene(const Node& node);

// The coordinate system of a path's last node's children: the product of its Transforms. Billboards
// are taken as unturned.
Matrix localToWorld(const Path& path);

// False if a Switch on the path leads elsewhere. LODs are taken to show any level.
bool isChosen(const Path& path);

} // namespace xvrml
