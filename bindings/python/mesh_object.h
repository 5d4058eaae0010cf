// mesh_object.h: the C++ side of the Python class Mesh, which shapes.cpp defines. World.meshes()
// and the renderers of World.render_with() return them. [GIL held]
#pragma once

#include <array>
#include <memory>

#include "objects.h"
#include "xvrml/build.h"

using SharedArrays = std::shared_ptr<const xvrml::GeometryArrays>;

struct MeshObject {
  NodeObject shape;
  SharedArrays arrays; // shared by all instances of a geometry node
  std::array<double, 16> matrix;
};

// Returns the columns of the argument view: a matrix from camera to world. Raises ValueError for
// other objects.
std::array<double, 16> viewMatrix(const py::object& view);
