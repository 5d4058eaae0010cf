// environment.cpp: Background and Fog as the class VRML97Environment (clauses 6.5 and 6.19).
#include "mapper/views.h"

#include "xvrml/nodes.h"

namespace xvrml::mapper {
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
    {"frontTexture", &nodes::Background::frontUrl},
    {"backTexture", &nodes::Background::backUrl},
    {"leftTexture", &nodes::Background::leftUrl},
    {"rightTexture", &nodes::Background::rightUrl},
    {"topTexture", &nodes::Background::topUrl},
    {"bottomTexture", &nodes::Background::bottomUrl},
};

} // namespace

void Environment::setBackground(ShaderSetup& shader, const nodes::Background& node,
                                const RTid (&textures)[6]) {
  setColors(shader, "skyColor", node.skyColor, linear_);
  shader.floats("skyAngle", node.skyAngle);
  setColors(shader, "groundColor", node.groundColor, linear_);
  shader.floats("groundAngle", node.groundAngle);
  for (int i = 0; i < 6; ++i)
    if (textures[i] != 0 || !shader.fresh()) shader.texture(pictures[i].name, textures[i]);
}

// Sets the fog. Distances are measured in the fog's own coordinate system (clause 6.19).
void Environment::setFog(ShaderSetup& shader) {
  const auto& fog = static_cast<const nodes::Fog&>(*fog_);
  Matrix toFog;
  if (!(fog.visibilityRange > 0) || !invert(fogMatrix_, toFog)) {
    if (!shader.fresh()) shader.integer("fogType", 0);
    return;
  }
  const bool exponential = fog.fogType == "EXPONENTIAL";
  if (!exponential && fog.fogType != "LINEAR")
    world_.diagnostics.warn(fog.source, "Fog: fogType \"" + fog.fogType +
                                            "\" is neither LINEAR nor EXPONENTIAL; LINEAR is used");
  shader.integer("fogType", exponential ? 2 : 1);
  shader.color("fogColor", convert(fog.color, linear_));
  shader.number("fogRange", fog.visibilityRange);
  shader.matrix("fogMatrix", compose(toFog, matrix_));
}

void Environment::setAll(ShaderSetup& shader, const RTid (&images)[6]) {
  if (background_)
    setBackground(shader, static_cast<const nodes::Background&>(*background_), images);
  if (fog_) setFog(shader);
}

void Environment::clear() {
  if (shader_ != 0) rtDeleteShader(shader_); // the scene then has no environment
  if (used_ != 0 && used_ != shader_) rtUseEnvironment(0);
  shader_ = used_ = 0;
}

void Environment::useCustom(nodes::ORTBackground& node) {
  auto* shader = nodeCast<nodes::ORTShader>(renderedNode(node.shader.get()));
  used_ = shader ? custom_.shaderFor(*shader, RT_ENVIRONMENT) : 0;
  load(matrix_);
  rtUseEnvironment(used_);
  if (fog_) world_.diagnostics.warn(fog_->source, "Fog is not drawn with an ORTBackground");
}

void Environment::updateForFrame(const Places& places, const Bound& bound) {
  const auto worldOf = [&](int32_t place) {
    return place == none ? Matrix() : places.all[size_t(place)].world;
  };
  const Matrix matrix = bound.background ? rotationOnly(worldOf(bound.backgroundPlace)) : Matrix();
  const Matrix fogMatrix = bound.fog ? worldOf(bound.fogPlace) : Matrix();
  const bool others = bound.background != background_ || bound.fog != fog_,
             turned = matrix != matrix_;
  if (!others && !stale_ && !turned && fogMatrix == fogMatrix_) return;
  background_ = bound.background;
  fog_ = bound.fog;
  matrix_ = matrix;
  fogMatrix_ = fogMatrix;
  stale_ = false;
  if (others) clear();
  if (!background_ && !fog_) return;
  if (auto* custom = nodeCast<nodes::ORTBackground>(background_)) {
    useCustom(*custom);
    report(world_.diagnostics, custom->source, "ORTBackground");
    return;
  }
  RTid images[6] = {};
  const nodes::Background* background = nodeCast<nodes::Background>(background_);
  for (int i = 0; background && i < 6; ++i)
    images[i] = textures_.ofUrls(background->*pictures[i].urls, *background, false, false);
  const bool fresh = shader_ == 0;
  const RTid shaderClass = classes_.get("VRML97Environment", "");
  if (fresh) {
    ShaderSetup setup(shaderClass);
    shader_ = setup.id();
    setAll(setup, images);
  } else {
    ShaderSetup setup(shaderClass, shader_, sets_);
    setAll(setup, images);
  }
  if (fresh || turned) {
    load(matrix_);
    rtUseEnvironment(used_ = shader_);
  }
  report(world_.diagnostics, background_ ? background_->source : fog_->source, "environment");
}

} // namespace xvrml::mapper
