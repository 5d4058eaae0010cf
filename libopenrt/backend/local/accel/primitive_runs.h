// primitive_runs.h: maps the primitives of an Embree geometry to the scene's geometries. A merged
// geometry holds the primitives of many small ones, in runs of consecutive numbers. Filled when an
// Embree geometry is made; then immutable. [any thread]
#pragma once

#include <cstdint>
#include <vector>

namespace openrt {

struct PrimitiveId {
  uint32_t record, primitive;
};

class PrimitiveRuns {
 public:
  // Appends the primitives `first` to `first + count - 1` of a record.
  void add(uint32_t record, uint32_t first, uint32_t count = 1) {
    if (count == 0) return;
    if (!continues(record, first)) runs_.push_back({end_, record, first});
    end_ += count;
    while (uint64_t(runOfBlock_.size()) * blockSize < end_)
      runOfBlock_.push_back(uint32_t(runs_.size() - 1));
  }
  // Returns what the primitive with this number is. It must have been added.
  PrimitiveId find(uint32_t number) const {
    if (runs_.size() == 1) return {runs_[0].record, runs_[0].first + number}; // a whole geometry
    const Run* run = runs_.data() + runOfBlock_[number / blockSize];
    const Run* const last = runs_.data() + runs_.size() - 1;
    while (run != last && run[1].begin <= number) ++run;
    return {run->record, run->first + (number - run->begin)};
  }

 private:
  static constexpr uint32_t blockSize = 16;
  struct Run {
    uint32_t begin;         // number of its first primitive in the Embree geometry
    uint32_t record, first; // first: the number of that primitive in its own geometry
  };
  bool continues(uint32_t record, uint32_t first) const {
    if (runs_.empty()) return false;
    const Run& run = runs_.back();
    return run.record == record && run.first + (end_ - run.begin) == first;
  }

  std::vector<Run> runs_;
  std::vector<uint32_t> runOfBlock_; // index of the run in which each block of numbers begins
  uint32_t end_ = 0;                 // number of primitives
};

} // namespace openrt
