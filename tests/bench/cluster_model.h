// cluster_model.h: the models that the cluster simulator (cluster_sim.cpp) puts around the real
// master: links with a bandwidth and a latency, workers that sleep instead of rendering, and a
// picture whose tiles differ in cost. Time is virtual; only the master's time is measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <queue>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "backend/cluster/messages/messages.h"
#include "render/frame/result_codec.h"
#include "render/wave/tiles.h"

namespace sim {

using namespace openrt;
using namespace openrt::cluster;

// Cost of a sample relative to the mean of the picture, by cell, row by row.
class CostMap {
 public:
  // Reads a text file: width, height, then the seconds of each cell (any unit). Lines that begin
  // with # are comments.
  explicit CostMap(const std::string& file) {
    std::ifstream in(file);
    std::string line, all;
    while (std::getline(in, line))
      if (line.empty() || line[0] != '#') all += line + ' ';
    const char* at = all.c_str();
    const auto number = [&] {
      char* end = nullptr;
      const double x = std::strtod(at, &end);
      if (end == at || !(x >= 0))
        throw std::runtime_error(file +
                                 ": width, height and their product of numbers are expected");
      at = end;
      return x;
    };
    width_ = uint32_t(number());
    height_ = uint32_t(number());
    cells_.resize(size_t(width_) * height_);
    for (double& c : cells_) c = number();
    normalize();
  }
  // Makes a picture. A third of it is background at a tenth of the cost. The rest is log-normal
  // (sigma 0.5), with eight hot spots of ten times the cost; their radius is a fortieth of the
  // picture's width.
  CostMap() : width_(120), height_(68), cells_(size_t(width_) * height_) {
    std::mt19937 random(7);
    std::vector<std::pair<double, double>> spots;
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    for (int i = 0; i < 8; i++)
      spots.push_back({width_ * uniform(), height_ * (0.35 + 0.6 * uniform())});
    for (uint32_t y = 0; y < height_; y++)
      for (uint32_t x = 0; x < width_; x++) {
        const double normal =
            std::sqrt(-2 * std::log(uniform() + 1e-12)) * std::cos(6.283185307 * uniform());
        double cost = y * 3 < height_ ? 0.1 : std::exp(0.5 * normal);
        for (const auto& [sx, sy] : spots) {
          const double r = std::hypot(x - sx, y - sy) / (width_ / 40.0);
          if (r < 1) cost *= 10;
        }
        cells_[y * width_ + x] = cost;
      }
    normalize();
  }
  // Returns the mean cost of the cells that a tile touches, weighted by where its pixels lie.
  double of(const Tile& tile, uint32_t width, uint32_t height) const {
    constexpr int steps = 8;
    double sum = 0;
    for (int j = 0; j < steps; j++)
      for (int i = 0; i < steps; i++) {
        const double x = (tile.x0 + (i + 0.5) / steps * (tile.x1 - tile.x0)) / width;
        const double y = (tile.y0 + (j + 0.5) / steps * (tile.y1 - tile.y0)) / height;
        sum += cells_[size_t(std::min(y * height_, height_ - 1.0)) * width_ +
                      size_t(std::min(x * width_, width_ - 1.0))];
      }
    return sum / (steps * steps);
  }

 private:
  void normalize() {
    double sum = 0;
    for (const double c : cells_) sum += c;
    for (double& c : cells_) c *= double(cells_.size()) / sum;
  }
  uint32_t width_ = 0, height_ = 0;
  std::vector<double> cells_;
};

// A server that does one thing after the other; each takes its time.
struct Server {
  double free = 0, busy = 0;
  double take(double now, double seconds) {
    free = std::max(free, now) + seconds;
    busy += seconds;
    return free;
  }
};

class Events {
 public:
  void at(double when, std::function<void()> what) {
    queue_.push({when, next_++, std::move(what)});
  }
  bool empty() const { return queue_.empty(); }
  double now = 0;
  void step() {
    Event e = std::move(const_cast<Event&>(queue_.top()));
    queue_.pop();
    now = std::max(now, e.when);
    e.what();
  }

 private:
  struct Event {
    double when;
    uint64_t number;
    std::function<void()> what;
    bool operator<(const Event& e) const {
      return when != e.when ? when > e.when : number > e.number;
    }
  };
  std::priority_queue<Event> queue_;
  uint64_t next_ = 0;
};

// Result messages. They hold sums of random pixels, encoded as a worker does. All tiles of one size
// share the same sums and differ only in their lease.
class Results {
 public:
  explicit Results(const edit::FrameSettingsT& frame) : frame_(frame) {}
  Frames make(uint64_t session, Epoch epoch, const LeasedJob& job, size_t pixels, double seconds) {
    message::Result result;
    result.epoch = epoch;
    result.lease = job.lease;
    result.seconds = seconds;
    result.bytes = bytes(job, pixels);
    return encode(session, std::move(result));
  }

 private:
  std::vector<std::byte> bytes(const LeasedJob& job, size_t pixels) {
    std::vector<std::byte>& known = bytes_[pixels];
    if (known.empty()) {
      std::mt19937_64 random(pixels);
      JobResult result;
      result.sums.resize(pixels);
      for (PixelSums& s : result.sums) {
        for (double& c : s.rgba) c = double(random() >> 11) * 0x1p-50;
        s.rgba[3] = job.job.count;
        s.samples = job.job.count;
      }
      known = encodeResult(frame_, job.job, result);
    }
    return known;
  }
  const edit::FrameSettingsT frame_;
  std::map<size_t, std::vector<std::byte>> bytes_;
};

} // namespace sim
