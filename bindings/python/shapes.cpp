// shapes.cpp: Implements the Python class Mesh and World.meshes(), which return the drawn geometry
// of a world as arrays. [GIL held; released while geometry is made]
#include <array>
#include <cstring>
#include <map>

#include "arrays.h"
#include "mesh_object.h"

using namespace xvrml;

namespace {

struct Keeper {
  SharedArrays arrays;
};

// Returns a read-only view of shared arrays; they no longer change.
template <class T, class From>
py::array view(const MeshObject& self, const std::vector<From>& list, py::ssize_t width) {
  const auto rows = py::ssize_t(list.size() * sizeof(From) / sizeof(T)) / width;
  std::vector<py::ssize_t> shape{rows};
  if (width > 1) shape.push_back(width);
  py::capsule keeper(new Keeper{self.arrays},
                     [](void* held) { delete static_cast<Keeper*>(held); });
  py::array_t<T> array(std::move(shape), reinterpret_cast<const T*>(list.data()), keeper);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <class T, class From>
py::object viewOrNone(const MeshObject& self, const std::vector<From>& list, py::ssize_t width) {
  return list.empty() ? py::object(py::none()) : py::object(view<T>(self, list, width));
}

const char* kindOf(const MeshObject& self) {
  constexpr const char* names[] = {"empty", "triangles", "lines", "points", "sphere"};
  return names[size_t(self.arrays->kind)];
}

py::array faces(const MeshObject& self) {
  const auto kind = self.arrays->kind;
  const py::ssize_t corners = kind == GeometryArrays::Kind::triangles ? 3
                              : kind == GeometryArrays::Kind::lines   ? 2
                                                                      : 1;
  return view<uint32_t>(self, self.arrays->indices, corners);
}

py::array placed(const MeshObject& self) {
  const auto& points = self.arrays->points;
  py::array_t<double> out({py::ssize_t(points.size()), py::ssize_t(3)});
  double* to = out.mutable_data();
  const auto& m = self.matrix;
  for (const Vec3f& p : points)
    for (size_t k = 0; k < 3; ++k) *to++ = m[k] * p.x + m[4 + k] * p.y + m[8 + k] * p.z + m[12 + k];
  return out;
}

py::list meshes(const WorldPtr& self, int spheres, const py::object& view) {
  if (spheres < 0 || spheres > 1000) throw py::value_error("spheres: 0 to 1000 expected");
  std::array<double, 16> camera{};
  if (!view.is_none()) camera = viewMatrix(view);
  std::vector<PlacedShape> shapes;
  std::map<const Node*, SharedArrays> made; // geometries that ClipPlanes leave whole
  std::vector<SharedArrays> arraysOf;       // by shape
  World& world = self->graph();
  {
    const auto lock = self->lockGraph();
    const ReleaseGil release;
    shapes = placedShapes(world, view.is_none() ? nullptr : camera.data());
    for (const PlacedShape& shape : shapes) {
      if (!shape.kept.empty()) {
        arraysOf.push_back(
            std::make_shared<GeometryArrays>(geometryArrays(shape, spheres, world.options.limits)));
        continue;
      }
      SharedArrays& arrays = made[shape.geometry.get()];
      if (!arrays)
        arrays = std::make_shared<GeometryArrays>(
            geometryArrays(*shape.geometry, spheres, world.options.limits));
      arraysOf.push_back(arrays);
    }
  }
  py::list out;
  for (size_t i = 0; i < shapes.size(); ++i) {
    const PlacedShape& shape = shapes[i];
    const SharedArrays& arrays = arraysOf[i];
    if (arrays->kind == GeometryArrays::Kind::empty) continue;
    std::array<double, 16> matrix;
    std::memcpy(matrix.data(), shape.matrix, sizeof matrix);
    out.append(MeshObject{{self, shape.shape}, arrays, matrix});
  }
  return out;
}

} // namespace

std::array<double, 16> viewMatrix(const py::object& view) {
  const auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(view);
  if (PyErr_Occurred()) PyErr_Clear();
  if (!rows || rows.ndim() != 2 || rows.shape(0) != 4 || rows.shape(1) != 4)
    throw py::value_error("view: a 4x4 matrix expected");
  std::array<double, 16> columns;
  for (size_t i = 0; i < 16; ++i) columns[i] = rows.at(py::ssize_t(i % 4), py::ssize_t(i / 4));
  return columns;
}

void defineShapes(py::module_& module) {
  py::class_<MeshObject>(module, "Mesh",
                         "The geometry of a Shape, and its place in the world. The arrays are "
                         "read-only and share the memory of the renderer's mesh.")
      .def_property_readonly(
          "node",
          [](const MeshObject& self) { return asNode(self.shape.world(), self.shape.node); },
          "The Shape.")
      .def_property_readonly("kind", kindOf, "'triangles', 'lines', 'points' or 'sphere'.")
      .def_property_readonly(
          "matrix", [](const MeshObject& self) { return matrixArray(self.matrix.data()); },
          "The matrix from the mesh's coordinates to the world's, 4x4 for column vectors.")
      .def_property_readonly(
          "vertices",
          [](const MeshObject& self) { return view<float>(self, self.arrays->points, 3); },
          "The points in the mesh's own coordinates: float32 of shape (n, 3).")
      .def_property_readonly(
          "world_vertices", placed,
          "The points in world coordinates: a new array of float64 of shape (n, 3).")
      .def_property_readonly(
          "faces", faces,
          "Vertices of each triangle (m, 3), line segment (m, 2) or point (m,): uint32.")
      .def_property_readonly(
          "normals",
          [](const MeshObject& self) { return viewOrNone<float>(self, self.arrays->normals, 3); },
          "One normal per vertex, float32 of shape (n, 3); None: the faces are flat.")
      .def_property_readonly(
          "texcoords",
          [](const MeshObject& self) { return viewOrNone<float>(self, self.arrays->texCoords, 2); },
          "One texture coordinate per vertex, float32 of shape (n, 2), or None.")
      .def_property_readonly(
          "colors",
          [](const MeshObject& self) { return viewOrNone<float>(self, self.arrays->colors, 3); },
          "One colour per vertex, float32 of shape (n, 3), or None.")
      .def_property_readonly(
          "alphas",
          [](const MeshObject& self) { return viewOrNone<float>(self, self.arrays->alphas, 1); },
          "How opaque each vertex is, float32 of shape (n,), or None.")
      .def_property_readonly(
          "radius", [](const MeshObject& self) { return self.arrays->radius; },
          "The radius, if kind is 'sphere'.")
      .def_property_readonly(
          "solid", [](const MeshObject& self) { return self.arrays->solid; },
          "True if back faces are not drawn.")
      .def_property_readonly(
          "ccw", [](const MeshObject& self) { return self.arrays->ccw; },
          "True if the vertices of a face are in counter-clockwise order, seen from its front.");
  py::object world = module.attr("World");
  py::reinterpret_borrow<py::class_<WorldObject, WorldPtr>>(world).def(
      "meshes", meshes, py::kw_only(), py::arg("spheres") = 32, py::arg("view") = py::none(),
      "Returns everything that is drawn, as a list of Mesh. spheres: number of segments of a "
      "Sphere from pole to pole; 0 keeps Spheres exact (kind 'sphere'). view: camera-to-world "
      "matrix, for levels of detail and billboards.");
}
