// renderer.h: renderers for worlds. A class that derives from Renderer gets the nodes of a world
// one after the other, in their places, and the Shapes with what has to be drawn. Exporters,
// previews and statistics are such classes (docs/extend.md, "Write a renderer"). [the thread that
// owns the world]
//
//   struct Counter : xvrml::Renderer {
//     size_t triangles = 0;
//     void draw(const xvrml::DrawnShape& shape) override {
//       if (shape.mesh().kind == xvrml::GeometryArrays::Kind::triangles)
//         triangles += shape.mesh().indices.size() / 3;
//     }
//   };
//   Counter counter;
//   xvrml::render(*world, counter);
//
// All lengths are in the units of the world, which are metres (ISO/IEC 14772-1 4.4.5). Matrices
// have 16 numbers, column by column.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/appearance.h"
#include "xvrml/build.h"
#include "xvrml/change.h"
#include "xvrml/node_renderer.h"
#include "xvrml/world.h"

namespace xvrml {

// The answer of a callback: how the walk goes on.
enum class Visit : uint8_t {
  // The walk goes on into the children of the node. A Shape is drawn; its appearance and geometry
  // are its children.
  children,
  // A Shape is drawn without going into its appearance and geometry, which saves time. The same as
  // `skip` for all other nodes.
  draw,
  // The node and everything below it are left out. A Shape is not drawn.
  skip
};

// The place of the node that a callback gets. It is valid during the callback.
struct RenderState {
  const World& world;
  // The nodes from a root of the world to the node itself, which is the last one. Prototype
  // instances (ProtoInstance), Inlines and nodes of plug-ins are among them, followed by what
  // stands for them.
  std::span<Node* const> path;
  const double* matrix; // from the node's own coordinate system to the world
  // From the coordinate system of the node's children to its own: the matrix of a Transform, the
  // rotation of a Billboard; the identity for other nodes.
  const double* local;
  // From the coordinate system of the node's children to the world: matrix times local. Null if no
  // child can be visible, because the matrix is singular or not finite; then none is visited.
  const double* inner;
  // The part of the world that ClipPlanes leave at the node: points with a x + b y + c z + d >= 0
  // for each of these. Empty: everything.
  std::span<const std::array<double, 4>> kept;

  // Returns the node above the node; null for a root.
  Node* parent() const { return path.size() > 1 ? path[path.size() - 2] : nullptr; }
  // Returns the DEF name of the node, else of the nearest node above it that has one; "" if none
  // has.
  std::string_view name() const;
};

// Says which node an event can reach, for code that groups what does not change.
struct Reach {
  const Node* node = nullptr; // null: no event reaches it
  Change change = Change::none;

  explicit operator bool() const { return node != nullptr; }
  // Returns the cause for messages: "ROUTE from Clock.fraction_changed".
  std::string reason() const { return node ? reachReason(*node, change) : std::string(); }
};

// Returns whether events reach a node with such a change, or a node that one of its SFNode fields
// holds (Coordinate, FontStyle).
Reach reachBelow(const Node& node, Change change);

class RenderWalk;

// A Shape with a geometry. Everything is computed when it is first asked for. It is valid during
// the call of draw().
class DrawnShape {
 public:
  DrawnShape(nodes::Shape& shape, Node& geometry, const RenderState& state, RenderWalk& walk)
      : shape(shape), geometry(geometry), state(state), walk_(walk) {}
  DrawnShape(const DrawnShape&) = delete;
  DrawnShape& operator=(const DrawnShape&) = delete;

  nodes::Shape& shape;
  Node& geometry; // the geometry node that is rendered
  const RenderState& state;

  const double* matrix() const { return state.matrix; } // from the shape to the world
  std::string_view name() const { return state.name(); }
  // Returns the arrays of the geometry in the coordinates of the shape, cut by ClipPlanes. The
  // triangles are counter-clockwise as seen from the front if `ccw`. It has Kind::empty if there is
  // nothing to draw. The arrays of a geometry that is used n times are made n times: a renderer
  // that keeps them by `geometry` asks once, unless kept() has planes.
  const GeometryArrays& mesh() const;
  const AppearanceParts& appearance() const;
  // Returns what ClipPlanes leave, as state.kept, in the coordinates of the shape.
  const std::vector<std::array<double, 4>>& kept() const;
  // Returns how many Shapes of this world have the geometry node, as the viewer sees it, whatever
  // callbacks skip. The first call walks the whole world, with the limits of render().
  uint64_t uses() const;

  // Return what events can reach in a running world: the matrix of the shape; whether it is there
  // (the children above it); its geometry node with Coordinates and the like; its appearance with
  // materials, textures and shaders.
  Reach reachOfMatrix() const;
  Reach reachOfPresence() const;
  Reach reachOfGeometry() const;
  Reach reachOfAppearance() const;

 private:
  RenderWalk& walk_;
  mutable std::optional<GeometryArrays> mesh_;
  mutable std::optional<AppearanceParts> appearance_;
  mutable std::optional<std::vector<std::array<double, 4>>> kept_;
};

// The base of all renderers. The callbacks for nodes are those of NodeRenderer, which nodegen
// writes from the .node files: `Visit renderTransform(nodes::Transform& node, const RenderState&
// state)` and so on, one for each node type. Each calls render(), the callback for all nodes,
// unless it is overridden; render() returns Visit::children. leave() is called after the children
// of each node for which a callback returned Visit::children.
//
// Exceptions of callbacks end the walk and pass through render(). Callbacks should not change the
// world: the walk stays valid, but it may visit what was there before.
class Renderer : public NodeRenderer {
 public:
  // Draws a Shape that has a geometry, after renderShape() and before the children of the Shape.
  virtual void draw(const DrawnShape& shape);
};

struct RenderOptions {
  // Camera to world: chooses the level of LODs and turns Billboards. Null: the viewer is at the
  // origin.
  const double* view = nullptr;
  // Number of parts that a Sphere is cut into from pole to pole, with twice as many around. 0 keeps
  // it a sphere: DrawnShape::mesh() then has Kind::sphere and a radius, and no points.
  int sphereSteps = 32;
  // Goes into all children of a Switch and all levels of an LOD, not only those that the viewer
  // sees.
  bool allChoices = false;
  // LODs have their first level, whatever the distance of the viewer.
  bool finestLevels = false;
  // More visits to nodes throw std::length_error. A node that is used n times is visited n times.
  uint64_t maximumVisits = 4'000'000;
};

// Walks over what a viewer sees of a world, in the order of the file, and calls the renderer. The
// world is taken as it is now, also while it runs (Browser::world()).
// - Switch, LOD and CADLayer lead to the children that are shown; the proxy of a Collision is not
//   visited. Nodes whose field `visible` is FALSE are left out.
// - Prototype instances lead to the first node of their body, Inlines to what they loaded, nodes of
//   plug-ins to what they expand to.
// - A node that contains itself is not entered again.
// Nesting costs no C++ stack. Throws std::length_error beyond options.maximumVisits.
void render(const World& world, Renderer& renderer, const RenderOptions& options = {});

} // namespace xvrml
