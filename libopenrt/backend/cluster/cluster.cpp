// cluster.cpp: the backend that renders with the help of other machines.
#include "backend/backend.h"

namespace openrt {

std::unique_ptr<Backend> makeClusterBackend(const BackendOptions&, const ClusterOptions&) {
  throw ClusterError("backend=cluster is not built yet");
}

} // namespace openrt
