// snapshots.cpp: The cost of a change:
//   parameters, textures, lights, camera    a new snapshot with the same acceleration structure
//   moved dynamic instances, redefined      the acceleration structure is updated in place
//   dynamic objects
//   anything else                           it is rebuilt, reusing the parts that did not change
#include "backend/local/snapshots.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "backend/local/motions.h"
#include "steady_clock.h"
#include "system/memory.h"

namespace openrt {
namespace {

// The edits of so many things, which are freed when they have been applied, take more memory than
// the structures that are made next.
constexpr size_t manyThings = 100'000;

// Returns the number of edits and geometries of a commit.
size_t countThings(const Commit& commit) {
  size_t things = commit.edits.edits.size();
  for (const auto& edit : commit.edits.edits)
    if (const edit::ObjectT* object = edit ? edit->any.AsObject() : nullptr)
      things += object->geometries.size();
  return things;
}

// Commits that wait for structures take no more memory than this, and one commit more.
constexpr size_t mostWaiting = size_t(128) << 20;

// Returns about how many bytes a commit takes.
size_t bytesOf(const Commit& commit) {
  constexpr size_t thing = 256;
  size_t bytes = thing * (1 + countThings(commit));
  for (const auto& [id, array] : commit.arrays) bytes += array ? array->size() : 0;
  return bytes;
}

// So many triangles are built within about 20 ms on two processors.
constexpr uint64_t fewTriangles = 30'000;

constexpr double forever = std::numeric_limits<double>::infinity();

} // namespace

Snapshots::Snapshots(const BackendOptions& options, std::shared_ptr<EmbreeDevice> device,
                     LocalQueries& queries)
    : options_(options), device_(std::move(device)), queries_(queries), builder_(device_) {}

void Snapshots::apply(std::shared_ptr<const Commit> commit) {
  if (!pending_ && waiting_.empty()) return applyNow(*commit);
  view_->note(*commit);
  waitingBytes_ += bytesOf(*commit);
  waiting_.push_back(std::move(commit));
}

void Snapshots::applyNow(const Commit& commit) {
  const double begin = steadySeconds();
  const bool keepsFormer = patience_ > 0;
  isIntact_ = isIntact_ && keepsFormer;
  changes_.add(scene_.apply(commit, &history_, keepsFormer ? &former_ : nullptr));
  freedMuch_ |= countThings(commit) > manyThings;
  commitSeconds_ = steadySeconds() - begin;
}

// Applies the commits that have waited. Only the frame of the last one will show them.
void Snapshots::applyWaiting() {
  while (!waiting_.empty()) {
    if (!std::exchange(isShown_, false)) history_.skipFrame();
    applyNow(*waiting_.front());
    waiting_.pop_front();
  }
  waitingBytes_ = 0;
  view_.reset();
}

Vec3d Snapshots::eye() const {
  return scene_.camera.shader && scene_.camera.matrix.usable() ? scene_.camera.matrix.translation()
                                                               : Vec3d{};
}

void Snapshots::prepare() {
  if (pending_) completeBuild();
  applyWaiting();
  makeSnapshot(forever);
}

// Once structures are built, the first frame shows them in the newest view, and the commits that
// have waited follow with the next one. So the motion since the frame before is that of the commit
// that they were built for.
void Snapshots::prepareInTime() {
  if (patience_ <= 0) return prepare();
  if (!pending_) {
    applyWaiting();
    if (!makeSnapshot(patience_)) standIn();
    return;
  }
  if (!mayStandIn(*view_) || waitingBytes_ > mostWaiting) return prepare();
  if (isBuilt(patience_)) completeBuild();
  if (pending_ || !waiting_.empty()) standIn();
}

template <class Work> bool Snapshots::orRebuild(const Work& work) {
  try {
    return work();
  } catch (...) {
    pending_.reset(); // no thread builds for it any more, or none could be started
    queries_.clear();
    accel_ = nullptr;
    throw;
  }
}

bool Snapshots::makeSnapshot(double patience) {
  // A thing that moved in the last snapshot may rest in this one, and in another view other things
  // moved.
  const bool motionsDiffer =
      snapshot_ && snapshotFrame_ != history_.number() && (snapshot_->motions || history_.any());
  if (snapshot_ && accel_ && !changes_.any() && !motionsDiffer) return true;
  if (std::exchange(freedMuch_, false)) os::giveBackMemory();
  if (patience < forever) describeScene(describedScene_);
  Preparation made;
  made.begin = steadySeconds();
  made.next = std::make_shared<RenderScene>();
  made.next->frame = scene_.frame;
  makeShaders(*made.next);
  return orRebuild([&] {
    plan(made);
    queries_.outdate();
    if (isQuick(made, patience))
      update(std::move(made));
    else if (patience < forever && mayStandIn(FrameView(scene_)))
      return buildBeside(std::move(made), patience);
    else
      complete(made, build(made));
    return true;
  });
}

// Finds out what the structures of a snapshot are to be, and places its camera.
void Snapshots::plan(Preparation& made) {
  const SceneChanges& c = changes_;
  RenderScene& next = *made.next;
  bool scoped = false;
  for (const auto& [id, light] : scene_.lights) scoped |= light.scope != 0;
  made.laysOut =
      !accel_ || c.structure || (c.lights && (scoped || scopedLights_)) ||
      (next.shaders != snapshot_->shaders && !next.shaders->extends(*snapshot_->shaders)) ||
      !builder_.survey.resurvey(scene_, flat_, c.redefined);
  if (made.laysOut) {
    flat_ = flatten(scene_, history_.watches());
    builder_.survey.take(scene_, flat_);
    if (flat_.truncated && options_.log)
      options_.log(3,
                   ("too many placed objects: only the first " + std::to_string(maxPlacements) +
                    " are drawn, or " + std::to_string(maxClusters) + " that move")
                       .c_str(),
                   options_.logUser);
  } else {
    if (c.lights) { // no light is or was scoped, so there is a single light set
      flat_.lightSets.clear();
      flat_.setNumbers.clear();
      flat_.lightSet(unscopedLights(scene_));
    }
    made.moved = updateClusters(scene_, flat_, c.moved);
    builder_.survey.place(flat_, made.moved);
  }
  scopedLights_ = scoped;
  made.origin = builder_.survey.origin(eye());
  store(made.origin, next.origin);
  if (scene_.transport) next.transport = next.shaders->role(scene_.transport, RTS_TRANSPORT);
  placeCamera(scene_.camera, next);
  placeEnvironment(scene_.environment, next);
  made.footprint = footprintOf(next);
  made.scale = builder_.survey.scale(made.origin);
  made.reach = builder_.survey.reach(made.origin) * made.scale;
}

// Returns whether the structures of before can be updated. With a patience they are not if that
// takes long, because frames cannot use them meanwhile.
bool Snapshots::isQuick(const Preparation& made, double patience) {
  if (made.laysOut || !AccelBuilder::hasFrame(*accel_, inputOf(made))) return false;
  return patience == forever ||
         builder_.trianglesToBuild(inputOf(made), made.moved, changes_.redefined) < fewTriangles;
}

BuildInput Snapshots::inputOf(const Preparation& made) {
  return {scene_,     flat_,      *made.next->shaders, made.origin,
          made.scale, made.reach, made.footprint,      made.besideFrames};
}

std::shared_ptr<Accel> Snapshots::build(const Preparation& made) {
  return builder_.build(inputOf(made));
}

void Snapshots::update(Preparation made) {
  builder_.update(*accel_, inputOf(made), made.moved, changes_.redefined,
                  made.footprint != footprint_);
  complete(made, nullptr);
}

void Snapshots::complete(Preparation& made, std::shared_ptr<Accel> accel) {
  RenderScene& next = *made.next;
  recordsRest_ = recordsRest_ && !accel && made.moved.empty() && changes_.redefined.empty();
  if (accel) accel_ = std::move(accel);
  footprint_ = made.footprint;
  updateMotions(next, std::move(made.moved), made.laysOut);
  lightSlots_ = placeLights(scene_.lights, flat_, next);
  next.kernel = accel_;
  next.records = accel_->records;
  next.buckets = accel_->buckets;
  next.transparentShadows = accel_->hasTransparent;
  snapshot_ = std::move(made.next);
  cameraShader_ = scene_.camera.shader;
  snapshotFrame_ = history_.number();
  changes_ = {};
  former_.clear();
  isShown_ = false;
  isIntact_ = true;
  buildSeconds_ = steadySeconds() - made.begin;
}

// --- Building beside frames ---

// The motions of a snapshot are those since the frame before in its own view.
bool Snapshots::mayStandIn(const FrameView& view) const {
  return isIntact_ && accel_ && view.cameraShader() == cameraShader_ &&
         view.number() == snapshot_->frame.view;
}

// Builds the structures of a snapshot on a thread of its own. Returns false if they are not there
// after so many seconds. The thread reads what is made of the scene, which rests meanwhile.
bool Snapshots::buildBeside(Preparation made, double patience) {
  view_.emplace(scene_);
  made.besideFrames = true;
  pending_ = std::move(made);
  try {
    built_ = std::async(std::launch::async, [this] { return build(*pending_); });
  } catch (const std::system_error&) { // threads are short
    built_ = std::async(std::launch::deferred, [this] { return build(*pending_); });
    built_.wait();
  }
  if (!isBuilt(patience)) return false;
  completeBuild();
  return true;
}

bool Snapshots::isBuilt(double patience) const {
  return built_.wait_for(std::chrono::duration<double>(patience)) == std::future_status::ready;
}

// Waits for the structures that are being built, and makes the snapshot that they are for.
void Snapshots::completeBuild() {
  orRebuild([&] {
    std::shared_ptr<Accel> accel = built_.get();
    Preparation made = std::move(*pending_);
    pending_.reset();
    complete(made, std::move(accel));
    return true;
  });
}

// Makes a snapshot of the last one in the view of the newest commit.
void Snapshots::standIn() {
  std::shared_ptr<RenderScene> next = view_->show(*snapshot_, lightSlots_);
  if (isShown_) next->motions = nullptr; // the frame before showed the same
  snapshot_ = std::move(next);
}

// Finds out what has moved since the frame before in the same view, for RT_MOTION.
//   moved  clusters that moved since the last prepare()
//   all    anything may have moved
void Snapshots::updateMotions(RenderScene& next, std::vector<uint32_t> moved, bool all) {
  if (!history_.watches()) return dropPaths(flat_);
  if (!history_.any()) return;
  if (flat_.paths.empty() && !history_.view().beginning()) addPaths(scene_, flat_);
  // A prepare() after the frame before, also of another view, has already taken note of
  // changes.
  all |= snapshot_ && snapshotFrame_ > history_.numberBefore();
  for (const uint32_t object : changes_.redefined) {
    const uint32_t part = builder_.survey.partOf(object);
    if (part == ~0u) continue;
    const std::vector<uint32_t>& its = builder_.survey.parts()[part].clusters;
    moved.insert(moved.end(), its.begin(), its.end());
  }
  std::sort(moved.begin(), moved.end());
  moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
  next.motions = makeMotions({scene_, history_.view(), flat_, builder_.survey, *accel_},
                             all ? nullptr : &moved);
}

// Reuses the shaders and textures of the last snapshot if they did not change.
void Snapshots::makeShaders(RenderScene& next) const {
  fillHost(next.host);
  next.host.logCallback = options_.log;
  next.host.logUser = options_.logUser;
  next.host.diagnose = options_.diagnose;
  const bool kept = snapshot_ && !changes_.shaders && !changes_.textures;
  if (kept && changes_.parameters.empty()) {
    next.textures = snapshot_->textures;
    next.shaders = snapshot_->shaders;
    next.host.textures = next.textures.get();
    return;
  }
  std::map<uint32_t, uint32_t> index;
  std::vector<Texture> textures;
  textures.emplace_back(edit::TextureT(), nullptr); // number 0: no texture, samples as white
  for (const auto& [id, image] : scene_.textures) {
    const auto number = uint32_t(index.size() + 1);
    index[id] = number;
    if (!kept) textures.emplace_back(image.description, image.texels);
  }
  next.textures = kept ? snapshot_->textures
                       : std::make_shared<const std::vector<Texture>>(std::move(textures));
  next.host.textures = next.textures.get();
  next.shaders =
      kept ? std::make_shared<const ShaderTable>(*snapshot_->shaders, changes_.parameters, scene_,
                                                 index, next.host)
           : std::make_shared<const ShaderTable>(scene_, *options_.shaders, index, next.host);
}

// Writes the statistics of the scene that snapshot_ shows.
void Snapshots::describeScene(RTstats& s) const {
  if (accel_) {
    const AccelBuilder::Counts counts = builder_.count(*accel_, flat_);
    s.scene.triangles = counts.triangles;
    s.scene.uniqueTriangles = counts.uniqueTriangles;
    s.rejected.primitives = counts.degenerate;
    s.rejected.rays = accel_->rejectedRays;
    s.rejected.instances = flat_.rejected + counts.rejectedInstances;
  }
  s.bvh = {uint64_t(std::max<int64_t>(device_->bytes, 0)), builder_.objectBuilds,
           builder_.topLevelBuilds};
}

void Snapshots::describe(RTstats& s) const {
  s.time.commit = commitSeconds_;
  s.time.build = buildSeconds_;
  if (!pending_) return describeScene(s);
  s.scene = describedScene_.scene; // the builder is at work
  s.rejected = describedScene_.rejected;
  s.bvh = describedScene_.bvh;
}

} // namespace openrt
