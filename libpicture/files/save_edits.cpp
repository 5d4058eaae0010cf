#include "libpicture/files/save_edits.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "libpicture/files/atomic_file.h"

namespace picture {

void saveEdits(xvrml::Editor& editor, const xvrml::World& world, const std::string& path,
               bool overwrite) {
  std::error_code none;
  const std::string& target = path.empty() ? world.path : path;
  const bool isOwn = target == world.path || std::filesystem::equivalent(target, world.path, none);
  const std::string bytes = editor.bytes();
  if (isOwn && !overwrite && editor.isChangedOnDisk())
    throw xvrml::EditError(
        fmt::format("{} has been changed or removed by another program since it was "
                    "read: "
                    "save with overwrite to replace it",
                    target));
  if (!isOwn) return writeRegularFile(target, bytes, Wait::disk);
  writeEditedFile(target, bytes);
  editor.saved();
}

} // namespace picture
