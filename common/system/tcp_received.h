// tcp_received.h: how much has arrived over a TCP connection. Not for files that include
// <netinet/tcp.h>, which has some of the same names as the system's own header. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include <netinet/in.h>
#include <sys/socket.h>

#if defined(__linux__)
#include <linux/tcp.h> // the C library's tcp_info ends before what is needed
#endif

namespace os {

// Returns the bytes received so far over a TCP connection; 0 if unknown.
inline uint64_t bytesReceived(int fd) {
#if defined(__linux__)
  tcp_info info{};
  socklen_t size = sizeof info;
  if (fd >= 0 && ::getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size) == 0 &&
      size >= offsetof(tcp_info, tcpi_segs_out))
    return info.tcpi_bytes_received;
#else
  (void)fd;
#endif
  return 0;
}

} // namespace os
