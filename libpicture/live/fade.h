// fade.h: Finds how much of a still picture may be shown over the preview before it without making
// what is shown noisier. The difference of two states of a still picture tells its noise, and its
// difference from the preview, less that noise, tells what the preview has wrong. Their mixture
// with the least error has a weight that follows from both; its noise is never more than half of
// what the preview has wrong. Owned by a Display. [the browser's thread]
#pragma once

#include <cstdint>
#include <vector>

#include "libpicture/neighbours.h"

namespace picture::live {

class Fade {
 public:
  // Begins with a still picture of this size over another preview. There is no limit yet.
  void begin(int width, int height);
  // Learns from a state of the still picture that has samples in each pixel. below, rgb: the bytes
  // of the preview and of the still picture. samples: per pixel. weight: the one that is wanted;
  // the limits never fall below what was shown before.
  void learn(const std::vector<uint8_t>& below, const std::vector<uint8_t>& rgb, double samples,
             double weight);

  // The limits along a row of pixels, 0 to 1.
  class Row {
   public:
    Row(const Fade& fade, int y);
    double operator()(int x) const;

   private:
    const Fade& fade_;
    Neighbours rows_;
  };

 private:
  // A block of pixels, whose noise and errors are taken together.
  struct Block {
    double variance = 0; // that one sample has, mean over pixels and colours
    double limit = 0;    // the largest weight so far
  };
  size_t blockOf(size_t x, size_t y) const { return y * columns_ + x; }
  double limitAt(size_t column, size_t row) const;

  int width_ = 0, height_ = 0;
  size_t columns_ = 0, rows_ = 0;
  std::vector<Block> blocks_;
  std::vector<Neighbours> acrossBlocks_, downBlocks_; // for each column and row of pixels
  std::vector<uint8_t> earlier_;                      // an earlier state of the still picture
  double earlierSamples_ = 0;                         // 0: there is none
  double lastWeight_ = 0;                             // the wanted weight before
  bool isKnown_ = false;                              // the noise is
};

} // namespace picture::live
