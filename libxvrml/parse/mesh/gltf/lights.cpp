// lights.cpp: the lights of KHR_lights_punctual as DirectionalLight, PointLight and SpotLight.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>

#include "parse/mesh/gltf/materials.h"
#include "parse/mesh/gltf/scene.h"

namespace xvrml::gltf {

using Imath::M33d;
using Imath::M44d;
using Imath::V3d;

namespace {

constexpr double brightest = 1e30; // a float

Color lightColor(const Item& light) {
  const auto rgb = light.numbers("color", 3);
  if (rgb.empty()) return {1, 1, 1};
  const auto part = [&](size_t i) { return float(std::clamp(rgb[i], 0.0, 1.0)); };
  return encoded({part(0), part(1), part(2)});
}

// The coordinate system that a light with a place gets. The scale of its node changes no property
// of a glTF light (KHR_lights_punctual, Adding Light Instances to Nodes), but distances of a
// PointLight and a SpotLight are those of its coordinate system (ISO/IEC 14772-1 6.35, 6.45).
struct Frame {
  explicit Frame(const M44d& world);

  double scale = 1;   // metres to a unit, the same in all directions
  bool isEven = true; // false: a Transform with `evening` comes between the node and the light
  M44d evening;       // row vectors
  Vec3f direction{0, 0, -1}; // the node's -z
};

// The linear part of a matrix is U S V^T. After U S^-1 U^T it is the orthogonal U V^T.
Frame::Frame(const M44d& world) {
  M33d linear, u, v;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) linear[i][k] = world[i][k];
  V3d s;
  Imath::jacobiSVD(linear, u, s, v, std::numeric_limits<double>::epsilon(), true);
  const double greatest = std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  if (!(greatest > 0) || !std::isfinite(greatest)) return;
  for (int i = 0; i < 3; ++i) s[i] = std::max(std::abs(s[i]), flatness * greatest);
  constexpr double same = 1e-5, one = 1e-6; // matrices of many floats are no better
  scale = std::cbrt(s.x) * std::cbrt(s.y) * std::cbrt(s.z);
  isEven = std::all_of(&s.x, &s.x + 3, [&](double x) { return std::abs(x / scale - 1) < same; });
  if (std::abs(scale - 1) < one) scale = 1;
  if (isEven) return;
  const M33d sizes(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z);
  const M33d back(scale / s.x, 0, 0, 0, scale / s.y, 0, 0, 0, scale / s.z);
  const M33d even = u * back * u.transposed();
  evening = M44d(even, V3d(0));
  const V3d to = (V3d(0, 0, -1) * (u * sizes * u.transposed())).normalized();
  direction = {float(to.x), float(to.y), float(to.z)};
}

// Light decreases with the square of the distance. `range` ends it; without one it never ends. The
// light stays as it is within a metre or a unit, whichever is less, because the attenuation of a
// node never makes light brighter.
void setPlaced(NodeStream& out, const Item& light, double candela, const Frame& frame) {
  const double square = frame.scale * frame.scale;
  out.set("intensity", float(std::min(candela * std::max(1.0, 1 / square), brightest)));
  out.set("attenuation", Vec3f{0, 0, float(std::min(std::max(1.0, square), brightest))});
  constexpr double endless = 1e9; // metres
  const double range = light.has("range") ? std::max(0.0, light.number("range", 1)) : endless;
  out.set("radius", float(std::min(range / frame.scale, brightest)));
}

void setCone(NodeStream& out, const Item& cone, const Frame& frame) {
  const double half = std::numbers::pi / 2;
  const double outer = std::clamp(cone.number("outerConeAngle", half / 2), 1e-3, half);
  const double inner = std::clamp(cone.number("innerConeAngle", 0), 1e-3, outer);
  out.set("cutOffAngle", float(outer));
  out.set("beamWidth", float(inner));
  if (!frame.isEven) out.set("direction", frame.direction);
}

} // namespace

// Candela and lux stay as they are: PhysicalMaterial takes an intensity as an irradiance, and
// lights of X3D 4 have no upper limit.
void writeLight(NodeStream& out, const Item& light, const M44d& world) {
  if (!light) return;
  const std::string type = light.text("type");
  const bool spot = type == "spot", placed = spot || type == "point";
  if (!placed && type != "directional")
    return light.error("the light has no type that is known (directional, point, spot)");
  const Frame frame = placed ? Frame(world) : Frame(M44d());
  if (!frame.isEven) {
    out.open("Transform");
    writeMatrix(out, frame.evening);
    out.openField("children");
  }
  out.open(spot     ? "SpotLight"
           : placed ? "PointLight"
                    : "DirectionalLight",
           out.define(light.text("name"), "Light"));
  out.set("color", lightColor(light));
  const double strength = std::clamp(light.number("intensity", 1), 0.0, brightest);
  if (placed)
    setPlaced(out, light, strength, frame);
  else
    out.set("intensity", float(strength));
  out.set("global", true);
  if (spot) setCone(out, light.object("spot"), frame);
  out.close();
  if (frame.isEven) return;
  out.closeField();
  out.close();
}

} // namespace xvrml::gltf
