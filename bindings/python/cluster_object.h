// cluster_object.h: the Python class Cluster: machines that pictures are rendered with. Used with
// the GIL held.
#pragma once

#include <memory>

#include "libpicture/cluster.h"
#include "objects.h"

// The machines for a picture of this world: of the argument `cluster` of a render, else (None) of
// the innermost `with` around the call; null: this machine alone. Another world that still holds on
// to them gives them up. Raises TypeError or ValueError.
std::shared_ptr<picture::Cluster> clusterFor(const py::object& given, const WorldPtr& world);

void defineCluster(py::module_& module);
