// cluster.h: Owns the OpenRT context that connects to the worker machines of a cluster
// (docs/cluster.md). The context outlives worlds and renderers, so workers stay connected and keep
// the data they were sent. A renderer borrows the context for its lifetime; the next renderer waits
// for it. vv and the Python class Cluster create it. [any thread, except where noted]
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

struct RenderSettings;

// Values in the syntax of a context's configuration (openrt.h).
struct ClusterSettings {
  std::string workers;    // workers to call: HOST[:PORT],... or @FILE
  std::string listen;     // where workers may call: ADDRESS[:PORT]
  std::string key, allow; // names of files
  int localThreads = -1;  // rendering threads of this machine; below 0: RenderSettings.threads
  std::string split;      // auto, tiles, samples or frames; empty: auto
  int require = 0;        // minimum number of workers; with fewer, rendering fails
  bool tolerant = false;

  bool used() const { return !workers.empty() || !listen.empty(); }
};

// Returns " backend=cluster workers=..." for rtNewContext. Throws RenderError.
std::string clusterConfiguration(const ClusterSettings& settings);
// Appends one value to a configuration. Throws RenderError if the value contains a double quote.
void addQuoted(std::string& configuration, const char* key, const std::string& value);

struct ClusterMessage { // a message of the engine about its workers
  int level = 1;        // level of RTlogCallback
  std::string text;
};

class Cluster {
 public:
  // Starts to connect to the workers and returns at once. `rendering` gives the threads and the
  // shader path of the context. Throws RenderError.
  Cluster(const ClusterSettings& settings, const RenderSettings& rendering);
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  const ClusterSettings& settings() const;
  // Returns the current state of all machines, including this one and those that have left.
  std::vector<RTworker> workers() const;
  size_t alive() const; // number of connected workers, without this machine
  // Waits until `count` workers are connected. Returns false after `seconds`, or when `stop`
  // returns true; `stop` is called 20 times a second.
  bool wait(size_t count, double seconds, const std::function<bool()>& stop = {}) const;
  // Returns the messages since the last call.
  std::vector<ClusterMessage> takeMessages();

  // --- For Stage ---
  using Listener = std::function<void(int level, const char* text)>;
  // Waits until no other renderer has the context, resets it, makes it current on this thread and
  // returns it. Returns null if `stop` returned true first. `listener` receives the engine's
  // messages about the scene.
  RTcontext borrow(Listener listener, const std::function<bool()>& stop);
  void giveBack(); // Called on the thread that borrowed. Deletes the contents of the scene.

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Tells whether this entry stands for the threads of this process.
inline bool isHere(const RTworker& worker) { return std::string_view(worker.name) == "here"; }

} // namespace picture
