// flat_triangles.cpp: flips edges until no sliver has a neighbour at its longest edge.
#include "geometry/polygons/flat_triangles.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace xvrml {
namespace {

class Flips {
 public:
  Flips(const std::function<V3d(uint32_t)>& position,
        const std::function<bool(uint32_t, uint32_t, uint32_t)>& hasArea)
      : position_(position), hasArea_(hasArea) {}

  void run(std::vector<uint32_t>& triangles) {
    for (size_t i = 0; i + 2 < triangles.size(); i += 3)
      insert({triangles[i], triangles[i + 1], triangles[i + 2]});
    if (open_.empty()) return;
    // Each flip removes a sliver or, after a walk along slivers, shortens the edge between two of
    // them. The limit guards against rounding and against faces made to take long.
    const uint64_t n = all_.size();
    for (uint64_t left = 64 + 16 * n + std::min<uint64_t>(n * n, 2'000'000);
         !open_.empty() && left > 0; --left)
      flip();
    triangles.clear();
    for (size_t i = 0; i < all_.size(); ++i)
      if (alive_[i] && hasArea(i))
        triangles.insert(triangles.end(), all_[i].begin(), all_[i].end());
  }

 private:
  using Triangle = std::array<uint32_t, 3>;
  static uint64_t key(uint32_t from, uint32_t to) { return uint64_t(from) << 32 | to; }
  bool hasArea(size_t number) const {
    return hasArea_(all_[number][0], all_[number][1], all_[number][2]);
  }
  // Returns whether the triangle is so thin that rounding may have made it: collinear corners are
  // seldom exactly collinear. The flips leave the outline unchanged.
  bool isFlat(size_t number) const {
    const auto [a, b, c] = turned(all_[number]);
    const double longest = length(a, c);
    return (position_(b) - position_(a)).cross(position_(c) - position_(a)).length() <=
           1e-5 * longest * longest;
  }
  double length(uint32_t a, uint32_t b) const { return (position_(a) - position_(b)).length(); }

  void insert(const Triangle& t) {
    const auto number = uint32_t(all_.size());
    all_.push_back(t);
    alive_.push_back(true);
    final_.push_back(false);
    for (int i = 0; i < 3; ++i) edges_.emplace(key(t[i], t[(i + 1) % 3]), number);
    if (isFlat(number)) open_.push_back(number);
  }

  void remove(uint32_t number) {
    alive_[number] = false;
    const Triangle& t = all_[number];
    for (int i = 0; i < 3; ++i) {
      const auto found = edges_.find(key(t[i], t[(i + 1) % 3]));
      if (found != edges_.end() && found->second == number) edges_.erase(found);
    }
  }

  // Rotates a triangle so that its longest edge leads from the last vertex to the first.
  Triangle turned(const Triangle& t) const {
    int best = 0;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
      const double now = length(t[(i + 2) % 3], t[i]);
      if (now > longest) {
        longest = now;
        best = i;
      }
    }
    return {t[best], t[(best + 1) % 3], t[(best + 2) % 3]};
  }

  // Flips the last open triangle (a, b, c), where b lies between a and c. With the triangle (a, c,
  // d) behind its edge it becomes (a, b, d) and (b, c, d).
  void flip() {
    const uint32_t number = open_.back();
    open_.pop_back();
    if (!alive_[number] || final_[number]) return;
    const auto [a, b, c] = turned(all_[number]);
    const auto found = edges_.find(key(a, c));
    // If two vertices coincide, either can be used.
    const bool apart = length(a, b) > 0 && length(b, c) > 0;
    if (!apart || found == edges_.end() || found->second == number) { // on the outline
      final_[number] = true;
      if (!hasArea(number)) remove(number);
      return;
    }
    const uint32_t other = found->second;
    Triangle o = all_[other];
    while (o[0] != a || o[1] != c) o = {o[1], o[2], o[0]};
    const uint32_t d = o[2];
    if (d == b) {
      remove(number);
      remove(other);
      return;
    }
    // A longer sliver behind the edge is processed first.
    if (isFlat(other) && !final_[other] && std::max(length(c, d), length(d, a)) > length(a, c)) {
      open_.push_back(number);
      open_.push_back(other);
      return;
    }
    remove(number);
    remove(other);
    insert({a, b, d});
    insert({b, c, d});
  }

  const std::function<V3d(uint32_t)>& position_;
  const std::function<bool(uint32_t, uint32_t, uint32_t)>& hasArea_;
  std::vector<Triangle> all_;
  std::vector<bool> alive_, final_; // final_: cannot be flipped
  std::vector<uint32_t> open_;
  std::unordered_map<uint64_t, uint32_t> edges_; // directed edges to the triangle on their left
};

} // namespace

void removeFlatTriangles(std::vector<uint32_t>& triangles,
                         const std::function<V3d(uint32_t)>& position,
                         const std::function<bool(uint32_t, uint32_t, uint32_t)>& hasArea) {
  Flips(position, hasArea).run(triangles);
}

} // namespace xvrml
