// faults.cpp: the text of the warning about a geometry node.
#include "geometry/faults.h"

#include <fmt/format.h>

namespace xvrml {

static constexpr const char* faultTexts[] = {
    "dropped for too few different vertices",
    "dropped for an index without a point",
    "dropped for coordinates that are not finite",
    "dropped for having no area",
    "dropped as too large and tangled to be cut into triangles",
    "dropped beyond ",
    "without a colour, drawn white",
    "without a usable normal, drawn with the face's own",
    "without texture coordinates",
};
static_assert(std::size(faultTexts) == size_t(Fault::count));

bool Faults::any() const {
  for (const Entry& entry : entries_)
    if (entry.count) return true;
  return !notes_.empty();
}

// Returns whether only degenerate points, lines and faces were dropped, which are invisible anyway.
bool Faults::invisible() const {
  for (size_t i = 0; i < entries_.size(); i++)
    if (entries_[i].count && Fault(i) != Fault::fewVertices && Fault(i) != Fault::noArea)
      return false;
  return notes_.empty();
}

void Faults::report(const Node& node, Diagnostics* diagnostics, std::string_view limit) const {
  if (!diagnostics || !any()) return;
  std::string text;
  auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  for (size_t i = 0; i < entries_.size(); i++) {
    const Entry& entry = entries_[i];
    if (!entry.count) continue;
    const std::string_view which = i == size_t(Fault::overLimit) ? limit : "";
    append(
        fmt::format("{} {}{} (first at index {})", entry.count, faultTexts[i], which, entry.first));
  }
  for (const std::string& note : notes_) append(note);
  Diagnostic d;
  d.severity = invisible() ? Severity::note : Severity::warning;
  if (node.source.file) d.file = *node.source.file;
  d.line = node.source.line;
  d.column = node.source.column;
  d.message = node.type().name + ": " + text;
  diagnostics->add(std::move(d));
}

} // namespace xvrml
