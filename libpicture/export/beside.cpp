#include "libpicture/export/beside.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "libpicture/files/atomic_file.h"

namespace picture {

namespace {

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '-' || c == '_';
}

} // namespace

bool hasFilesBeside(const std::string& path) { return path != "-" && whyNotRegular(path).empty(); }

NamesBeside::NamesBeside(const std::string& path, std::vector<std::string> inputs)
    : inputs_(std::move(inputs)) {
  const size_t slash = path.rfind('/');
  const size_t begin = slash == path.npos ? 0 : slash + 1;
  folder_ = path.substr(0, begin);
  std::string name = path.substr(begin);
  taken_.insert(name);
  if (const size_t dot = name.rfind('.'); dot != name.npos && dot > 0) name.resize(dot);
  for (char& c : name)
    if (!isPlain(c)) c = '_';
  constexpr size_t longest = 200; // a name has at most 255 bytes on most systems
  stem_ = name.substr(0, longest);
}

bool NamesBeside::isTaken(const std::string& name) const {
  if (taken_.contains(name)) return true;
  std::error_code none;
  const std::string path = pathOf(name);
  if (!std::filesystem::exists(path, none)) return false;
  return std::any_of(inputs_.begin(), inputs_.end(), [&](const std::string& input) {
    return std::filesystem::equivalent(input, path, none);
  });
}

std::string NamesBeside::choose(std::string_view end, std::string_view suffix) {
  const std::string first = stem_ + std::string(end);
  std::string name = first + std::string(suffix);
  for (int i = 2; isTaken(name); ++i) name = first + "_" + std::to_string(i) + std::string(suffix);
  taken_.insert(name);
  return name;
}

} // namespace picture
