#include "edit/choices.h"

#include <algorithm>
#include <string_view>

namespace vv {

using namespace xvrml;

std::vector<std::string> choicesOf(const FieldInfo& field) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ_-";
  std::vector<std::string> words;
  if (field.type != FieldType::SFString && field.type != FieldType::MFString) return words;
  for (std::string_view rest = field.text; !rest.empty();) {
    const size_t end = std::min(rest.find_first_not_of(letters), rest.size());
    const bool isWord = end > 1 && (end == rest.size() || rest[end] < 'a' || rest[end] > 'z');
    if (!isWord) break;
    words.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
    if (rest.starts_with(", "))
      rest.remove_prefix(2);
    else if (rest.starts_with(" or "))
      rest.remove_prefix(4);
    else
      break;
  }
  if (words.size() < 2) words.clear();
  return words;
}

} // namespace vv
