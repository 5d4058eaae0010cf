// snapshots.h: makes the snapshots of the committed scene that frames render and queries read: it
// applies commits and builds what they changed. Owned by the local backend. [application thread,
// between frames]
//
// With a patience (RT_PATIENCE) structures are built beside the frames. Until they are built, the
// scene rests, commits wait, and frames show a stand-in: the last snapshot in the view of the
// newest commit (docs/decisions/0116-building-beside-frames.md).
#pragma once

#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "backend/backend.h"
#include "backend/local/accel/accel_build.h"
#include "backend/local/frame_view.h"
#include "backend/local/local_queries.h"
#include "scene/history.h"

namespace openrt {

class Snapshots {
 public:
  // queries: is told when the geometry changes.
  Snapshots(const BackendOptions& options, std::shared_ptr<EmbreeDevice> device,
            LocalQueries& queries);
  void apply(std::shared_ptr<const Commit> commit);
  // 0: as long as it takes.
  void setPatience(double seconds) { patience_ = seconds; }
  // Makes a new snapshot of all commits if anything changed since the last. It has what ray queries
  // need: geometry, shaders, camera.
  void prepare();
  // Does the same, or shows an earlier scene in the newest view if that takes longer than the
  // patience.
  void prepareInTime();
  const std::shared_ptr<RenderScene>& current() const { return snapshot_; }
  PreparedGeometry geometry() const {
    return {scene_, flat_, builder_.survey, *accel_, *snapshot_};
  }
  // Notes that a frame renders the snapshot.
  void noteFrame() { isShown_ = true; }
  // Returns whether commits are missing from the snapshot.
  bool isBehind() const { return pending_ || !waiting_.empty(); }
  // Tell whether every record is in the same place as at the last noteRecords().
  void noteRecords() { recordsRest_ = true; }
  bool recordsRest() const { return recordsRest_; }
  // Writes the statistics of the scene that the snapshot shows, and the times of the last commit.
  void describe(RTstats& stats) const;

 private:
  // A snapshot whose structures are not there yet, and what they are to be.
  struct Preparation {
    std::shared_ptr<RenderScene> next;
    bool laysOut = false;        // anything may have moved; false: only `moved`
    std::vector<uint32_t> moved; // clusters that moved since the last snapshot
    Vec3d origin;
    double scale = 1, reach = 0;
    PixelFootprint footprint;
    bool besideFrames = false;
    double begin = 0; // time of the steady clock
  };
  void applyNow(const Commit& commit);
  void applyWaiting();
  // Makes a new snapshot if anything changed. Returns false if its structures are still being built
  // after so many seconds.
  bool makeSnapshot(double patience);
  void makeShaders(RenderScene& next) const;
  void plan(Preparation& made);
  Vec3d eye() const;
  bool isQuick(const Preparation& made, double patience);
  BuildInput inputOf(const Preparation& made);
  std::shared_ptr<Accel> build(const Preparation& made);
  void update(Preparation made);
  // Makes the snapshot. accel: its structures; null: those of before have been updated.
  void complete(Preparation& made, std::shared_ptr<Accel> accel);
  void updateMotions(RenderScene& next, std::vector<uint32_t> moved, bool all);
  // Runs `work`. If it throws, the structures are incomplete, and are built anew by the next call.
  template <class Work> bool orRebuild(const Work& work);
  bool mayStandIn(const FrameView& view) const;
  bool buildBeside(Preparation made, double patience);
  bool isBuilt(double patience) const;
  void completeBuild();
  void standIn();
  void describeScene(RTstats& stats) const;

  const BackendOptions options_;
  std::shared_ptr<EmbreeDevice> device_;
  LocalQueries& queries_;
  AccelBuilder builder_;
  Scene scene_;
  SceneHistory history_;       // what has changed since the last frame of each view
  SceneChanges changes_;       // since the last snapshot
  uint64_t snapshotFrame_ = 0; // number of the history at the last snapshot
  std::shared_ptr<RenderScene> snapshot_;
  std::shared_ptr<Accel> accel_;
  Flattened flat_;
  PixelFootprint footprint_;
  LightSlots lightSlots_;                          // those of the snapshot
  uint32_t cameraShader_ = 0;                      // that of the snapshot
  bool scopedLights_ = false, recordsRest_ = true; // scopedLights_: some light has a scope
  bool freedMuch_ = false; // a commit of many things, since the last snapshot
  bool isShown_ = false;   // a frame has had the structures of the snapshot
  bool isIntact_ = false;  // all that records of the snapshot point into is there
  double patience_ = 0, commitSeconds_ = 0, buildSeconds_ = 0;
  std::vector<FormerGeometries> former_; // what records of the snapshot may still point into

  // While structures are built: the snapshot that they are for, the view of the newest commit, the
  // commits that wait, and the statistics of the snapshot of before. The thread that builds reads
  // the scene and what is made of it; nothing changes these meanwhile.
  std::optional<Preparation> pending_;
  std::optional<FrameView> view_;
  std::deque<std::shared_ptr<const Commit>> waiting_;
  size_t waitingBytes_ = 0;
  RTstats describedScene_{};
  std::future<std::shared_ptr<Accel>> built_; // the last member: its destructor waits
};

} // namespace openrt
