#include "edit/actions.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Imath/ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "edit/node_fields.h"
#include "edit/outline.h"
#include "edit/transform_tool.h"

namespace vv {

using namespace xvrml;

namespace {

constexpr NewNode table[] = {
    {"Box", true},        {"Sphere", true},      {"Cylinder", true},   {"Cone", true},
    {"Transform", false}, {"PointLight", false}, {"SpotLight", false}, {"DirectionalLight", false}};

MFNode selectionOf(WorldEditor& editor) {
  if (editor.selection().empty()) throw EditError("nothing is selected");
  return editor.selection();
}

// Returns "Remove Box", or "Remove 3 nodes".
std::string nameOf(const char* verb, const MFNode& nodes) {
  return nodes.size() == 1 ? fmt::format("{} {}", verb, nodes.front()->type().name)
                           : fmt::format("{} {} nodes", verb, nodes.size());
}

const FieldInfo* childrenOf(const Node& node) {
  const FieldInfo* const field = node.type().find("children");
  return field && field->type == FieldType::MFNode && holdsValue(*field) ? field : nullptr;
}

} // namespace

NodeRef nodeOf(WorldEditor& editor, PickHit hit, bool group) {
  // From the Shape upwards: what stands in the file, and is a group if one is wanted.
  if (group) hit.path.pop_back();
  const MFNode above = nodesOfFile(editor.browser().world(), hit.path);
  return above.empty() ? NodeRef() : above.back();
}

void selectAt(WorldEditor& editor, const EditView& view, double x, double y, bool group, bool add) {
  const CameraRay ray = rayThrough(view.camera, view.aspect, x, y);
  PickHit hit;
  const bool isHit = editor.browser().pick(ray.origin, ray.direction, {.bothSides = true}, hit);
  editor.choose(isHit ? nodeOf(editor, std::move(hit), group) : NodeRef(), add);
}

void removeSelected(WorldEditor& editor) {
  const MFNode nodes = selectionOf(editor);
  editor.step(nameOf("Remove", nodes), [&] {
    bool anyGone = false;
    for (const NodeRef& node : nodes) {
      // A node may have gone with the group that it was in.
      if (anyGone && !editor.editor().stands(*node)) continue;
      editor.editor().remove(editor.placeOf(*node));
      anyGone = true;
    }
  });
  editor.select({});
}

void duplicateSelected(WorldEditor& editor) {
  const MFNode nodes = selectionOf(editor);
  MFNode copies;
  editor.step(nameOf("Duplicate", nodes), [&] {
    for (const NodeRef& node : nodes)
      copies.push_back(editor.editor().duplicate(editor.placeOf(*node)));
  });
  editor.select(std::move(copies));
}

void wrapSelected(WorldEditor& editor) {
  const MFNode nodes = selectionOf(editor);
  MFNode groups;
  editor.step(nameOf("Wrap", nodes), [&] {
    for (const NodeRef& node : nodes) groups.push_back(editor.editor().wrap(editor.placeOf(*node)));
  });
  editor.select(std::move(groups));
}

std::span<const NewNode> newNodes() { return table; }

NodeSlot placeForNew(WorldEditor& editor) {
  Node* const selected = editor.selected();
  if (selected && childrenOf(*selected)) return editor.endOf(selected, "children");
  if (selected)
    for (NodeSlot place : editor.editor().placesOf(*selected))
      if (!place.parent || place.field == "children") {
        ++place.index;
        return place;
      }
  return editor.endOf(nullptr, "");
}

void add(WorldEditor& editor, const NewNode& node) {
  NodeRef made;
  editor.step(fmt::format("Add {}", node.name), [&] {
    made = insertNew(editor, placeForNew(editor), node.isGeometry ? "Shape" : node.name);
    if (!node.isGeometry) return;
    const NodeRef appearance = insertNew(editor, {made.get(), "appearance", 0}, "Appearance");
    insertNew(editor, {appearance.get(), "material", 0}, "Material");
    insertNew(editor, {made.get(), "geometry", 0}, node.name);
  });
  editor.select({made});
}

void addViewpoint(WorldEditor& editor, const EditView& view) {
  const double* const m = view.camera.matrix;
  Imath::M44d matrix;
  std::copy(m, m + 16, &matrix.x[0][0]);
  if (view.camera.fovy == 0) throw EditError("a parallel view cannot be added as a Viewpoint");
  const double angle = view.aspect >= 1
                           ? view.camera.fovy
                           : 2 * std::atan(std::tan(view.camera.fovy / 2) * view.aspect);
  NodeRef made;
  editor.step("Add Viewpoint", [&] {
    made = insertNew(editor, placeForNew(editor), "Viewpoint");
    const auto set = [&](const char* field, Value value) {
      editor.editor().set(*made, field, std::move(value));
    };
    set("description", std::string("view"));
    set("position", Vec3f{float(m[12]), float(m[13]), float(m[14])});
    set("orientation", rotationOf(Imath::extractQuat(matrix)));
    set("fieldOfView", float(angle));
  });
  editor.select({made});
}

} // namespace vv
