// edit_texts.h: Writes what the editor of a page shows as JSON: rows of the outline, the fields of
// a node, handles, problems, and what can be undone. Pure functions, apart from the numbers of
// nodes that they give out. Everything is bounded, whatever the world holds. docs/serve.md lists
// the messages. [the browser's thread]
#pragma once

#include <cstdint>
#include <string>

#include <vector>

#include "as_json/node_numbers.h"
#include "edit/edit_model.h"
#include "edit/gizmo.h"

namespace vv::server::edit {

// The choice of `add` that is no row of newNodes().
inline constexpr const char* viewpointKind = "Viewpoint from here";

// Returns some rows of the outline, and how many there are.
std::string rowsText(const EditModel& model, json::NodeNumbers& numbers, int first, int count);
// Tells a page to show a row, which others have selected.
std::string revealText(int row);
std::string sheetText(const PropertySheet& sheet, json::NodeNumbers& numbers);
// Returns the small pictures of the textures of a sheet, as PNG files.
std::string thumbnailsText(const TextureThumbnails& thumbnails, json::NodeNumbers& numbers);
// A look that the selected Shapes can have.
struct ShownLook {
  uint64_t number = 0; // by which the page names it
  const Look* look = nullptr;
  std::string image; // the path of a picture of a ball with it; "": there is none, or not yet
};
std::string looksText(const std::vector<ShownLook>& looks);
// Returns what may be put into a field of nodes. node: the number of its node.
std::string choicesText(uint64_t node, const PropertyRow& row, json::NodeNumbers& numbers);
// Returns the messages about the world; without rows while their list is closed.
std::string problemsText(const ProblemList& problems, json::NodeNumbers& numbers);
// Returns the lines around what is selected, in the picture.
std::string framesText(const EditModel& model);
std::string handlesText(const Gizmo& gizmo);
// text: what the tool does; "": none is in use.
std::string toolText(const std::string& text);
// Returns what can be undone and done again, and whether there are edits that are not saved.
// hidden: how many nodes are hidden for now.
std::string historyText(WorldEditor& editor, const std::string& readOnly, size_t hidden);
// Tells the user something. isError: a command was refused.
std::string saidText(const std::string& text, bool isError);
// Tells how many bytes of a file have come that the page sends; bytes 0: it sends none.
std::string importText(size_t received, size_t bytes);
// Asks whether a file is to be replaced that another program has changed.
std::string questionText();

} // namespace vv::server::edit
