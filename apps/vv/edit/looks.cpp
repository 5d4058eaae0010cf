#include "edit/looks.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "edit/copy_node.h"
#include "edit/material_files.h"
#include "edit/node_fields.h"
#include "libpicture/shader_text.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace vv {

using namespace xvrml;

namespace {

// A material, and its field for the colour that people see first.
struct Material {
  const char* type;
  const char* colour;
};
constexpr Material materials[] = {{"Material", "diffuseColor"},
                                  {"PhysicalMaterial", "baseColor"},
                                  {"UnlitMaterial", "emissiveColor"}};

// A look, and the Appearance that its file gives; null: it has no file.
struct Wanted {
  const Look& look;
  NodeRef model;
};

// Returns the node in an SFNode; null if there is none, or no such field.
NodeRef nodeIn(const Node& node, const char* name) {
  const FieldInfo* const field = node.type().find(name);
  if (!field || field->type != FieldType::SFNode || !holdsValue(*field)) return {};
  return *static_cast<const SFNode*>(node.storage(*field));
}

// Returns the material or the shader of an appearance; null: it has none.
NodeRef surfaceOf(const NodeRef& appearance) {
  Node* const rendered = renderedNode(appearance.get());
  if (!rendered) return {};
  const NodeRef shader = nodeIn(*rendered, "shader");
  return shader ? shader : nodeIn(*rendered, "material");
}

// Returns whether a node is an appearance itself, and not an instance of a prototype.
bool isAppearance(const NodeRef& node) {
  return nodeCast<nodes::Appearance>(node) || nodeCast<nodes::ORTAppearance>(node);
}

void insertShader(WorldEditor& editor, Node& appearance, const Look& look) {
  const NodeRef shader = insertNew(editor, {&appearance, "shader", 0}, "ORTShader");
  editor.editor().set(*shader, "name", look.name);
  editor.editor().set(*shader, "file", look.library);
}

// Inserts a whole appearance with a look. Returns it.
NodeRef insertAppearance(WorldEditor& editor, const NodeSlot& slot, const Wanted& wanted) {
  if (wanted.model) return copyNode(editor, slot, wanted.model);
  const Look& look = wanted.look;
  NodeRef made = insertNew(editor, slot, look.isShader() ? "ORTAppearance" : "Appearance");
  if (look.isShader())
    insertShader(editor, *made, look);
  else
    insertNew(editor, {made.get(), "material", 0}, look.name);
  return made;
}

// Takes the value of a field over, if both nodes have it and it is no default.
void takeOver(WorldEditor& editor, const Node& from, const char* name, Node& to,
              const char* newName) {
  const FieldInfo *const field = from.type().find(name), *const other = to.type().find(newName);
  if (!field || !other || field->type != other->type) return;
  if (Value value = from.get(*field); value != field->defaultValue && inRange(*other, value))
    editor.editor().set(to, newName, std::move(value));
}

void setMaterial(WorldEditor& editor, Node& appearance, const Look& look) {
  const NodeRef before = nodeIn(appearance, "material");
  if (before && before->type().name == look.name) return;
  const NodeRef made = insertNew(editor, {&appearance, "material", 0}, look.name);
  const auto named = [](const std::string& type) {
    return std::find_if(std::begin(materials), std::end(materials),
                        [&](const Material& one) { return one.type == type; });
  };
  if (!before || named(before->type().name) == std::end(materials)) return;
  takeOver(editor, *before, named(before->type().name)->colour, *made, named(look.name)->colour);
  takeOver(editor, *before, "transparency", *made, "transparency");
}

// Puts an ORTAppearance with a shader, or the Appearance of a file, into all places of an
// appearance. It takes over the name, and beside a shader what both can hold.
void replaceAppearance(WorldEditor& editor, const NodeRef& before, const Wanted& wanted) {
  Editor& file = editor.editor();
  const std::vector<NodeSlot> places = file.placesOf(*before);
  MFNode parents; // Scripts that an edit runs may let them go
  for (const NodeSlot& place : places) parents.emplace_back(place.parent);
  // Nodes are moved while both stand in the file, so that they keep their names and routes.
  const NodeRef holder = insertNew(editor, editor.endOf(nullptr, ""), "Shape");
  const NodeRef made = insertAppearance(editor, {holder.get(), "appearance", 0}, wanted);
  for (const char* field : {"material", "texture", "textureTransform"})
    if (!wanted.model && nodeIn(*before, field))
      file.move({before.get(), field, 0}, {made.get(), field, 0});
  file.move({holder.get(), "appearance", 0}, places.front());
  for (size_t i = 1; i < places.size(); ++i) file.use(places[i], *made);
  if (!before->defName.empty()) file.rename(*made, before->defName);
  file.remove(editor.placeOf(*holder));
}

void setLookOf(WorldEditor& editor, const NodeSlot& slot, const NodeRef& appearance,
               const Wanted& wanted) {
  Editor& file = editor.editor();
  const Look& look = wanted.look;
  if (!isAppearance(appearance)) {
    insertAppearance(editor, slot, wanted);
    return;
  }
  if (wanted.model) return replaceAppearance(editor, appearance, wanted);
  if (!look.isShader()) {
    if (nodeIn(*appearance, "shader")) file.remove({appearance.get(), "shader", 0});
    return setMaterial(editor, *appearance, look);
  }
  if (nodeCast<nodes::Appearance>(appearance)) return replaceAppearance(editor, appearance, wanted);
  const auto* const known = nodeCast<nodes::ORTShader>(nodeIn(*appearance, "shader"));
  if (known && known->name == look.name) return;
  insertShader(editor, *appearance, look);
}

// Compares what nodes say: their values and the nodes in them, but no names.
bool equalValues(const NodeRef& a, const NodeRef& b, int depth = 0) {
  constexpr int deepest = 8; // a material has textures, and these have properties
  if (a == b) return true;
  if (!a || !b || depth == deepest || a->type().name != b->type().name ||
      a->type().fields.size() != b->type().fields.size())
    return false;
  return std::all_of(a->type().fields.begin(), a->type().fields.end(), [&](const FieldInfo& field) {
    const FieldInfo* const other = b->type().find(field.name);
    if (!other || other->type != field.type) return false;
    if (!holdsValue(field) || field.isMetadata) return true;
    if (field.type == FieldType::SFNode)
      return equalValues(nodeIn(*a, field.name.c_str()), nodeIn(*b, field.name.c_str()), depth + 1);
    if (field.type == FieldType::MFNode) {
      const auto &one = *static_cast<const MFNode*>(a->storage(field)),
                 &two = *static_cast<const MFNode*>(b->storage(*other));
      return std::equal(
          one.begin(), one.end(), two.begin(), two.end(),
          [&](const NodeRef& x, const NodeRef& y) { return equalValues(x, y, depth + 1); });
    }
    return a->get(field) == b->get(*other);
  });
}

} // namespace

