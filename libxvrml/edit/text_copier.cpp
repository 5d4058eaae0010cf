#include "edit/text_copier.h"

#include <algorithm>
#include <utility>

#include "edit/changed_value.h"
#include "edit/lines.h"
#include "write/xml_escape.h"

namespace xvrml {

// Returns what a string in JSON has between its quotes.
static std::string withoutQuotes(const std::string& quoted) {
  return quoted.substr(1, quoted.size() - 2);
}

TextCopier::TextCopier(const Document& document, std::vector<const PrototypeText*> lifted)
    : document_(document), lifted_(std::move(lifted)), declared_(lifted_.begin(), lifted_.end()) {
  for (const Route& route : document.scope().routes)
    routes_.emplace(placeKey(route.source.line, route.source.column), &route);
  for (const PrototypeText& one : document.file().layout.prototypes)
    prototypes_.emplace(placeKey(one.line, one.column), &one);
}

const PrototypeText* TextCopier::missingFor(const ProtoInstance& instance) const {
  const SourcePosition& place = instance.declaration->source;
  const auto found = prototypes_.find(placeKey(place.line, place.column));
  return found == prototypes_.end() || declared_.contains(found->second) ? nullptr : found->second;
}

void TextCopier::raw(const DocumentText& text, size_t end) {
  if (end <= at) return;
  out.append(text.text, at, end - at);
  at = end;
}

void TextCopier::copy(const DocumentText& text, size_t end) {
  const auto from = [this](const auto& statements) {
    return std::lower_bound(statements.begin(), statements.end(), at,
                            [](const auto& one, size_t begin) { return one.whole.begin < begin; });
  };
  const TextLayout& layout = text.layout;
  for (;;) {
    const auto route = from(layout.routes);
    const auto prototype = from(layout.prototypes);
    const size_t nextRoute = route == layout.routes.end() ? end : route->whole.begin,
                 nextPrototype =
                     prototype == layout.prototypes.end() ? end : prototype->whole.begin;
    if (std::min(nextRoute, nextPrototype) >= end) break;
    if (nextRoute < nextPrototype) {
      if (route->valid) copyRoute(text, *route);
      raw(text, route->whole.end);
    } else if (std::find(lifted_.begin(), lifted_.end(), &*prototype) != lifted_.end()) {
      remove(text, prototype->whole);
    } else {
      raw(text, prototype->whole.end);
      declared_.insert(&*prototype);
    }
  }
  raw(text, end);
}

void TextCopier::copyRoute(const DocumentText& text, const RouteText& place) {
  const auto found = routes_.find(placeKey(place.line, place.column));
  if (found == routes_.end()) return remove(text, place.whole);
  const Route& route = *found->second;
  if (!written.contains(route.from.get()) || !written.contains(route.to.get()))
    return remove(text, place.whole);
  copied.insert(&route);
  replaceName(text, place.from, *route.from);
  replaceName(text, place.to, *route.to);
}

void TextCopier::replaceName(const DocumentText& text, const TextSpan& span, const Node& node) {
  if (document_.nameInText(node) == node.defName) return;
  raw(text, span.begin);
  if (document_.isXml())
    escapeXml(out, node.defName, "'\"");
  else if (document_.encoding() == Encoding::x3dJson)
    out += withoutQuotes(jsonString(node.defName));
  else
    out += node.defName;
  at = span.end;
}

void TextCopier::remove(const DocumentText& text, const TextSpan& span) {
  const std::string_view all = text.text;
  size_t begin = span.begin, end = span.end;
  while (end < all.size() && (isBlank(all[end]) || all[end] == ',')) ++end;
  const bool endsLine = end == all.size() || all[end] == '\n' || all[end] == '\r';
  if (startsLine(all, begin) && endsLine && lineBegin(all, begin) >= at) {
    copy(text, lineBegin(all, begin));
    at = nextLine(all, end);
    return;
  }
  if (startsLine(all, begin)) { // the rest of the line stands where it began
    copy(text, begin);
    at = end;
    return;
  }
  while (begin > at && isBlank(all[begin - 1])) --begin;
  copy(text, begin);
  at = span.end;
}

} // namespace xvrml
