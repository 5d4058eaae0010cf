// renderer.cpp: Implements World.render_with(): walks over a world, and calls the methods of a
// Renderer in Python (xvrml/_renderer.py) for its nodes and Shapes. [GIL held; released between
// callbacks]
#include <array>
#include <exception>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "appearance_object.h"
#include "arrays.h"
#include "mesh_object.h"
#include "numbers.h"
#include "objects.h"
#include "xvrml/renderer.h"

using namespace xvrml;

namespace {

// Shared by the objects that callbacks get.
struct Walk {
  WorldPtr world;
  std::thread::id thread = std::this_thread::get_id();
  std::map<const Node*, SharedArrays> made; // arrays of geometries that ClipPlanes leave whole
};

// A RenderState or DrawnShape that Python sees. It is empty after the callback.
template <class T> struct Lent {
  Walk* walk;
  const T* value;

  const T& get() const {
    if (!value || walk->thread != std::this_thread::get_id())
      throw std::runtime_error("a state or shape is valid only during the callback that gets it, "
                               "and on its thread");
    return *value;
  }
};
using StateObject = Lent<RenderState>;
using ShapeObject = Lent<DrawnShape>;

// Lends an object to Python for its lifetime.
template <class T> class Lending {
 public:
  Lending(Walk& walk, const T& value) : lent_(std::make_shared<Lent<T>>(Lent<T>{&walk, &value})) {}
  ~Lending() { lent_->value = nullptr; }
  Lending(const Lending&) = delete;
  Lending& operator=(const Lending&) = delete;
  py::object object() const { return py::cast(lent_); }

 private:
  std::shared_ptr<Lent<T>> lent_;
};

// Ends a walk after a callback has raised an exception.
struct Stopped {};

struct Callbacks {
  std::vector<py::object> byType; // by NodeType::index; None: no callback
  py::object instance, leave, draw;
};

class PythonRenderer : public Renderer {
 public:
  PythonRenderer(Walk& walk, const Callbacks& callbacks) : walk_(walk), callbacks_(callbacks) {}
  const std::exception_ptr& failure() const { return failure_; }

  Visit render(Node& node, const RenderState& state) override {
    const py::object& callback = callbackOf(node);
    Visit visit = Visit::children;
    if (!callback.is_none())
      call([&] {
        const Lending<RenderState> lent(walk_, state);
        visit = visitOf(node, callback(asNode(walk_.world, &node), lent.object()));
      });
    return visit;
  }
  void leave(Node& node, const RenderState& state) override {
    if (callbacks_.leave.is_none()) return;
    call([&] {
      const Lending<RenderState> lent(walk_, state);
      callbacks_.leave(asNode(walk_.world, &node), lent.object());
    });
  }
  void draw(const DrawnShape& shape) override {
    if (callbacks_.draw.is_none()) return;
    call([&] {
      const Lending<DrawnShape> lent(walk_, shape);
      callbacks_.draw(lent.object());
    });
  }

 private:
  // [GIL not needed]
  const py::object& callbackOf(const Node& node) const {
    const int index = node.type().index; // a Script has a type of its own with the index of Script
    if (index < 0) return callbacks_.instance;
    // Types that another thread has loaded meanwhile have no callback.
    return size_t(index) < callbacks_.byType.size() ? callbacks_.byType[size_t(index)] : none_;
  }

  static Visit visitOf(const Node& node, const py::object& answer) {
    if (answer.is_none()) return Visit::children;
    const std::string word = py::isinstance<py::str>(answer) ? fromText(answer) : "";
    if (word == "children") return Visit::children;
    if (word == "draw") return Visit::draw;
    if (word == "skip") return Visit::skip;
    throw py::value_error(fmt::format("the callback for {} returned {}: None, 'children', 'draw' "
                                      "or 'skip' expected",
                                      node.type().name, shown(answer)));
  }

