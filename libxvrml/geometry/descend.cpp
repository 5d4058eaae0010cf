#include "geometry/descend.h"

#include <algorithm>

#include "geometry/node_matrix.h"
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
