// nodes_at.h: finds the nodes of an edited file by places in its text. Internal. [any thread]
#pragma once

#include <span>
#include <vector>

#include "edit/document.h"

namespace xvrml {

// Returns for each place the innermost node whose text holds it, in the file as it was read; null
// if there is none, or edits have removed it. The files of the places are not looked at.
std::vector<const Node*> nodesAt(const Document& document, std::span<const SourcePosition> places);

} // namespace xvrml
