// faults.cpp: the text of the warning about a geometry node.
#include "geometry/faults.h"

#include <fmt/format.h>

namespace xvrml {

static constexpr const char* faultTexts[] = {
    "left out: too few different vertices",
    "", // report() names the index
    "left out: coordinates that are not finite",
    "left out: no area",
    "left out: too large or tangled to be cut into triangles",
    "crossing itself, in a list without -1: is -1 missing between faces?",
    "with many points named again: is -1 missing between faces?",
    "left out beyond ",
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
  const std::string_view type = node.type().name;
  const bool line = type == "IndexedLineSet" || type == "LineSet" || type == "Polyline2D";
  const bool point = type == "PointSet" || type == "Polypoint2D";
  const char* noun = line ? "line" : point ? "point" : "face";
  const char* index = node.type().is("indexedGeometry") ? "index" : "coordIndex";
  std::string text;
  auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  for (size_t i = 0; i < entries_.size(); i++) {
    const Entry& entry = entries_[i];
    if (!entry.count) continue;
    const std::string_view which = i == size_t(Fault::overLimit) ? limit : "";
    // Faults after the limit are counted in faces or vertices, which the text does not tell apart.
    const std::string counted =
        i > size_t(Fault::overLimit)
            ? fmt::format("{}", entry.count)
            : fmt::format("{} {}{}", entry.count, noun, entry.count == 1 ? "" : "s");
    append(i == size_t(Fault::indexRange)
               ? fmt::format("{} left out: {}[{}] has no point", counted, index, entry.first)
               : fmt::format("{} {}{} (first at index {})", counted, faultTexts[i], which,
                             entry.first));
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
