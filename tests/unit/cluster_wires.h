// cluster_wires.h: several wires in one thread, served in turn, and the events of each so far.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/sockets.h"
#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

// A folder that the destructor removes.
struct Folder {
  std::string path;
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "openrt-test-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string operator/(const std::string& name) const { return path + "/" + name; }
};

inline KeyRing freshKeys(const Folder& folder, const std::string& name) {
  makeKeyFile(folder / name);
  return readKeys(folder / name);
}

// Returns options with long timeouts, so that a busy machine is no failure and no silent peer is
// dropped during a test.
inline WireOptions withLongTimeouts(WireOptions options) {
  options.heartbeat = 0.05;
  options.silence = 60;
  return options;
}
inline WireOptions listening(const KeyRing& keys = {}, const std::string& where = "127.0.0.1:0") {
  return withLongTimeouts({{}, where, keys});
}
inline WireOptions calling(const Wire& other, const KeyRing& keys = {},
                           const std::string& serverKey = "") {
  return withLongTimeouts(
      {{other.address() + (serverKey.empty() ? "" : "=" + serverKey)}, "", keys});
}

class Wires {
 public:
  Wire& add(const WireOptions& options) {
    sides_.push_back({std::make_unique<Wire>(options), {}});
    return *sides_.back().wire;
  }
  void end(const Wire& wire) {
    std::erase_if(sides_, [&](const Side& s) { return s.wire.get() == &wire; });
  }
  void serve() {
    for (Side& side : sides_)
      for (Event e; (e = side.wire->receive(0.002)).kind != Event::Kind::nothing;)
        side.events.push_back(std::move(e));
  }
  // Waits for the next event of a kind on a wire, removes it and returns it. Returns `nothing`
  // after a long time.
  Event next(const Wire& wire, Event::Kind kind, double patience = 30) {
    for (const double end = steadySeconds() + patience;;) {
      std::vector<Event>& events = of(wire).events;
      for (auto e = events.begin(); e != events.end(); ++e)
        if (e->kind == kind) {
          Event event = std::move(*e);
          events.erase(e);
          return event;
        }
      if (steadySeconds() > end) return {};
      serve();
    }
  }
  // Returns whether such an event has arrived.
  bool has(const Wire& wire, Event::Kind kind) {
    for (const Event& e : of(wire).events)
      if (e.kind == kind) return true;
    return false;
  }

 private:
  struct Side {
    std::unique_ptr<Wire> wire;
    std::vector<Event> events;
  };
  Side& of(const Wire& wire) {
    for (Side& side : sides_)
      if (side.wire.get() == &wire) return side;
    throw std::logic_error("no such wire");
  }
  std::vector<Side> sides_;
};

inline Message read(Event&& event) {
  Message message;
  EXPECT_EQ(decode(std::move(event.frames), message), "");
  return message;
}

// Returns the message of the exception that a function throws; empty if it throws none.
template <class F> std::string thrown(const F& f) {
  try {
    f();
  } catch (const std::exception& e) { return e.what(); }
  return {};
}

inline std::vector<std::byte> someBytes(size_t count, uint32_t seed = 1) {
  std::vector<std::byte> bytes(count);
  for (auto& b : bytes) b = std::byte((seed = seed * 1664525u + 1013904223u) >> 24);
  return bytes;
}

} // namespace openrt::cluster
