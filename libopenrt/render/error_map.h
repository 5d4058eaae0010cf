// error_map.h: the errors of a picture's pixels, for what only the neighbours know of a pixel and for the picture as a whole.
// store(): [render] each pixel by one thread; the rest by one thread when the picture is finished.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "render/picture_error.h"

namespace openrt {

inline constexpr float darkest = 0.03f;       // colours summed: errors of what is darker are not blown up
inline constexpr double ruleOfThree = 2.9957; // -ln 0.05: n misses in a row bound a probability by this / n

struct PixelError {
  float mean[3] = {};
  float halfWidth[3] = {}; // of the 95 % interval of each colour
  float relative = 1;      // relativeError() of the half-widths
  PixelNoise noise;
  uint32_t samples = 0;
  bool trusted = false;
  bool constant = false; // nothing random, all samples equal: exact, unless an edge passes through a corner
};

// A sum over the colours of errors, over the sum of the colours and `darkest`. At most 1.
float relativeError(double sum, const float colors[3]);

struct ErrorSummary { // as in RTstats
  double mean = 0, meanInterval = 0, halfWidth = 0, p99 = 0;
  uint64_t pixels = 0, trusted = 0;
};

class ErrorMap {
 public:
  // full: also what doubtConstants() needs; doubts: that alone, there is no summary().
  enum class Kind { none, summary, full, doubts };
  ErrorMap() = default;
  ErrorMap(uint32_t width, uint32_t height, Kind kind);
  bool empty() const { return relative_.empty(); }
  void store(size_t pixel, const PixelError& e);
  // A constant pixel beside pixels that differ from it is not known to be exact: the edge may cut a corner of it that no sample
  // met. Its interval gets what the rule of three allows for, and it is not trusted. The same at the border of a picture that is
  // not of one colour. changed is called for each.
  void doubtConstants(const std::function<void(size_t pixel, const float halfWidth[3])>& changed);
  // Tells of radiance that a finished pixel may lack and no sample tells of (ledger.h), colours summed. bound: the most, as far
  // as its tile's samples know; it takes the trust of a pixel with random samples whose interval is narrower, and true is
  // returned. expected: the most if light is met as often everywhere; it widens the interval of the summary's mean.
  bool miss(size_t pixel, double bound, double expected);
  ErrorSummary summary() const;

 private:
  struct Seen {
    float mean[3];
    uint32_t samples; // 0: not finished
    bool constant;
  };
  bool border(uint32_t x, uint32_t y) const { return x == 0 || y == 0 || x + 1 == width_ || y + 1 == height_; }
  bool beside(uint32_t x, uint32_t y) const;
  void range(uint32_t x, uint32_t y, float out[3]) const;
  uint32_t width_ = 0, height_ = 0;
  std::vector<float> relative_; // NaN: not finished; negative: not trusted
  std::vector<float> doubted_;  // what a constant pixel in doubt is expected to be off by, relative; NaN: it is not in doubt
  std::vector<PixelNoise> noise_;
  std::vector<Seen> seen_;
  float range_[3] = {}; // of all pixels' colours; doubtConstants()
  double missing_ = 0;  // sum over the pixels of what they may lack, relative
};

} // namespace openrt
