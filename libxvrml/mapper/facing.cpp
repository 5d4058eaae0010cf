// facing.cpp: tells whether a camera would see nothing but backs that are not drawn. Called on
// request, for worlds without a viewpoint.
#include <stdexcept>

#include "geometry/matrix.h"
#include "xvrml/mapper.h"
#include "xvrml/renderer.h"

namespace xvrml {
namespace {

Vector at(const GeometryArrays& mesh, size_t corner, const Matrix& toWorld) {
  const Vec3f& p = mesh.points[mesh.indices[corner]];
  return transformPoint(toWorld, Vector(p.x, p.y, p.z));
}

// Stops looking at the first thing that the eye sees.
class Backs : public Renderer {
 public:
  explicit Backs(const Vector& toEye) : toEye_(toEye) {}
  bool allAway() const { return any_ && !seen_; }

  Visit render(Node&, const RenderState&) override { return seen_ ? Visit::skip : Visit::children; }
  Visit renderShape(nodes::Shape&, const RenderState&) override {
    return seen_ ? Visit::skip : Visit::draw;
  }
  void draw(const DrawnShape& shape) override {
    const GeometryArrays& mesh = shape.mesh();
    if (mesh.kind == GeometryArrays::Kind::empty) return;
    if (mesh.kind != GeometryArrays::Kind::triangles || !mesh.solid) {
      seen_ = true;
      return;
    }
    const Matrix toWorld = fromArray(shape.matrix());
    // A mirror image turns the order of corners around, but not the side that is the front.
    const double front = (mesh.ccw ? 1 : -1) * (determinant(toWorld) < 0 ? -1 : 1);
    for (size_t i = 0; i + 2 < mesh.indices.size() && !seen_; i += 3) {
      const Vector a = at(mesh, i, toWorld);
      const Vector normal = (at(mesh, i + 1, toWorld) - a).cross(at(mesh, i + 2, toWorld) - a);
      const double facing = front * normal.dot(toEye_);
      seen_ = facing > 0;
      any_ |= facing < 0;
    }
  }

 private:
  const Vector toEye_;
  bool any_ = false, seen_ = false;
};

} // namespace

bool facesAway(const World& world, const double view[16]) {
  Backs backs(Vector(view[8], view[9], view[10]));
  RenderOptions options;
  options.view = view;
  options.sphereSteps = 0;
  try {
    render(world, backs, options);
  } catch (const std::length_error&) { return false; } // a world that is not walked to its end
  return backs.allAway();
}

} // namespace xvrml
