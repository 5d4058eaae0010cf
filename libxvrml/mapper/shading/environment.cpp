// environment.cpp: Background, TextureBackground, Fog and EnvironmentLight as the class
// VRML97Environment (clauses 6.5 and 6.19; ISO/IEC 19775-1 24.4.5 and ISO/IEC 19775-1:2023 17.4.2).
#include "mapper/views.h"

#include <algorithm>

#include "mapper/shading/fogs.h"
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

// In the order of CubeFace.
constexpr const char* pictures[cubeFaces] = {"frontTexture", "backTexture", "leftTexture",
                                             "rightTexture", "topTexture",  "bottomTexture"};
constexpr const char* lightPictures[cubeFaces] = {"lightFront", "lightBack", "lightLeft",
                                                  "lightRight", "lightTop",  "lightBottom"};

} // namespace

template <class Sky>
void Environment::setBackground(ShaderSetup& shader, const Sky& node, const Faces& images) {
  setColors(shader, "skyColor", node.skyColor, linear_);
  shader.floats("skyAngle", node.skyAngle);
  setColors(shader, "groundColor", node.groundColor, linear_);
  shader.floats("groundAngle", node.groundAngle);
  if (node.transparency != 0 || !shader.fresh())
    shader.number("transparency", node.transparency, 0, 1);
  for (size_t i = 0; i < cubeFaces; ++i)
    if (images[i] != 0 || !shader.fresh()) shader.texture(pictures[i], images[i]);
}

void Environment::picturesOfBackground(Faces& images) {
  if (const auto* sky = nodeCast<nodes::Background>(background_)) {
    const MFString* const urls[cubeFaces] = {&sky->frontUrl, &sky->backUrl, &sky->leftUrl,
                                             &sky->rightUrl, &sky->topUrl,  &sky->bottomUrl};
    for (size_t i = 0; i < cubeFaces; ++i)
      images[i] = textures_.ofUrls(*urls[i], *sky, false, false);
  } else if (const auto* textured = nodeCast<nodes::TextureBackground>(background_)) {
    const NodeRef* const faces[cubeFaces] = {&textured->frontTexture, &textured->backTexture,
                                             &textured->leftTexture,  &textured->rightTexture,
                                             &textured->topTexture,   &textured->bottomTexture};
    for (size_t i = 0; i < cubeFaces; ++i) images[i] = textures_.ofFace(faces[i]->get());
  }
}

// The surroundings of an EnvironmentLight whose pictures are missing are black. One that names none
// shines evenly.
CubeMap Environment::picturesOfLight() {
  const auto* light = nodeCast<nodes::EnvironmentLight>(light_);
  if (!light) return {};
  Node* cube = light->specularTexture ? light->specularTexture.get() : light->diffuseTexture.get();
  CubeMap map = cubes_.of(cube);
  bool any = map.sphere != 0;
  for (const RTid face : map.faces) any |= face != 0;
  if (cube && !any) map.sphere = textures_.black();
  return map;
}

void Environment::setLight(ShaderSetup& shader, const CubeMap& map) {
  const auto* light = nodeCast<nodes::EnvironmentLight>(light_);
  if (!light) {
    if (!shader.fresh()) shader.color("lightColor", Color{0, 0, 0});
    return;
  }
  const Color color = convert(light->color, linear_);
  const auto shining = [&](float share) {
    return std::clamp(light->intensity * share, 0.0f, 1e9f);
  };
  shader.color("lightColor", Color{shining(color.r), shining(color.g), shining(color.b)});
  for (size_t i = 0; i < cubeFaces; ++i)
    if (map.faces[i] != 0 || !shader.fresh()) shader.texture(lightPictures[i], map.faces[i]);
  if (map.sphere != 0 || !shader.fresh()) shader.texture("lightMap", map.sphere);
  const Matrix turned = compose(lightMatrix_, rotation(light->rotation));
  Matrix toLight;
  if (!finite(turned) || !invert(turned, toLight)) toLight = Matrix();
  shader.matrix("lightMatrix", compose(toLight, matrix_));
}

// Returns the place of the first EnvironmentLight that is on. Warns once if there are several.
int32_t Environment::findLight(const Graph& graph, const Places& places) {
  int32_t first = none;
  for (size_t i = 0; i < places.all.size(); ++i) {
    const Item& item = graph.items[places.all[i].item];
    if (item.kind != Kind::environmentLight || !item.on || !places.all[i].active) continue;
    if (first == none) {
      first = int32_t(i);
      continue;
    }
    if (!reportedLights_)
      world_.diagnostics.warn(item.node->source,
                              "EnvironmentLight: there are several, and only the "
                              "first that is on shines; turn the others off");
    reportedLights_ = true;
    break;
  }
  return first;
}

void Environment::setAll(ShaderSetup& shader, const Faces& images, const CubeMap& light) {
  if (const auto* sky = nodeCast<nodes::Background>(background_))
    setBackground(shader, *sky, images);
  if (const auto* sky = nodeCast<nodes::TextureBackground>(background_))
    setBackground(shader, *sky, images);
  if (fog_) setFog(shader, *fog_, fogMatrix_, matrix_, linear_, world_.diagnostics);
  setLight(shader, light);
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
  if (light_)
    world_.diagnostics.warn(light_->source,
                            "EnvironmentLight: it does not shine with an ORTBackground, which "
                            "lights the world itself");
}

void Environment::updateForFrame(const Graph& graph, const Places& places, const Bound& bound) {
  const auto worldOf = [&](int32_t place) {
    return place == none ? Matrix() : places.all[size_t(place)].world;
  };
  const int32_t lightPlace = findLight(graph, places);
  const NodeRef light =
      lightPlace == none ? NodeRef() : graph.items[places.all[size_t(lightPlace)].item].node;
  const Matrix matrix = bound.background ? rotationOnly(worldOf(bound.backgroundPlace)) : Matrix();
  const Matrix fogMatrix = bound.fog ? worldOf(bound.fogPlace) : Matrix();
  const Matrix lightMatrix = light ? rotationOnly(worldOf(lightPlace)) : Matrix();
  const bool others = bound.background != background_ || bound.fog != fog_ || light != light_,
             turned = matrix != matrix_;
  if (!others && !stale_ && !turned && fogMatrix == fogMatrix_ && lightMatrix == lightMatrix_)
    return;
  background_ = bound.background;
  fog_ = bound.fog;
  light_ = light;
  matrix_ = matrix;
  fogMatrix_ = fogMatrix;
  lightMatrix_ = lightMatrix;
  stale_ = false;
  if (others) clear();
  if (!background_ && !fog_ && !light_) return;
  if (auto* custom = nodeCast<nodes::ORTBackground>(background_)) {
    useCustom(*custom);
    report(world_.diagnostics, custom->source, "ORTBackground");
    return;
  }
  Faces images = {};
  picturesOfBackground(images);
  const CubeMap lightImages = picturesOfLight();
  const bool fresh = shader_ == 0;
  const RTid shaderClass = classes_.get("VRML97Environment", "");
  if (fresh) {
    ShaderSetup setup(shaderClass);
    shader_ = setup.id();
    setAll(setup, images, lightImages);
  } else {
    ShaderSetup setup(shaderClass, shader_, sets_);
    setAll(setup, images, lightImages);
  }
  if (fresh || turned) {
    load(matrix_);
    rtUseEnvironment(used_ = shader_);
  }
  const NodeRef& where = background_ ? background_ : fog_ ? fog_ : light_;
  report(world_.diagnostics, where->source, "environment");
}

} // namespace xvrml::mapper
