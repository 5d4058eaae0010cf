#include "backend/cluster/net/libraries.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "shading/registry.h"

namespace openrt::cluster {

const Hash& FileHashes::of(const std::string& path) {
  std::error_code error;
  const int64_t changed = std::filesystem::last_write_time(path, error).time_since_epoch().count();
  const uint64_t bytes = std::filesystem::file_size(path, error);
  Known& known = files_[path];
  if (known.changed != changed || known.bytes != bytes) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<char> content(std::istreambuf_iterator<char>(stream), {});
    known = {changed, bytes, hashOf(std::as_bytes(std::span(content)))};
  }
  return known.hash;
}

std::string LibraryCheck::problem(std::span<const message::Library> wanted) {
  std::string text;
  const auto add = [&](const message::Library& library, const std::string& what) {
    text += (text.empty() ? "" : "; ") + ("shader library " + library.name) + what;
  };
  for (const message::Library& library : wanted) {
    const std::string path = shaders_ ? shaders_->locate(library.name) : std::string();
    if (path.empty()) {
      add(library, " is in no folder of this worker (--shader-path)");
      continue;
    }
    const Hash& hash = files_.of(path);
    if (hash != library.hash)
      add(library, " differs from the master's (" + path + " has hash " + hex(hash) +
                       ", the master's " + hex(library.hash) + ")");
  }
  return text;
}

} // namespace openrt::cluster
