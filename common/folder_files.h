// folder_files.h: Lists the files of a folder, for the searches for plug-ins. It does not use
// std::filesystem::directory_iterator, because GCC's implementation ends the process if there is no
// memory for a name. Stateless; any thread.
#pragma once

#include <algorithm>
#include <cerrno>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <dirent.h>
#include <sys/stat.h>

// Returns the paths of the regular files in a folder whose names end with `suffix`, sorted by name.
// Links are followed. The result is empty if the folder cannot be read. Throws std::bad_alloc.
inline std::vector<std::string> filesOfFolder(const std::string& folder, std::string_view suffix) {
  struct Close {
    void operator()(DIR* open) const { ::closedir(open); }
  };
  std::vector<std::string> files;
  errno = 0;
  const std::unique_ptr<DIR, Close> open(::opendir(folder.c_str()));
  if (!open && errno == ENOMEM) throw std::bad_alloc();
  while (const dirent* const entry = open ? ::readdir(open.get()) : nullptr) {
    const std::string_view name = entry->d_name;
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    std::string path = folder;
    if (!path.ends_with('/')) path += '/';
    path += name;
    struct stat info;
    if (::stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode)) files.push_back(std::move(path));
  }
  std::sort(files.begin(), files.end());
  return files;
}
