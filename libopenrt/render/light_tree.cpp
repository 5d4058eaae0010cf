// light_tree.cpp: see light_tree.h.
#include "render/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace openrt {
namespace {

constexpr uint32_t bins = 12;
constexpr uint32_t none = ~0u;
constexpr uint32_t deepest = 60;     // of a trail's 64 steps
constexpr uint32_t balanceFrom = 28; // deeper nodes are halved: 2^32 lights would end before the deepest step

double dot(const float a[3], const float b[3]) { return double(a[0]) * b[0] + double(a[1]) * b[1] + double(a[2]) * b[2]; }

// The smallest cone about both (S. Glassner's construction, as in PBR 3.8.4), a little wider for its own rounding.
void uniteCones(LightBounds& a, const LightBounds& b) {
  if (a.cosineNormals <= -1 || b.cosineNormals <= -1) {
    a.cosineNormals = -1;
    return;
  }
  const double along = dot(a.axis, b.axis);
  if (b.cosineNormals >= 1 && along >= a.cosineNormals) return; // most often: one normal more within the cone
  const double first = std::acos(std::clamp(double(a.cosineNormals), -1.0, 1.0));
  const double second = std::acos(std::clamp(double(b.cosineNormals), -1.0, 1.0));
  const double between = std::acos(std::clamp(along, -1.0, 1.0));
  if (std::min(between + second, M_PI) <= first) return;
  if (std::min(between + first, M_PI) <= second) {
    std::copy_n(b.axis, 3, a.axis);
    a.cosineNormals = b.cosineNormals;
    return;
  }
  const double half = (first + between + second) / 2, turn = half - first, sine = std::sin(between);
  if (half >= M_PI || !(sine > 1e-7)) { // opposite axes have no middle
    a.cosineNormals = -1;
    return;
  }
  double axis[3], square = 0; // from the first axis towards the second
  for (int k = 0; k < 3; k++) {
    axis[k] = (std::sin(between - turn) * a.axis[k] + std::sin(turn) * b.axis[k]) / sine;
    square += axis[k] * axis[k];
  }
  for (int k = 0; k < 3; k++) a.axis[k] = float(axis[k] / std::sqrt(square));
  a.cosineNormals = float(std::cos(std::min(half + 1e-6, M_PI)));
}

void unite(LightBounds& a, const LightBounds& b) {
  for (int k = 0; k < 3; k++) a.low[k] = std::min(a.low[k], b.low[k]), a.high[k] = std::max(a.high[k], b.high[k]);
  uniteCones(a, b);
  a.cosineBeyond = std::min(a.cosineBeyond, b.cosineBeyond);
  a.bothSides |= b.bothSides;
  a.intensity += b.intensity, a.irradiance += b.irradiance;
  a.reach = std::max(a.reach, b.reach);
}

// Of a split: strength times the directions lit times the surface of the box. Flat boxes get a little depth.
double cost(const LightBounds& b, const double size[3]) {
  const double normals = std::acos(std::clamp(double(b.cosineNormals), -1.0, 1.0));
  const double all = std::min(normals + std::acos(std::clamp(double(b.cosineBeyond), -1.0, 1.0)), M_PI);
  const double directions = 2 * M_PI * (1 - std::cos(normals)) + M_PI / 2 *
                                                                     (2 * all * std::sin(normals) - std::cos(normals - 2 * all) -
                                                                      2 * normals * std::sin(normals) + std::cos(normals));
  double d[3];
  const double least = 1e-3 * std::max({size[0], size[1], size[2]});
  for (int k = 0; k < 3; k++) d[k] = std::max(double(b.high[k]) - b.low[k], least);
  return (double(b.intensity) + b.irradiance) * directions * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]);
}

struct Range {
  uint32_t begin, end, parent, steps; // parent: its second child is this one; none: a first child, or the root
  uint64_t bits;
};

