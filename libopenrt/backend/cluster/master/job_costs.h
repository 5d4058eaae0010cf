// job_costs.h: the cost of a frame's jobs: mean and median seconds of one thread per pixel sample
// (light jobs: per path). A frame without results of its own uses the costs of the frame before.
// Used by the scheduler. [any, one at a time]
#pragma once

#include <array>
#include <cstdint>

namespace openrt::cluster {

class JobCosts {
 public:
  JobCosts ofNextFrame() const;
  void add(double units, double seconds);
  bool known() const { return mean() > 0; }
  double mean() const {
    return units_ + priorUnits_ > 0 ? (seconds_ + priorSeconds_) / (units_ + priorUnits_) : 0;
  }
  // Median of the jobs' mean costs; 0 if unknown.
  double median() const { return median_; }
  // The cost that one job in fifty reaches or exceeds.
  double expensive() const { return expensive_; }
  double seconds() const { return seconds_; }
  uint32_t jobs() const { return jobs_; }

 private:
  static constexpr int perOctave = 8, octaves = 52, lowest = -44; // the shortest time is 2^-44 s
  double quantile(double share) const;
  double seconds_ = 0, units_ = 0, priorSeconds_ = 0, priorUnits_ = 0, median_ = 0, expensive_ = 0;
  // next_: number of jobs at which the quantiles are computed again.
  uint32_t jobs_ = 0, next_ = 1;
  std::array<uint32_t, perOctave * octaves> counts_{};
};

} // namespace openrt::cluster
