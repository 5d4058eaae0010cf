#include "geometry/copied.h"

#include <algorithm>
#include <type_traits>

#include "xvrml/deformed.h"
#include "xvrml/nodes.h"
#include "xvrml/visit_storage.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

constexpr uint64_t slowTriangles = 50'000; // about 5 ms
constexpr int deepest = 4;                 // levels of nodes below a geometry, such as MultiTexture

// Lists of faces have nothing but their fields. Other geometry, such as Text, is small or depends
// on what is around it.
bool isListOfFaces(const NodeType& type) { return type.is("faces") || type.is("composedGeometry"); }

uint64_t lengthOf(const Node& node, const FieldInfo& field) {
  return visitStorage(field.type, node.storage(field), [](const auto& value) -> uint64_t {
    if constexpr (requires { value.size(); })
      return value.size();
    else
      return 0;
  });
}

bool isDeformed(const Node& node) {
  if (const auto* points = nodeCast<nodes::Coordinate>(&node))
    return drawnPoints(*points).data() != points->point.data();
  if (const auto* exact = nodeCast<nodes::CoordinateDouble>(&node))
    return drawnPoints(*exact).data() != exact->point.data();
  const auto* normals = nodeCast<nodes::Normal>(&node);
  return normals && drawnNormals(*normals).data() != normals->vector.data();
}

NodeRef copyOf(const Node& node, int level);

// Copies a node that another one holds, as it is rendered. Returns false if that is impossible.
bool copyHeld(const NodeRef& held, NodeRef& copy, int level) {
  const Node* rendered = renderedNode(held.get());
  if (!rendered) return true;
  copy = copyOf(*rendered, level + 1);
  return bool(copy);
}

NodeRef copyOf(const Node& node, int level) {
  const NodeType& type = node.type();
  if (level > deepest || type.index < 0 || !type.create || type.expand || isDeformed(node))
    return {};
  NodeRef copy(type.create(type));
  copy->source = node.source;
  for (const FieldInfo& field : type.fields) {
    if (!holdsValue(field) || field.isMetadata || node.isUnset(field)) continue;
    const bool whole = visitStorage(field.type, copy->storage(field), [&](auto& value) {
      using T = std::remove_reference_t<decltype(value)>;
      const T& original = *static_cast<const T*>(node.storage(field));
      if constexpr (std::is_same_v<T, NodeRef>) {
        return copyHeld(original, value, level);
      } else if constexpr (std::is_same_v<T, MFNode>) {
        value.resize(original.size());
        for (size_t i = 0; i < original.size(); ++i)
          if (!copyHeld(original[i], value[i], level)) return false;
        return true;
      } else {
        value = original;
        return true;
      }
    });
    if (!whole) return {};
  }
  return copy;
}

// Returns the length of the longest array of a geometry node and the nodes that it holds.
uint64_t longestArray(const Node& geometry) {
  uint64_t longest = 0;
  for (const FieldInfo& field : geometry.type().fields) {
    if (!holdsValue(field) || field.isMetadata || geometry.isUnset(field)) continue;
    longest = std::max(longest, lengthOf(geometry, field));
    if (field.type != FieldType::SFNode) continue;
    const auto& held = *static_cast<const NodeRef*>(geometry.storage(field));
    const Node* rendered = renderedNode(held.get());
    if (!rendered || rendered->type().index < 0) continue;
    for (const FieldInfo& own : rendered->type().fields)
      if (holdsValue(own) && !rendered->isUnset(own))
        longest = std::max(longest, lengthOf(*rendered, own));
  }
  return longest;
}

} // namespace

uint64_t lengthOfFaces(const Node& geometry) {
  // These two are looked at thousands of times.
  if (const auto* faces = nodeCast<nodes::IndexedFaceSet>(&geometry))
    return faces->coordIndex.size();
  if (const auto* grid = nodeCast<nodes::ElevationGrid>(&geometry)) return 2 * grid->height.size();
  return isListOfFaces(geometry.type()) ? longestArray(geometry) : 0;
}

bool isSlowToBuild(const Node& geometry) { return lengthOfFaces(geometry) >= slowTriangles * 3; }

uint64_t mostTriangles(const Node& geometry) {
  const auto* faces = nodeCast<nodes::IndexedFaceSet>(&geometry);
  if (!faces) return lengthOfFaces(geometry);
  uint64_t triangles = 0, corners = 0; // in all faces, and in the present one
  for (const int32_t index : faces->coordIndex) {
    corners = index == -1 ? 0 : corners + 1;
    triangles += corners > 2;
  }
  return triangles;
}

NodeRef copyOfGeometry(const Node& geometry) {
  return isListOfFaces(geometry.type()) ? copyOf(geometry, 0) : NodeRef();
}

} // namespace xvrml