class Builder {
 public:
  Builder(std::span<const LightBounds> lights, std::vector<uint32_t>& order) : lights_(lights), order_(order) {}
  // Where the range is cut in two, its lights in order before and after.
  uint32_t split(const Range& range, const LightBounds& whole) {
    const uint32_t middle = (range.begin + range.end) / 2;
    float low[3], high[3];
    std::fill_n(low, 3, std::numeric_limits<float>::infinity());
    std::fill_n(high, 3, -std::numeric_limits<float>::infinity());
    for (uint32_t i = range.begin; i < range.end; i++)
      for (int k = 0; k < 3; k++)
        low[k] = std::min(low[k], centre(order_[i], k)), high[k] = std::max(high[k], centre(order_[i], k));
    int widest = 0;
    for (int k = 1; k < 3; k++)
      if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
    if (!(high[widest] - low[widest] > 0)) return middle; // all in one place
    double best = std::numeric_limits<double>::infinity();
    int dimension = -1;
    uint32_t cut = 0;
    const bool all = range.end - range.begin <= 1u << 14; // of many only the widest extent is tried
    for (int k = 0; k < 3 && range.steps < balanceFrom; k++)
      if ((all || k == widest) && high[k] > low[k]) tryCuts(range, whole, k, low[k], high[k], best, dimension, cut);
    const auto first = order_.begin() + range.begin, last = order_.begin() + range.end;
    if (dimension >= 0) {
      const auto found = std::stable_partition(
          first, last, [&](uint32_t i) { return bin(i, dimension, low[dimension], high[dimension]) <= cut; });
      if (found != first && found != last) return uint32_t(found - order_.begin());
    }
    std::nth_element(first, order_.begin() + middle, last, [&](uint32_t a, uint32_t b) {
      const float x = centre(a, widest), y = centre(b, widest);
      return x != y ? x < y : a < b;
    });
    return middle;
  }

 private:
  float centre(uint32_t i, int k) const { return lights_[i].low[k] / 2 + lights_[i].high[k] / 2; }
  uint32_t bin(uint32_t i, int k, float low, float high) const {
    return std::min(uint32_t((double(centre(i, k)) - low) / (double(high) - low) * bins), bins - 1);
  }
  void tryCuts(const Range& range, const LightBounds& whole, int k, float low, float high, double& best, int& dimension,
               uint32_t& cut) const {
    LightBounds in[bins];
    bool used[bins] = {};
    for (uint32_t i = range.begin; i < range.end; i++) {
      const uint32_t b = bin(order_[i], k, low, high);
      if (used[b])
        unite(in[b], lights_[order_[i]]);
      else
        in[b] = lights_[order_[i]], used[b] = true;
    }
    double size[3];
    for (int j = 0; j < 3; j++) size[j] = double(whole.high[j]) - whole.low[j];
    const double longest = std::max({size[0], size[1], size[2]}), factor = longest / std::max(size[k], 1e-3 * longest);
    const auto add = [](LightBounds& sum, bool& any, const LightBounds& more) {
      if (any)
        unite(sum, more);
      else
        sum = more, any = true;
    };
    bool any = false, anyAbove = false;
    LightBounds sum, above;
    double belowCost[bins];
    for (uint32_t b = 0; b < bins; b++) {
      if (used[b]) add(sum, any, in[b]);
      belowCost[b] = any ? cost(sum, size) : 0;
    }
    for (uint32_t b = bins - 1; b > 0; b--) {
      if (used[b]) add(above, anyAbove, in[b]);
      if (!anyAbove) continue;
      const double c = factor * (belowCost[b - 1] + cost(above, size));
      if (belowCost[b - 1] > 0 && c < best) best = c, dimension = k, cut = b - 1;
    }
  }

  std::span<const LightBounds> lights_;
  std::vector<uint32_t>& order_;
};

} // namespace

void LightTree::build(std::span<const LightBounds> lights) {
  nodes_.clear();
  depth_ = 0;
  trails_.assign(lights.size(), {0, none});
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < lights.size(); i++)
    if (lights[i].intensity > 0 || lights[i].irradiance > 0) order.push_back(i);
  if (order.empty()) return;
  nodes_.reserve(2 * order.size() - 1);
  Builder builder(lights, order);
  std::vector<Range> left{{0, uint32_t(order.size()), none, 0, 0}};
  while (!left.empty()) { // depth first, the first child first: it follows its parent
    const Range range = left.back();
    left.pop_back();
    const auto number = uint32_t(nodes_.size());
    if (range.parent != none) nodes_[range.parent].next = number;
    Node node{lights[order[range.begin]], order[range.begin], range.end - range.begin == 1};
    for (uint32_t i = range.begin + 1; i < range.end; i++) unite(node.bounds, lights[order[i]]);
    nodes_.push_back(node);
    depth_ = std::max(depth_, range.steps);
    if (node.leaf) {
      trails_[node.next] = {range.bits, range.steps};
      continue;
    }
    const uint32_t middle = builder.split(range, node.bounds);
    left.push_back({middle, range.end, number, range.steps + 1, range.bits | uint64_t(1) << range.steps});
    left.push_back({range.begin, middle, none, range.steps + 1, range.bits});
  }
}

// cos(max(0, a - b)) of angles given by sine and cosine.
static float cosineLess(float sinA, float cosA, float sinB, float cosB) { return cosA > cosB ? 1.0f : cosA * cosB + sinA * sinB; }
static float sineLess(float sinA, float cosA, float sinB, float cosB) { return cosA > cosB ? 0.0f : sinA * cosB - cosA * sinB; }
static float sineOf(float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); }

