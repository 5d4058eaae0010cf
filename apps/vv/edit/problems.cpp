#include "edit/problems.h"

#include <algorithm>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "edit/outline.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr double refreshInterval = 0.5; // seconds

const char* nameOf(Severity severity) {
  switch (severity) {
  case Severity::error: return "error";
  case Severity::warning: return "warning";
  default: return "note";
  }
}

std::string placeOf(const Diagnostic& diagnostic, const std::string& world) {
  const bool isOther = !diagnostic.file.empty() && diagnostic.file != world;
  if (diagnostic.line == 0) return isOther ? diagnostic.file : "";
  return isOther ? fmt::format("{}, line {}", diagnostic.file, diagnostic.line)
                 : fmt::format("line {}", diagnostic.line);
}

} // namespace

std::string problemText(const ProblemRow& row) {
  std::string text = nameOf(row.severity);
  if (!row.place.empty()) text += "  " + row.place;
  text += "  " + row.message;
  if (row.times > 1) text += fmt::format(" ({} times)", row.times);
  return text;
}

bool ProblemList::update(WorldEditor& editor, double seconds) {
  const Diagnostics& messages = editor.browser().world().diagnostics;
  const uint64_t count = messages.errors() + messages.warnings();
  const bool hasChanged = std::exchange(count_, count) != count;
  if (!isOpen_) return hasChanged;
  const bool isRead = hasRead_ && list_ == &messages && read_ == messages.list().size();
  dropped_ = messages.dropped();
  if (isRead || (hasRead_ && seconds < readAt_ + refreshInterval)) return hasChanged;
  if (!editor.prepare()) return hasChanged; // the nodes are not known yet
  readAt_ = seconds;
  read(editor);
  return true;
}

void ProblemList::read(WorldEditor& editor) {
  const World& world = editor.browser().world();
  const std::vector<Diagnostic>& list = world.diagnostics.list();
  hasRead_ = true;
  list_ = &world.diagnostics;
  read_ = list.size();
  const auto file = std::make_shared<const std::string>(world.path);
  using Key = std::tuple<std::string, uint32_t, uint32_t, std::string>;
  std::map<Key, size_t> known;
  const ProblemRow shownBefore = shown() ? *shown() : ProblemRow();
  rows_.clear();
  std::vector<SourcePosition> places;
  for (const Diagnostic& one : list) {
    const auto [at, isNew] =
        known.try_emplace({one.file, one.line, one.column, one.message}, rows_.size());
    if (!isNew) {
      ++rows_[at->second].times;
      continue;
    }
    rows_.push_back(
        {one.severity, placeOf(one, world.path), one.message, one.sourceLine, {}, "", 1});
    places.push_back(one.file == world.path ? SourcePosition{file, one.line, one.column}
                                            : SourcePosition());
  }
  const MFNode nodes = editor.editor().nodesAt(places);
  for (size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].node = nodes[i];
    if (nodes[i]) rows_[i].label = labelOf(*nodes[i]);
  }
  std::stable_sort(rows_.begin(), rows_.end(), [](const ProblemRow& a, const ProblemRow& b) {
    return a.severity > b.severity;
  });
  const auto again = std::find_if(rows_.begin(), rows_.end(), [&](const ProblemRow& row) {
    return row.place == shownBefore.place && row.message == shownBefore.message;
  });
  shown_ = size_t(again - rows_.begin());
}

} // namespace vv
