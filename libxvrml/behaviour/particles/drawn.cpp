// drawn.cpp: writes the particles of a system into one geometry of a Shape.
#include "behaviour/particles/drawn.h"

#include <fmt/format.h>

#include "behaviour/particles/emitter.h"
#include "behaviour/particles/form.h"
#include "behaviour/particles/life.h"
#include "behaviour/particles/motion.h"
#include "nodes/registry.h"

namespace xvrml {
namespace {

constexpr uint64_t mostParticles = 1'000'000;
constexpr uint64_t mostCorners = 4'000'000; // all particles of a system together
// Triangles of surfaces that particles of a system are compared with.
constexpr uint64_t mostComparisons = 20'000'000;
constexpr uint64_t bytesOfCorner = 128; // in the geometry that is drawn, and in the next one
constexpr double farthest = 1e20;

// The particles of a system as arrays, one entry for each corner.
struct Arrays {
  MFVec3f points, normals;
  MFVec2f texCoords;
  MFVec4f texPlaces;
  MFFloat fogCoords;
  MFColorRGBA colors;
  MFInt32 indices;

  void add(const ParticleForm& form, const Motion& motion) {
    const auto first = int32_t(points.size());
    const V3d along = unit(motion.velocity) == V3d(0) ? V3d(0, 0, 1) : unit(motion.velocity);
    for (const V3d& point : form.points)
      points.push_back(toVec3f(motion.place + (form.isAlong ? along * point.z : point)));
    normals.insert(normals.end(), form.normals.begin(), form.normals.end());
    texPlaces.insert(texPlaces.end(), form.texPlaces.begin(), form.texPlaces.end());
    fogCoords.insert(fogCoords.end(), form.fogCoords.begin(), form.fogCoords.end());
    for (const uint32_t index : form.indices) indices.push_back(first + int32_t(index));
  }
};

template <class T> T& made(NodeRef& place) {
  auto* const node = new T();
  place = NodeRef(node);
  return *node;
}

void setColor(NodeRef& place, const Arrays& arrays, const ParticleRamps& ramps) {
  if (!ramps.hasColors()) return;
  if (ramps.hasAlphas()) {
    made<nodes::ColorRGBA>(place).color = arrays.colors;
    return;
  }
  MFColor& colors = made<nodes::Color>(place).color;
  for (const ColorRGBA& color : arrays.colors) colors.push_back({color.r, color.g, color.b});
}

// Sets what faces, lines and points have at each vertex.
template <class Set> void setVertices(Set& set, const Arrays& arrays, const ParticleRamps& ramps) {
  made<nodes::Coordinate>(set.coord).point = arrays.points;
  setColor(set.color, arrays, ramps);
  if (!arrays.fogCoords.empty()) made<nodes::FogCoordinate>(set.fogCoord).depth = arrays.fogCoords;
}

NodeRef faces(const ParticleForm& form, const Arrays& arrays, const ParticleRamps& ramps) {
  NodeRef geometry;
  auto& set = made<nodes::IndexedTriangleSet>(geometry);
  setVertices(set, arrays, ramps);
  if (!form.normals.empty()) made<nodes::Normal>(set.normal).vector = arrays.normals;
  set.normalPerVertex = !form.normals.empty();
  if (!form.texPlaces.empty())
    made<nodes::TextureCoordinate4D>(set.texCoord).point = arrays.texPlaces;
  else if (!form.texCoords.empty())
    made<nodes::TextureCoordinate>(set.texCoord).point = arrays.texCoords;
  set.index = arrays.indices;
  set.solid = form.solid;
  set.ccw = form.ccw;
  return geometry;
}

NodeRef lines(const Arrays& arrays, const ParticleRamps& ramps) {
  NodeRef geometry;
  auto& set = made<nodes::IndexedLineSet>(geometry);
  setVertices(set, arrays, ramps);
  for (size_t i = 0; i + 1 < arrays.indices.size(); i += 2)
    set.coordIndex.insert(set.coordIndex.end(), {arrays.indices[i], arrays.indices[i + 1], -1});
  return geometry;
}

NodeRef points(const Arrays& arrays, const ParticleRamps& ramps) {
  NodeRef geometry;
  auto& set = made<nodes::PointSet>(geometry);
  setVertices(set, arrays, ramps);
  return geometry;
}

NodeRef geometryOf(const ParticleForm& form, const Arrays& arrays, const ParticleRamps& ramps) {
  if (form.kind == Mesh::Kind::points) return points(arrays, ramps);
  return form.kind == Mesh::Kind::lines ? lines(arrays, ramps) : faces(form, arrays, ramps);
}

Motion motionOf(const LivingParticle& particle, const Emitter& emitter,
                const ParticlePhysics& physics) {
  Draws birth(particle.key, Stream::birth), body(particle.key, Stream::body);
  const Emitter::Start start = emitter.start(birth);
  const double speed = body.around(emitter.speed, emitter.variation);
  const double mass = body.around(emitter.mass, emitter.variation);
  const double area = body.around(emitter.surfaceArea, emitter.variation);
  const V3d acceleration = mass > 0 ? physics.force(particle.key, area) / mass : V3d(0);
  return physics.after({start.place, start.direction * speed}, acceleration, particle.age);
}

float usable(float value) { return value > 0 && std::isfinite(value) ? value : 0; }

ParticleRoom roomFor(const nodes::ParticleSystem& system, const ParticleForm& form,
                     const std::optional<Emitter>& emitter, const ParticlePhysics& physics) {
  const uint64_t corners = std::max<uint64_t>({form.points.size(), form.indices.size(), 1});
  const uint64_t facets = physics.facets() + (emitter ? emitter->facets : 0);
  ParticleRoom room{uint32_t(std::max(system.maxParticles, 0)), corners * bytesOfCorner, {}};
  const auto bound = [&](uint64_t most, const std::string& limit) {
    if (room.count <= most) return;
    room.count = uint32_t(most);
    room.limit = limit;
  };
  bound(mostParticles, fmt::format("a system has at most {} particles", mostParticles));
  bound(mostCorners / corners,
        fmt::format("the particles of a system have at most {} corners", mostCorners));
  if (facets > 0)
    bound(mostComparisons / facets,
          fmt::format("particles are compared with at most {} triangles of surfaces",
                      mostComparisons));
  return room;
}

} // namespace

ParticleRoom roomOf(const nodes::ParticleSystem& system) {
  return roomFor(system, formOf(system, {}), emitterOf(system.emitter.get()),
                 ParticlePhysics(system.physics));
}

NodeRef expandParticleSystem(const Node& node) {
  const auto* const system = dynamic_cast<const TimedParticleSystem*>(&node);
  if (!system) return {};
  const ParticleClock& clock = system->clock;
  const ParticleForm form = formOf(*system, clock);
  const std::optional<Emitter> emitter = emitterOf(system->emitter.get());
  const ParticlePhysics physics(system->physics);
  const ParticleRamps ramps(*system);
  LifeOfParticles life;
  if (emitter && system->enabled && !form.points.empty()) {
    life = {std::min(roomFor(*system, form, emitter, physics).count, clock.most),
            usable(system->particleLifetime), std::min(usable(system->lifetimeVariation), 1.0f),
            emitter->explodes, mixed(system->defName)};
  }
  Arrays arrays;
  for (const LivingParticle& particle : livingParticles(life, clock)) {
    const Motion motion = motionOf(particle, *emitter, physics);
    if (!(motion.place.length() < farthest)) continue;
    arrays.add(form, motion);
    const auto corners = form.isQuad ? ramps.corners(particle) : std::span(form.texCoords);
    arrays.texCoords.insert(arrays.texCoords.end(), corners.begin(), corners.end());
    if (!ramps.hasColors()) continue;
    const Color4 color = ramps.color(particle);
    arrays.colors.insert(arrays.colors.end(), form.points.size(),
                         {color.r, color.g, color.b, color.a});
  }
  NodeRef shape;
  auto& drawn = made<nodes::Shape>(shape);
  drawn.appearance = system->appearance;
  drawn.geometry = geometryOf(form, arrays, ramps);
  drawn.visible = system->visible;
  return shape;
}

} // namespace xvrml
