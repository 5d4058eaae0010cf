// beside.h: Names the files beside an exported one. Pure functions, apart from looking at names in
// the folder. [any thread]
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace picture {

// Returns whether an export to the path may have files beside it: it is no device, no pipe and not
// standard output.
bool hasFilesBeside(const std::string& path);

// Chooses names for files beside an exported one: its name without the suffix, what the file is,
// and a number if the name is taken. They consist of letters, digits, dots, - and _, so that they
// need no quotes in any format.
class NamesBeside {
 public:
  // inputs: files that the world was made of; none of them gets a name.
  NamesBeside(const std::string& path, std::vector<std::string> inputs);
  // Returns a new name such as "world_0.png" for the end "_0" and the suffix ".png".
  std::string choose(std::string_view end, std::string_view suffix);
  // Returns the path of a file with such a name.
  std::string pathOf(const std::string& name) const { return folder_ + name; }

 private:
  bool isTaken(const std::string& name) const;
  std::string folder_, stem_; // the folder ends with a slash, or is empty
  std::vector<std::string> inputs_;
  std::set<std::string> taken_;
};

} // namespace picture
