// frame_work.h: the work of one frame: hands out jobs in an order that shows a picture early, takes
// their results in any order, and merges them in a fixed order, so the picture has the same bytes
// whoever did which job. It knows nothing of threads, machines and time (except for frames with a
// time limit). All functions [any].
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "render/film/film.h"
#include "render/frame/job.h"
#include "render/wave/tiles.h"
#include "scene/scene.h"

namespace openrt {

// Properties of the scene that the work depends on besides the frame's settings. They are the same
// wherever the scene is prepared.
struct FrameFacts {
  bool camera = false; // the scene has a camera
  bool lamps = false;  // light tracing is needed
  // Tells how many photons guide the paths, which depends on the number of samples. 0: none do.
  uint64_t guide = 0;
  // The bits of `guide` that say where light paths by way of glossy surfaces take a part of the
  // light: connected to the camera, and to surfaces of camera paths.
  static constexpr uint64_t glossyPaths = uint64_t(1) << 62, connectedPaths = uint64_t(1) << 61;
  // The bit of it that says that camera paths share the light of mirrors and glass.
  static constexpr uint64_t sharedMirrors = uint64_t(1) << 60;
  // Its factor for the number of light paths that go with a camera path, beyond the first.
  static constexpr uint64_t moreLightPaths = uint64_t(1) << 56;
  static constexpr uint64_t unknownGuide = ~uint64_t(0);
};

struct FrameSums;

// Holds what the samples of a frame depend on besides its settings.
struct SumsIdentity {
  uint64_t world = 0, view = 0;     // digests (scene/scene_digest.h)
  std::string version, isa, kernel; // the library's version; the ray kernels' name
  bool operator==(const SumsIdentity&) const = default;
};

inline std::string versionText() {
  return std::to_string(OPENRT_VERSION_MAJOR) + "." + std::to_string(OPENRT_VERSION_MINOR) + "." +
         std::to_string(OPENRT_VERSION_PATCH);
}

// Asks for the sums of a frame to be kept beside its picture.
struct KeepSums {
  bool keep = false;
  SumsIdentity identity;
  std::shared_ptr<const FrameSums> from; // the sums to continue from; null: none
};

class FrameWork {
 public:
  // settings: with the transport that was chosen. threadCount: approximate number of threads that
  // work on the frame; it has no influence on the picture.
  // Throws SumsError if the frame cannot be kept, or cannot continue from the sums.
  FrameWork(const edit::FrameSettingsT& settings, const FrameFacts& facts, uint32_t threadCount,
            const KeepSums& kept = {});
  // Makes the picture of condensed sums; there are no jobs. Throws SumsError.
  explicit FrameWork(const FrameSums& sums);
  ~FrameWork();

  enum class Next : uint8_t {
    job,
    wait, // nothing can be handed out until outstanding jobs are done
    over
  };
  // Hands out the next job. largest: preferred maximum of samples per pixel; the samples of a tile
  // are then handed out in aligned blocks of powers of two, at least 32.
  Next next(Job& job, uint32_t largest = ~0u);
  // Sets the order in which tiles are handed out: the numbers of all tiles. Call before the first
  // job. A frame that shows early results keeps its own order.
  void order(std::vector<uint32_t> tiles);
  uint32_t upcoming() const; // Returns the tile that next() will hand out; tiles() if that is open.
  // Takes back a job that was not done; it is handed out again before others.
  void giveBack(const Job& job);
  // Takes the result of a job that was handed out. Returns true the first time; repeated results
  // are dropped.
  bool take(const Job& job, JobResult&& result);
  // Stops handing out jobs and drops outstanding ones; the picture keeps what is finished.
  void cancel();
  bool over() const; // whether all results were taken, or the frame was cancelled
  // Sets a callback for threads that got `wait` and should call next() again. It is called from the
  // thread that hands out or takes a job, once for all waiting threads.
  void onChange(std::function<void()> changed);

  uint32_t tiles() const; // number of tiles of the picture
  double undone() const;  // approximate amount of work not handed out: pixels times samples
  Tile tile(uint32_t number) const;
  float progress() const;
  bool snapshot(uint32_t channel, std::span<float> out) const;
  const Film& film() const; // valid once over() is true
  // Returns the results so far of a frame whose sums are kept; null for another one.
  std::shared_ptr<FrameSums> sums() const;
  RayCounters counters() const;
  // Writes what is known about the picture: its rays, its error and the light that it leaves out.
  // Valid once over() is true.
  void describe(RTstats& stats) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt
