// types.cpp: the table of VRML 1.0's nodes, with the fields and defaults of its specification
// (G. Bell, A. Parisi, M. Pesce, 26 May 1995, "Nodes").
#include <algorithm>

#include "parse/vrml1/tree.h"

namespace xvrml::vrml1 {
namespace {

template <class T> Field field(const char* name, T value) {
  const Value stored(std::move(value));
  return {name, static_cast<FieldType>(stored.index()), Spelling::plain, stored, false};
}
template <class T> Field extension(const char* name, T value) {
  Field made = field(name, std::move(value));
  made.extension = true;
  return made;
}
Field word(const char* name, const char* value) {
  return {name, FieldType::SFString, Spelling::enumeration, Value(SFString(value)), false};
}
Field mask(const char* name, const char* value) {
  return {name, FieldType::MFString, Spelling::bitMask, Value(MFString{value}), false};
}
Field matrix(const char* name) {
  return {name, FieldType::MFFloat, Spelling::matrix,
          Value(MFFloat{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), false};
}

// Fields of VRML97's lights. Browsers of VRML 1.0 read them, too.
std::vector<Field> light(std::vector<Field> own, bool local) {
  std::vector<Field> fields{field("on", true), field("intensity", 1.0f),
                            field("color", Color{1, 1, 1})};
  fields.insert(fields.end(), own.begin(), own.end());
  fields.push_back(extension("ambientIntensity", 0.0f));
  if (local) {
    fields.push_back(extension("attenuation", Vec3f{1, 0, 0}));
    fields.push_back(extension("radius", 100.0f));
  }
  return fields;
}

std::vector<Field> camera(Field size) {
  return {field("position", Vec3f{0, 0, 1}),
          field("orientation", Rotation{0, 0, 1, 0}),
          field("focalDistance", 5.0f),
          std::move(size),
          extension("direction", Vec3f{0, 0, -1}),
          extension("up", Vec3f{0, 1, 0}),
          extension("gravityUp", Vec3f{0, 1, 0})};
}

std::vector<Type> makeTypes() {
  const MFInt32 none{-1};
  return {
      {Kind::asciiText,
       "AsciiText",
       {field("string", MFString{""}), field("spacing", 1.0f), word("justification", "LEFT"),
        field("width", MFFloat{0})}},
      {Kind::cone,
       "Cone",
       {mask("parts", "ALL"), field("bottomRadius", 1.0f), field("height", 2.0f)}},
      {Kind::coordinate3, "Coordinate3", {field("point", MFVec3f{{}})}},
      {Kind::cube, "Cube", {field("width", 2.0f), field("height", 2.0f), field("depth", 2.0f)}},
      {Kind::cylinder,
       "Cylinder",
       {mask("parts", "ALL"), field("radius", 1.0f), field("height", 2.0f)}},
      {Kind::directionalLight, "DirectionalLight",
       light({field("direction", Vec3f{0, 0, -1})}, false)},
      {Kind::fontStyle,
       "FontStyle",
       {field("size", 10.0f), word("family", "SERIF"), mask("style", "NONE")}},
      {Kind::group, "Group", {}},
      {Kind::indexedFaceSet,
       "IndexedFaceSet",
       {field("coordIndex", MFInt32{0}), field("materialIndex", none), field("normalIndex", none),
        field("textureCoordIndex", none)}},
      {Kind::indexedLineSet,
       "IndexedLineSet",
       {field("coordIndex", MFInt32{0}), field("materialIndex", none), field("normalIndex", none),
        field("textureCoordIndex", none)}},
      {Kind::info, "Info", {field("string", SFString("<Undefined info>"))}},
      {Kind::lod, "LOD", {field("range", MFFloat{}), field("center", Vec3f{})}},
      {Kind::material,
       "Material",
       {field("ambientColor", MFColor{{0.2f, 0.2f, 0.2f}}),
        field("diffuseColor", MFColor{{0.8f, 0.8f, 0.8f}}), field("specularColor", MFColor{{}}),
        field("emissiveColor", MFColor{{}}), field("shininess", MFFloat{0.2f}),
        field("transparency", MFFloat{0})}},
      {Kind::materialBinding, "MaterialBinding", {word("value", "DEFAULT")}},
      {Kind::matrixTransform, "MatrixTransform", {matrix("matrix")}},
      {Kind::normal, "Normal", {field("vector", MFVec3f{})}},
      {Kind::normalBinding, "NormalBinding", {word("value", "DEFAULT")}},
      {Kind::orthographicCamera, "OrthographicCamera", camera(field("height", 2.0f))},
      {Kind::perspectiveCamera, "PerspectiveCamera", camera(field("heightAngle", 0.785398f))},
      {Kind::pointLight, "PointLight", light({field("location", Vec3f{0, 0, 1})}, true)},
      {Kind::pointSet, "PointSet", {field("startIndex", int32_t(0)), field("numPoints", -1)}},
      {Kind::rotation, "Rotation", {field("rotation", Rotation{0, 0, 1, 0})}},
      {Kind::scale, "Scale", {field("scaleFactor", Vec3f{1, 1, 1})}},
      {Kind::separator, "Separator", {word("renderCulling", "AUTO")}},
      {Kind::shapeHints,
       "ShapeHints",
       {word("vertexOrdering", "UNKNOWN_ORDERING"), word("shapeType", "UNKNOWN_SHAPE_TYPE"),
        word("faceType", "CONVEX"), field("creaseAngle", 0.5f)}},
      {Kind::sphere, "Sphere", {field("radius", 1.0f)}},
      {Kind::spotLight, "SpotLight",
       light({field("location", Vec3f{0, 0, 1}), field("direction", Vec3f{0, 0, -1}),
              field("dropOffRate", 0.0f), field("cutOffAngle", 0.785398f)},
             true)},
      {Kind::switchNode, "Switch", {field("whichChild", int32_t(-1))}},
      {Kind::texture2,
       "Texture2",
       {field("filename", SFString()), field("image", Image{}), word("wrapS", "REPEAT"),
        word("wrapT", "REPEAT")}},
      {Kind::texture2Transform,
       "Texture2Transform",
       {field("translation", Vec2f{}), field("rotation", 0.0f), field("scaleFactor", Vec2f{1, 1}),
        field("center", Vec2f{})}},
      {Kind::textureCoordinate2, "TextureCoordinate2", {field("point", MFVec2f{{}})}},
      {Kind::transform,
       "Transform",
       {field("translation", Vec3f{}), field("rotation", Rotation{0, 0, 1, 0}),
        field("scaleFactor", Vec3f{1, 1, 1}), field("scaleOrientation", Rotation{0, 0, 1, 0}),
        field("center", Vec3f{})}},
      {Kind::transformSeparator, "TransformSeparator", {}},
      {Kind::translation, "Translation", {field("translation", Vec3f{})}},
      {Kind::wwwAnchor,
       "WWWAnchor",
       {field("name", SFString()), field("description", SFString()), word("map", "NONE")}},
      {Kind::wwwInline,
       "WWWInline",
       {field("name", SFString()), field("bboxSize", Vec3f{}), field("bboxCenter", Vec3f{})}},
  };
}

struct TypeName {
  std::string_view name;
  FieldType type;
  Spelling spelling = Spelling::plain;
};
constexpr TypeName typeNames[] = {
    {"SFBitMask", FieldType::MFString, Spelling::bitMask},
    {"SFBool", FieldType::SFBool},
    {"SFColor", FieldType::SFColor},
    {"SFEnum", FieldType::SFString, Spelling::enumeration},
    {"SFFloat", FieldType::SFFloat},
    {"SFImage", FieldType::SFImage},
    {"SFLong", FieldType::SFInt32},
    {"SFMatrix", FieldType::MFFloat, Spelling::matrix},
    {"SFRotation", FieldType::SFRotation},
    {"SFString", FieldType::SFString},
    {"SFTime", FieldType::SFTime},
    {"SFVec2f", FieldType::SFVec2f},
    {"SFVec3f", FieldType::SFVec3f},
    {"MFColor", FieldType::MFColor},
    {"MFFloat", FieldType::MFFloat},
    {"MFLong", FieldType::MFInt32},
    {"MFRotation", FieldType::MFRotation},
    {"MFString", FieldType::MFString},
    {"MFVec2f", FieldType::MFVec2f},
    {"MFVec3f", FieldType::MFVec3f},
    // Names of Open Inventor and of VRML97, which files use as well.
    {"SFInt32", FieldType::SFInt32},
    {"MFInt32", FieldType::MFInt32},
};

} // namespace

int Type::find(std::string_view field) const {
  for (size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == field) return static_cast<int>(i);
  return -1;
}

const std::vector<Type>& types() {
  static const std::vector<Type> all = makeTypes();
  return all;
}

const Type* findType(std::string_view name) {
  if (name == "Selection" || name == "Annotation") name = "Separator";
  const auto& all = types();
  const auto found =
      std::lower_bound(all.begin(), all.end(), name, [](const Type& type, std::string_view wanted) {
        return type.name < wanted;
      });
  return found != all.end() && found->name == name ? &*found : nullptr;
}

const TreeNode& defaultNode(Kind kind) {
  static const std::vector<TreeNode> all = [] {
    std::vector<TreeNode> nodes;
    for (const Type& type : types()) {
      TreeNode& node = nodes.emplace_back();
      node.type = &type;
      node.kind = type.kind;
      for (const Field& field : type.fields) node.values.push_back(field.value);
      node.given.assign(type.fields.size(), false);
    }
    return nodes;
  }();
  return all[static_cast<size_t>(kind)]; // kinds and types have one order
}

bool fieldTypeNamed(std::string_view name, FieldType& type, Spelling& spelling) {
  for (const TypeName& known : typeNames) {
    if (known.name != name) continue;
    type = known.type;
    spelling = known.spelling;
    return true;
  }
  return false;
}

} // namespace xvrml::vrml1
