// size_groups.cpp: halves a group that is too large until each fits its smallest member. A thing as
// large as the group is taken out of it first, because no plane separates it from what it contains.
#include "backend/local/accel/size_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

namespace openrt {
namespace {

using Members = std::vector<uint32_t>;

class Grouping {
 public:
  explicit Grouping(const std::vector<Box>& boxes) : boxes_(boxes) {}

  std::vector<uint32_t> run() {
    std::vector<uint32_t> groupOf(boxes_.size());
    Members all(boxes_.size());
    for (uint32_t i = 0; i < all.size(); i++) all[i] = i;
    std::deque<Members> open{all};
    for (uint32_t done = 0; !open.empty();) {
      const Members group = std::move(open.front());
      open.pop_front();
      const Box box = around(group);
      if (done + open.size() + 2 <= mostGroups && isTooLarge(group, halfDiagonal(box))) {
        for (Members& part : split(group, box)) open.push_back(std::move(part));
        continue;
      }
      for (const uint32_t i : group) groupOf[i] = done;
      done++;
    }
    return groupOf;
  }

 private:
  Box around(const Members& group) const {
    Box all;
    for (const uint32_t i : group)
      if (!boxes_[i].empty()) all.add(boxes_[i], Matrix4d());
    return all;
  }

  bool isTooLarge(const Members& group, double size) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (const uint32_t i : group)
      if (const double s = halfDiagonal(boxes_[i]); s > 0) smallest = std::min(smallest, s);
    return std::isfinite(size) && size > largestToSmallest * smallest;
  }

  // Splits by size if something is about as large as all together, else by place. Neither part is
  // empty: the smallest member is not large, and without large ones both ends of the longest axis
  // have members of their own.
  std::array<Members, 2> split(const Members& group, const Box& box) const {
    const double large = halfDiagonal(box) / 4;
    const bool bySize = std::any_of(group.begin(), group.end(),
                                    [&](uint32_t i) { return halfDiagonal(boxes_[i]) >= large; });
    const Vec3d extent = box.high - box.low, twice = box.high + box.low;
    const auto isLow = [&](uint32_t i) {
      const Vec3d d = boxes_[i].low + boxes_[i].high - twice;
      if (extent.x >= extent.y && extent.x >= extent.z) return d.x < 0;
      return extent.y >= extent.z ? d.y < 0 : d.z < 0;
    };
    std::array<Members, 2> parts;
    for (const uint32_t i : group) {
      const bool first = bySize ? halfDiagonal(boxes_[i]) < large : isLow(i);
      parts[first ? 0 : 1].push_back(i);
    }
    return parts;
  }

  const std::vector<Box>& boxes_;
};

} // namespace

std::vector<uint32_t> groupBySize(const std::vector<Box>& boxes) { return Grouping(boxes).run(); }

} // namespace openrt
