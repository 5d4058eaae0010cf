// backend.h: the interface between the API and the backends: local, cluster, record, null, debug. A
// backend applies commits, renders frames and answers ray queries. Functions are called on the
// application's thread, except those marked [any thread].
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
#include "scene/scene_digest.h"

namespace openrt {

class Queries;
class ShaderRegistry;
struct FrameSums;

// Asks for the sums of frames to be kept (render/frame/frame_sums.h).
struct SumsRequest {
  bool keep = false;
  SceneDigest::Value scene;              // what the frames show
  std::shared_ptr<const FrameSums> from; // the sums that the next frame continues from; or null
};

struct BackendOptions {
  uint32_t threads = 0;     // 0: as many as the process may use
  std::string isa = "auto"; // instruction set of the ray kernels (instruction_sets.h)
  std::string file;         // the recording to write
  const ShaderRegistry* shaders = nullptr;
  RTlogCallback log = nullptr;
  void* logUser = nullptr;
  bool diagnose = false; // detect misuse while rendering; costs time
  // false: paths find emitting shapes and the sky by hitting them alone
  bool lightSamples = true;
};

struct ClusterOptions {
  std::vector<std::string> workers; // workers to connect to: HOST[:PORT][=PUBLICKEY] or @FILE
  std::string listen;               // ADDRESS[:PORT]; empty: accepts no connections
  std::string keyFile, allowFile;
  std::optional<uint32_t> local; // render threads of this process; none: BackendOptions.threads
  std::string split = "auto";    // how work is divided: auto, tiles, samples, frames
  uint32_t require = 0;          // a frame fails with fewer workers
  bool tolerant = false;         // also accepts workers with other instruction sets and versions
};

// Thrown if workers are missing, or an address or a key is unusable. The message is for the user.
class ClusterError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Thrown if this machine cannot do what an option asks for. The message is for the user.
class OptionError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Backend {
 public:
  virtual ~Backend() = default;
  // Returns true if apply() and start() may be called while frames are in flight. Frames then
  // finish in the order of their start.
  virtual bool pipelines() const { return false; }
  // Applies the edits of a commit; they take effect with the next start(). If !pipelines(), never
  // called while a frame is in flight.
  virtual void apply(std::shared_ptr<const Commit> commit) = 0;
  // Says for how many seconds start() waits while structures are built for the scene; 0: until they
  // are. After that the frame shows an earlier scene (RT_PATIENCE). A backend may always wait.
  virtual void setPatience(double) {}
  // Says whether the sums of the frames that are started from now on are kept, and with what the
  // next one begins. start() then throws std::runtime_error if it cannot begin with that. Returns
  // false if this backend keeps no sums.
  virtual bool keepSums(const SumsRequest& request) { return !request.keep; }
  // Returns the sums of the (oldest) frame in flight, or else of the finished one. Null if they are
  // not kept. [any thread]
  virtual std::shared_ptr<FrameSums> sums() const { return nullptr; }
  // Starts rendering a frame of the committed scene and returns at once.
  virtual void start() = 0;
  // Waits for the (oldest) frame in flight. After it, read() reads that frame.
  virtual void wait() = 0;
  // Cancels all frames in flight. [any thread]
  virtual void cancel() = 0;
  // Returns the finished fraction, 0..1, of the (oldest) frame in flight. [any thread]
  virtual float progress() const = 0;
  // Copies the finished tiles of one channel of the (oldest) frame in flight. Returns false if
  // there is no such channel or frame. [any thread]
  virtual bool snapshot(RTenum, std::span<float>) const { return false; }
  // Copies one channel of the finished frame, first row at the top. Returns false if there is no
  // such channel or frame.
  virtual bool read(RTenum channel, std::span<float> out) const = 0;
  virtual void stats(RTstats& stats) const = 0;
  // Returns the workers of a cluster. [any thread]
  virtual std::vector<RTworker> workers() const { return {}; }
  // Returns the queries of the committed scene. Null: this backend has no surfaces, so that they
  // find nothing.
  virtual Queries* queries() { return nullptr; }
  // Completes the file that the backend writes, if any; throws if it is incomplete. Afterwards only
  // the destructor may be called.
  virtual void finish() {}
};

// These throw std::runtime_error with a message for the user if the backend cannot start; those
// that render throw OptionError if the machine lacks the instruction set.
std::unique_ptr<Backend> makeLocalBackend(const BackendOptions& options);
std::unique_ptr<Backend> makeRecordBackend(const BackendOptions& options);
std::unique_ptr<Backend> makeNullBackend(const BackendOptions& options);
// Also throws ClusterError.
std::unique_ptr<Backend> makeClusterBackend(const BackendOptions& options,
                                            const ClusterOptions& cluster);
// Forwards every call to the backend that renders, and explains misuse to options.log.
std::unique_ptr<Backend> makeDebugBackend(const BackendOptions& options,
                                          std::unique_ptr<Backend> renderer);
// Writes the recording options.file and forwards every call to the backend that renders.
std::unique_ptr<Backend> makeTeeBackend(const BackendOptions& options,
                                        std::unique_ptr<Backend> renderer);

} // namespace openrt
