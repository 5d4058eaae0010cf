// upload.h: A file that a page sends in parts, to be put into the world: it becomes a new file in
// the folder of the world's file, and an Inline. Owned by the editor of a page. [main thread, while
// the world can be used]
#pragma once

#include <cstddef>
#include <string>

#include "edit/world_editor.h"
#include "server/edit_command.h"

namespace vv::server {

// Returns the name under which a file of a page is written: letters, digits, "-", "_" and ".", none
// of which is at its beginning, and a suffix of worlds or meshes. Throws xvrml::EditError if the
// name has no such suffix.
std::string plainFileName(const std::string& name);

class Upload {
 public:
  // Takes a command of the page. Throws xvrml::EditError; then the upload has ended.
  void take(const edit::FileCommand& command, WorldEditor& editor);
  // Tells whether all of the file has come.
  bool isComplete() const { return size_ > 0 && content_.size() == size_; }
  // Writes the file beside the world's, and adds an Inline with it as one step. Returns the path of
  // the new file. Throws xvrml::EditError; then there is no new file.
  std::string finish(WorldEditor& editor);

  size_t received() const { return content_.size(); }
  size_t size() const { return size_; } // 0: the page sends no file

 private:
  void begin(const edit::Import& import, WorldEditor& editor);
  void append(const edit::ImportPart& part);

  std::string name_, content_;
  size_t size_ = 0;
};

} // namespace vv::server
