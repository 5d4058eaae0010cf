// xml_writer.cpp: writes X3D's XML encoding (ISO/IEC 19776-1): a node is an element, its fields of
// plain values are attributes, and the nodes that it holds are elements within.
#include <fmt/format.h>

#include "base/x3d.h"
#include "graph/field_access.h"
#include "nodes/registry.h"
#include "printable.h"
#include "write/value_writer.h"
#include "write/writer.h"
#include "write/xml_escape.h"

namespace xvrml {
namespace {

bool holdsText(FieldType type) {
  return type == FieldType::SFString || type == FieldType::MFString;
}

// Returns the only string of a url that is a program in the text and may stand in a CDATA section;
// null for other urls.
const std::string* programOf(const void* value) {
  const auto& urls = *static_cast<const MFString*>(value);
  if (urls.size() != 1) return nullptr;
  const std::string& text = urls[0];
  const size_t colon = text.find(':');
  if (colon == std::string::npos || text.find('\n') == std::string::npos) return nullptr;
  if (!text.substr(0, colon).ends_with("script")) return nullptr;
  if (text.find("]]>") != std::string::npos || text.find('\r') != std::string::npos) return nullptr;
  for (std::string_view rest = text; !rest.empty();) { // what CDATA cannot hold
    const size_t length = printable_text::utf8Length(rest);
    if (length == 0 || (printable_text::controlLength(rest) == 1 && rest[0] != 0x7f) ||
        rest.starts_with("\xef\xbf\xbe") || rest.starts_with("\xef\xbf\xbf"))
      return nullptr;
    rest.remove_prefix(length);
  }
  // Readers remove blanks around the program.
  constexpr std::string_view blanks = " \t\n";
  const bool around = blanks.find(text.front()) != std::string_view::npos ||
                      blanks.find(text.back()) != std::string_view::npos;
  return around ? nullptr : &text;
}

class XmlWriter : public Writer {
 public:
  using Writer::Writer;

 private:
  void writeHead() override {
    std::string header;
    const FileHead& head = world_.head;
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    for (const std::string& comment : commentsOf(world_, header)) {
      // A comment of XML holds no "--" and does not end with "-".
      text_ += "<!--";
      const size_t begin = text_.size();
      appendPlain(comment);
      for (size_t at; (at = text_.find("--", begin)) != std::string::npos;) text_[at + 1] = ' ';
      text_ += text_.back() == '-' ? " -->\n" : "-->\n";
    }
    text_ += fmt::format("<X3D profile='{}' version='{}.{}'>", profileOf(head), version_.major,
                         version_.minor);
    indent_ = 2;
    if (!head.components.empty() || !head.meta.empty() || !unitsOf(head).empty())
      writeStatements(head);
    line();
    text_ += "<Scene>";
    indent_ = 4;
  }

  void writeStatements(const FileHead& head) {
    line();
    text_ += "<head>";
    indent_ = 4;
    for (const FileHead::Component& one : head.components) {
      line();
      text_ += "<component";
      attribute("name", one.name);
      attribute("level", std::to_string(one.level));
      text_ += "/>";
    }
    for (const FileHead::Unit& one : unitsOf(head)) {
      line();
      text_ += "<unit";
      attribute("category", one.category);
      attribute("name", one.name);
      attribute("conversionFactor", fmt::format("{}", one.factor));
      text_ += "/>";
    }
    for (const FileHead::Meta& one : head.meta) {
      line();
      text_ += "<meta";
      attribute("name", one.name);
      attribute("content", one.content);
      text_ += "/>";
    }
    indent_ = 2;
    line();
    text_ += "</head>";
  }

  void writeEnd() override { text_ += "\n  </Scene>\n</X3D>\n"; }

  // Appends text without characters that XML does not have, for comments.
  void appendPlain(std::string_view text) {
    while (!text.empty()) {
      const size_t length = printable_text::utf8Length(text);
      const bool good = length > 1 || (length == 1 && (text[0] == '\t' || text[0] >= 0x20));
      text_ += good ? text.substr(0, length) : "?";
      text.remove_prefix(std::max<size_t>(length, 1));
    }
  }

  void attribute(std::string_view name, std::string_view text) {
    text_ += fmt::format(" {}='", name);
    escapeXml(text_, text);
    text_ += '\'';
  }

  void attribute(std::string_view name, FieldType type, const void* value) {
    text_ += fmt::format(" {}='", name);
    if (holdsText(type)) {
      std::string plain;
      if (type == FieldType::SFString)
        plain = *static_cast<const std::string*>(value);
      else
        writeXmlValue(plain, type, value, indent_);
      escapeXml(text_, plain);
    } else {
      writeXmlValue(text_, type, value, indent_);
    }
    text_ += '\'';
  }

  // Writes the attributes that every element of a node begins with.
  void attributesOf(const Node& node, std::string_view word, const std::string& name,
                    std::string_view place) {
    attribute(word, name);
    attributeOfPlace(node, place);
  }

  void attributeOfPlace(const Node& node, std::string_view place) {
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    const std::string_view usual = instance ? "children" : containerOf(node.type());
    // X3D 4 has another usual field for metadata in a MetadataSet.
    const bool varies = version_.major >= 4 && usual == "metadata";
    if (!place.empty() && (place != usual || varies)) attribute("containerField", place);
  }

