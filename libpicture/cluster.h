// cluster.h: other machines that render, too (docs/cluster.md): one OpenRT context that calls them,
// kept while worlds and renderers come and go, so that workers stay connected and keep what they
// were sent. A renderer borrows the context as long as it lives; the next one waits for it. Made by
// vv and by the Python class Cluster. [any thread, but for what says otherwise]
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

// Words as in the configuration of a context (openrt.h).
struct ClusterSettings {
  std::string workers;    // HOST[:PORT],... or @FILE
  std::string listen;     // ADDRESS[:PORT]
  std::string key, allow; // files
  int localThreads = -1;  // that render here, too; below 0: as RenderSettings.threads says
  std::string split;      // auto, tiles, samples or frames; empty: auto
  int require = 0;        // workers without which there is no picture
  bool tolerant = false;

  bool used() const { return !workers.empty() || !listen.empty(); }
};

// " backend=cluster workers=..." for rtNewContext. Throws RenderError.
std::string clusterConfiguration(const ClusterSettings& settings);
// Adds one value to a configuration; throws RenderError if it cannot stand there.
void addQuoted(std::string& configuration, const char* key, const std::string& value);

struct ClusterNote { // what the engine says of its workers
  int level = 1;     // as of RTlogCallback
  std::string text;
};

class Cluster {
 public:
  // Begins to call the workers and returns at once. rendering: threads and shader path of the
  // context. Throws RenderError.
  Cluster(const ClusterSettings& settings, const RenderSettings& rendering);
  ~Cluster();
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  const ClusterSettings& settings() const;
  // Machines as they are now, this one and those that have left included.
  std::vector<RTworker> workers() const;
  size_t alive() const; // without this one
  // Waits until `count` are there. False: not within so many seconds, or `stop`, asked 20 times a
  // second, said true.
  bool wait(size_t count, double seconds, const std::function<bool()>& stop = {}) const;
  // Since the last call.
  std::vector<ClusterNote> takeNotes();

  // --- For a stage ---
  using Listener = std::function<void(int level, const char* text)>;
  // The context, current on this thread, as if it were new, as soon as nobody else has it; null:
  // `stop` said true before. listener: gets what the engine says of the scene.
  RTcontext borrow(Listener listener, const std::function<bool()>& stop);
  void giveBack(); // on the same thread; what was in the scene is gone

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The threads of this process.
inline bool isHere(const RTworker& worker) { return std::string_view(worker.name) == "here"; }

} // namespace picture
