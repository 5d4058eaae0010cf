#include "libpicture/material_ball.h"

#include "libpicture/bare_model.h"
#include "xvrml/nodes.h"

namespace picture {

std::vector<uint8_t> drawMaterialBall(const xvrml::NodeRef& appearance, int side,
                                      const std::string& shaderPath,
                                      const ProgressCallback& watch) {
  const std::unique_ptr<xvrml::World> world = xvrml::loadWorldFromMemory(
      "#VRML V2.0 utf8\nDEF BALL Shape { geometry Sphere { } }\n", "ball.wrl");
  xvrml::nodeCast<xvrml::nodes::Shape>(world->scope.names.at("BALL"))->appearance = appearance;
  RenderSettings settings;
  settings.width = settings.height = side;
  settings.samples = 48;
  settings.threads = 1;
  settings.shaderPath = shaderPath;
  choose(Look::studio, settings);
  View view;
  view.side = Side::threeQuarter;
  view.up = xvrml::Axis::y;
  const RenderResult result = Renderer(*world, settings, watch).render(view);
  return result.interrupted ? std::vector<uint8_t>() : displayBytes(result.picture);
}

} // namespace picture
