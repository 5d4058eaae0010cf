#include "libpicture/export/remarks.h"

#include <fmt/format.h>

namespace picture {

void Remarks::Counts::add(std::string_view text) {
  const auto [found, fresh] = places.try_emplace(std::string(text), list.size());
  if (fresh) list.emplace_back(text, 0);
  ++list[found->second].second;
}

void Remarks::leaveOut(std::string_view what) { leftOut_.add(what); }

void Remarks::change(std::string_view text) { changed_.add(text); }

std::vector<std::string> Remarks::sentences(std::string_view format) const {
  std::vector<std::string> all;
  std::string names;
  for (const auto& [name, count] : leftOut_.list)
    names += fmt::format("{}{}{}", names.empty() ? "" : ", ", name,
                         count > 1 ? fmt::format(" ({} times)", count) : "");
  if (!names.empty()) all.push_back(fmt::format("{} has nothing for: {}", format, names));
  for (const auto& [text, count] : changed_.list)
    all.push_back(count > 1 ? fmt::format("{} ({} times)", text, count) : text);
  return all;
}

} // namespace picture
