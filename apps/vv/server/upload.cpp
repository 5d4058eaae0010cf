#include "server/upload.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <unistd.h>

#include "base64.h"
#include "edit/import.h"
#include "libpicture/files/atomic_file.h"
#include "lower_case.h"
#include "server/limits.h"
#include "xvrml/file_head.h"

namespace vv::server {

using xvrml::EditError;
namespace fs = std::filesystem;

namespace {

constexpr size_t longestName = 64; // without suffixes and a number
constexpr int mostNumber = 99;     // files that have the same name, but for their numbers

// Tells whether a name, in lower case, ends as those of worlds or meshes do.
bool isNameOfWorld(std::string_view name) {
  if (name.ends_with(".gz")) name.remove_suffix(3);
  constexpr std::string_view worlds[] = {".wrl",  ".wrz",  ".x3d",  ".x3dv",
                                         ".x3dj", ".x3dz", ".x3dvz"};
  if (std::any_of(std::begin(worlds), std::end(worlds),
                  [&](std::string_view suffix) { return name.ends_with(suffix); }))
    return true;
  const size_t dot = name.rfind('.');
  if (dot == name.npos) return false;
  const std::string suffix(name.substr(dot));
  for (int i = 0; i < xvrml::encodingCount(); ++i) {
    const std::string all = fmt::format(" {} ", meshSuffixes(static_cast<xvrml::Encoding>(i)));
    if (all.find(" " + suffix + " ") != all.npos) return true;
  }
  return false;
}

// Returns the length of the name before its suffixes: that of "leg" for "leg.wrl.gz".
size_t stemLength(std::string_view name) {
  const size_t dot = name.rfind('.', name.size() - (name.ends_with(".gz") ? 4 : 1));
  return dot == name.npos ? name.size() : dot;
}

// Opens a new file in a folder, under its name or with a number before the suffix. Returns its
// descriptor.
int openNumbered(const fs::path& folder, const std::string& name, std::string& path) {
  const size_t stem = stemLength(name);
  for (int number = 1; number <= mostNumber; ++number) {
    const std::string addition = number == 1 ? "" : fmt::format("-{}", number);
    path = (folder / (name.substr(0, stem) + addition + name.substr(stem))).string();
    if (const int file = picture::openNew(path, 0666); file >= 0) return file;
    if (errno != EEXIST)
      throw EditError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  }
  throw EditError(fmt::format("there are {} files with the name {} already", mostNumber, name));
}

// Returns the path of a new file with this content.
std::string writeNew(const fs::path& folder, const std::string& name, std::string_view content) {
  std::string path;
  const int file = openNumbered(folder, name, path);
  std::string why;
  try {
    picture::writeDescriptor(file, content, path);
    if (::fsync(file) != 0) why = fmt::format("cannot write {}: {}", path, std::strerror(errno));
  } catch (const std::runtime_error& error) { why = error.what(); }
  ::close(file);
  if (why.empty()) return path;
  ::unlink(path.c_str());
  throw EditError(why);
}

} // namespace

std::string plainFileName(const std::string& name) {
  std::string plain = lowerCase(name);
  if (!isNameOfWorld(plain))
    throw EditError("only worlds and meshes can be put into a world: .wrl, .x3d, .stl, .glb and "
                    "others that vv reads");
  plain = name.substr(name.find_last_of("/\\") + 1);
  for (char& c : plain) {
    const bool isPlain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                         (c >= 'a' && c <= 'z') || c == '_' || c == '-' || c == '.';
    if (!isPlain) c = '_';
  }
  const size_t stem = stemLength(plain);
  std::string front = plain.substr(0, std::min(stem, longestName));
  if (front.empty() || front[0] == '.' || front[0] == '-') front.insert(0, "_");
  return front + plain.substr(stem);
}

void Upload::take(const edit::FileCommand& command, WorldEditor& editor) {
  try {
    if (const auto* const import = std::get_if<edit::Import>(&command))
      begin(*import, editor);
    else
      append(std::get<edit::ImportPart>(command));
  } catch (...) {
    *this = {};
    throw;
  }
}

void Upload::begin(const edit::Import& import, WorldEditor& editor) {
  *this = {};
  if (const std::string why = editor.editor().whyReadOnly(); !why.empty()) throw EditError(why);
  std::string name = plainFileName(import.name);
  if (import.bytes == 0) throw EditError(fmt::format("{} is empty", name));
  if (import.bytes > size_t(maxImportBytes))
    throw EditError(fmt::format("{} has {} bytes, and at most {} can be put into a world from a "
                                "page (maxImportBytes)",
                                name, import.bytes, maxImportBytes));
  name_ = std::move(name);
  size_ = import.bytes;
}

void Upload::append(const edit::ImportPart& part) {
  if (size_ == 0) return; // it has been refused
  if (!appendBytesOfBase64(part.data, content_) || content_.size() > size_)
    throw EditError(fmt::format("{} has not come as it was sent", name_));
}

std::string Upload::finish(WorldEditor& editor) {
  const Upload whole = std::exchange(*this, {});
  const fs::path folder = fs::path(editor.browser().world().path).parent_path();
  std::string path = writeNew(folder, whole.name_, whole.content_);
  try {
    importFile(editor, fs::absolute(path).string());
  } catch (...) {
    ::unlink(path.c_str());
    throw;
  }
  return path;
}

} // namespace vv::server
