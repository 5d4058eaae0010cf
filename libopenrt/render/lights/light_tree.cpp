#include "render/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace openrt {
namespace {

constexpr uint32_t none = ~0u;
constexpr uint32_t balanceFrom = 28; // deeper nodes are split in halves, which bounds the depth

// Unites two cones into the smallest cone about both (S. Glassner's construction, as in PBR 3.8.4),
// slightly widened for rounding.
void uniteCones(LightBounds& a, const LightBounds& b) {
  if (a.cosineNormals <= -1 || b.cosineNormals <= -1) {
    a.cosineNormals = -1;
    return;
  }
  const double along = dot(Vec3d(a.axis), Vec3d(b.axis));
  if (b.cosineNormals >= 1 && along >= a.cosineNormals)
    return; // the most frequent case: one more normal inside the cone
  const double first = std::acos(std::clamp(double(a.cosineNormals), -1.0, 1.0));
  const double second = std::acos(std::clamp(double(b.cosineNormals), -1.0, 1.0));
  const double between = std::acos(std::clamp(along, -1.0, 1.0));
  if (std::min(between + second, M_PI) <= first) return;
  if (std::min(between + first, M_PI) <= second) {
    a.axis = b.axis;
    a.cosineNormals = b.cosineNormals;
    return;
  }
  const double half = (first + between + second) / 2, turn = half - first, sine = std::sin(between);
  if (half >= M_PI || !(sine > 1e-7)) { // opposite axes have no middle direction
    a.cosineNormals = -1;
    return;
  }
  const Vec3d axis = // rotated from the first axis towards the second
      (std::sin(between - turn) * Vec3d(a.axis) + std::sin(turn) * Vec3d(b.axis)) / sine;
  a.axis = Vec3f(axis / length(axis));
  a.cosineNormals = float(std::cos(std::min(half + 1e-6, M_PI)));
}

void unite(LightBounds& a, const LightBounds& b) {
  a.low = min(a.low, b.low);
  a.high = max(a.high, b.high);
  uniteCones(a, b);
  a.cosineEmission = std::min(a.cosineEmission, b.cosineEmission);
  a.bothSides |= b.bothSides;
  a.intensity += b.intensity;
  a.irradiance += b.irradiance;
  a.reach = std::max(a.reach, b.reach);
}

// Cost of a node for split selection: strength times the solid angle lit times the surface area of
// the box. Flat boxes are treated as if they had a small depth.
double cost(const LightBounds& b, const Vec3d& size) {
  const double normals = std::acos(std::clamp(double(b.cosineNormals), -1.0, 1.0));
  const double all =
      std::min(normals + std::acos(std::clamp(double(b.cosineEmission), -1.0, 1.0)), M_PI);
  const double directions = 2 * M_PI * (1 - std::cos(normals)) +
                            M_PI / 2 *
                                (2 * all * std::sin(normals) - std::cos(normals - 2 * all) -
                                 2 * normals * std::sin(normals) + std::cos(normals));
  const double least = 1e-3 * largest(size);
  const Vec3d d = max(Vec3d(b.high) - Vec3d(b.low), {least, least, least});
  return (double(b.intensity) + b.irradiance) * directions * (d.x * d.y + d.y * d.z + d.z * d.x);
}

struct Range {
  // parent: the node that has this range as second child; none for a first child and the root
  uint32_t begin, end, parent, steps;
};

// A node of the binary tree that is built first.
struct BinaryNode {
  LightBounds bounds;
  // next: the second child (the first one follows the node), or the light of a leaf. steps:
  // distance from the root.
  uint32_t next, steps;
  bool leaf;
};

// Equal bins of an axis between the extreme centres of the lights.
struct Bins {
  static constexpr uint32_t count = 12;
  int axis = -1; // -1: none
  float low = 0, high = 0;
  // Returns the bin of a centre's coordinate on the axis.
  uint32_t of(float center) const {
    return std::min(uint32_t((double(center) - low) / (double(high) - low) * count), count - 1);
  }
};

// A split of a range at the upper end of a bin. Infinite cost: none was found.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  Bins bins;
  uint32_t last = 0; // the last bin whose lights go to the first child
};

