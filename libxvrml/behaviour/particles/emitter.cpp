// emitter.cpp: the six emitters.
#include "behaviour/particles/emitter.h"

#include <memory>

#include "behaviour/particles/facets.h"
#include "geometry/builders.h"
#include "xvrml/world.h"

namespace xvrml {
namespace {

using Start = Emitter::Start;
using StartFunction = std::function<Start(Draws&)>;

// Returns a direction: the given one, or any if it is 0 0 0.
V3d direction(const Vec3f& given, Draws& draws) {
  const V3d one = unit(toV3d(given));
  return one == V3d(0) ? draws.within(one, 0) : one;
}

StartFunction startOf(const nodes::PointEmitter& node) {
  return [place = toV3d(node.position), way = node.direction](Draws& draws) {
    return Start{place, direction(way, draws)};
  };
}

StartFunction startOf(const nodes::ExplosionEmitter& node) {
  return [place = toV3d(node.position)](Draws& draws) {
    return Start{place, draws.within(V3d(0), 0)};
  };
}

StartFunction startOf(const nodes::ConeEmitter& node) {
  const double angle = std::clamp(double(node.angle), 0.0, std::numbers::pi);
  return [place = toV3d(node.position), axis = toV3d(node.direction), angle](Draws& draws) {
    return Start{place, draws.within(axis, angle)};
  };
}

// The pieces of lines, and the sums of their lengths.
struct Lines {
  std::vector<std::pair<V3d, V3d>> pieces;
  std::vector<double> lengths;

  Lines(std::span<const Vec3f> points, const MFInt32& index) {
    for (size_t i = 0; i + 1 < index.size(); ++i) {
      const auto a = size_t(index[i]), b = size_t(index[i + 1]); // -1 is beyond all points
      if (a >= points.size() || b >= points.size()) continue;
      const V3d from = toV3d(points[a]), to = toV3d(points[b]);
      const double length = (to - from).length();
      if (!std::isfinite(length)) continue;
      pieces.emplace_back(from, to);
      lengths.push_back((lengths.empty() ? 0 : lengths.back()) + length);
    }
  }
  V3d draw(Draws& draws) const {
    const double at = draws.next() * lengths.back();
    const auto i =
        std::min(size_t(std::upper_bound(lengths.begin(), lengths.end(), at) - lengths.begin()),
                 pieces.size() - 1);
    return pieces[i].first + (pieces[i].second - pieces[i].first) * draws.next();
  }
};

StartFunction startOf(const nodes::PolylineEmitter& node) {
  const auto lines = std::make_shared<Lines>(coordinates(node.coord).points, node.coordIndex);
  if (lines->pieces.empty()) return {};
  return [lines, way = node.direction](Draws& draws) {
    const V3d place = lines->draw(draws);
    return Start{place, direction(way, draws)};
  };
}

StartFunction startOf(const nodes::SurfaceEmitter& node) {
  const auto surface = std::make_shared<Facets>(node.surface.get());
  if (surface->empty()) return {};
  return [surface](Draws& draws) {
    const Facets::Point point = surface->draw(draws);
    return Start{point.place, point.normal};
  };
}

StartFunction startOf(const nodes::VolumeEmitter& node, uint64_t& facets) {
  const auto surface = std::make_shared<Facets>(facetsOfFaces(node.coord, node.coordIndex));
  if (surface->empty()) return {};
  if (node.internal) facets = 8 * surface->all().size(); // for each point that is tried
  return [surface, within = node.internal, way = node.direction](Draws& draws) {
    const V3d place = within ? surface->drawWithin(draws) : surface->draw(draws).place;
    return Start{place, direction(way, draws)};
  };
}

double positive(float value) { return value > 0 && std::isfinite(value) ? double(value) : 0; }

template <class T> std::optional<Emitter> read(Node* node) {
  const auto* const given = nodeCast<T>(node);
  if (!given) return {};
  Emitter emitter;
  emitter.explodes = std::is_same_v<T, nodes::ExplosionEmitter>;
  emitter.speed = positive(given->speed);
  emitter.variation = positive(given->variation);
  emitter.mass = positive(given->mass);
  emitter.surfaceArea = positive(given->surfaceArea);
  if constexpr (std::is_same_v<T, nodes::VolumeEmitter>)
    emitter.start = startOf(*given, emitter.facets);
  else
    emitter.start = startOf(*given);
  return emitter;
}

template <class... T> std::optional<Emitter> readAny(Node* node) {
  std::optional<Emitter> found;
  (void)((found = read<T>(node)) || ...);
  return found;
}

} // namespace

std::optional<Emitter> emitterOf(Node* node) {
  using namespace nodes;
  auto found = readAny<PointEmitter, ExplosionEmitter, ConeEmitter, PolylineEmitter, SurfaceEmitter,
                       VolumeEmitter>(renderedNode(node));
  return found && found->start ? found : std::nullopt;
}

} // namespace xvrml
