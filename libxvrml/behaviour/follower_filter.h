// follower_filter.h: the filters of the followers (ISO/IEC 19775-1 39.2, 39.3.1, 39.3.2). A value
// is a list of elements; each element is filtered for itself. The result is a closed form of the
// events and the time, so that it does not depend on when it is asked for. [the browser's thread]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "behaviour/quaternion.h"
#include "behaviour/wide.h"

namespace xvrml {

// How elements of a type move: the difference of two, and an element moved by a difference.
template <class T> struct Motion {
  using Delta = Wide<T>;
  static Delta between(const T& from, const T& to) { return Wide<T>(to).add(Wide<T>(from), -1); }
  static T moved(const T& from, const Delta& by) { return Wide<T>(from).add(by, 1).narrow(); }
  static Delta scaled(const Delta& delta, double factor) { return Delta().add(delta, factor); }
  static Delta sum(Delta first, const Delta& second) { return first.add(second, 1); }
  static Delta inSuccession(const Delta& first, const Delta& second) { return sum(first, second); }
  static double length(const Delta& delta) { return delta.length(); }
};

// Rotations move on the shortest way. A difference is half a rotation vector, in the coordinate
// system that the first of the two has turned.
template <> struct Motion<Rotation> {
  using Delta = V3d;
  static Delta between(const Rotation& from, const Rotation& to) {
    const Quaternion q = inverse(toQuaternion(from)) * toQuaternion(to);
    return logarithm(q.w < 0 ? -q : q);
  }
  static Rotation moved(const Rotation& from, const Delta& by) {
    return toRotation(toQuaternion(from) * exponential(by), V3d(from.x, from.y, from.z));
  }
  static Delta scaled(const Delta& delta, double factor) { return delta * factor; }
  static Delta sum(const Delta& first, const Delta& second) { return first + second; }
  static Delta inSuccession(const Delta& first, const Delta& second) {
    return logarithm(exponential(first) * exponential(second));
  }
  static double length(const Delta& delta) { return 2 * delta.length(); } // in radians
};

// The finite impulse response of a chaser: each new destination adds its difference from the one
// before, times the step response R(t) = (1 - cos(pi t / duration)) / 2 (39.3.1).
template <class T> class ChaserFilter {
 public:
  using List = std::vector<T>;
  explicit ChaserFilter(double duration = 1) : duration_(duration > 0 ? duration : 0) {}

  // Continues from `value` at time now, towards the present destination.
  void setValue(const List& value, double now) {
    base_ = value;
    steps_.clear();
    addStep(value, now);
  }
  void setDestination(const List& destination, double now) {
    const List before = std::exchange(destination_, destination);
    if (before.size() != destination_.size() || base_.size() != destination_.size()) {
      base_ = destination_; // lists of different lengths have no way between them
      steps_.clear();
    } else {
      addStep(before, now);
    }
  }
  // Returns the value at time now, which must not go back. Afterwards moving() tells whether it has
  // arrived.
  List at(double now) {
    size_t done = 0;
    for (; done < steps_.size() && response(now - steps_[done].time) >= 1; ++done)
      apply(base_, steps_[done], 1);
    steps_.erase(steps_.begin(), steps_.begin() + ptrdiff_t(done));
    if (steps_.empty()) return base_ = destination_;
    List value = base_;
    for (const Step& step : steps_) apply(value, step, response(now - step.time));
    return value;
  }
  bool moving() const { return !steps_.empty(); }

 private:
  using Delta = typename Motion<T>::Delta;
  struct Step {
    double time; // the time of its event, in seconds
    std::vector<Delta> deltas;
  };
  // Memory for one node is bounded: beyond this, each two steps become one.
  static constexpr size_t maximumSteps = 128;

  double response(double seconds) const {
    if (seconds >= duration_) return 1;
    return seconds > 0 ? 0.5 - 0.5 * std::cos(std::numbers::pi * seconds / duration_) : 0;
  }

  // Adds the step from `before` to the destination.
  void addStep(const List& before, double now) {
    if (before == destination_ || before.size() != destination_.size()) return;
    if (duration_ == 0) {
      base_ = destination_;
      return;
    }
    if (steps_.size() >= maximumSteps) halve();
    Step step{now, std::vector<Delta>(before.size())};
    for (size_t i = 0; i < before.size(); ++i)
      step.deltas[i] = Motion<T>::between(before[i], destination_[i]);
    steps_.push_back(std::move(step));
  }

  // Joins each two steps that follow each other, at the time of the later one.
  void halve() {
    for (size_t i = 0; i + 1 < steps_.size(); i += 2) {
      Step joined = std::move(steps_[i + 1]);
      for (size_t k = 0; k < joined.deltas.size(); ++k)
        joined.deltas[k] = Motion<T>::inSuccession(steps_[i].deltas[k], joined.deltas[k]);
      steps_[i / 2] = std::move(joined);
    }
    steps_.resize(steps_.size() / 2);
  }

  static void apply(List& value, const Step& step, double part) {
    for (size_t i = 0; i < value.size(); ++i)
      value[i] = Motion<T>::moved(value[i], Motion<T>::scaled(step.deltas[i], part));
  }

  double duration_;
  List base_, destination_; // base_: the value without the steps
  std::vector<Step> steps_; // all of one length, in the order of their times
};

// The infinite impulse response of a damper: a chain of first-order low-pass filters x' = (input -
// x) / tau, of which the first one gets the destination (39.3.2). While that stays, the differences
// e of the filters from it are, at s = t / tau:
//   e_i(t) = exp(-s) (e_i + s e_(i-1) + s^2/2! e_(i-2) + ...)
template <class T> class DamperFilter {
 public:
  using List = std::vector<T>;
  // order: number of filters. tau: in seconds. tolerance: distance that counts as none; negative:
  // 0.0001.
  explicit DamperFilter(int order = 3, double tau = 0.3, double tolerance = -1)
      : stages_(size_t(std::clamp(order, 0, 5))) {
    setTau(tau, 0);
    setTolerance(tolerance);
  }

  // Changes the time constant from `now` on.
  void setTau(double tau, double now) {
    rebase(now);
    tau_ = tau > 0 ? tau : 0;
  }
  void setTolerance(double tolerance) { tolerance_ = tolerance >= 0 ? tolerance : 1e-4; }
  void setValue(const List& value, double now) {
    since_ = now;
    Stage error;
    if (value.size() == destination_.size())
      for (size_t i = 0; i < value.size(); ++i)
        error.push_back(Motion<T>::between(destination_[i], value[i]));
    for (Stage& stage : stages_) stage = error;
    isMoving_ = tau_ > 0 && !stages_.empty() && !error.empty() && value != destination_;
  }
  void setDestination(const List& destination, double now) {
    if (destination.size() != destination_.size()) { // no way between lists of different lengths
      destination_ = destination;
      isMoving_ = false;
      return;
    }
    if (!isMoving_) setValue(destination_, now); // all differences are 0
    rebase(now);
    for (Stage& stage : stages_)
      for (size_t i = 0; i < stage.size(); ++i)
        stage[i] = Motion<T>::between(destination[i], Motion<T>::moved(destination_[i], stage[i]));
    isMoving_ = tau_ > 0 && !stages_.empty() && !destination.empty() &&
                (isMoving_ || destination != destination_);
    destination_ = destination;
  }
  // Returns the value at time now, which must not go back. Afterwards moving() tells whether it has
  // arrived.
  List at(double now) {
    if (!isMoving_ || hasArrived(now)) {
      isMoving_ = false;
      return destination_;
    }
    List value = destination_;
    const std::vector<double> weights = weightsAt(now);
    for (size_t i = 0; i < value.size(); ++i)
      value[i] = Motion<T>::moved(value[i], error(stages_.size() - 1, i, weights));
    return value;
  }
  bool moving() const { return isMoving_; }

 private:
  using Delta = typename Motion<T>::Delta;
  using Stage = std::vector<Delta>; // for each element the filter's difference from the destination

  // Returns the factors exp(-s) s^k / k! of the time since `since_`.
  std::vector<double> weightsAt(double now) const {
    std::vector<double> weights(stages_.size(), 0.0);
    const double s = tau_ > 0 ? std::max(now - since_, 0.0) / tau_ : 1e300;
    if (s > 700) return weights; // exp(-s) is 0
    double weight = std::exp(-s);
    for (size_t k = 0; k < weights.size(); ++k) {
      weights[k] = weight;
      weight *= s / double(k + 1);
    }
    return weights;
  }

  Delta error(size_t stage, size_t element, const std::vector<double>& weights) const {
    Delta sum = Motion<T>::scaled(stages_[stage][element], weights[0]);
    for (size_t k = 1; k <= stage; ++k)
      sum = Motion<T>::sum(sum, Motion<T>::scaled(stages_[stage - k][element], weights[k]));
    return sum;
  }

  // Makes the state at `now` the one that the formula begins with.
  void rebase(double now) {
    if (isMoving_) {
      const std::vector<double> weights = weightsAt(now);
      for (size_t i = 0; i < stages_[0].size(); ++i)
        for (size_t stage = stages_.size(); stage-- > 0;) // the later ones need the earlier ones
          stages_[stage][i] = error(stage, i, weights);
    }
    since_ = now;
  }

  // Returns whether all filters are within the tolerance.
  bool hasArrived(double now) const {
    const std::vector<double> weights = weightsAt(now);
    for (size_t i = 0; i < stages_[0].size(); ++i)
      for (size_t stage = 0; stage < stages_.size(); ++stage)
        if (Motion<T>::length(error(stage, i, weights)) > tolerance_) return false;
    return true;
  }

  std::vector<Stage> stages_;
  List destination_;
  double tau_ = 0.3, tolerance_ = 1e-4;
  double since_ = 0; // time at which stages_ hold, in seconds
  bool isMoving_ = false;
};

} // namespace xvrml
