// origins.cpp: bounds of parts and assemblies, computed in double precision.
#include "origins.h"

#include <algorithm>
#include <cmath>

#include <gp_Quaternion.hxx>
#include <gp_Vec.hxx>

namespace xvrml::decoding {
namespace {

// Points that are this many times the size of their box away have lost 3 of their 24 bits.
constexpr double farAway = 8;

struct Box {
  gp_XYZ least{1, 1, 1}, most{-1, -1, -1};

  bool isEmpty() const { return least.X() > most.X(); }
  void add(const gp_XYZ& p) {
    if (!std::isfinite(p.X()) || !std::isfinite(p.Y()) || !std::isfinite(p.Z())) return;
    if (isEmpty()) least = most = p;
    for (int i = 1; i <= 3; ++i) {
      least.SetCoord(i, std::min(least.Coord(i), p.Coord(i)));
      most.SetCoord(i, std::max(most.Coord(i), p.Coord(i)));
    }
  }
  void add(const Box& other) {
    if (other.isEmpty()) return;
    add(other.least);
    add(other.most);
  }
  void move(const gp_XYZ& by) {
    if (isEmpty()) return;
    least += by;
    most += by;
  }
  gp_XYZ corner(int number) const {
    return {number & 1 ? most.X() : least.X(), number & 2 ? most.Y() : least.Y(),
            number & 4 ? most.Z() : least.Z()};
  }
};

double largest(const gp_XYZ& v) {
  return std::max({std::abs(v.X()), std::abs(v.Y()), std::abs(v.Z())});
}

gp_XYZ vectorOf(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

void move(ModelNode& node, const gp_XYZ& by) {
  for (size_t i = 0; i < 3; ++i) node.translation[i] += by.Coord(int(i) + 1);
}

// Returns a vector of a node's own frame in that of its parent.
gp_XYZ turned(const ModelNode& node, const gp_XYZ& v) {
  const auto& r = node.rotation;
  return gp_Quaternion(r[0], r[1], r[2], r[3]).Multiply(gp_Vec(v)).XYZ() * node.scale;
}

Box pointsOf(const Mesh& mesh) {
  Box box;
  for (const Primitive& primitive : mesh.primitives)
    for (size_t i = 0; i + 2 < primitive.points.size(); i += 3)
      box.add(gp_XYZ(primitive.points[i], primitive.points[i + 1], primitive.points[i + 2]));
  return box;
}

class Origins {
 public:
  explicit Origins(Model& model) : model_(model), boxes_(model.nodes.size()) {
    for (const Mesh& mesh : model.meshes) meshes_.push_back(pointsOf(mesh));
  }

  Extent move() {
    for (size_t i = model_.nodes.size(); i-- > 0;) moveNode(i); // children come behind their parent
    Box all = boxOf(model_.roots);
    if (all.isEmpty()) return {};
    const Extent extent = {std::max(largest(all.least), largest(all.most)),
                           (all.most - all.least).Modulus()};
    const gp_XYZ origin = takeOrigin(model_.roots, all);
    if (origin.Modulus() > 0) {
      ModelNode above;
      decoding::move(above, origin);
      above.children = std::move(model_.roots);
      model_.roots = {model_.nodes.size()};
      model_.nodes.push_back(std::move(above));
    }
    return extent;
  }

 private:
  // Sets the box of a node in the frame of its parent.
  void moveNode(size_t number) {
    ModelNode& node = model_.nodes[number];
    Box inside;
    gp_XYZ origin;
    if (node.mesh) {
      inside = meshes_[*node.mesh];
      origin = vectorOf(model_.meshes[*node.mesh].origin);
    } else {
      inside = boxOf(node.children);
      origin = takeOrigin(node.children, inside);
    }
    decoding::move(node, turned(node, origin));
    for (int i = 0; i < 8 && !inside.isEmpty(); ++i)
      boxes_[number].add(turned(node, inside.corner(i)) + vectorOf(node.translation));
  }

  Box boxOf(const std::vector<size_t>& nodes) const {
    Box box;
    for (const size_t i : nodes) box.add(boxes_[i]);
    return box;
  }

  gp_XYZ takeOrigin(const std::vector<size_t>& nodes, Box& box) {
    const gp_XYZ origin = box.isEmpty() ? gp_XYZ() : originFor(box.least, box.most);
    if (origin.Modulus() > 0)
      for (const size_t i : nodes) decoding::move(model_.nodes[i], origin * -1);
    box.move(origin * -1);
    return origin;
  }

  Model& model_;
  std::vector<Box> boxes_, meshes_;
};

} // namespace

gp_XYZ originFor(const gp_XYZ& least, const gp_XYZ& most) {
  const gp_XYZ middle = (least + most) / 2;
  const double away = largest(middle);
  if (!(away > farAway * (most - least).Modulus()) || !std::isfinite(float(away))) return {};
  return {float(middle.X()), float(middle.Y()), float(middle.Z())};
}

Extent moveOrigins(Model& model) { return Origins(model).move(); }

} // namespace xvrml::decoding
