// motion.cpp: forces, wind, parabolas, and where they meet triangles.
#include "behaviour/particles/motion.h"

#include "xvrml/world.h"

namespace xvrml {
namespace {

// A particle that has met surfaces this often stays where it meets the next one.
constexpr int mostBounces = 32;

Motion moved(const Motion& start, const V3d& acceleration, double seconds) {
  return {start.place + start.velocity * seconds + acceleration * (seconds * seconds / 2),
          start.velocity + acceleration * seconds};
}

// Returns whether a point of the plane of a facet is within it. Facets overlap by a billionth of
// their edges, so that nothing passes between two.
bool isWithin(const Facet& facet, const V3d& point) {
  for (size_t k = 0; k < 3; ++k) {
    const V3d& corner = facet.corners[k];
    const V3d edge = facet.corners[(k + 1) % 3] - corner;
    if (facet.normal.dot(edge.cross(point - corner)) < -1e-9 * edge.length2()) return false;
  }
  return true;
}

// Returns the times at which a t^2 + b t + c is 0; NaN: there is none.
std::pair<double, double> roots(double a, double b, double c) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (c == 0) return {a == 0 ? none : -b / a, none}; // and 0, where it begins
  if (a == 0) return {b == 0 ? none : -c / b, none};
  const double square = b * b - 4 * a * c;
  if (!(square >= 0)) return {none, none};
  const double q = -(b + std::copysign(std::sqrt(square), b)) / 2;
  return {q / a, q == 0 ? none : c / q};
}

} // namespace

ParticlePhysics::ParticlePhysics(const MFNode& models) {
  for (size_t i = 0; i < models.size(); ++i) {
    Node* const model = renderedNode(models[i].get());
    if (const auto* force = nodeCast<nodes::ForcePhysicsModel>(model); force && force->enabled) {
      if (isFinite(force->force)) constant_ += toV3d(force->force);
    } else if (const auto* wind = nodeCast<nodes::WindPhysicsModel>(model); wind && wind->enabled) {
      const double speed = isFinite(wind->speed) ? double(wind->speed) : 0;
      const double gustiness = isFinite(wind->gustiness) ? double(wind->gustiness) : 0;
      const double turbulence = std::clamp(double(wind->turbulence), 0.0, 1.0);
      winds_.push_back({toV3d(wind->direction), speed, gustiness,
                        std::isfinite(turbulence) ? std::numbers::pi * turbulence : 0, i});
    } else if (const auto* bounds = nodeCast<nodes::BoundedPhysicsModel>(model);
               bounds && bounds->enabled) {
      const Facets facets(bounds->geometry.get());
      bounds_.insert(bounds_.end(), facets.all().begin(), facets.all().end());
    }
  }
}

// The pressure of wind is 10^(2 log10 v) 0.64615, which is 0.64615 v^2 newtons on a square metre
// (40.4.10).
V3d ParticlePhysics::force(uint64_t particle, double surfaceArea) const {
  V3d sum = constant_;
  for (const Wind& wind : winds_) {
    Draws draws(particle, Stream::physics, wind.number);
    const double speed = draws.around(wind.speed, wind.gustiness);
    sum += draws.within(wind.direction, wind.angle) * (0.64615 * speed * speed * surfaceArea);
  }
  return sum;
}

Motion ParticlePhysics::after(const Motion& start, const V3d& acceleration, double seconds) const {
  Motion motion = start;
  for (int bounces = 0; !bounds_.empty(); ++bounces) {
    const Hit hit = nextHit(motion, acceleration, seconds);
    if (!hit.facet) break;
    motion = moved(motion, acceleration, hit.seconds);
    // exactly into the plane, so that the next piece of the way begins there
    motion.place += hit.facet->normal * hit.facet->normal.dot(hit.facet->corners[0] - motion.place);
    if (bounces == mostBounces) return {motion.place, V3d(0)};
    motion.velocity -= hit.facet->normal * (2 * hit.facet->normal.dot(motion.velocity));
    seconds -= hit.seconds;
  }
  return moved(motion, acceleration, seconds);
}

// Finds the first triangle that the way meets. It does not meet the plane that it begins in at
// once.
ParticlePhysics::Hit ParticlePhysics::nextHit(const Motion& motion, const V3d& acceleration,
                                              double seconds) const {
  Hit first{seconds};
  for (const Facet& facet : bounds_) {
    double height = facet.normal.dot(motion.place - facet.corners[0]);
    const double size = motion.place.length() + facet.corners[0].length();
    if (std::abs(height) <= 1e-12 * size) height = 0;
    const auto [one, other] =
        roots(facet.normal.dot(acceleration) / 2, facet.normal.dot(motion.velocity), height);
    for (const double at : {one, other})
      if (at > 0 && at <= first.seconds && isWithin(facet, moved(motion, acceleration, at).place) &&
          (at < first.seconds || !first.facet))
        first = {at, &facet};
  }
  return first;
}

} // namespace xvrml
