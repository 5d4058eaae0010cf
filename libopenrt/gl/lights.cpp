// lights.cpp: Gives OpenRT the lights, the environment and the camera of a frame.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>

#include "gl/parameters.h"
#include "gl/scene.h"

namespace rtgl {
namespace {

enum LampKind { noLamp, directional, point, spot };

LampKind kindOf(const Light& light) {
  if (!light.on) return noLamp;
  return light.position[3] == 0 ? directional : light.cutoff == 180 ? point : spot;
}

std::array<float, 3> colorOf(const float* color, bool linear) {
  std::array<float, 3> out;
  for (size_t c = 0; c < 3; c++)
    out[c] = linear ? decoded(std::max(color[c], 0.0f)) : std::max(color[c], 0.0f);
  return out;
}

// Sets the cone of a spot. OpenGL's falls off as a power of the cosine, that of VRML97 linearly
// with the angle: the two are half as bright at the same angle.
void setCone(const Light& light) {
  constexpr float radians = std::numbers::pi_v<float> / 180;
  const float cutoff = std::min(light.cutoff, 90.0f) * radians;
  float full = cutoff, end = cutoff;
  if (light.exponent > 0) {
    const float half = std::acos(std::pow(0.5f, 1 / light.exponent));
    end = std::min(cutoff, 2 * half);
    full = std::max(2 * half - end, 0.0f);
  }
  set("beamWidth", full);
  set("cutOffAngle", end);
}

} // namespace

void Scene::useLamp(Lamp& lamp, const Light& light) {
  const LampKind kind = kindOf(light);
  if (lamp.kind != kind) {
    if (lamp.id) rtRemoveLight(lamp.id);
    if (lamp.shader) rtDeleteShader(lamp.shader);
    lamp = Lamp();
    lamp.kind = kind;
    if (kind == noLamp) return;
    lamp.shader = rtNewShader(classOf(kind == directional ? "VRML97DirectionalLight"
                                      : kind == point     ? "VRML97PointLight"
                                                          : "VRML97SpotLight"));
    rtPushMatrix();
    rtLoadIdentity();
    lamp.id = rtUseLight(lamp.shader);
    rtPopMatrix();
  } else if (kind == noLamp || lamp.light == light) {
    return;
  }
  lamp.light = light;
  const Color& p = light.position;
  rtBindShader(lamp.shader);
  set("color", colorOf(light.diffuse.data(), linear()));
  if (kind == directional) {
    set("direction", std::array<float, 3>{-p[0], -p[1], -p[2]});
  } else {
    set("location", std::array<float, 3>{p[0] / p[3], p[1] / p[3], p[2] / p[3]});
    set("attenuation", light.attenuation);
    set("radius", FLT_MAX);
  }
  if (kind == spot) {
    set("direction", light.direction);
    setCone(light);
  }
  rtBindShader(0);
}

// Sets the lights, and a light of its own for the ambient light that vertex colours reflect.
void Scene::useLights(const LightSet& lights) {
  for (size_t i = 0; i < lightCount; i++) useLamp(lamps_[i], lights.lights[i]);
  const std::array<float, 3> ambient =
      linear() ? std::array<float, 3>{0, 0, 0} : colorOf(lights.ambient.data(), false);
  if (ambient_ == ambient) return;
  if (!ambientShader_) {
    ambientShader_ = rtNewShader(classOf("VRML97DirectionalLight"));
    rtUseLight(ambientShader_);
    rtBindShader(ambientShader_);
    set("intensity", 0.0f);
    set("ambientIntensity", 1.0f);
    set("shadows", 0);
  }
  rtBindShader(ambientShader_);
  set("color", ambient);
  rtBindShader(0);
  ambient_ = ambient;
}

void Scene::useEnvironment(const Frame& frame, const LightSet& lights) {
  const Surroundings wanted = {frame.clear, frame.fog, lights.ambient, linear()};
  if (surroundings_ == wanted) return;
  surroundings_ = wanted;
  if (!environment_) {
    environment_ = rtNewShader(classOf("VRML97Environment"));
    rtPushMatrix();
    rtLoadIdentity();
    rtUseEnvironment(environment_);
    rtPopMatrix();
  }
  rtBindShader(environment_);
  const std::array<float, 3> sky = colorOf(frame.clear.data(), linear());
  rtParameterfv(rtParameterHandle("skyColor"), 3, sky.data());
  const std::array<float, 3> none = {0, 0, 0};
  set("lightColor", linear() ? colorOf(lights.ambient.data(), true) : none);
  // Fog of OpenGL depends on the distance along the view axis.
  const float alongAxis[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  rtParameter16f(rtParameterHandle("fogMatrix"), alongAxis);
  const Fog& fog = frame.fog;
  const bool byDistance = fog.mode == GL_LINEAR;
  set("fogType", !fog.on ? 0 : byDistance ? 1 : fog.mode == GL_EXP ? 3 : 4);
  set("fogColor", colorOf(fog.color.data(), linear()));
  set("fogStart", byDistance ? fog.start : 0.0f);
  set("fogRange", byDistance ? fog.end : fog.density > 0 ? 1 / fog.density : FLT_MAX);
  rtBindShader(0);
}

void Scene::useCamera(const Frame& frame) {
  Camera camera;
  const double aspect = static_cast<double>(frame.width) / frame.height;
  if (!cameraOf(frame.projection.value_or(identity), aspect, camera) || camera_ == camera) return;
  camera_ = camera;
  RTid& shader = cameras_[camera.perspective];
  if (!shader) {
    shader = rtNewShader(classOf(camera.perspective ? "PerspectiveCamera" : "OrthographicCamera"));
    rtBindShader(shader);
    set(camera.perspective ? "fovy" : "height", camera.perspective ? 90.0f : 2.0f);
    rtBindShader(0);
  }
  rtPushMatrix();
  rtLoadMatrixd(camera.toWorld.data());
  rtUseCamera(shader);
  rtPopMatrix();
}

} // namespace rtgl