class Builder {
 public:
  Builder(std::span<const LightBounds> lights, std::vector<uint32_t>& order)
      : lights_(lights), order_(order) {}
  // Partitions the lights of a range and returns the position of the split.
  uint32_t split(const Range& range, const LightBounds& whole) {
    const uint32_t middle = (range.begin + range.end) / 2;
    constexpr float infinite = std::numeric_limits<float>::infinity();
    Vec3f low{infinite, infinite, infinite}, high = -low;
    for (uint32_t i = range.begin; i < range.end; i++) {
      low = min(low, center(order_[i]));
      high = max(high, center(order_[i]));
    }
    const Vec3f size = high - low;
    int widest = 0;
    for (int k = 1; k < 3; k++)
      if (size[k] > size[widest]) widest = k;
    if (!(size[widest] > 0)) return middle; // all lights are in one place
    Cut best;
    // With many lights only the widest axis is tried.
    const bool all = range.end - range.begin <= 1u << 14;
    for (int k = 0; k < 3 && range.steps < balanceFrom; k++)
      if ((all || k == widest) && high[k] > low[k])
        tryCuts(range, whole, {k, low[k], high[k]}, best);
    const auto first = order_.begin() + range.begin, last = order_.begin() + range.end;
    if (best.bins.axis >= 0) {
      const auto found = std::stable_partition(first, last, [&](uint32_t i) {
        return best.bins.of(center(i)[best.bins.axis]) <= best.last;
      });
      if (found != first && found != last) return uint32_t(found - order_.begin());
    }
    std::nth_element(first, order_.begin() + middle, last, [&](uint32_t a, uint32_t b) {
      const float x = center(a)[widest], y = center(b)[widest];
      return x != y ? x < y : a < b;
    });
    return middle;
  }

 private:
  Vec3f center(uint32_t i) const { return lights_[i].low / 2 + lights_[i].high / 2; }
  // Sorts the lights of a range into bins and replaces `best` if a cut between them costs less.
  void tryCuts(const Range& range, const LightBounds& whole, Bins bins, Cut& best) const {
    LightBounds in[Bins::count];
    bool used[Bins::count] = {};
    for (uint32_t i = range.begin; i < range.end; i++) {
      const uint32_t b = bins.of(center(order_[i])[bins.axis]);
      if (used[b])
        unite(in[b], lights_[order_[i]]);
      else {
        in[b] = lights_[order_[i]];
        used[b] = true;
      }
    }
    const Vec3d size = Vec3d(whole.high) - Vec3d(whole.low);
    const double longest = largest(size),
                 factor = longest / std::max(size[bins.axis], 1e-3 * longest);
    const auto add = [](LightBounds& sum, bool& any, const LightBounds& more) {
      if (any)
        unite(sum, more);
      else {
        sum = more;
        any = true;
      }
    };
    bool any = false, anyAbove = false;
    LightBounds sum, above;
    double belowCost[Bins::count];
    for (uint32_t b = 0; b < Bins::count; b++) {
      if (used[b]) add(sum, any, in[b]);
      belowCost[b] = any ? cost(sum, size) : 0;
    }
    for (uint32_t b = Bins::count - 1; b > 0; b--) {
      if (used[b]) add(above, anyAbove, in[b]);
      if (!anyAbove) continue;
      const double c = factor * (belowCost[b - 1] + cost(above, size));
      if (belowCost[b - 1] > 0 && c < best.cost) best = {c, bins, b - 1};
    }
  }

  std::span<const LightBounds> lights_;
  std::vector<uint32_t>& order_;
};

std::vector<BinaryNode> buildBinaryTree(std::span<const LightBounds> lights,
                                        std::vector<uint32_t>& order) {
  std::vector<BinaryNode> binaryNodes;
  binaryNodes.reserve(2 * order.size() - 1);
  Builder builder(lights, order);
  std::vector<Range> left{{0, uint32_t(order.size()), none, 0}};
  while (!left.empty()) { // depth first; the first child follows its parent
    const Range range = left.back();
    left.pop_back();
    const auto number = uint32_t(binaryNodes.size());
    if (range.parent != none) binaryNodes[range.parent].next = number;
    BinaryNode binaryNode{lights[order[range.begin]], order[range.begin], range.steps,
                          range.end - range.begin == 1};
    for (uint32_t i = range.begin + 1; i < range.end; i++)
      unite(binaryNode.bounds, lights[order[i]]);
    binaryNodes.push_back(binaryNode);
    if (binaryNode.leaf) continue;
    const uint32_t middle = builder.split(range, binaryNode.bounds);
    left.push_back({middle, range.end, number, range.steps + 1});
    left.push_back({range.begin, middle, none, range.steps + 1});
  }
  return binaryNodes;
}

} // namespace

