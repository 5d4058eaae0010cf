#include "edit/declaration.h"

#include <fmt/format.h>

#include "edit/lines.h"
#include "write/value_writer.h"
#include "write/xml_escape.h"

namespace xvrml {
namespace {

const void* storageOf(const Value& value) {
  return std::visit([](const auto& one) -> const void* { return &one; }, value);
}

// Inserts a statement before the last bracket of a text: in a line of its own if the bracket begins
// one, so that it never stands in a comment.
std::string before(std::string text, size_t bracket, const std::string& statement) {
  if (!startsLine(text, bracket)) {
    const bool isApart = bracket > 0 && isBlank(text[bracket - 1]);
    return text.insert(bracket, (isApart ? "" : " ") + statement + " ");
  }
  const std::string indentation(indentationAt(text, bracket));
  return text.insert(bracket, "  " + statement + std::string(lineFeedOf(text)) + indentation);
}

} // namespace

std::string withDeclaration(std::string text, const FileVersion& version, std::string_view field,
                            const Value& value) {
  const auto type = FieldType(value.index());
  std::string written;
  if (version.encoding != Encoding::x3dXml) {
    writeValue(written, type, storageOf(value), 0);
    const std::string statement =
        fmt::format("{} {} {} {}", version.isX3d() ? "inputOutput" : "exposedField",
                    fieldTypeName(type), field, written);
    const size_t brace = text.rfind('}');
    return before(std::move(text), brace, statement);
  }
  writeXmlValue(written, type, storageOf(value), 0);
  std::string escaped;
  escapeXml(escaped, written);
  const std::string element =
      fmt::format("<field name='{}' type='{}' accessType='inputOutput' value='{}'/>", field,
                  fieldTypeName(type), escaped);
  if (text.ends_with("/>")) {
    const std::string name = text.substr(1, text.find_first_of(" \t\r\n/>", 1) - 1);
    text.resize(text.size() - 2);
    while (isBlank(text.back())) text.pop_back();
    return fmt::format("{}>{}</{}>", text, element, name);
  }
  const size_t end = text.rfind("</");
  if (startsLine(text, end)) return before(std::move(text), end, element);
  return text.insert(end, element);
}

} // namespace xvrml
