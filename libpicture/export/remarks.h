// remarks.h: Counts what an export leaves out or changes, and says it in a sentence for each kind.
// [one thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace picture {

class Remarks {
 public:
  // Counts a thing that the format has nothing for: the name of a node type.
  void leaveOut(std::string_view what);
  // Counts a thing of which a part is lost. text: a sentence without a full stop.
  void change(std::string_view text);
  // Returns the sentences, in the order of the first thing of each kind. format: its name.
  std::vector<std::string> sentences(std::string_view format) const;

 private:
  struct Counts {
    std::vector<std::pair<std::string, uint64_t>> list;
    std::unordered_map<std::string, size_t> places; // in `list`
    void add(std::string_view text);
  };
  Counts leftOut_, changed_;
};

} // namespace picture
