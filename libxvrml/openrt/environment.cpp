// environment.cpp: Background and Fog as the class VRML97Environment. Clauses 6.5 and 6.19. See views.h.
#include "openrt/views.h"

#include "xvrml/nodes.h"

namespace xvrml::mapping {
namespace {

void setColors(ShaderSetup& shader, const char* name, const MFColor& colors, bool linear) {
  std::vector<float> floats;
  floats.reserve(3 * colors.size());
  for (const Color& color : colors) {
    const Color c = convert(color, linear);
    floats.insert(floats.end(), {c.r, c.g, c.b});
  }
  shader.floats(name, floats);
}

struct Picture {
  const char* name;
  const MFString nodes::Background::*urls;
};
constexpr Picture pictures[] = {
    {"frontTexture", &nodes::Background::frontUrl}, {"backTexture", &nodes::Background::backUrl},
    {"leftTexture", &nodes::Background::leftUrl},   {"rightTexture", &nodes::Background::rightUrl},
    {"topTexture", &nodes::Background::topUrl},     {"bottomTexture", &nodes::Background::bottomUrl},
};

void setBackground(ShaderSetup& shader, const nodes::Background& node, bool linear, const RTid (&textures)[6]) {
  setColors(shader, "skyColor", node.skyColor, linear);
  shader.floats("skyAngle", node.skyAngle);
  setColors(shader, "groundColor", node.groundColor, linear);
  shader.floats("groundAngle", node.groundAngle);
  for (int i = 0; i < 6; ++i)
    if (textures[i] != 0) shader.texture(pictures[i].name, textures[i]);
}

// Clause 6.19: distances are measured in the fog's own coordinate system.
void setFog(World& world, ShaderSetup& shader, const nodes::Fog& fog, const Matrix& fogToWorld, const Matrix& environment,
            bool linear) {
  if (!(fog.visibilityRange > 0)) return;
  const bool exponential = fog.fogType == "EXPONENTIAL";
  if (!exponential && fog.fogType != "LINEAR")
    world.diagnostics.warn(fog.source, "Fog: fogType \"" + fog.fogType + "\" is neither LINEAR nor EXPONENTIAL; LINEAR is used");
  Matrix toFog;
  if (!invert(fogToWorld, toFog)) return;
  shader.integer("fogType", exponential ? 2 : 1);
  shader.color("fogColor", convert(fog.color, linear));
  shader.number("fogRange", fog.visibilityRange);
  shader.matrix("fogMatrix", compose(toFog, environment));
}

} // namespace

void useEnvironment(World& world, bool linearColor, const Graph& graph, const Places& places, const Bound& bound,
                    ShaderClasses& classes, Textures& textures) {
  if (bound.background == none && bound.fog == none) return;
  const auto place = [&](int32_t index) -> const Place& { return places.all[size_t(index)]; };
  const auto node = [&](int32_t index) { return graph.items[place(index).item].node; };
  RTid images[6] = {};
  const nodes::Background* background = bound.background == none ? nullptr : nodeCast<nodes::Background>(node(bound.background));
  for (int i = 0; background && i < 6; ++i) images[i] = textures.ofUrls(background->*pictures[i].urls, *background, false, false);
  const Matrix environment = background ? rotationOnly(place(bound.background).world) : Matrix();
  RTid shader;
  {
    ShaderSetup setup(classes.get("VRML97Environment", ""));
    shader = setup.id();
    if (background) setBackground(setup, *background, linearColor, images);
    if (bound.fog != none)
      setFog(world, setup, static_cast<nodes::Fog&>(*node(bound.fog)), place(bound.fog).world, environment, linearColor);
  }
  load(environment);
  rtUseEnvironment(shader);
  report(world.diagnostics, background ? background->source : node(bound.fog)->source, "environment");
}

} // namespace xvrml::mapping
