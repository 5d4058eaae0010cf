#include "render/lights/photon_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/frame.h"

namespace openrt {
namespace {

constexpr uint32_t mostInCell = 24, fewestPhotons = 8;
// A lobe reaches as far as this neighbour among the places that the light of its cell came from.
constexpr size_t neighbour = 3;
// The narrowest and the widest lobe, as angles: 1 / sqrt(concentration).
constexpr double narrowest = 3e-4, widest = 1;

// A von Mises-Fisher distribution around an axis (N. I. Fisher, T. Lewis, B. J. J. Embleton,
// "Statistical Analysis of Spherical Data", 1987, 4.4.3). Values so small that they do not matter
// are 0.
struct Distribution {
  Vec3d axis;
  double concentration, beyond; // beyond: exp(-2 concentration)

  Distribution(const Vec3d& towards, double radius) {
    const double distance = length(towards);
    axis = distance > 0 ? towards / distance : Vec3d{0, 0, 1};
    const double width =
        distance > 0 ? std::clamp(radius / distance, narrowest, widest) : double(widest);
    concentration = 1 / (width * width);
    beyond = concentration < 20 ? std::exp(-2 * concentration) : 0; // else below 1e-17
  }
  double pdf(const Vec3d& direction) const {
    const Vec3d chord = direction - axis;
    const double exponent = concentration * dot(chord, chord) / 2;
    if (exponent > 60) return 0; // below 1e-26 of the largest value
    return concentration / (2 * M_PI * (1 - beyond)) * std::exp(-exponent);
  }
  Vec3f sample(float u, float v) const {
    const double height = -std::log(1 - double(u) * (1 - beyond)) / concentration, // 1 - cosine
        round = std::sqrt(std::max(0.0, height * (2 - height))), phi = 2 * M_PI * double(v);
    Vec3f s, t;
    basisOf(Vec3f(axis), s, t);
    const Vec3d direction =
        (1 - height) * axis + round * std::cos(phi) * Vec3d(s) + round * std::sin(phi) * Vec3d(t);
    return Vec3f(direction / length(direction));
  }
};

// Returns the distance from a place to the given neighbour among the others.
float distanceToNeighbour(const Photon* photons, uint32_t count, uint32_t of) {
  float nearest[neighbour]; // squared distances, ascending
  std::fill_n(nearest, neighbour, std::numeric_limits<float>::infinity());
  for (uint32_t i = 0; i < count; i++) {
    if (i == of) continue;
    const Vec3f apart = photons[i].from - photons[of].from;
    float square = dot(apart, apart);
    for (float& n : nearest)
      if (square < n) std::swap(square, n);
  }
  size_t last = std::min<size_t>(neighbour, count - 1);
  return last ? std::sqrt(nearest[last - 1]) : 0;
}

} // namespace

PhotonGuide::PhotonGuide(std::vector<Photon> photons) {
  std::erase_if(photons, [](const Photon& p) {
    return !(p.power > 0) || !std::isfinite(p.power) || !isFinite(p.position) || !isFinite(p.from);
  });
  if (photons.size() < fewestPhotons) return;
  build(photons, 0, uint32_t(photons.size()));
}

// Divides photons at the median of the longest axis. Returns the number of the node or cell, as in
// Node::child.
int32_t PhotonGuide::build(std::vector<Photon>& photons, uint32_t begin, uint32_t end) {
  if (end - begin <= mostInCell) return addCell(photons, begin, end);
  Vec3f low = photons[begin].position, high = low;
  for (uint32_t i = begin; i < end; i++) {
    low = min(low, photons[i].position);
    high = max(high, photons[i].position);
  }
  const Vec3f size = high - low;
  const uint32_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      photons.begin() + begin, photons.begin() + middle, photons.begin() + end,
      [axis](const Photon& a, const Photon& b) { return a.position[axis] < b.position[axis]; });
  const float split = photons[middle].position[axis];
  const auto node = int32_t(nodes_.size());
  nodes_.push_back({{0, 0}, axis, split});
  const int32_t below = build(photons, begin, middle), above = build(photons, middle, end);
  nodes_[size_t(node)].child[0] = below;
  nodes_[size_t(node)].child[1] = above;
  return node;
}

int32_t PhotonGuide::addCell(const std::vector<Photon>& photons, uint32_t begin, uint32_t end) {
  const Photon* own = photons.data() + begin;
  const uint32_t count = end - begin;
  Cell cell{uint32_t(lobes_.size()), uint32_t(lobes_.size()) + count, own[0].position,
            own[0].position};
  double power = 0;
  for (uint32_t i = 0; i < count; i++) {
    cell.low = min(cell.low, own[i].position);
    cell.high = max(cell.high, own[i].position);
    power += double(own[i].power);
  }
  // Light does not end at the outermost photon.
  const float size = length(cell.high - cell.low);
  const Vec3f margin{size / 2, size / 2, size / 2};
  cell.low -= margin;
  cell.high += margin;
  // An eighth of the samples goes to all photons alike, because weak ones may lead to light that is
  // strong elsewhere in the cell.
  const double mean = power / count, total = power + count * mean / 8;
  for (uint32_t i = 0; i < count; i++)
    lobes_.push_back({own[i].from, distanceToNeighbour(own, count, i),
                      float((double(own[i].power) + mean / 8) / total)});
  cells_.push_back(cell);
  return ~int32_t(cells_.size() - 1);
}

uint32_t PhotonGuide::find(const Vec3f& position) const {
  if (cells_.empty()) return none;
  int32_t at = nodes_.empty() ? ~0 : 0;
  while (at >= 0) {
    const Node& node = nodes_[size_t(at)];
    at = node.child[position[node.axis] < node.split ? 0 : 1];
  }
  const Cell& cell = cells_[size_t(~at)];
  for (size_t k = 0; k < 3; k++)
    if (!(position[k] >= cell.low[k] && position[k] <= cell.high[k])) return none;
  return uint32_t(~at);
}

float PhotonGuide::sample(uint32_t cell, const Vec3f& position, float pick, float u, float v,
                          Vec3f& direction) const {
  uint32_t i = cells_[cell].begin;
  float left = pick;
  while (i + 1 < cells_[cell].end && left >= lobes_[i].probability) left -= lobes_[i++].probability;
  const Distribution distribution(Vec3d(lobes_[i].from) - Vec3d(position),
                                  double(lobes_[i].radius));
  direction = distribution.sample(u, v);
  return pdf(cell, position, direction);
}

float PhotonGuide::pdf(uint32_t cell, const Vec3f& position, const Vec3f& direction) const {
  double sum = 0;
  for (uint32_t i = cells_[cell].begin; i < cells_[cell].end; i++)
    sum += double(lobes_[i].probability) *
           Distribution(Vec3d(lobes_[i].from) - Vec3d(position), double(lobes_[i].radius))
               .pdf(Vec3d(direction));
  return std::isfinite(sum) ? float(sum) : 0.0f;
}

} // namespace openrt
