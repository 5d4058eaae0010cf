// in_place_writer.h: writes a document as its own text with what has been edited. Comments, order,
// spaces and numbers that have not been edited stay as they are. Internal; one thread at a time.
#pragma once

#include <string>
#include <string_view>

#include "edit/document.h"

namespace xvrml {

// Stack in bytes that these functions take for the deepest nesting that a file may have
// (Parser::maximumNesting): recursion follows the nodes.
inline constexpr size_t deepestStack = size_t(32) << 20;

// Returns the text of the document.
std::string writeInPlace(const Document& document);

// Returns the text of a node with all that is in it, as the document has it, without indentation of
// its own. A node with a name that stands further up in the file is written in full.
std::string writeNode(const Document& document, const Node& node);

// Returns the text of a grouping node of a type, without children.
std::string emptyNode(const Document& document, std::string_view type);

} // namespace xvrml
