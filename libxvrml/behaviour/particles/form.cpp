// form.cpp: quads, lines, points and meshes for particles, and their ramps.
#include "behaviour/particles/form.h"

#include <algorithm>

#include "behaviour/blend.h"
#include "behaviour/keys.h"
#include "behaviour/particles/facets.h"
#include "geometry/sphere_facets.h"

namespace xvrml {
namespace {

constexpr uint32_t sphereRows = 8; // facets of a Sphere as a particle, from pole to pole
constexpr Vec2f wholeTexture[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

float length(float given) { return given > 0 && std::isfinite(given) ? given : 0; }

ParticleForm quad(const V3d& right, const V3d& up) {
  ParticleForm form;
  form.points = {-right - up, right - up, right + up, up - right};
  const Vec3f normal = toVec3f(unit(right.cross(up)));
  form.normals.assign(4, normal);
  form.texCoords.assign(std::begin(wholeTexture), std::end(wholeTexture));
  form.indices = {0, 1, 2, 0, 2, 3};
  form.isQuad = true;
  return form;
}

ParticleForm formOfGeometry(Node* geometry) {
  ParticleForm form;
  if (!geometry) return form;
  Limits limits;
  limits.triangles = Facets::most;
  MeshOptions options;
  options.limits = &limits;
  options.needTexCoords = true;
  Mesh mesh = buildMesh(*geometry, options);
  facetSphere(mesh, sphereRows);
  if (mesh.kind == Mesh::Kind::empty) return form;
  form.kind = mesh.kind;
  for (const Vec3f& point : mesh.points) form.points.push_back(toV3d(point));
  form.normals.assign(mesh.normals.begin(), mesh.normals.end());
  form.texCoords.assign(mesh.texCoords.begin(), mesh.texCoords.end());
  form.texPlaces.assign(mesh.texPlaces.begin(), mesh.texPlaces.end());
  form.fogCoords.assign(mesh.fogCoords.begin(), mesh.fogCoords.end());
  form.indices.assign(mesh.indices.begin(), mesh.indices.end());
  form.solid = mesh.solid;
  form.ccw = mesh.ccw;
  return form;
}

// Returns the argument for keys: they are seconds (40.4.5), but parts of a life where all are at
// most 1, as files by X_ITE and Titania have them.
float argument(std::span<const float> keys, const LivingParticle& particle) {
  const bool seconds = std::any_of(keys.begin(), keys.end(), [](float key) { return key > 1; });
  return float(seconds ? particle.age : particle.age / particle.life);
}

} // namespace

bool isKnownForm(std::string_view type) {
  constexpr std::string_view known[] = {"QUAD", "SPRITE", "TRIANGLE", "LINE", "POINT", "GEOMETRY"};
  return std::find(std::begin(known), std::end(known), type) != std::end(known);
}

ParticleForm formOf(const nodes::ParticleSystem& system, const ParticleClock& clock) {
  const double width = length(system.particleSize.x), height = length(system.particleSize.y);
  const std::string& type = system.geometryType;
  if (type == "GEOMETRY") return formOfGeometry(system.geometry.get());
  if (type == "SPRITE")
    return quad(toV3d(clock.right) * (width / 2), toV3d(clock.up) * (height / 2));
  if (type != "POINT" && type != "LINE") return quad({width / 2, 0, 0}, {0, height / 2, 0});
  ParticleForm form;
  form.kind = type == "POINT" ? Mesh::Kind::points : Mesh::Kind::lines;
  form.isAlong = type == "LINE";
  if (form.isAlong) {
    form.points = {{0, 0, -height / 2}, {0, 0, height / 2}};
    form.indices = {0, 1};
  } else {
    form.points = {{0, 0, 0}};
    form.indices = {0};
  }
  return form;
}

ParticleRamps::ParticleRamps(const nodes::ParticleSystem& system)
    : colors_(colorValues(system.colorRamp)), corners_(textureCoordinates(system.texCoordRamp)) {
  colorKeys_ =
      std::span(system.colorKey).first(std::min(system.colorKey.size(), colors_.rgb.size()));
  cornerKeys_ = std::span(system.texCoordKey)
                    .first(std::min(system.texCoordKey.size(), corners_.points.size() / 4));
}

Color4 ParticleRamps::color(const LivingParticle& particle) const {
  const auto [left, t] =
      locate(colorKeys_.data(), colorKeys_.size(), argument(colorKeys_, particle));
  const Color at = t > 0 ? blend(colors_.rgb[left], colors_.rgb[left + 1], t) : colors_.rgb[left];
  const auto& alphas = colors_.alphas;
  const float alpha = alphas.empty() ? 1
                      : t > 0        ? blend(alphas[left], alphas[left + 1], t)
                                     : alphas[left];
  return {at.r, at.g, at.b, alpha};
}

std::span<const Vec2f> ParticleRamps::corners(const LivingParticle& particle) const {
  if (cornerKeys_.empty()) return wholeTexture;
  const size_t left =
      locate(cornerKeys_.data(), cornerKeys_.size(), argument(cornerKeys_, particle)).left;
  return corners_.points.subspan(4 * left, 4);
}

} // namespace xvrml
