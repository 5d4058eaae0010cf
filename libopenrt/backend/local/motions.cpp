#include "backend/local/motions.h"

#include <unordered_map>

namespace openrt {
namespace {

// Where something was in the frame before.
struct Past {
  Matrix4d matrix;   // to the part, or of a cluster to the world
  bool there = true; // it existed and was visible
};

class MotionMaker {
 public:
  explicit MotionMaker(const MotionInput& input) : in_(input) {}

  std::shared_ptr<const Motions> make(const std::vector<uint32_t>* clusters) {
    if (in_.history.beginning()) {
      motions_->allNew = true;
      return motions_;
    }
    if (clusters) {
      for (const uint32_t c : *clusters) visit(c);
    } else {
      findChangedSteps();
      findChangedParts();
      for (uint32_t c = 0; c < in_.flat.clusters.size(); c++) visit(c);
    }
    return motions_->kind.empty() ? nullptr : motions_;
  }

 private:
  // Finds the static instances that have changed, and what is placed by way of them. Only a pass
  // over everything needs them: if static instances have changed, the scene was laid out anew.
  void findChangedSteps() {
    const std::vector<PathStep>& paths = in_.flat.paths;
    for (uint32_t s = 1; s < paths.size(); s++) {
      const auto above = steps_.find(paths[s].above);
      const bool changed = in_.history.changed(paths[s].instance);
      if (above == steps_.end() && !changed) continue;
      Past past = pastOfStep(paths[s].above);
      enter(past, paths[s].instance);
      steps_.emplace(s, past);
    }
  }

  // Returns where a step led in the frame before. Steps at rest are kept, too, so that many changes
  // below the same ones do not walk up from each.
  Past pastOfStep(uint32_t step) {
    if (const auto found = steps_.find(step); found != steps_.end()) return found->second;
    std::vector<uint32_t> way; // up to a known step or the part's root
    uint32_t known = step;
    for (; known != 0 && !resting_.contains(known); known = in_.flat.paths[known].above)
      way.push_back(known);
    Matrix4d matrix = known == 0 ? Matrix4d() : resting_.at(known);
    for (size_t i = way.size(); i-- > 0;) {
      matrix = matrix * in_.scene.instances.at(in_.flat.paths[way[i]].instance).matrix;
      resting_.emplace(way[i], matrix);
    }
    return {matrix};
  }

  // Goes on from the frame of an instance to that of its object, as it was in the frame before.
  void enter(Past& past, uint32_t instance) const {
    const Instance& now = in_.scene.instances.at(instance);
    const Instance* then = in_.history.changed(instance) ? in_.history.before(instance) : &now;
    past.there = past.there && then && then->visible;
    if (past.there) past.matrix = past.matrix * then->matrix;
  }

  // Finds the parts in which an item has changed its place or its object was defined again.
  void findChangedParts() {
    changedParts_.assign(in_.flat.parts.size(), false);
    if (steps_.empty() && !in_.history.redefinedAny()) return;
    for (size_t p = 0; p < in_.flat.parts.size(); p++) {
      const ScenePart& part = in_.flat.parts[p];
      for (size_t i = 0; i < part.items.size() && !changedParts_[p]; i++)
        changedParts_[p] =
            steps_.contains(part.itemPaths[i]) || in_.history.redefined(part.items[i].object);
    }
  }

  // Records how a cluster's geometries have moved. Parents are visited before their children.
  void visit(uint32_t c) {
    const Cluster& cluster = in_.flat.clusters[c];
    const bool moved = c != 0 && placeChanged(c);
    if (!cluster.visible || !(moved || changedParts_.empty() || changedParts_[cluster.part]))
      return;
    const Past world = moved ? clusters_.at(c) : Past{cluster.world};
    const ScenePart& part = in_.flat.parts[cluster.part];
    const PartInfo& info = in_.survey.parts()[cluster.part];
    const uint32_t first = in_.accel.firstRecord(c);
    for (uint32_t i = 0; i < part.items.size(); i++) {
      const Item& item = part.items[i];
      const bool redefined = in_.history.redefined(item.object);
      const auto step = steps_.find(part.itemPaths[i]);
      if (!moved && !redefined && step == steps_.end()) continue;
      Past past = step == steps_.end() ? Past{item.matrix} : step->second;
      past.matrix = world.matrix * past.matrix;
      past.there = past.there && world.there;
      const auto& geometries = in_.scene.objects.at(item.object).geometries;
      for (uint32_t k = 0; k < geometries.size(); k++) {
        const Geometry* before = redefined ? in_.history.before(item.object, k) : &geometries[k];
        record(first + info.firstEntry[i] + k, cluster.world * item.matrix, geometries[k], past,
               before);
      }
    }
  }

  // Returns whether a cluster may have moved, and notes where it was.
  bool placeChanged(uint32_t c) {
    const Cluster& cluster = in_.flat.clusters[c];
    const ScenePart& part = in_.flat.parts[in_.flat.clusters[cluster.parent].part];
    const Socket& socket = part.sockets[cluster.socket];
    const auto parent = clusters_.find(cluster.parent);
    const auto step = steps_.find(part.socketPaths[cluster.socket]);
    if (parent == clusters_.end() && step == steps_.end() && !in_.history.changed(socket.instance))
      return false;
    Past past =
        parent == clusters_.end() ? Past{in_.flat.clusters[cluster.parent].world} : parent->second;
    past.matrix = past.matrix * (step == steps_.end() ? socket.above : step->second.matrix);
    past.there = past.there && (step == steps_.end() || step->second.there);
    enter(past, socket.instance);
    clusters_.emplace(c, past);
    return true;
  }

  // before: the geometry in the frame before; null if there was none.
  void record(uint32_t number, const Matrix4d& item, const Geometry& geometry, const Past& past,
              const Geometry* before) {
    const bool there = past.there && before;
    Motion motion{item * geometry.matrix, {}, geometry.points, nullptr, geometry.width,
                  geometry.width};
    if (there) {
      motion.before = past.matrix * before->matrix;
      motion.radiusBefore = before->width;
      if (before->points != geometry.points) motion.pointsBefore = before->points;
      const bool sphere = geometry.primitive == edit::Primitive::Sphere;
      if (motion.before == motion.now && !motion.pointsBefore &&
          (!sphere || motion.radiusBefore == motion.radius))
        return;
    }
    if (motions_->kind.empty()) motions_->kind.assign(in_.accel.records.size(), Motions::resting);
    motions_->kind[number] =
        there ? Motions::firstMoved + uint32_t(motions_->moved.size()) : Motions::isNew;
    if (there) motions_->moved.push_back(std::move(motion));
  }

  const MotionInput& in_;
  const std::shared_ptr<Motions> motions_ = std::make_shared<Motions>();
  std::unordered_map<uint32_t, Past> steps_;       // changed ones, by index in Flattened::paths
  std::unordered_map<uint32_t, Matrix4d> resting_; // some of the others
  std::unordered_map<uint32_t, Past> clusters_;    // those whose place has changed
  std::vector<bool> changedParts_;                 // empty: any part may have changed
};

} // namespace

std::shared_ptr<const Motions> makeMotions(const MotionInput& input,
                                           const std::vector<uint32_t>* clusters) {
  return MotionMaker(input).make(clusters);
}

} // namespace openrt
