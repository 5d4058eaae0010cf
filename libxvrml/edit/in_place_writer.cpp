#include "edit/in_place_writer.h"

#include <fmt/format.h>

#include "edit/lines.h"
#include "edit/node_writer.h"

namespace xvrml {
namespace {

std::unique_ptr<NodeWriter> makeWriter(const Document& document, WritingPlan plan = {}) {
  switch (document.encoding()) {
  case Encoding::x3dXml: return makeElementWriter(document, std::move(plan));
  case Encoding::x3dJson: return makeJsonWriter(document, std::move(plan));
  default: return makeClassicWriter(document, std::move(plan));
  }
}

} // namespace

std::string writeInPlace(const Document& document) {
  const std::unique_ptr<NodeWriter> writer = makeWriter(document);
  std::string text = writer->file();
  WritingPlan missing = writer->missing();
  return missing.isEmpty() ? text : makeWriter(document, std::move(missing))->file();
}

std::string writeNode(const Document& document, const Node& node) {
  return makeWriter(document)->node(node);
}

std::string emptyNode(const Document& document, std::string_view type) {
  const std::string_view feed = lineFeedOf(document.file().text);
  switch (document.encoding()) {
  case Encoding::x3dXml: return fmt::format("<{}/>", type);
  case Encoding::x3dJson: return fmt::format("{{\"{0}\": {{{1}  }}{1}}}", type, feed);
  default: return fmt::format("{0} {{{1}  children [{1}  ]{1}}}", type, feed);
  }
}

} // namespace xvrml
