// light_image.h: the part of the picture made by light tracing. Light paths may contribute to any
// pixel, so the picture is made in a fixed number of parts, each a whole picture rendered by one
// thread. Their mean and its variance are kept, or only their mean where no error is asked for.
// Parts are added in the order of their numbers, and a part that arrives early waits. So the sums
// do not depend on threads. [any]
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "render/film/error.h"
#include "render/film/film.h"

namespace openrt {

class LightImage {
 public:
  // Number of parts of a frame, at most; and with a time limit, where later rounds have parts, too.
  static constexpr uint32_t parts = 16, mostParts = 1 << 20;
  // Returns the number of parts of a frame. Those with light in few pixels are previews: their
  // parts have few paths, and to add up whole pictures would cost more than to trace them.
  static uint32_t partsOf(const edit::FrameSettingsT& frame);
  // Tells what is kept: means alone, or also the variances that errors need. A pixel shares its
  // variance with its neighbours; a sensor has one of its own.
  enum class Kept : uint8_t { means, pixels, sensors };
  LightImage(uint32_t width, uint32_t height, uint32_t all = parts, Kept kept = Kept::pixels);
  // Adds a part: rgb by pixel, row by row. Each number may be added once; numbers beyond the last
  // are parts that a time limit leaves time for.
  void add(uint32_t number, std::vector<float>&& part);
  uint32_t added() const { return added_.load(std::memory_order_acquire); }
  bool complete() const { return added() >= all_; }
  // Returns a tile's sums, row by row, from the parts added so far. The variance is infinite with
  // fewer than two parts, and 0 where it is not kept.
  void read(const Tile& tile, std::vector<LightSums>& out) const;

  // The sums of the parts added so far, without those that wait.
  struct State {
    uint32_t added = 0;
    std::vector<double> values; // by pixel: means of the colours, then squares where they are kept
  };
  State state() const;
  // Sets the sums of a picture to which nothing was added. Returns false if the state is not one of
  // such a picture. complete: no part is missing, however many there were.
  bool restore(const State& state, bool complete = false);
  // Adds the sums of a picture of other paths.
  static void merge(State& into, const State& more, Kept kept);

 private:
  struct Pixel {
    double mean[3] = {}, squares[3] = {}; // squares: sum of squared differences from the mean
  };
  using Mean = std::array<double, 3>;
  static_assert(sizeof(Pixel) == 6 * sizeof(double) && sizeof(Mean) == 3 * sizeof(double));
  void addNow(const std::vector<float>& part, double number);
  void summarise();
  double variance(const Pixel& pixel, int k) const;
  struct Window {
    uint32_t reach; // number of pixels to each side
    int colours;    // the first ones count
  };
  void addWindow(uint32_t x, uint32_t y, const Window& window, LightSums& out) const;
  LightSums at(uint32_t x, uint32_t y) const;
  LightSums ofSensor(uint32_t x, uint32_t y) const;

  uint32_t width_, height_, all_;
  Kept kept_;
  mutable std::shared_mutex sums_; // guards pixels_ and means_, and added_ for readers
  std::vector<Pixel> pixels_;      // where variances are kept
  std::vector<Mean> means_;        // where they are not
  // Where pixels are sensors, these are the mean that one path leaves in a cell, and the largest
  // mean of all cells. They are 0 if no path has crossed any.
  double ofOnePath_ = 0, brightest_ = 0;
  std::atomic<uint32_t> added_{0};
  std::mutex turn_; // guards waiting_ and adding_
  std::vector<std::vector<float>> waiting_;
  bool adding_ = false;
};

} // namespace openrt
