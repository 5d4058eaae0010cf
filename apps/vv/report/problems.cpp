#include "problems.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "describe.h"
#include "process/messages.h"

namespace vv {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// Tells whether a diagnostic is a detail for the author of the world, without a visible effect.
// Output of Scripts also has the severity note, but is not a detail.
bool isDetail(const xvrml::Diagnostic& d) {
  return d.severity == xvrml::Severity::note && !d.message.starts_with("Script");
}

} // namespace

std::string kindOf(const xvrml::Diagnostic& diagnostic) {
  std::string kind(1, char('0' + int(diagnostic.severity)));
  const std::string& text = diagnostic.message;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool inName =
        i > 0 && (std::isalnum(static_cast<unsigned char>(text[i - 1])) || text[i - 1] == '_');
    const bool sign =
        (text[i] == '-' || text[i] == '.') && i + 1 < text.size() && isDigit(text[i + 1]);
    if (inName || (!isDigit(text[i]) && !sign)) {
      kind += text[i];
      continue;
    }
    // Skip a number with its sign, fraction and exponent; a list of numbers counts as one.
    while (i + 1 < text.size() &&
           (isDigit(text[i + 1]) || text[i + 1] == '.' || text[i + 1] == 'e' ||
            ((text[i + 1] == '-' || text[i + 1] == '+') && (text[i] == 'e')) ||
            (text[i + 1] == ' ' && i + 2 < text.size() &&
             (isDigit(text[i + 2]) || text[i + 2] == '-'))))
      ++i;
    kind += '#';
  }
  return kind;
}

// Reports the messages of one kind once. Lines printed by Scripts are not problems: each is
// reported.
void Problems::reportGrouped(const std::vector<xvrml::Diagnostic>& fresh) {
  std::unordered_map<std::string, size_t> counts;
  std::vector<std::pair<const xvrml::Diagnostic*, std::string>> shown;
  for (const xvrml::Diagnostic& d : fresh) {
    if (options_.quiet && d.severity != xvrml::Severity::error) continue;
    if (isDetail(d) && !options_.check) continue;
    if (d.severity == xvrml::Severity::note && !isDetail(d)) {
      shown.emplace_back(&d, std::string());
      continue;
    }
    std::string kind = kindOf(d);
    if (kinds_.contains(kind)) {
      ++repeated_;
      continue;
    }
    if (counts[kind]++ == 0) shown.emplace_back(&d, std::move(kind));
  }
  for (const auto& [kind, count] : counts) kinds_.insert(kind);
  constexpr size_t maxErrors = 50, maxWarnings = 50;
  size_t errors = 0, warnings = 0;
  for (const auto& [diagnostic, kind] : shown) {
    if (diagnostic->severity == xvrml::Severity::error && ++errors > maxErrors) continue;
    if (diagnostic->severity == xvrml::Severity::warning && ++warnings > maxWarnings) continue;
    xvrml::Diagnostic told = *diagnostic;
    if (const auto count = counts.find(kind); count != counts.end() && count->second > 1)
      told.message += fmt::format(" (and {} more like this; -v shows all)", count->second - 1);
    say(told.text());
  }
  const size_t more =
      errors - std::min(errors, maxErrors) + warnings - std::min(warnings, maxWarnings);
  if (more > 0) say(fmt::format("vv: and {} more kinds of problems; -v shows all", more));
}

void Problems::tell(const xvrml::World& world) {
  if (std::exchange(world_, &world) != &world) {
    reported_ = droppedTold_ = repeated_ = 0;
    kinds_.clear();
  }
  const auto& list = world.diagnostics.list();
  const std::vector<xvrml::Diagnostic> fresh(list.begin() + long(std::min(reported_, list.size())),
                                             list.end());
  reported_ = list.size();
  if (options_.verbose) {
    for (const xvrml::Diagnostic& d : fresh)
      if (!options_.quiet || d.severity == xvrml::Severity::error) say(d.text());
  } else if (options_.check) { // each error and warning, and a detail for each kind of them
    std::vector<xvrml::Diagnostic> notes;
    for (const xvrml::Diagnostic& d : fresh)
      if (d.severity == xvrml::Severity::note)
        notes.push_back(d);
      else if (!options_.quiet || d.severity == xvrml::Severity::error)
        say(d.text());
    reportGrouped(notes);
  } else {
    reportGrouped(fresh);
  }
  if (const uint64_t dropped = world.diagnostics.dropped(); dropped > droppedTold_) {
    if (!options_.quiet) say(fmt::format("vv: and {} more problems", dropped - droppedTold_));
    droppedTold_ = dropped;
  }
}

void Problems::reportEnd(const xvrml::World& world) const {
  if (options_.quiet) return;
  if (repeated_ > 0)
    say(fmt::format("vv: {} more like those above came later; -v shows all", repeated_));
  const uint64_t errors = world.diagnostics.errors();
  if (errors == 0) return;
  constexpr size_t maxPlaces = 3;
  std::vector<std::string> places;
  bool more = false;
  for (const xvrml::Diagnostic& d : world.diagnostics.list()) {
    if (d.severity != xvrml::Severity::error || d.line == 0) continue;
    std::string place = fmt::format("{}:{}", d.file, d.line);
    if (std::find(places.begin(), places.end(), place) != places.end()) continue;
    more = places.size() == maxPlaces;
    if (more) break;
    places.push_back(std::move(place));
  }
  const std::string where =
      fmt::format("{}{}", fmt::join(places, ", "), more ? " and further lines" : "");
  say(fmt::format(
      "vv: {}{}: the picture may lack parts of the world; --strict refuses such a world",
      counted(errors, "error"), places.empty() ? "" : fmt::format(" ({})", where)));
}

} // namespace vv
