// figure.h: figures of H-Anim (ISO/IEC 19774-1, ISO/IEC 19775-1 26), whose joints bend a skin and
// whose displacers move single vertices. Skins of glTF are figures, too. The event engine calls
// this in a running world, whoever draws in one that does not run. [the thread that owns the nodes]
#pragma once

#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/nodes.h"

namespace xvrml {

// Returns whether nodes of this type move vertices: HAnimHumanoid and HAnimSegment.
bool deforms(const NodeType& type);

// Moves the vertices of such a node to where its joints and displacers have them now. Returns the
// parts of its skin that are drawn in another way than before. diagnostics: receives one warning of
// what is wrong with the node; null: none is made.
std::vector<Node*> deform(const Node& node, Diagnostics* diagnostics);
// Returns the joints of a HAnimHumanoid's skeleton, in the order of the file.
std::vector<nodes::HAnimJoint*> jointsOfSkeleton(const nodes::HAnimHumanoid& figure);
// Returns the parts of its skin that such a node moves, or may move: a Coordinate or
// CoordinateDouble, and a Normal.
std::vector<Node*> skinOf(const Node& node);
// Lets a part of a skin be drawn as it is at rest. Returns whether that is a change.
bool straighten(Node& part);
// Returns the field of such a part whose vectors are drawn.
const FieldInfo& vectorsOf(const Node& part);

} // namespace xvrml
