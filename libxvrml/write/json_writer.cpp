// json_writer.cpp: writes X3D's JSON encoding (ISO/IEC 19776-5): a node is an object with one
// member, named by its type. "@name" is a field of plain values, "-name" one of nodes.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "base/x3d.h"
#include "graph/field_access.h"
#include "write/json_value.h"
#include "write/writer.h"

namespace xvrml {
namespace {

class JsonWriter : public Writer {
 public:
  using Writer::Writer;

 private:
  // Opens and closes an object or array, whose items stand in lines of their own.
  void open(char bracket) {
    text_ += bracket;
    indent_ += 2;
  }
  void close(char bracket) {
    indent_ -= 2;
    if (text_.back() != '[' && text_.back() != '{') line();
    text_ += bracket;
  }

  // Ends the item before, if there is one. Lines may have begun after it.
  void separate() {
    const size_t last = text_.find_last_not_of(" \n");
    if (last != text_.npos && !std::strchr("[{:,", text_[last])) text_.insert(last + 1, ",");
  }
  void member(std::string_view name) {
    separate();
    line();
    writeJsonString(text_, name);
    text_ += ": ";
  }
  void attribute(std::string_view name, std::string_view text) {
    member(fmt::format("@{}", name));
    writeJsonString(text_, text);
  }
  void attribute(std::string_view name, FieldType type, const void* value) {
    member(fmt::format("@{}", name));
    writeJsonValue(text_, type, value, indent_);
  }
  // Opens an item of a list: an object with one object as its member.
  void openItem(std::string_view name) {
    separate();
    text_ += "{ ";
    writeJsonString(text_, name);
    text_ += ": ";
    open('{');
  }
  void closeItem() {
    close('}');
    text_ += " }";
  }

  void writeHead() override {
    open('{');
    member("X3D");
    open('{');
    member("encoding");
    writeJsonString(text_, "UTF-8");
    attribute("profile", profileOf(world_.head));
    attribute("version", fmt::format("{}.{}", version_.major, version_.minor));
    const FileHead& head = world_.head;
    const std::vector<FileHead::Unit> units = unitsOf(head);
    if (!head.components.empty() || !head.meta.empty() || !units.empty()) {
      member("head");
      open('{');
      writeStatements("component", head.components, [this](const FileHead::Component& one) {
        attribute("name", one.name);
        member("@level");
        text_ += std::to_string(one.level);
      });
      writeStatements("unit", units, [this](const FileHead::Unit& one) {
        attribute("category", one.category);
        attribute("name", one.name);
        member("@conversionFactor");
        text_ += fmt::format("{}", one.factor);
      });
      writeStatements("meta", head.meta, [this](const FileHead::Meta& one) {
        attribute("name", one.name);
        attribute("content", one.content);
      });
      close('}');
    }
    member("Scene");
    open('{');
    member("-children");
    open('[');
    std::string header;
    for (const std::string& comment : commentsOf(world_, header)) {
      separate();
      line();
      text_ += "{ \"#comment\": ";
      writeJsonString(text_, comment);
      text_ += " }";
    }
  }

  template <class Statement, class Write> void
  writeStatements(std::string_view name, const std::vector<Statement>& list, const Write& write) {
    if (list.empty()) return;
    member(name);
    open('[');
    for (const Statement& one : list) {
      separate();
      line();
      open('{');
      write(one);
      close('}');
    }
    close(']');
  }

  void writeEnd() override {
    close(']');
    for (int i = 0; i < 3; ++i) close('}'); // the scene, X3D, the file
    text_ += '\n';
  }

  void writeNode(const Content& content, std::string_view) override {
    const Node& node = *content.node;
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    openItem(instance ? "ProtoInstance" : node.type().name);
    if (content.name) attribute("DEF", *content.name);
    if (instance) attribute("name", node.type().name);
    writeConnections(content);
    // Readers take `field` first, so that nodes in it are defined before other fields use them.
    writeFields(content, instance ? "fieldValue" : "field",
                [&](const Field& field) { return field.declared || (instance && field.value); });
    for (const Field& field : content.fields) {
      if (field.declared || !field.value || instance) continue;
      const std::string_view name = spelled(node.type(), field.info->name);
      if (holdsNodes(*field.info))
        writeNodes(name, field, keepsNull(node.type()));
      else
        attribute(name, field.info->type, field.value);
    }
    closeItem();
  }

