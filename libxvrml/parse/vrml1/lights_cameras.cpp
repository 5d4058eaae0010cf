// lights_cameras.cpp: lights and cameras of VRML 1.0 as those of VRML97.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include "parse/vrml1/converter.h"

namespace xvrml::vrml1 {
namespace {

// VRML 1.0's lights shine at any distance; VRML97's PointLight and SpotLight end at a radius.
constexpr float unlimited = 1e9f;

Vec3f narrowed(const Vector& v) { return {float(v.x), float(v.y), float(v.z)}; }

template <class Light> void setCommon(const TreeNode& node, Light& light) {
  light.on = node.get<bool>("on");
  light.intensity = node.get<float>("intensity");
  light.color = node.get<SFColor>("color");
  light.ambientIntensity = node.get<float>("ambientIntensity");
}

// Sets a field of X3D, if this library's node has it: FALSE keeps a light in its group.
void keepInGroup(Node& light) {
  const FieldInfo* global = light.type().find("global");
  if (global && global->type == FieldType::SFBool) light.set(*global, false);
}

template <class Light> void setLocal(const TreeNode& node, const Matrix& matrix, Light& light) {
  light.location = narrowed(transformPoint(matrix, vector(node.get<Vec3f>("location"))));
  light.attenuation = node.get<Vec3f>("attenuation");
  light.radius = node.has("radius") ? node.get<float>("radius") : unlimited;
  keepInGroup(light);
}

Vec3f directionOf(const TreeNode& node, const Matrix& matrix) {
  return narrowed(transformDirection(matrix, vector(node.get<Vec3f>("direction"))));
}

// In VRML 1.0 the light of a spot falls with a power of the cosine, as in OpenGL: the exponent is
// 128 times dropOffRate. In VRML97 it is whole up to beamWidth, and then falls evenly to nothing at
// cutOffAngle. Both are half as bright at the same angle.
void setCone(const TreeNode& node, nodes::SpotLight& light) {
  constexpr float quarter = std::numbers::pi_v<float> / 2;
  const float cutOff = std::clamp(node.get<float>("cutOffAngle"), 1e-4f, quarter);
  const float exponent = 128 * std::clamp(node.get<float>("dropOffRate"), 0.0f, 1.0f);
  light.cutOffAngle = cutOff;
  light.beamWidth = cutOff;
  if (!(exponent > 0)) return;
  const float half = std::acos(std::pow(0.5f, 1 / exponent));
  if (half >= cutOff) return;
  light.cutOffAngle = std::min(cutOff, 2 * half);
  light.beamWidth = std::max(2 * half - light.cutOffAngle, 1e-4f);
}

// Returns the rotation from looking along -z with +y up to a direction and an up vector. Files by
// one browser have them in place of `orientation`.
Rotation lookingAlong(const Vec3f& direction, const Vec3f& up) {
  const Vector z = -vector(direction).normalized();
  const Vector x = vector(up).cross(z).normalized();
  if (!(z.length() > 0) || !(x.length() > 0)) return {};
  const Vector y = z.cross(x);
  const Matrix axes(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1);
  const Imath::Quatd turn = Imath::extractQuat(axes);
  const Vector axis = turn.axis();
  return {float(axis.x), float(axis.y), float(axis.z), float(turn.angle())};
}

} // namespace

bool isCamera(const TreeNode& node) {
  return node.kind == Kind::perspectiveCamera || node.kind == Kind::orthographicCamera;
}

// The placement goes into the numbers of the light, because a Transform around a light would end
// its effect (4.6.6).
NodeRef convertLight(Graph& graph, const TreeNode& node, const Placement& placement) {
  const Matrix matrix = placement.matrix();
  NodeRef result;
  if (node.kind == Kind::directionalLight) {
    auto* light = graph.make<nodes::DirectionalLight>(node);
    setCommon(node, *light);
    light->direction = directionOf(node, matrix);
    result = graph.finish(light);
  } else if (node.kind == Kind::pointLight) {
    auto* light = graph.make<nodes::PointLight>(node);
    setCommon(node, *light);
    setLocal(node, matrix, *light);
    result = graph.finish(light);
  } else {
    auto* light = graph.make<nodes::SpotLight>(node);
    setCommon(node, *light);
    setLocal(node, matrix, *light);
    light->direction = directionOf(node, matrix);
    setCone(node, *light);
    result = graph.finish(light);
  }
  graph.name(result, node);
  return result;
}

namespace {

// Sets what both kinds of viewpoints have. The DEF name of a camera is what browsers list.
template <class View> void setPlace(const TreeNode& node, View& view) {
  view.position = node.get<Vec3f>("position");
  view.orientation = node.has("direction") || node.has("up")
                         ? lookingAlong(node.get<Vec3f>("direction"), node.get<Vec3f>("up"))
                         : node.get<Rotation>("orientation");
  view.description = node.name;
}

} // namespace

NodeRef convertCamera(Graph& graph, const TreeNode& node) {
  if (node.kind == Kind::perspectiveCamera) {
    constexpr float pi = std::numbers::pi_v<float>;
    auto* view = graph.make<nodes::Viewpoint>(node);
    setPlace(node, *view);
    view->fieldOfView = std::clamp(node.get<float>("heightAngle"), 1e-3f, pi - 1e-3f);
    return graph.finish(view);
  }
  auto* view = graph.make<nodes::OrthoViewpoint>(node);
  setPlace(node, *view);
  const float half = std::max(std::abs(node.get<float>("height")), 1e-6f) / 2;
  view->fieldOfView = {-half, -half, half, half};
  return graph.finish(view);
}

} // namespace xvrml::vrml1
