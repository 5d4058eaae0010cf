// job_costs.cpp: estimates the costs of jobs. The median comes from a histogram of logarithms with
// eight bins per octave. It is exact to 5 %, far less than jobs differ by, and its size is
// constant.
#include "backend/cluster/master/job_costs.h"

#include <algorithm>
#include <cmath>

namespace openrt::cluster {

namespace {
// This many jobs of the current frame weigh as much as all jobs of the frame before.
constexpr double priorJobs = 8;
} // namespace

JobCosts JobCosts::ofNextFrame() const {
  JobCosts next;
  next.median_ = median_;
  next.expensive_ = expensive_;
  if (jobs_ == 0) {
    next.priorSeconds_ = priorSeconds_;
    next.priorUnits_ = priorUnits_;
  } else {
    const double share = std::min(1.0, priorJobs / jobs_);
    next.priorSeconds_ = seconds_ * share;
    next.priorUnits_ = units_ * share;
  }
  return next;
}

void JobCosts::add(double units, double seconds) {
  if (!(units > 0) || !(seconds >= 0) || !std::isfinite(seconds)) return;
  seconds_ += seconds;
  units_ += units;
  jobs_++;
  const double bin = (std::log2(std::max(seconds / units, 0x1p-43)) - lowest) * perOctave;
  counts_[size_t(std::clamp(bin, 0.0, double(counts_.size() - 1)))]++;
  if (jobs_ < next_) return;
  next_ = jobs_ + std::max(jobs_ / 16, 1u);
  // A few jobs of this frame tell less than all jobs of the last one.
  if (median_ == 0 || jobs_ >= priorJobs) median_ = quantile(0.5);
  // Expensive tiles may come late in a frame.
  if (expensive_ == 0 || jobs_ >= 50 * priorJobs) expensive_ = quantile(0.98);
}

double JobCosts::quantile(double share) const {
  double below = 0;
  size_t bin = 0;
  while (bin + 1 < counts_.size() && below + counts_[bin] < share * jobs_) below += counts_[bin++];
  return std::exp2((double(bin) + 0.5) / perOctave + lowest);
}

} // namespace openrt::cluster
