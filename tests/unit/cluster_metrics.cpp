// cluster_metrics.cpp: Tests the server of metrics beyond its answers, which
// tests/python/test_worker_metrics.py tests with a worker.
#include <atomic>
#include <cstdint>
#include <new>
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "backend/cluster/net/addresses.h"
#include "backend/cluster/net/metrics_server.h"

using namespace openrt::cluster;

namespace {

// Asks for the metrics. Returns all that is answered until the connection ends.
std::string ask(const MetricsServer& server) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(Address::parse(server.address()).port);
  ::inet_pton(AF_INET, "127.0.0.1", &place.sin_addr);
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  std::string answer;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
    const std::string request = "GET /metrics HTTP/1.0\r\n\r\n";
    ::send(fd, request.data(), request.size(), MSG_NOSIGNAL);
    char bytes[1024];
    for (ssize_t n; (n = ::recv(fd, bytes, sizeof bytes, 0)) > 0;) answer.append(bytes, size_t(n));
  }
  ::close(fd);
  return answer;
}

} // namespace

// A worker that has no memory for an answer goes on.
TEST(Metrics, aShortageOfMemoryEndsOneConnection) {
  std::atomic<int> calls = 0;
  const MetricsServer server("127.0.0.1:0", [&]() -> std::string {
    if (++calls == 1) throw std::bad_alloc();
    return "frames 7\n";
  });
  EXPECT_EQ(ask(server), "");
  EXPECT_NE(ask(server).find("frames 7"), std::string::npos);
  EXPECT_EQ(calls, 2);
}
