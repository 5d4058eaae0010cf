// idle_connections.h: Chooses which HTTP connection is closed when many ask for nothing. Otherwise
// silent ones could keep new visitors out. Pure logic. [the host's thread]
#pragma once

#include <algorithm>
#include <deque>

#include "server/limits.h"

namespace vv::server {

// Connection: a handle, of which null means none.
template <class Connection> class IdleConnections {
 public:
  // Notes a connection that has made no request yet, or none since its last answer. Returns the
  // connection to close, which has asked for nothing for longest; null: none.
  Connection add(Connection connection) {
    remove(connection);
    oldestFirst_.push_back(connection);
    if (oldestFirst_.size() <= size_t(maxIdleConnections)) return {};
    const Connection oldest = oldestFirst_.front();
    oldestFirst_.pop_front();
    return oldest;
  }
  // Notes that a connection has made a request or has ended.
  void remove(Connection connection) { std::erase(oldestFirst_, connection); }

 private:
  std::deque<Connection> oldestFirst_;
};

} // namespace vv::server
