// null.cpp: the backend that renders nothing. It counts the contents of commits, and its pictures
// are zeros. It is used to measure the cost of the API alone. Application thread; cancel and
// progress from any.
#include <algorithm>
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
    stats.scene.uniqueTriangles = 0;
    for (const auto& [id, count] : triangles_) stats.scene.uniqueTriangles += count;
    stats.machine.threads = 0;
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
};

} // namespace

std::unique_ptr<Backend> makeNullBackend(const BackendOptions&) {
  return std::make_unique<NullBackend>();
}

} // namespace openrt