// A bound of the irradiance at a place that faces where the light comes from most, up to the nearness of the box.
float LightTree::measure(const LightBounds& b, const float place[3], const float* normal, Side side) {
  constexpr float slack = 1e-5f; // of cosines: bounds must hold whatever rounds
  float way[3], square = 0, diagonal = 0, axial = 0;
  for (int k = 0; k < 3; k++) {
    const float middle = b.low[k] / 2 + b.high[k] / 2, size = b.high[k] - b.low[k];
    way[k] = place[k] - middle;
    square += way[k] * way[k], diagonal += size * size;
  }
  const float radius2 = diagonal / 4;
  if (b.reach < std::numeric_limits<float>::max()) {
    const float far = b.reach * (1 + 1e-5f) + std::sqrt(radius2);
    if (square > far * far) return 0;
  }
  // The cone about the box as seen from the place.
  const bool within = square <= radius2 * (1 + 1e-5f);
  const float distance = std::sqrt(square);
  const float sinBox = within ? 0.0f : std::sqrt(radius2 / square), cosBox = within ? -1.0f : sineOf(sinBox) - slack;
  float leaving = 1, arriving = 1;
  if (distance > 0 && !within) {
    if (b.cosineNormals > -1) {
      for (int k = 0; k < 3; k++) axial += way[k] * b.axis[k];
      float cosine = std::clamp(axial / distance, -1.0f, 1.0f);
      if (b.bothSides) cosine = std::fabs(cosine);
      const float sine = sineOf(cosine), sinNormals = sineOf(b.cosineNormals);
      const float cosX = cosineLess(sine, cosine, sinNormals, b.cosineNormals),
                  sinX = sineLess(sine, cosine, sinNormals, b.cosineNormals);
      leaving = cosineLess(sinX, cosX, sineOf(cosBox), cosBox);
      if (leaving < b.cosineBeyond - slack) return 0;
      leaving = std::max(leaving, slack);
    }
    if (normal) {
      float facing = 0;
      for (int k = 0; k < 3; k++) facing -= way[k] * normal[k];
      const float cosine = std::clamp(facing / distance, -1.0f, 1.0f);
      arriving = cosineLess(sineOf(cosine), cosine, sineOf(cosBox), cosBox);
      if (side == Side::only && arriving < -slack) return 0;
      arriving = std::max(arriving, side == Side::only ? slack : 0.1f);
    }
  }
  const float nearest = std::max(square, radius2);
  const float falling = nearest > 0 ? b.intensity / nearest : b.intensity;
  const float strength = std::min(falling + b.irradiance, 1e30f);
  return leaving * arriving * std::max(strength, 1e-30f);
}

LightTree::Choice LightTree::choose(const float place[3], const float* normal, double pick, Side side) const {
  if (nodes_.empty()) return {};
  uint32_t at = 0;
  double probability = 1;
  if (nodes_[0].leaf && !(measure(nodes_[0].bounds, place, normal, side) > 0)) return {};
  while (!nodes_[at].leaf) {
    const float first = measure(nodes_[at + 1].bounds, place, normal, side);
    const float second = measure(nodes_[nodes_[at].next].bounds, place, normal, side);
    const double sum = double(first) + second;
    if (!(sum > 0)) return {};
    const double share = first / sum;
    if (pick < share) {
      pick /= share, probability *= share;
      at = at + 1;
    } else {
      pick = (pick - share) / (1 - share), probability *= 1 - share;
      at = nodes_[at].next;
    }
    pick = std::min(pick, 1 - 0x1p-53);
  }
  return {nodes_[at].next, float(probability)};
}

float LightTree::probability(const float place[3], const float* normal, uint32_t light) const {
  if (nodes_.empty() || trails_[light].steps == none) return 0;
  Trail trail = trails_[light];
  uint32_t at = 0;
  double probability = 1;
  if (nodes_[0].leaf) return measure(nodes_[0].bounds, place, normal) > 0 ? 1.0f : 0.0f;
  for (; trail.steps > 0; trail.steps--, trail.bits >>= 1) {
    const float first = measure(nodes_[at + 1].bounds, place, normal);
    const float second = measure(nodes_[nodes_[at].next].bounds, place, normal);
    const double sum = double(first) + second;
    if (!(sum > 0)) return 0;
    const double share = first / sum;
    probability *= trail.bits & 1 ? 1 - share : share;
    at = trail.bits & 1 ? nodes_[at].next : at + 1;
  }
  return float(probability);
}

} // namespace openrt
