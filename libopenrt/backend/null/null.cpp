// null.cpp: the backend that renders nothing. It counts the contents of commits, and its pictures
// are zeros. It is used to measure the cost of the API alone. Application thread; cancel and
// progress from any.
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "backend/backend.h"

namespace openrt {
namespace {

class NullBackend final : public Backend {
 public:
  void apply(std::shared_ptr<const Commit> commit) override {
    for (const auto& [id, array] : commit->arrays) elements_[id] = array->size() / sizeof(uint32_t);
    for (const auto& entry : commit->edits.edits) {
      if (!entry) continue;
      if (const auto* object = entry->any.AsObject()) triangles_[object->id] = triangles(*object);
      if (const auto* deleted = entry->any.AsDeleteObject()) triangles_.erase(deleted->id);
      if (const auto* frame = entry->any.AsFrameSettings()) channels_ = frame->channels;
      if (const auto* camera = entry->any.AsCamera()) camera_ = camera->shader != 0;
    }
    elements_.clear();
  }
  void start() override {}
  void wait() override {}
  void cancel() override {}
  float progress() const override { return 1; }

  bool read(RTenum channel, std::span<float> out) const override {
    if (!(channels_ & channel)) return false;
    std::fill(out.begin(), out.end(), 0.0f);
    return true;
  }

  void stats(RTstats& stats) const override {
    stats.uniqueTriangles = 0;
    for (const auto& [id, count] : triangles_) stats.uniqueTriangles += count;
    stats.threads = 0;
  }

  void castRays(std::span<const RTray>, std::span<RThit> hits) override {
    RThit nothing{};
    nothing.t = std::numeric_limits<float>::infinity();
    std::fill(hits.begin(), hits.end(), nothing);
  }
  void occludedRays(std::span<const RTray>, std::span<uint8_t> occluded) override {
    std::fill(occluded.begin(), occluded.end(), uint8_t(0));
  }

  bool pick(double, double, RThit& hit) override {
    hit = {};
    hit.t = std::numeric_limits<float>::infinity();
    return camera_ && channels_ != 0;
  }

 private:
  uint64_t triangles(const edit::ObjectT& object) const {
    uint64_t count = 0;
    for (const auto& g : object.geometries) {
      if (!g || g->primitive != edit::Primitive::Triangles) continue;
      const auto found = elements_.find(g->indices);
      if (found != elements_.end()) count += found->second / 3;
    }
    return count;
  }

  // Number of 32-bit elements of the arrays in the current commit.
  std::unordered_map<ArrayId, uint64_t> elements_;
  std::unordered_map<uint32_t, uint64_t> triangles_;
  uint32_t channels_ = 0;
  bool camera_ = false;
};

} // namespace

std::unique_ptr<Backend> makeNullBackend(const BackendOptions&) {
  return std::make_unique<NullBackend>();
}

} // namespace openrt