std::vector<Look> looksFor(WorldEditor& editor) {
  std::vector<Look> looks;
  for (const Material& one : materials)
    looks.push_back({one.type, "", findNodeType(one.type)->text});
  for (const picture::ShaderClass& one : editor.shaderClasses())
    if (one.role == RT_SURFACE) looks.push_back({one.name, one.library, one.text});
  return looks;
}

std::vector<Look> looksIn(const std::string& folder) {
  std::vector<Look> looks;
  for (const std::string& file : materialFiles(folder))
    looks.push_back({std::filesystem::path(file).stem().string(), "", file, file});
  return looks;
}

ShapeLook lookOf(const Node& shape) {
  ShapeLook look;
  look.appearance = nodeIn(shape, "appearance");
  look.surface = surfaceOf(look.appearance);
  const auto* const shader = nodeCast<nodes::ORTShader>(look.surface);
  if (look.surface) look.name = shader ? shader->name : look.surface->type().name;
  return look;
}

void setLook(WorldEditor& editor, const Look& look, bool onlyHere) {
  MFNode shapes;
  for (const NodeRef& node : editor.selection())
    if (nodeCast<nodes::Shape>(node)) shapes.push_back(node);
  if (shapes.empty()) throw EditError("select a Shape first");
  const UserMaterial own = look.file.empty() ? UserMaterial() : readMaterial(look.file);
  const Wanted wanted{look, own.appearance};
  std::unordered_map<const Node*, size_t> users; // the selected Shapes of each appearance
  for (const NodeRef& shape : shapes) ++users[nodeIn(*shape, "appearance").get()];
  editor.step(fmt::format("Set look {}", look.name), [&] {
    std::unordered_map<const Node*, NodeRef> instead; // what takes the place of an appearance
    SeenNodes done;
    for (const NodeRef& shape : shapes) {
      const NodeSlot slot{shape.get(), "appearance", 0};
      const NodeRef appearance = nodeIn(*shape, "appearance");
      if (!appearance) {
        insertAppearance(editor, slot, wanted);
      } else if (const auto other = instead.find(appearance.get()); other != instead.end()) {
        editor.editor().use(slot, *other->second);
      } else if (!done.contains(appearance.get())) {
        const bool isShared =
            editor.editor().placesOf(*appearance).size() > users[appearance.get()];
        const bool copies = isAppearance(appearance) && onlyHere && isShared;
        setLookOf(editor, slot, copies ? editor.editor().separate(slot) : appearance, wanted);
        const NodeRef now = nodeIn(*shape, "appearance");
        if (copies || !isAppearance(appearance)) instead.emplace(appearance.get(), now);
        done.insert(now.get());
      }
    }
  });
}

void selectSameLook(WorldEditor& editor) {
  const NodeRef selected(editor.selected());
  NodeRef surface;
  if (nodeCast<nodes::Shape>(selected))
    surface = lookOf(*selected).surface;
  else if (selected && selected->type().is("appearance"))
    surface = surfaceOf(selected);
  else if (selected && (selected->type().is("material") || selected->type().is("shader")))
    surface = selected;
  if (!surface) throw EditError("select a Shape that has a material, or a material");
  MFNode found;
  walk(rootsOf(editor.browser().world().scope), [&](Node& node, std::vector<Node*>& open) {
    appendChildren(node, open);
    if (nodeCast<nodes::Shape>(&node) && equalValues(lookOf(node).surface, surface))
      found.push_back(NodeRef(&node));
  });
  std::reverse(found.begin(), found.end()); // walks begin at the last root
  editor.select(std::move(found));
}

std::string shaderOption(const Node& shape) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_+-.,:/=";
  const auto* const shader = nodeCast<nodes::ORTShader>(lookOf(shape).surface);
  if (!shader || shape.defName.find_first_of(".,:/=") != shape.defName.npos) return {};
  bool isWhole = false;
  const std::string rule = shape.defName + "=" + picture::shaderText(*shader, &isWhole);
  // A shell takes these letters as they are.
  const bool isPlain = rule.find_first_not_of(plain) == rule.npos;
  constexpr size_t longest = 1024; // bytes of a command line that people read
  return shape.defName.empty() || !isWhole || !isPlain || rule.size() > longest
             ? ""
             : "--shader " + rule;
}

} // namespace vv
