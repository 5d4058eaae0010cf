#include "geometry/descend.h"

#include <algorithm>
#include <optional>

#include "geometry/node_matrix.h"
#include "nodes/registry.h"
#include "nodes/visible.h"
#include "xvrml/nodes.h"

namespace xvrml {

bool innerMatrix(const Node& node, const Matrix& toWorld, const Matrix& view, Matrix& inner,
                 Matrix* local) {
  const auto place = [&](const Matrix& own) {
    inner = compose(toWorld, own);
    if (local) *local = own;
  };
  if (hasMatrix(node)) {
    place(matrixOf(node));
    return determinant(inner) != 0;
  }
  inner = toWorld;
  if (node.type().index == nodes::Billboard::typeIndex) {
    Matrix toLocal;
    if (!invert(toWorld, toLocal)) return false;
    const Vector eye(view.x[3][0], view.x[3][1], view.x[3][2]),
        up(view.x[1][0], view.x[1][1], view.x[1][2]);
    const Vector axis = vector(static_cast<const nodes::Billboard&>(node).axisOfRotation);
    place(billboardMatrix(axis, transformPoint(toLocal, eye), transformDirection(toLocal, up)));
  }
  return true;
}

namespace {

using PlacingFields = std::optional<std::vector<const FieldInfo*>>;

// Returns the fields of a type that place nodes; null: it has not the role `listing`.
const std::vector<const FieldInfo*>* placingFields(const NodeType& type) {
  static const auto& byIndex = *[] {
    auto* const all = new std::vector<PlacingFields>();
    for (const NodeType* one : nodes::builtinNodeTypes()) {
      PlacingFields& placing = all->emplace_back();
      if (!one->is("listing")) continue;
      std::vector<const FieldInfo*>& fields = placing.emplace();
      for (const FieldInfo& field : one->fields)
        if (field.change == Change::children && holdsValue(field) &&
            (field.type == FieldType::SFNode || field.type == FieldType::MFNode))
          fields.push_back(&field);
    }
    return all;
  }();
  const auto index = size_t(type.index); // that of prototypes and Scripts is beyond the end
  return index < byIndex.size() && byIndex[index] ? &*byIndex[index] : nullptr;
}

} // namespace

bool appendPlaced(const Node& node, std::vector<Node*>& parts) {
  const auto* const fields = placingFields(node.type());
  if (!fields) return false;
  const auto append = [&](const NodeRef& child) {
    if (child) parts.push_back(child.get());
  };
  if (const auto* set = nodeCast<nodes::LayerSet>(&node)) {
    // The layers are counted from 1: 0 is what stands in no layer (ISO/IEC 19775-1 35.4.2).
    for (const int32_t number : set->order)
      if (number >= 1 && size_t(number) <= set->layers.size())
        append(set->layers[size_t(number) - 1]);
    return true;
  }
  for (const FieldInfo* field : *fields) {
    if (field->type == FieldType::SFNode)
      append(*static_cast<const NodeRef*>(node.storage(*field)));
    else
      for (const NodeRef& child : *static_cast<const MFNode*>(node.storage(*field))) append(child);
  }
  return true;
}

bool isPlacedBy(const Node& parent, const Node& child) {
  std::vector<Node*> parts;
  return !appendPlaced(parent, parts) ||
         std::find(parts.begin(), parts.end(), &child) != parts.end();
}

void appendShownChildren(const nodes::CADLayer& layer, std::vector<Node*>& parts) {
  for (size_t i = 0; i < layer.children.size(); ++i)
    if (showsChild(layer, i)) parts.push_back(layer.children[i].get());
}

size_t levelFor(const nodes::LOD& lod, const Matrix& toWorld, const Matrix& view) {
  Matrix toLocal;
  if (!invert(toWorld, toLocal)) return 0;
  const double distance =
      (transformPoint(toLocal, {view.x[3][0], view.x[3][1], view.x[3][2]}) - vector(lod.center))
          .length();
  size_t level = 0;
  while (level < lod.range.size() && distance >= lod.range[level]) ++level;
  return std::min(level, lod.level.size() - 1);
}

} // namespace xvrml
