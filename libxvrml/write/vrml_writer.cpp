// vrml_writer.cpp: writes VRML97 (ISO/IEC 14772-1 annex A) and X3D's ClassicVRML encoding (ISO/IEC
// 19776-2), which differ in the head of the file, in words and in some names.
#include <fmt/format.h>

#include "base/x3d.h"
#include "geometry/mesh.h"
#include "write/value_writer.h"
#include "write/writer.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

class VrmlWriter : public Writer {
 public:
  using Writer::Writer;

 private:
  void writeHead() override {
    std::string header;
    const std::vector<std::string> comments = commentsOf(world_, header);
    text_ = isX3d() ? fmt::format("#X3D V{}.{} utf8\n", version_.major, version_.minor)
                    : fmt::format("#VRML V2.0 utf8{}\n", header);
    for (const std::string& comment : comments) text_ += fmt::format("#{}\n", comment);
    if (isX3d()) statements(world_.head);
  }

  void statements(const FileHead& head) {
    text_ += fmt::format("PROFILE {}\n", profileOf(head));
    for (const FileHead::Component& one : head.components)
      text_ += fmt::format("COMPONENT {}:{}\n", nameText(one.name), one.level);
    for (const FileHead::Unit& one : unitsOf(head))
      text_ +=
          fmt::format("UNIT {} {} {}\n", nameText(one.category), nameText(one.name), one.factor);
    for (const FileHead::Meta& one : head.meta) {
      text_ += "META ";
      writeString(text_, one.name);
      text_ += ' ';
      writeString(text_, one.content);
      text_ += '\n';
    }
  }

  void writeEnd() override { text_ += '\n'; }

  void writeNode(const Content& given, std::string_view) override {
    Content faces;
    if (isOpenShape(*given.node)) faces = facesOf(*given.node, given.name);
    const Content& content = faces.node ? faces : given;
    if (content.name) text_ += "DEF " + *content.name + " ";
    text_ += content.node->type().name + " {";
    const size_t before = text_.size();
    indent_ += 2;
    for (const Field& field : content.fields) writeField(content.node->type(), field);
    for (const auto& [event, interfaceName] : content.events) {
      line();
      text_ += fmt::format("{} IS {}", event, interfaceName);
    }
    indent_ -= 2;
    if (text_.size() > before) line();
    text_ += text_.size() > before ? "}" : " }";
  }

  // Returns whether the node is a Cone or Cylinder of VRML 1.0 that lacks a part, whose inside is
  // seen. VRML97 draws only the outside of its own, so that their faces are written instead.
  bool isOpenShape(Node& node) const {
    if (isX3d() || versionOf(node).encoding != Encoding::vrml1 || shapesOfFaces_ >= mostOfFaces)
      return false;
    const auto* cone = nodeCast<nodes::Cone>(&node);
    const auto* cylinder = nodeCast<nodes::Cylinder>(&node);
    return (cone && !cone->solid) || (cylinder && !cylinder->solid);
  }

  // Returns the faces of the node. They live as long as the writer, which remembers what it has
  // written by address.
  Content facesOf(Node& node, const std::string* name) {
    Diagnostics silent; // what is wrong with the node is said where it is drawn
    MeshOptions options;
    options.needTexCoords = true;
    options.diagnostics = &silent;
    const Mesh mesh = buildMesh(node, options);
    ++shapesOfFaces_;
    auto& faces = make<nodes::IndexedFaceSet>("IndexedFaceSet");
    faces.solid = false;
    auto& coord = make<nodes::Coordinate>("Coordinate");
    coord.point.assign(mesh.points.begin(), mesh.points.end());
    faces.coord = NodeRef(&coord);
    auto& normal = make<nodes::Normal>("Normal");
    normal.vector.assign(mesh.normals.begin(), mesh.normals.end());
    if (!normal.vector.empty()) faces.normal = NodeRef(&normal);
    auto& texCoord = make<nodes::TextureCoordinate>("TextureCoordinate");
    texCoord.point.assign(mesh.texCoords.begin(), mesh.texCoords.end());
    if (!texCoord.point.empty()) faces.texCoord = NodeRef(&texCoord);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      faces.coordIndex.insert(faces.coordIndex.end(),
                              {int32_t(mesh.indices[i]), int32_t(mesh.indices[i + 1]),
                               int32_t(mesh.indices[i + 2]), -1});
    return contentOf(faces, name);
  }
  template <class T> T& make(const char* type) {
    const NodeType& found = *findNodeType(type);
    made_.emplace_back(found.create(found));
    return static_cast<T&>(*made_.back());
  }

