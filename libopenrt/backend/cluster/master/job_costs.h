// job_costs.h: what jobs of a frame cost: seconds of one thread for a pixel's sample (of light: for
// a path), their mean and median. Until a frame knows better, that of the frame before counts. Of
// the scheduler. [any, one at a time]
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
  double median() const { return median_; } // of the jobs' means; 0: nothing is known
  double dear() const { return dear_; }     // what one in fifty jobs costs at least
  double seconds() const { return seconds_; }
  uint32_t jobs() const { return jobs_; }

 private:
  static constexpr int perOctave = 8, octaves = 52, lowest = -44; // from 2^-44 s
  double quantile(double share) const;
  double seconds_ = 0, units_ = 0, priorSeconds_ = 0, priorUnits_ = 0, median_ = 0, dear_ = 0;
  uint32_t jobs_ = 0, next_ = 1; // jobs with which these are looked for anew
  std::array<uint32_t, perOctave * octaves> counts_{};
};

} // namespace openrt::cluster
