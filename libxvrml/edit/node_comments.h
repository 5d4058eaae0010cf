// node_comments.h: the comments that belong to a node of a text, and go where it goes.
// [any thread]
#pragma once

#include <string>
#include <string_view>

#include "parse/text_layout.h"

namespace xvrml {

// A node with its comments: the lines of comments directly above its own, and the comment behind it
// in its last line.
struct CommentedNode {
  size_t begin;   // where the comments above begin, with their line; the node's begin if none
  size_t comment; // where the comment behind begins; the end if there is none
  size_t end;
  TextSpan node;

  bool hasComments() const { return begin < node.begin || comment < end; }
};

// Return a node with the comments that belong to it. Only a node has some that begins and ends a
// line. Comments at the beginning of the text belong to the file.
CommentedNode commentedNode(std::string_view text, const TextSpan& node);
CommentedNode commentedXmlNode(std::string_view text, const TextSpan& node);

// Returns the text of a node that gets lines of its own with this indentation, with its comments.
// made: the node itself. feed: what ends lines.
std::string withComments(std::string_view text, const CommentedNode& node, std::string made,
                         std::string_view indentation, std::string_view feed);

} // namespace xvrml