  // Calls `body` with the GIL. [GIL not held]
  template <class Body> void call(const Body& body) {
    const AcquireGil acquire;
    if (!acquire) throw Stopped();
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      body();
    } catch (...) {
      failure_ = std::current_exception();
      throw Stopped();
    }
  }

  Walk& walk_;
  const Callbacks& callbacks_;
  const py::object none_ = py::none();
  std::exception_ptr failure_;
};

// byType: callbacks by names of node types.
void renderWith(const WorldPtr& self, const py::dict& byType, const py::object& instance,
                const py::object& leave, const py::object& draw, const py::object& view,
                int spheres, bool allChoices, uint64_t maximumVisits) {
  Callbacks callbacks{{}, instance, leave, draw};
  for (const NodeType* type : nodeTypes())
    callbacks.byType.push_back(byType.attr("get")(toText(type->name), py::none()));
  RenderOptions options;
  std::array<double, 16> camera{};
  if (!view.is_none()) {
    camera = viewMatrix(view);
    options.view = camera.data();
  }
  options.sphereSteps = spheres;
  options.allChoices = allChoices;
  options.maximumVisits = maximumVisits;
  // A callback may render the world or wait for its pictures, so both locks are taken, in order.
  const auto drawing = self->lockDrawing();
  if (self->isRenderingHere)
    throw py::value_error("render_with(): the world is being rendered by this thread already");
  const auto graph = self->lockGraph();
  const World& world = self->graph();
  Walk walk{self};
  PythonRenderer renderer(walk, callbacks);
  std::exception_ptr failure;
  {
    const Drawing here(*self);
    const ReleaseGil release;
    try {
      xvrml::render(world, renderer, options);
    } catch (const Stopped&) { failure = renderer.failure(); } catch (...) {
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

py::list pathOf(const Walk& walk, const RenderState& state) {
  py::list path;
  for (Node* node : state.path) path.append(asNode(walk.world, node));
  return path;
}

py::array planes(const std::vector<std::array<double, 4>>& kept) {
  py::array_t<double> rows(ArrayShape{py::ssize_t(kept.size()), 4});
  double* to = rows.mutable_data();
  for (const auto& plane : kept) to = std::copy(plane.begin(), plane.end(), to);
  return rows;
}

// Returns the arrays of a shape. Shapes with the same geometry share them.
MeshObject meshOf(const ShapeObject& self) {
  const DrawnShape& shape = self.get();
  SharedArrays own;
  SharedArrays& arrays = shape.kept().empty() ? self.walk->made[&shape.geometry] : own;
  if (!arrays) {
    const ReleaseGil release;
    arrays = std::make_shared<GeometryArrays>(shape.mesh());
  }
  std::array<double, 16> matrix;
  std::copy_n(shape.matrix(), 16, matrix.begin());
  return {{self.walk->world, NodeRef(&shape.shape)}, arrays, matrix};
}

// Returns what events can reach: a dict of the parts that they can change.
py::dict reachesOf(const ShapeObject& self) {
  const DrawnShape& shape = self.get();
  py::dict out;
  const auto add = [&](const char* part, const Reach& reach) {
    if (!reach) return;
    out[part] = classInPython("Reach")(asNode(self.walk->world, const_cast<Node*>(reach.node)),
                                       toText(reach.reason()));
  };
  add("matrix", shape.reachOfMatrix());
  add("presence", shape.reachOfPresence());
  add("geometry", shape.reachOfGeometry());
  add("appearance", shape.reachOfAppearance());
  return out;
}

} // namespace

void defineRenderer(py::module_& module) {
  using S = StateObject;
  using D = ShapeObject;
  py::class_<S, std::shared_ptr<S>>(module, "RenderState",
                                    "The place of the node that a callback of a Renderer gets. It "
                                    "is valid during the callback.")
      .def_property_readonly(
          "path", [](const S& self) { return pathOf(*self.walk, self.get()); },
          "The nodes from a root of the world to the node itself, which is the last one. Instances "
          "of prototypes and Inlines are among them.")
      .def_property_readonly(
          "parent", [](const S& self) { return asNode(self.walk->world, self.get().parent()); },
          "The node above the node; None for a root.")
      .def_property_readonly(
          "name", [](const S& self) { return toText(std::string(self.get().name())); },
          "The DEF name of the node, else of the nearest node above it that has one, else ''.")
      .def_property_readonly(
          "matrix", [](const S& self) { return matrixArray(self.get().matrix); },
          "The matrix from the node's coordinate system to the world, 4x4 for column vectors.")
      .def_property_readonly(
          "local", [](const S& self) { return matrixArray(self.get().local); },
          "The matrix from the coordinate system of the node's children to its own.")
      .def_property_readonly(
          "inner",
          [](const S& self) {
            const double* inner = self.get().inner;
            return inner ? py::object(matrixArray(inner)) : py::object(py::none());
          },
          "The matrix from the coordinate system of the node's children to the world; None if no "
          "child can be visible.")
      .def_property_readonly(
          "planes",
          [](const S& self) {
            const auto kept = self.get().kept;
            return planes({kept.begin(), kept.end()});
          },
          "What ClipPlanes leave at the node: an array (n, 4) of planes of the world. Points with "
          "a x + b y + c z + d >= 0 for each of them are left.");
  py::class_<D, std::shared_ptr<D>>(
      module, "DrawnShape",
      "A Shape with a geometry, which a Renderer draws. It is valid during the callback. All is "
      "computed when it is asked for.")
      .def_property_readonly(
          "node", [](const D& self) { return asNode(self.walk->world, &self.get().shape); },
          "The Shape.")
      .def_property_readonly(
          "geometry", [](const D& self) { return asNode(self.walk->world, &self.get().geometry); },
          "The geometry node that is drawn.")
      .def_property_readonly(
          "path", [](const D& self) { return pathOf(*self.walk, self.get().state); },
          "The nodes from a root of the world to the Shape, which is the last one.")
      .def_property_readonly(
          "name", [](const D& self) { return toText(std::string(self.get().name())); },
          "The DEF name of the Shape, else of the nearest node above it that has one, else ''.")
      .def_property_readonly(
          "matrix", [](const D& self) { return matrixArray(self.get().matrix()); },
          "The matrix from the shape's coordinates to the world's, 4x4 for column vectors.")
      .def_property_readonly(
          "mesh", meshOf,
          "The arrays of the geometry, cut by ClipPlanes: a Mesh, which stays valid. Shapes with "
          "the same geometry share the arrays. Its kind is 'empty' if there is nothing to draw.")
      .def_property_readonly(
          "appearance",
          [](const D& self) { return appearanceObject(self.walk->world, self.get().appearance()); },

          "The appearance with its references resolved: AppearanceParts.")
      .def_property_readonly(
          "planes", [](const D& self) { return planes(self.get().kept()); },
          "What ClipPlanes leave, in the coordinates of the shape: an array (n, 4) of planes.")
      .def_property_readonly(
          "uses",
          [](const D& self) {
            const DrawnShape& shape = self.get();
            const ReleaseGil release;
            return shape.uses();
          },
          "The number of Shapes that have the geometry node, as the viewer sees the world.")
      .def_property_readonly(
          "reaches", reachesOf,
          "What events can reach in a running world: a dict of Reach with the keys 'matrix', "
          "'presence', 'geometry' and 'appearance'. A part that does not change is missing.");
  py::object world = module.attr("World");
  py::reinterpret_borrow<py::class_<WorldObject, WorldPtr>>(world).def(
      "_render_with", renderWith, py::arg("by_type"), py::arg("instance"), py::arg("leave"),
      py::arg("draw"), py::arg("view"), py::arg("spheres"), py::arg("all_choices"),
      py::arg("max_visits"));
}