  void writeNode(const Content& content, std::string_view place) override {
    const Node& node = *content.node;
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    const std::string element = instance ? "ProtoInstance" : node.type().name;
    text_ += '<' + element;
    if (content.name) attribute("DEF", *content.name);
    if (instance) attribute("name", node.type().name);
    attributeOfPlace(node, place);
    const std::string* program = nullptr;
    if (!instance) {
      for (const Field& field : content.fields) {
        if (field.declared || !field.value || holdsNodes(*field.info)) continue;
        if (element == "Script" && field.info->name == "url" && (program = programOf(field.value)))
          continue;
        attribute(spelled(node.type(), field.info->name), field.info->type, field.value);
      }
    }
    text_ += '>';
    const size_t before = text_.size();
    indent_ += 2;
    writeConnections(content);
    for (const Field& field : content.fields) {
      if (instance) {
        if (field.value) writeElement("fieldValue", field, "value");
      } else if (field.declared) {
        writeElement("field", field, "value");
      } else if (field.value && holdsNodes(*field.info)) {
        writeNodes(field, spelled(node.type(), field.info->name), keepsNull(node.type()));
      }
    }
    if (program) {
      line();
      text_ += "<![CDATA[" + *program + "]]>";
    }
    indent_ -= 2;
    if (text_.size() == before) {
      text_.back() = '/';
      text_ += '>';
      return;
    }
    line();
    text_ += "</" + element + '>';
  }

  void writeConnections(const Content& content) {
    const bool any = !content.events.empty() ||
                     std::any_of(content.fields.begin(), content.fields.end(),
                                 [](const Field& field) { return !field.interfaces.empty(); });
    if (!any) return;
    line();
    text_ += "<IS>";
    indent_ += 2;
    const auto connect = [&](std::string_view name, std::string_view interfaceName) {
      line();
      text_ += "<connect";
      attribute("nodeField", name);
      attribute("protoField", interfaceName);
      text_ += "/>";
    };
    for (const Field& field : content.fields)
      for (const std::string& one : field.interfaces)
        connect(field.declared ? field.info->name : spelled(content.node->type(), field.info->name),
                one);
    for (const auto& [event, interfaceName] : content.events) connect(event, interfaceName);
    indent_ -= 2;
    line();
    text_ += "</IS>";
  }

  // Writes a field of an interface or an argument of an instance.
  void writeElement(std::string_view element, const Field& field, std::string_view valueName) {
    line();
    text_ += fmt::format("<{}", element);
    if (field.declared) {
      attribute("accessType", x3dAccessName(field.info->access));
      attribute("type", fieldTypeName(field.info->type));
    }
    attribute("name", field.info->name);
    const bool nodes = field.value && holdsNodes(*field.info);
    if (field.value && !nodes) attribute(valueName, field.info->type, field.value);
    text_ += '>';
    const size_t before = text_.size();
    indent_ += 2;
    if (nodes) writeNodes(field, "", true); // a program may count the places
    indent_ -= 2;
    if (text_.size() == before) {
      text_.back() = '/';
      text_ += '>';
      return;
    }
    line();
    text_ += fmt::format("</{}>", element);
  }

  // XML has no word for NULL. isSelecting: the places in a list matter, and an empty Group takes
  // that of NULL.
  void writeNodes(const Field& field, std::string_view place, bool isSelecting) {
    const auto write = [&](Node* child) {
      if (!child && !isSelecting) return;
      line();
      if (child)
        node(child, place);
      else
        text_ += "<Group/>";
    };
    if (field.info->type == FieldType::SFNode) {
      if (Node* child = static_cast<const NodeRef*>(field.value)->get()) write(child);
    } else {
      for (const NodeRef& child : *static_cast<const MFNode*>(field.value)) write(child.get());
    }
  }

  void writeUse(const Node& node, const std::string& name, std::string_view place) override {
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    text_ += '<' + (instance ? "ProtoInstance" : node.type().name);
    if (instance) attribute("name", node.type().name);
    attributesOf(node, "USE", name, place);
    text_ += "/>";
  }

  void writeNull() override {}

  void writeRoute(const RouteText& route) override {
    text_ += "<ROUTE";
    attribute("fromNode", route.from);
    attribute("fromField", route.fromField);
    attribute("toNode", route.to);
    attribute("toField", route.toField);
    text_ += "/>";
  }

  void writeImport(const std::string& inlineName, const std::string& exported,
                   const std::string& local) override {
    text_ += "<IMPORT";
    attribute("inlineDEF", inlineName);
    attribute("importedDEF", exported);
    attribute("AS", local);
    text_ += "/>";
  }
  void writeExport(const std::string& node, const std::string& exported) override {
    text_ += "<EXPORT";
    attribute("localDEF", node);
    attribute("AS", exported);
    text_ += "/>";
  }

  void openPrototype(const std::string& name, const MFString* urls) override {
    text_ += urls ? "<ExternProtoDeclare" : "<ProtoDeclare";
    attribute("name", name);
    if (urls) attribute("url", FieldType::MFString, urls);
    text_ += '>';
    indent_ += 2;
    if (urls) return;
    line();
    text_ += "<ProtoInterface>";
    indent_ += 2;
  }
  void writeDeclaration(const Field& field) override { writeElement("field", field, "value"); }
  void openBody() override {
    indent_ -= 2;
    line();
    text_ += "</ProtoInterface>";
    line();
    text_ += "<ProtoBody>";
    indent_ += 2;
  }
  void closePrototype(const MFString* urls) override {
    indent_ -= 2;
    line();
    if (!urls) {
      text_ += "</ProtoBody>";
      indent_ -= 2;
      line();
    }
    text_ += urls ? "</ExternProtoDeclare>" : "</ProtoDeclare>";
  }
};

} // namespace

std::unique_ptr<Writer> makeXmlWriter(const World& world, const std::string& target,
                                      const FileVersion& version) {
  return std::make_unique<XmlWriter>(world, target, version);
}

} // namespace xvrml
