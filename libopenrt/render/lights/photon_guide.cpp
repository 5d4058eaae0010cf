#include "render/lights/photon_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/orthonormal_basis.h"

namespace openrt {
namespace {

constexpr uint32_t mostInCell = 24, fewestPhotons = 8;
// A lobe is as wide as the error with which it predicts the direction of its photon's neighbour of
// this number, in the order of these errors.
constexpr size_t neighbour = 3;
// Bounds of a lobe's spread.
constexpr float narrowest = 1e-8f, widest = .5f;
// Places farther away than this are not usable, because their squares would overflow.
constexpr float farthest = 1e18f;

// A lobe about an axis. With h = 1 - cosine of the angle to the axis, its solid-angle pdf is
//   spread (spread + 2) / (4 pi (spread + h)^2).
// Half of the samples of a narrow lobe have h < spread. It has the longer tails of Student's t, and
// costs no exponential function: it is evaluated for each photon of a cell at every hit.
struct Distribution {
  Vec3f axis;
  float spread;

  Distribution(const Vec3f& towards, float side, float s) : spread(s) {
    const float square = dot(towards, towards), inverse = side / std::sqrt(square > 0 ? square : 1);
    axis = {towards.x * inverse, towards.y * inverse, square > 0 ? towards.z * inverse : 1};
  }
  float pdf(const Vec3f& direction) const {
    const Vec3f chord = direction - axis;
    const float reach = spread + dot(chord, chord) / 2;
    return spread * (spread + 2) / (4 * std::numbers::pi_v<float> * reach * reach);
  }
  Vec3f sample(float u, float v) const {
    const double a = double(spread), h = 2 * a * double(u) / (a + 2 - 2 * double(u)),
                 round = std::sqrt(std::max(0.0, h * (2 - h))), phi = 2 * M_PI * double(v);
    Vec3f s, t;
    basisOf(axis, s, t);
    const Vec3d direction =
        (1 - h) * Vec3d(axis) + round * std::cos(phi) * Vec3d(s) + round * std::sin(phi) * Vec3d(t);
    return Vec3f(direction / length(direction));
  }
};

// A point that the light of photons comes from, or goes to.
struct Focus {
  Vec3f place;
  float side, spread;
};

// Returns the focus at a distance along the light of a photon; beyond it, if the distance is below
// 0. Its spread follows from how well it predicts the directions of the other photons.
Focus focusAt(const Photon* photons, uint32_t count, uint32_t of, float distance) {
  Focus focus{photons[of].position + distance * photons[of].direction, distance > 0 ? 1.f : -1.f,
              0};
  float error[neighbour]; // 1 - cosine of the angle, ascending
  std::fill_n(error, neighbour, widest);
  for (uint32_t i = 0; i < count; i++) {
    if (i == of) continue;
    const Vec3f chord =
        photons[i].direction - Distribution(focus.place - photons[i].position, focus.side, 0).axis;
    float next = dot(chord, chord) / 2;
    for (float& e : error)
      if (next < e) std::swap(next, e);
  }
  focus.spread = std::max(error[std::min<size_t>(neighbour, count - 1) - 1], narrowest);
  return focus;
}

// Returns the best focus for the light of a photon. Candidates:
// * the emitter, seen in flat mirrors;
// * the place on the specular surface, from which the light of curved ones spreads;
// * real images between the two surfaces, and beyond the photon.
Focus focusOf(const Photon* photons, uint32_t count, uint32_t of) {
  const Photon& p = photons[of];
  const float distances[] = {p.total, p.last, p.last / 2, p.last / 4, -p.last / 2, -2 * p.last};
  Focus best = focusAt(photons, count, of, distances[0]);
  for (size_t d = 1; d < std::size(distances); d++) {
    const Focus next = focusAt(photons, count, of, distances[d]);
    if (next.spread < best.spread) best = next;
  }
  return best;
}

} // namespace

PhotonGuide::PhotonGuide(std::vector<Photon> photons) {
  const auto usable = [](const Photon& p) {
    return p.power > 0 && std::isfinite(p.power) && largest(abs(p.position)) < farthest &&
           p.last > 0 && p.last <= p.total && p.total < farthest && isFinite(p.position) &&
           std::fabs(dot(p.direction, p.direction) - 1) < 1e-3f;
  };
  std::erase_if(photons, [&](const Photon& p) { return !usable(p); });
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
  const auto first = uint32_t(probability_.size());
  Cell cell{first, first + count, own[0].position, own[0].position, 1};
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
  for (uint32_t i = 0; i < count; i++) {
    const Focus focus = focusOf(own, count, i);
    for (size_t k = 0; k < 3; k++) focus_[k].push_back(focus.place[k]);
    side_.push_back(focus.side);
    spread_.push_back(focus.spread);
    probability_.push_back(float((double(own[i].power) + mean / 8) / total));
  }
  cells_.push_back(cell);
  return ~int32_t(cells_.size() - 1);
}

void PhotonGuide::setShares(const std::vector<float>& shares) {
  for (size_t c = 0; c < cells_.size(); c++) cells_[c].share = shares[c];
  if (std::none_of(shares.begin(), shares.end(), [](float s) { return s > 0; })) cells_.clear();
}

uint32_t PhotonGuide::find(const Vec3f& position) const {
  if (cells_.empty()) return none;
  int32_t at = nodes_.empty() ? ~0 : 0;
  while (at >= 0) {
    const Node& node = nodes_[size_t(at)];
    at = node.child[position[node.axis] < node.split ? 0 : 1];
  }
  const Cell& cell = cells_[size_t(~at)];
  if (!(cell.share > 0)) return none;
  for (size_t k = 0; k < 3; k++)
    if (!(position[k] >= cell.low[k] && position[k] <= cell.high[k])) return none;
  return uint32_t(~at);
}

float PhotonGuide::sample(uint32_t cell, const Vec3f& position, float pick, float u, float v,
                          Vec3f& direction) const {
  uint32_t i = cells_[cell].begin;
  float left = pick;
  while (i + 1 < cells_[cell].end && left >= probability_[i]) left -= probability_[i++];
  const Vec3f focus{focus_[0][i], focus_[1][i], focus_[2][i]};
  direction = Distribution(focus - position, side_[i], spread_[i]).sample(u, v);
  return pdf(cell, position, direction);
}

// The compiler makes vector code of the loop.
float PhotonGuide::pdf(uint32_t cell, const Vec3f& position, const Vec3f& direction) const {
  const uint32_t begin = cells_[cell].begin, count = cells_[cell].end - begin;
  const float *x = focus_[0].data() + begin, *y = focus_[1].data() + begin,
              *z = focus_[2].data() + begin, *side = side_.data() + begin,
              *spread = spread_.data() + begin, *probability = probability_.data() + begin;
  float share[mostInCell];
  for (uint32_t i = 0; i < count; i++) {
    const Vec3f focus{x[i], y[i], z[i]};
    share[i] = probability[i] * Distribution(focus - position, side[i], spread[i]).pdf(direction);
  }
  float sum = 0;
  for (uint32_t i = 0; i < count; i++) sum += share[i];
  return sum * cells_[cell].share;
}

} // namespace openrt
