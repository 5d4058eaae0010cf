// backend.h: the waist between the API and whoever renders: local, record, null, cluster.
// Called on the application's thread only, except cancel(), progress(), snapshot() and workers().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "openrt/openrt.h"
#include "scene/commit.h"

namespace openrt {

class ShaderRegistry;

struct BackendOptions {
  uint32_t threads = 0; // 0: as many as the process may use
  std::string file;     // recording
  const ShaderRegistry* shaders = nullptr;
  RTlogCallback log = nullptr;
  void* logUser = nullptr;
  bool diagnose = false; // costs time: looks for misuse while it renders
};

struct ClusterOptions {
  std::vector<std::string> workers; // HOST[:PORT][=PUBLICKEY] to call; @FILE
  std::string listen;               // ADDRESS[:PORT]; empty: nobody calls in
  std::string keyFile, allowFile;
  std::optional<uint32_t> local; // threads of this process; none: BackendOptions.threads
  std::string split = "auto";    // tiles, samples, frames
  uint32_t require = 0;          // workers without which a frame fails
  bool tolerant = false;         // workers of other instruction sets and versions are taken
};

// Workers are missing, an address or a key is of no use. The message is for people.
class ClusterError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Backend {
 public:
  virtual ~Backend() = default;
  // True: apply() and start() may be called while frames are in flight, which are finished in their
  // order.
  virtual bool pipelines() const { return false; }
  // Takes the edits over; they hold from the next start() on. Never called while a frame is in
  // flight, if !pipelines().
  virtual void apply(std::shared_ptr<const Commit> commit) = 0;
  // Starts a frame of the committed scene; returns at once.
  virtual void start() = 0;
  // Waits for the (oldest) frame in flight, which then is the one that read() reads.
  virtual void wait() = 0;
  virtual void cancel() = 0;          // [any] all frames in flight
  virtual float progress() const = 0; // [any] 0..1, of the (oldest) frame in flight
  // One channel of the (oldest) frame in flight, its finished tiles; false if there is no such
  // channel or frame. [any]
  virtual bool snapshot(RTenum, std::span<float>) const { return false; }
  // One channel of the finished frame, first row at the top; false if there is no such channel or
  // frame.
  virtual bool read(RTenum channel, std::span<float> out) const = 0;
  virtual void stats(RTstats& stats) const = 0;
  virtual std::vector<RTworker> workers() const { return {}; } // [any] of a cluster
  virtual void castRays(std::span<const RTray> rays, std::span<RThit> hits) = 0;
  virtual void occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) = 0;
  // What the committed camera sees at a place of the picture, as castRays; false if no camera or no
  // frame is committed.
  virtual bool pick(double x, double y, RThit& hit) = 0;
  // Ends the file that is written, if one is: throws where it is not whole. No call but the
  // destructor may follow.
  virtual void finish() {}
};

// Throws std::runtime_error with a message for people when the backend cannot start.
std::unique_ptr<Backend> makeLocalBackend(const BackendOptions& options);
std::unique_ptr<Backend> makeRecordBackend(const BackendOptions& options);
std::unique_ptr<Backend> makeNullBackend(const BackendOptions& options);
std::unique_ptr<Backend> makeClusterBackend(const BackendOptions& options,
                                            const ClusterOptions& cluster); // or ClusterError
// Passes everything on to the backend that renders and explains misuse to options.log.
std::unique_ptr<Backend> makeDebugBackend(const BackendOptions& options,
                                          std::unique_ptr<Backend> renderer);
// Writes the recording options.file and passes everything on to the backend that renders.
std::unique_ptr<Backend> makeTeeBackend(const BackendOptions& options,
                                        std::unique_ptr<Backend> renderer);

} // namespace openrt