  void writeField(const NodeType& type, const Field& field) {
    const std::string_view name =
        field.declared ? field.info->name : spelled(type, field.info->name);
    bool first = true;
    if (field.value || field.declared) {
      line();
      if (field.declared) words(*field.info);
      text_ += name;
      if (field.value) value(field);
      if (field.declared && !field.interfaces.empty()) {
        text_ += " IS " + field.interfaces.front();
        first = false;
      }
    }
    for (size_t i = first ? 0 : 1; i < field.interfaces.size(); ++i) {
      line();
      text_ += fmt::format("{} IS {}", name, field.interfaces[i]);
    }
  }

  void words(const FieldInfo& info) {
    text_ += fmt::format("{} {} ", isX3d() ? x3dAccessName(info.access) : accessName(info.access),
                         fieldTypeName(info.type));
  }

  void value(const Field& field) {
    text_ += ' ';
    if (field.info->type == FieldType::SFNode) {
      node(static_cast<const NodeRef*>(field.value)->get(), field.info->name);
    } else if (field.info->type == FieldType::MFNode) {
      const auto& list = *static_cast<const MFNode*>(field.value);
      text_ += '[';
      indent_ += 2;
      for (const NodeRef& child : list) {
        line();
        node(child.get(), field.info->name);
      }
      indent_ -= 2;
      if (!list.empty()) line();
      text_ += list.empty() ? " ]" : "]";
    } else {
      writeValue(text_, field.info->type, field.value, indent_);
    }
  }

  void writeUse(const Node&, const std::string& name, std::string_view) override {
    text_ += "USE " + name;
  }
  void writeNull() override { text_ += "NULL"; }

  void writeRoute(const RouteText& route) override {
    text_ +=
        fmt::format("ROUTE {}.{} TO {}.{}", route.from, route.fromField, route.to, route.toField);
  }

  void writeImport(const std::string& inlineName, const std::string& exported,
                   const std::string& local) override {
    text_ += fmt::format("IMPORT {}.{} AS {}", inlineName, exported, local);
  }
  void writeExport(const std::string& node, const std::string& exported) override {
    text_ += fmt::format("EXPORT {} AS {}", node, exported);
  }

  void openPrototype(const std::string& name, const MFString* urls) override {
    text_ += fmt::format("{} {} [", urls ? "EXTERNPROTO" : "PROTO", name);
    interface_ = text_.size();
    indent_ += 2;
  }
  void writeDeclaration(const Field& field) override {
    line();
    words(*field.info);
    text_ += field.info->name;
    if (field.value) value(field);
  }
  void closeInterface() {
    indent_ -= 2;
    if (text_.size() > interface_) line();
    text_ += ']';
  }
  void openBody() override {
    closeInterface();
    text_ += " {";
    indent_ += 2;
  }
  void closePrototype(const MFString* urls) override {
    if (urls) {
      closeInterface();
      text_ += ' ';
      writeValue(text_, FieldType::MFString, urls, indent_);
      return;
    }
    indent_ -= 2;
    line();
    text_ += '}';
  }

  // Faces take about 20 KB of text. Further shapes keep the field `solid` of X3D, which is read.
  static constexpr size_t mostOfFaces = 5000;
  size_t shapesOfFaces_ = 0;
  std::vector<NodeRef> made_; // nodes that stand for others
  size_t interface_ = 0;      // where the interface of the open prototype begins in the text
};

} // namespace

std::unique_ptr<Writer> makeVrmlWriter(const World& world, const std::string& target,
                                       const FileVersion& version) {
  return std::make_unique<VrmlWriter>(world, target, version);
}

} // namespace xvrml
