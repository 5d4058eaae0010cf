// crossing_collectors.h: what a search of an ExactScene or a DoubleScene does with the crossings
// that it finds. Hit is that of the scene. [one thread]
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace openrt {

// Receives crossings. add() returns the t from which on further ones are of no interest.
template <class Hit> class CrossingCollector {
 public:
  virtual ~CrossingCollector() = default;
  virtual double add(const Hit& hit) = 0;
  double far = std::numeric_limits<double>::infinity();
};

// Ends the search at the first crossing.
template <class Hit> class AnyCrossing final : public CrossingCollector<Hit> {
 public:
  bool met = false;
  double add(const Hit&) override {
    met = true;
    return this->far = -std::numeric_limits<double>::infinity();
  }
};

// Appends all crossings to a list.
template <class Hit> class AllCrossings final : public CrossingCollector<Hit> {
 public:
  explicit AllCrossings(std::vector<Hit>& hits) : hits_(hits) {}
  double add(const Hit& hit) override {
    hits_.push_back(hit);
    return this->far;
  }

 private:
  std::vector<Hit>& hits_;
};

// Counts crossings.
template <class Hit> class CrossingCounter final : public CrossingCollector<Hit> {
 public:
  size_t count = 0;
  double add(const Hit&) override {
    count++;
    return this->far;
  }
};

} // namespace openrt
