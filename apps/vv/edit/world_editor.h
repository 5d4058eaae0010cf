// world_editor.h: Edits the world of a session: the editor of its file, and the nodes that are
// selected. All faces (the window, programs) edit through it, so they share one selection and one
// history. Owned by a session. [the browser's thread, while the world can be used]
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "edit/journal.h"
#include "libpicture/shader_classes.h"
#include "xvrml/edit.h"

namespace vv {

class WorldEditor {
 public:
  // The browser must outlive the editor. The file is read at the first edit. shaderPath: folders of
  // shader plug-ins that are searched first.
  explicit WorldEditor(xvrml::Browser& browser, std::string shaderPath = {})
      : browser_(browser), editor_(browser), shaderPath_(std::move(shaderPath)) {}

  xvrml::Editor& editor() { return editor_; }
  // Reads the file for the first edit, a large one on a thread of its own. Returns whether that has
  // been done. isReading(): tells whether such a thread still works, for any editor.
  bool prepare();
  static bool isReading();
  xvrml::Browser& browser() { return browser_; }
  const std::string& shaderPath() const { return shaderPath_; }
  // The classes of the shader plug-ins that are installed. They are read at the first call.
  const std::vector<picture::ShaderClass>& shaderClasses();

  // The nodes that are selected, in the order of their selection. A node stays selected when it has
  // been removed from the world, until another is selected.
  const xvrml::MFNode& selection() const { return selection_; }
  void select(xvrml::MFNode nodes);
  // Selects a node, or adds it to what is selected; a node that is selected then is taken out. Null
  // selects nothing more.
  void choose(const xvrml::NodeRef& node, bool add);
  // Returns the node that was selected last; null: none is selected.
  xvrml::Node* selected() const { return selection_.empty() ? nullptr : selection_.back().get(); }

  // Does edits as one step with this name. If they throw, what they have done is undone.
  void step(const std::string& name, const std::function<void()>& edits);
  // Returns the place of a node, if it stands in one place of the file, or in one that `accepts`
  // accepts. Throws EditError.
  using Accepts = std::function<bool(const xvrml::NodeSlot& place)>;
  xvrml::NodeSlot placeOf(const xvrml::Node& node, const Accepts& accepts = {});
  // Returns the place behind the last node of a field, or behind the last root for null; in an
  // SFNode the only place.
  xvrml::NodeSlot endOf(xvrml::Node* parent, const std::string& field) const;
  // Undo the last step, or do it again. Return its name; empty: there is none. Throw EditError. If
  // undo takes a selected node away, what was selected before it is selected again.
  std::string undo();
  std::string redo();
  // Tells whether there are edits that have not been saved.
  bool isChanged() const { return editor_.isChanged(); }
  // Keeps them if the program is killed.
  Journal& journal() { return journal_; }
  // Writes the file. See picture::saveEdits.
  void save(const std::string& path = "", bool overwrite = false);
  // How often the file has been saved: it differs then from what was read.
  uint64_t saves() const { return saves_; }

 private:
  xvrml::Browser& browser_;
  xvrml::Editor editor_;
  Journal journal_{editor_, browser_};
  xvrml::MFNode selection_;
  std::deque<xvrml::MFNode> earlier_; // selections before this one, the last one last
  uint64_t saves_ = 0;
  const std::string shaderPath_;
  std::optional<std::vector<picture::ShaderClass>> shaderClasses_;
};

} // namespace vv