  void writeConnections(const Content& content) {
    const bool any = !content.events.empty() ||
                     std::any_of(content.fields.begin(), content.fields.end(),
                                 [](const Field& field) { return !field.interfaces.empty(); });
    if (!any) return;
    member("IS");
    open('{');
    member("connect");
    open('[');
    const auto connect = [&](std::string_view name, std::string_view interfaceName) {
      separate();
      line();
      open('{');
      attribute("nodeField", name);
      attribute("protoField", interfaceName);
      close('}');
    };
    for (const Field& field : content.fields)
      for (const std::string& one : field.interfaces)
        connect(field.declared ? field.info->name : spelled(content.node->type(), field.info->name),
                one);
    for (const auto& [event, interfaceName] : content.events) connect(event, interfaceName);
    close(']');
    close('}');
  }

  // Writes the fields that are objects of a list: declared ones, and arguments of an instance.
  template <class Chosen>
  void writeFields(const Content& content, std::string_view list, const Chosen& chosen) {
    if (std::none_of(content.fields.begin(), content.fields.end(), chosen)) return;
    member(list);
    open('[');
    for (const Field& field : content.fields)
      if (chosen(field)) writeDeclaration(field);
    close(']');
  }

  void writeDeclaration(const Field& field) override {
    separate();
    line();
    open('{');
    if (field.declared) {
      attribute("accessType", x3dAccessName(field.info->access));
      attribute("type", fieldTypeName(field.info->type));
    }
    attribute("name", field.info->name);
    if (field.value && holdsNodes(*field.info))
      writeNodes("children", field, true); // a program may count the places
    else if (field.value)
      attribute("value", field.info->type, field.value);
    close('}');
  }

  // JSON has no word for NULL in a list of nodes. isSelecting: the places in the list matter, and
  // an empty Group takes that of NULL.
  void writeNodes(std::string_view name, const Field& field, bool isSelecting) {
    const bool single = field.info->type == FieldType::SFNode;
    if (single && !*static_cast<const NodeRef*>(field.value)) return;
    member(fmt::format("-{}", name));
    if (single) return node(static_cast<const NodeRef*>(field.value)->get(), name);
    open('[');
    for (const NodeRef& child : *static_cast<const MFNode*>(field.value)) {
      if (!child && !isSelecting) continue;
      separate();
      line();
      if (child) {
        node(child.get(), name);
      } else {
        openItem("Group");
        closeItem();
      }
    }
    close(']');
  }

  void writeUse(const Node& node, const std::string& name, std::string_view) override {
    const bool instance = nodeCast<ProtoInstance>(&node) != nullptr;
    openItem(instance ? "ProtoInstance" : node.type().name);
    if (instance) attribute("name", node.type().name);
    attribute("USE", name);
    closeItem();
  }

  void writeNull() override {}

  void writeRoute(const RouteText& route) override {
    openItem("ROUTE");
    attribute("fromNode", route.from);
    attribute("fromField", route.fromField);
    attribute("toNode", route.to);
    attribute("toField", route.toField);
    closeItem();
  }

  void writeImport(const std::string& inlineName, const std::string& exported,
                   const std::string& local) override {
    openItem("IMPORT");
    attribute("inlineDEF", inlineName);
    attribute("importedDEF", exported);
    attribute("AS", local);
    closeItem();
  }
  void writeExport(const std::string& node, const std::string& exported) override {
    openItem("EXPORT");
    attribute("localDEF", node);
    attribute("AS", exported);
    closeItem();
  }

  void openPrototype(const std::string& name, const MFString* urls) override {
    openItem(urls ? "ExternProtoDeclare" : "ProtoDeclare");
    attribute("name", name);
    if (urls) {
      attribute("url", FieldType::MFString, urls);
    } else {
      member("ProtoInterface");
      open('{');
    }
    member("field");
    open('[');
  }
  void openBody() override {
    close(']');
    close('}');
    member("ProtoBody");
    open('{');
    member("-children");
    open('[');
  }
  void closePrototype(const MFString* urls) override {
    close(']');
    if (!urls) close('}');
    closeItem();
  }
};

} // namespace

std::unique_ptr<Writer> makeJsonWriter(const World& world, const std::string& target,
                                       const FileVersion& version) {
  return std::make_unique<JsonWriter>(world, target, version);
}

} // namespace xvrml
