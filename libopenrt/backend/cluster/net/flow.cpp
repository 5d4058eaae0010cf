#include "backend/cluster/net/flow.h"

#include "system/tcp_received.h"

namespace openrt::cluster {
namespace {

// Bytes per second. Ten heartbeats and their answers per second have about 1500.
constexpr double least = 8192;

} // namespace

void Flow::look(int fd, double now, double window) {
  if (now - since_ < window) return;
  const uint64_t bytes = os::bytesReceived(fd);
  flowing_ = double(bytes - bytes_) >= least * (now - since_);
  since_ = now;
  bytes_ = bytes;
}

} // namespace openrt::cluster
