#include "missing_list.h"

#include <algorithm>

#include <fmt/format.h>

#include "describe.h"

namespace vv {

namespace {

constexpr size_t fewParts = 5, mostParts = 1000;

// Returns how a user finds a part: by its names, or by its line.
std::string nameOf(const picture::MissingPart& part) {
  if (!part.path.empty()) return oneLine(fmt::format("{} ({})", part.path, part.url));
  return oneLine(fmt::format("{} (line {})", part.url, part.where.line));
}

} // namespace

std::string missingText(const std::vector<picture::MissingPart>& parts, size_t boxes, bool all) {
  const size_t shown = std::min(parts.size(), all ? mostParts : fewParts);
  std::string text =
      fmt::format("vv: {} missing: ",
                  parts.size() == 1 ? "1 part is" : fmt::format("{} parts are", parts.size()));
  for (size_t i = 0; i < shown; ++i) text += (i > 0 ? ", " : "") + nameOf(parts[i]);
  if (shown < parts.size())
    text += fmt::format(" and {} more{}", parts.size() - shown, all ? "" : "; --check lists them");
  if (boxes > 0)
    text += fmt::format("; {} for {}", boxes == 1 ? "a box stands" : "boxes stand",
                        boxes == parts.size() ? "them" : fmt::format("{} of them", boxes));
  return text;
}

} // namespace vv
