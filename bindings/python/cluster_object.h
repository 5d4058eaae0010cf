// cluster_object.h: Declares the Python class Cluster, the machines that pictures are rendered
// with. [GIL held]
#pragma once

#include <memory>

#include "libpicture/cluster.h"
#include "objects.h"

// Returns the machines for a picture of this world: the argument `cluster` of render(), or if that
// is None, the innermost `with` around the call. Null means this machine alone. Another world that
// still holds the cluster releases it. Raises TypeError or ValueError.
std::shared_ptr<picture::Cluster> clusterFor(const py::object& given, const WorldPtr& world);

void defineCluster(py::module_& module);
