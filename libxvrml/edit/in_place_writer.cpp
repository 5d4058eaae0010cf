#include "edit/in_place_writer.h"

#include <fmt/format.h>

#include "edit/node_writer.h"

namespace xvrml {
namespace {

std::unique_ptr<NodeWriter> makeWriter(const Document& document,
                                       std::vector<const PrototypeText*> lifted = {}) {
  switch (document.encoding()) {
  case Encoding::x3dXml: return makeElementWriter(document, std::move(lifted));
  case Encoding::x3dJson: return makeJsonWriter(document, std::move(lifted));
  default: return makeClassicWriter(document, std::move(lifted));
  }
}

} // namespace

std::string writeInPlace(const Document& document) {
  const std::unique_ptr<NodeWriter> writer = makeWriter(document);
  std::string text = writer->file();
  const std::vector<const PrototypeText*> missing = writer->missing();
  return missing.empty() ? text : makeWriter(document, missing)->file();
}

std::string writeNode(const Document& document, const Node& node) {
  return makeWriter(document)->node(node);
}

std::string emptyNode(const Document& document, std::string_view type) {
  switch (document.encoding()) {
  case Encoding::x3dXml: return fmt::format("<{}/>", type);
  case Encoding::x3dJson: return fmt::format("{{\"{}\": {{\n  }}\n}}", type);
  default: return fmt::format("{} {{\n  children [\n  ]\n}}", type);
  }
}

} // namespace xvrml