// Collapses the binary tree: the strongest binary nodes are replaced by their children until a node
// is full.
void LightTree::build(std::span<const LightBounds> lights) {
  nodes_.clear();
  depth_ = 0;
  places_.assign(lights.size(), {none, 0});
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < lights.size(); i++)
    if (lights[i].intensity > 0 || lights[i].irradiance > 0) order.push_back(i);
  if (order.empty()) return;
  const std::vector<BinaryNode> binaryNodes = buildBinaryTree(lights, order);
  struct Todo {
    uint32_t binaryNode, parent, slot, depth;
  };
  std::vector<Todo> left{{0, none, 0, 1}};
  for (size_t next = 0; next < left.size(); next++) {
    const Todo todo = left[next];
    const auto number = uint32_t(nodes_.size());
    Node& node = nodes_.emplace_back();
    node = {};
    node.parent = todo.parent;
    node.slot = todo.slot;
    if (todo.parent != none) nodes_[todo.parent].child[todo.slot] = number;
    depth_ = std::max(depth_, todo.depth);
    uint32_t children[width] = {todo.binaryNode}, count = 1;
    while (count < width) {
      uint32_t strongest = none;
      float most = -1;
      for (uint32_t i = 0; i < count; i++) {
        const BinaryNode& t = binaryNodes[children[i]];
        const float strength = t.bounds.intensity + t.bounds.irradiance;
        if (!t.leaf && strength > most) {
          most = strength;
          strongest = i;
        }
      }
      if (strongest == none) break;
      const uint32_t opened = children[strongest];
      children[strongest] = opened + 1;
      children[count++] = binaryNodes[opened].next;
    }
    for (uint32_t i = 0; i < count; i++) {
      const BinaryNode& t = binaryNodes[children[i]];
      fill(number, i, t.bounds);
      nodes_[number].leaf[i] = t.leaf;
      if (t.leaf) {
        nodes_[number].child[i] = t.next;
        places_[t.next] = {number, i};
      } else
        left.push_back({children[i], number, i, todo.depth + 1});
    }
  }
}

void LightTree::fill(uint32_t number, uint32_t i, const LightBounds& b) {
  Node& node = nodes_[number];
  const Vec3f center = b.low / 2 + b.high / 2;
  const Vec3d half = max(Vec3d(b.high) - Vec3d(center), Vec3d(center) - Vec3d(b.low));
  const double diagonal = dot(half, half);
  store(center, node.center, i);
  store(b.axis, node.axis, i);
  node.radius2[i] = float(std::min(diagonal * (1 + 1e-6), 3e38));
  const double far = double(b.reach) * (1 + 1e-5) + std::sqrt(diagonal);
  node.reach2[i] =
      far < 1e19 ? float(far * far * (1 + 1e-6)) : std::numeric_limits<float>::infinity();
  node.cosine[i] = b.cosineNormals;
  node.sine[i] = float(std::sqrt(std::max(0.0, 1 - double(b.cosineNormals) * b.cosineNormals)));
  node.beyond[i] = b.cosineEmission;
  node.both[i] = b.bothSides ? 1 : 0;
  node.intensity[i] = b.intensity;
  node.irradiance[i] = b.irradiance;
  node.used[i] = 1;
}

LightTree::Choice LightTree::choose(const Vec3f& place, const Vec3f& normal, double pick,
                                    Side side) const {
  if (nodes_.empty()) return {};
  const LightReceiver query(place, normal, side);
  double probability = 1;
  for (uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    float each[width];
    importances(node, query, each);
    double sum = 0;
    for (const float m : each) sum += double(m);
    if (!(sum > 0)) return {};
    double target = pick * sum;
    uint32_t slot = 0, last = 0;
    for (uint32_t i = 0; i < width; i++)
      if (each[i] > 0) last = i;
    while (slot < last && !(target < double(each[slot]))) target -= double(each[slot++]);
    probability *= double(each[slot]) / sum;
    if (node.leaf[slot]) return {node.child[slot], float(probability)};
    pick = std::clamp(target / double(each[slot]), 0.0, 1 - 0x1p-53);
    at = node.child[slot];
  }
}

float LightTree::probability(const Vec3f& place, const Vec3f& normal, uint32_t light) const {
  if (nodes_.empty() || places_[light].node == none) return 0;
  const LightReceiver query(place, normal, Side::only);
  double probability = 1;
  Place at = places_[light];
  for (;;) {
    const Node& node = nodes_[at.node];
    float each[width];
    importances(node, query, each);
    double sum = 0;
    for (const float m : each) sum += double(m);
    if (!(sum > 0)) return 0;
    probability *= double(each[at.slot]) / sum;
    if (node.parent == none) return float(probability);
    at = {node.parent, node.slot};
  }
}

} // namespace openrt
