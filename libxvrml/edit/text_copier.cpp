#include "edit/text_copier.h"

#include <algorithm>

#include "edit/lines.h"

namespace xvrml {
namespace {

uint64_t placeKey(uint32_t line, uint32_t column) { return uint64_t(line) << 32 | column; }

} // namespace

TextCopier::TextCopier(const Document& document) {
  for (const Route& route : document.scope().routes)
    routes_.emplace(placeKey(route.source.line, route.source.column), &route);
}

void TextCopier::raw(const DocumentText& text, size_t end) {
  if (end <= at) return;
  out.append(text.text, at, end - at);
  at = end;
}

void TextCopier::copy(const DocumentText& text, size_t end) {
  const std::vector<RouteText>& routes = text.layout.routes;
  auto route =
      std::lower_bound(routes.begin(), routes.end(), at,
                       [](const RouteText& one, size_t at) { return one.whole.begin < at; });
  for (; route != routes.end() && route->whole.begin < end; ++route)
    if (route->valid) copyRoute(text, *route);
  raw(text, end);
}

void TextCopier::copyRoute(const DocumentText& text, const RouteText& place) {
  const auto found = routes_.find(placeKey(place.line, place.column));
  if (found == routes_.end()) return remove(text, place.whole);
  replaceName(text, place.from, *found->second->from);
  replaceName(text, place.to, *found->second->to);
}

void TextCopier::replaceName(const DocumentText& text, const TextSpan& span, const Node& node) {
  if (text.text.compare(span.begin, span.size(), node.defName) == 0) return;
  raw(text, span.begin);
  out += node.defName;
  at = span.end;
}

void TextCopier::remove(const DocumentText& text, const TextSpan& span) {
  const std::string_view all = text.text;
  size_t begin = span.begin, end = span.end;
  while (end < all.size() && (isBlank(all[end]) || all[end] == ',')) ++end;
  if (startsLine(all, begin) && end == lineEnd(all, end) && lineBegin(all, begin) >= at) {
    copy(text, lineBegin(all, begin));
    at = nextLine(all, end);
    return;
  }
  while (begin > at && isBlank(all[begin - 1])) --begin;
  copy(text, begin);
  at = startsLine(all, span.begin) ? end : span.end;
}

} // namespace xvrml
