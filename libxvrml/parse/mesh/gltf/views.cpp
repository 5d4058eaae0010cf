// views.cpp: cameras (glTF 2.0, 3.10) as Viewpoint and OrthoViewpoint, and the lights of
// KHR_lights_punctual.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "parse/mesh/gltf/materials.h"
#include "parse/mesh/gltf/scene.h"

namespace xvrml::gltf {

// fieldOfView is the angle of the smaller side of the picture (ISO/IEC 19775-1 23.4.6). yfov is
// that of the height, which is the smaller side unless aspectRatio is below 1.
static float fieldOfView(const Item& perspective) {
  const double y = std::clamp(perspective.number("yfov", 0.8), 0.01, 3.0);
  const double aspect = perspective.number("aspectRatio", 1);
  if (!(aspect > 0 && aspect < 1)) return float(y);
  return float(2 * std::atan(aspect * std::tan(y / 2)));
}

void writeCamera(NodeStream& out, const Item& camera) {
  if (!camera) return;
  const std::string name = camera.text("name");
  const bool ortho = camera.text("type") == "orthographic";
  if (ortho && !out.knows("OrthoViewpoint"))
    camera.warn("orthographic cameras are not supported: a perspective one stands for it");
  const bool parallel = ortho && out.knows("OrthoViewpoint");
  out.open(parallel ? "OrthoViewpoint" : "Viewpoint", out.define(name, "Camera"));
  out.set("description", name.empty() ? std::string("Camera") : name);
  out.set("position", Vec3f{0, 0, 0});
  if (parallel) {
    const Item size = camera.object("orthographic");
    const float x = float(std::abs(size.number("xmag", 1))),
                y = float(std::abs(size.number("ymag", 1)));
    out.set("fieldOfView", MFFloat{-x, -y, x, y});
  } else if (!ortho) {
    out.set("fieldOfView", fieldOfView(camera.object("perspective")));
  }
  out.close();
}

static Color lightColor(const Item& light) {
  const auto rgb = light.numbers("color", 3);
  if (rgb.empty()) return {1, 1, 1};
  const auto part = [&](size_t i) { return float(std::clamp(rgb[i], 0.0, 1.0)); };
  return encoded({part(0), part(1), part(2)});
}

namespace {

// Light decreases with the square of the distance. `range` ends it; without one it never ends.
void setPlaced(NodeStream& out, const Item& light) {
  out.set("attenuation", Vec3f{0, 0, 1});
  out.set("radius", float(light.has("range") ? std::max(0.0, light.number("range", 1)) : 1e9));
}

void setCone(NodeStream& out, const Item& cone) {
  const double half = std::numbers::pi / 2;
  const double outer = std::clamp(cone.number("outerConeAngle", half / 2), 1e-3, half);
  const double inner = std::clamp(cone.number("innerConeAngle", 0), 1e-3, outer);
  out.set("cutOffAngle", float(outer));
  out.set("beamWidth", float(inner));
}

} // namespace

void writeLight(NodeStream& out, const Item& light) {
  if (!light) return;
  const std::string type = light.text("type");
  const bool spot = type == "spot", placed = spot || type == "point";
  if (!placed && type != "directional")
    return light.error("the light has no type that is known (directional, point, spot)");
  // Candela and lux as they are: PhysicalMaterial takes an intensity as an irradiance, and lights
  // of X3D 4 have no upper limit.
  constexpr double brightest = 1e30; // a float
  out.open(spot     ? "SpotLight"
           : placed ? "PointLight"
                    : "DirectionalLight",
           out.define(light.text("name"), "Light"));
  out.set("color", lightColor(light));
  out.set("intensity", float(std::clamp(light.number("intensity", 1), 0.0, brightest)));
  if (placed) setPlaced(out, light);
  out.set("global", true);
  if (spot) setCone(out, light.object("spot"));
  out.close();
}

} // namespace xvrml::gltf
