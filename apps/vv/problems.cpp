// problems.cpp: see problems.h.
#include "problems.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "messages.h"

namespace vv {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// Notes are for whoever wrote the world: nothing that is seen depends on them. What Scripts print are notes, too.
bool isDetail(const xvrml::Diagnostic& d) { return d.severity == xvrml::Severity::note && !d.message.starts_with("Script"); }

} // namespace

std::string kindOf(const xvrml::Diagnostic& diagnostic) {
  std::string kind(1, char('0' + int(diagnostic.severity)));
  const std::string& text = diagnostic.message;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool sign = (text[i] == '-' || text[i] == '.') && i + 1 < text.size() && isDigit(text[i + 1]);
    if (!isDigit(text[i]) && !sign) {
      kind += text[i];
      continue;
    }
    // A number with its sign, fraction and exponent; lists of numbers are one.
    while (i + 1 < text.size() && (isDigit(text[i + 1]) || text[i + 1] == '.' || text[i + 1] == 'e' ||
                                   ((text[i + 1] == '-' || text[i + 1] == '+') && (text[i] == 'e')) ||
                                   (text[i + 1] == ' ' && i + 2 < text.size() && (isDigit(text[i + 2]) || text[i + 2] == '-'))))
      ++i;
    kind += '#';
  }
  return kind;
}

void Problems::tellFolded(const std::vector<xvrml::Diagnostic>& fresh) {
  constexpr size_t mostShown = 50;
  std::unordered_map<std::string, size_t> counts;
  std::vector<std::pair<const xvrml::Diagnostic*, std::string>> shown;
  for (const xvrml::Diagnostic& d : fresh) {
    if (isDetail(d) || (options_.quiet && d.severity != xvrml::Severity::error)) continue;
    std::string kind = kindOf(d);
    if (d.severity == xvrml::Severity::note) kind += fmt::format("|{}", told_ + counts.size()); // what Scripts print
    if (counts[kind]++ == 0 && kinds_.insert(kind).second) shown.emplace_back(&d, std::move(kind));
  }
  for (size_t i = 0; i < std::min(shown.size(), mostShown); ++i) {
    xvrml::Diagnostic told = *shown[i].first;
    if (const size_t count = counts[shown[i].second]; count > 1)
      told.message += fmt::format(" (and {} more like this; -v shows all)", count - 1);
    say(told.text());
  }
  if (shown.size() > mostShown) say(fmt::format("vv: and {} more kinds of problems; -v shows all", shown.size() - mostShown));
}

void Problems::tell(const xvrml::World& world) {
  if (std::exchange(world_, &world) != &world) {
    told_ = droppedTold_ = 0;
    kinds_.clear();
  }
  const auto& list = world.diagnostics.list();
  const std::vector<xvrml::Diagnostic> fresh(list.begin() + long(std::min(told_, list.size())), list.end());
  told_ = list.size();
  if (options_.verbose || options_.check) {
    for (const xvrml::Diagnostic& d : fresh)
      if (!options_.quiet || d.severity == xvrml::Severity::error) say(d.text());
  } else {
    tellFolded(fresh);
  }
  if (const uint64_t dropped = world.diagnostics.dropped(); dropped > droppedTold_) {
    say(fmt::format("vv: and {} more problems", dropped - droppedTold_));
    droppedTold_ = dropped;
  }
}

void Problems::tellLeftOut(const xvrml::World& world) const {
  const uint64_t errors = world.diagnostics.errors();
  if (errors == 0 || options_.quiet) return;
  constexpr size_t mostPlaces = 3;
  std::string places;
  size_t named = 0;
  for (const xvrml::Diagnostic& d : world.diagnostics.list()) {
    if (d.severity != xvrml::Severity::error || d.line == 0 || named == mostPlaces) continue;
    places += fmt::format("{}{}:{}", named++ ? ", " : "", d.file, d.line);
  }
  const bool more = named > 0 && named < errors;
  say(fmt::format("vv: what {} of {} left out; --strict refuses such a world",
                  errors == 1 ? "the error" : fmt::format("the {} errors", errors),
                  named == 0 ? "above names is" : fmt::format("{}{} names is", places, more ? " and further lines" : "")));
}

} // namespace vv
