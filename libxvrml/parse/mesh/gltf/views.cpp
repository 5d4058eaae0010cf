// views.cpp: cameras (glTF 2.0, 3.10) as Viewpoint and OrthoViewpoint.
#include <algorithm>
#include <cmath>

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

} // namespace xvrml::gltf
