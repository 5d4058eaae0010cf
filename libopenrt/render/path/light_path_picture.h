// light_path_picture.h: estimates the picture that light paths make from few of them. [render]
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/path/light_path_gain.h"

namespace openrt {

// A kd-tree over the picture. Each leaf has few finds and one radiance, so places that get much
// light have small leaves.
class LightPathPicture {
 public:
  LightPathPicture() = default; // black
  // finds: those of `paths` light paths. width, height: of the picture, in pixels.
  LightPathPicture(std::vector<LightPathFind> finds, double paths, double width, double height) {
    divide(finds.data(), finds.data() + finds.size(), paths, {{0, 0}, {width, height}});
  }
  // Returns the radiance at a place, summed over the colours.
  double at(double x, double y) const {
    if (nodes_.empty()) return 0;
    uint32_t n = 0;
    while (nodes_[n].above)
      n = (nodes_[n].axis ? y : x) < nodes_[n].value ? n + 1 : nodes_[n].above;
    return nodes_[n].value;
  }

 private:
  struct Node {
    double value;       // where a node divides the finds; the radiance of a leaf
    int axis;           // 0: x, 1: y
    uint32_t above = 0; // the part above `value`; the part below follows the node; 0: a leaf
  };
  struct Box {
    double low[2], high[2];
  };
  static constexpr ptrdiff_t mostInLeaf = 16;

  void divide(LightPathFind* begin, LightPathFind* end, double paths, const Box& box) {
    const size_t node = nodes_.size();
    nodes_.push_back({0, 0});
    const double size[2] = {box.high[0] - box.low[0], box.high[1] - box.low[1]};
    const int axis = size[1] > size[0];
    const auto place = [axis](const LightPathFind& f) { return axis ? f.y : f.x; };
    const auto isBefore = [&](const LightPathFind& a, const LightPathFind& b) {
      return place(a) < place(b);
    };
    if (end - begin > mostInLeaf && size[axis] > 1) {
      std::stable_sort(begin, end, isBefore);
      LightPathFind* middle = std::lower_bound(begin, end, begin[(end - begin) / 2], isBefore);
      const double value = place(*middle);
      if (value > box.low[axis] && value < box.high[axis]) {
        Box below = box, above = box;
        below.high[axis] = above.low[axis] = value;
        divide(begin, middle, paths, below);
        nodes_[node] = {value, axis, uint32_t(nodes_.size())};
        return divide(middle, end, paths, above);
      }
    }
    double sum = 0;
    for (const LightPathFind* f = begin; f < end; f++) sum += f->radiance;
    nodes_[node].value = sum / (paths * size[0] * size[1]);
  }

  std::vector<Node> nodes_;
};

} // namespace openrt
