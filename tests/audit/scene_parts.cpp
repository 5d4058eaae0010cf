#include "audit/scene_parts.h"

#include <cstdint>

namespace audit {

RTid shaderOf(const char* shaderClass) {
  return rtNewShader(rtNewShaderClass(shaderClass, nullptr));
}

void colored(RTid shader, const char* parameter, float r, float g, float b) {
  rtBindShader(shader);
  rtParameter3f(rtParameterHandle(parameter), r, g, b);
  rtBindShader(0);
}

void set(RTid shader, const char* parameter, float value) {
  rtBindShader(shader);
  rtParameter1f(rtParameterHandle(parameter), value);
  rtBindShader(0);
}

RTid diffuse(float emission, float reflectance) {
  const RTid shader = shaderOf("Diffuse");
  colored(shader, "emission", emission, emission, emission);
  colored(shader, "reflectance", reflectance, reflectance, reflectance);
  return shader;
}

RTid paint(float r, float g, float b) {
  const RTid shader = diffuse(0, 0);
  colored(shader, "reflectance", r, g, b);
  return shader;
}

void square(RTid shader, double half) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  rtVertex3d(-half, -half, 0);
  rtVertex3d(half, -half, 0);
  rtVertex3d(half, half, 0);
  rtVertex3d(-half, half, 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  rtInstantiateObject(object);
}

RTid box(RTid shader, double x, double y, double z) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2)
      for (int corner = 0; corner < 4; corner++) {
        const int a = corner == 1 || corner == 2 ? 1 : -1, b = corner >= 2 ? 1 : -1;
        double v[3];
        v[axis] = side;
        v[(axis + 1) % 3] = side * a;
        v[(axis + 2) % 3] = b;
        rtVertex3d(x * v[0], y * v[1], z * v[2]);
      }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return object;
}

RTid ball(RTid shader, float radius) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtSphere(radius);
  rtEndObject();
  rtBindShader(0);
  return object;
}

void put(RTid object, double x, double y, double z, double turn) {
  rtPushMatrix();
  rtTranslated(x, y, z);
  rtRotated(turn, 0, 1, 0);
  rtInstantiateObject(object);
  rtPopMatrix();
}

void lampAbove(double x, double y, double z, double half, float radiance) {
  rtPushMatrix();
  rtTranslated(x, y, z);
  rtRotated(90, 1, 0, 0);
  square(diffuse(radiance, 0), half);
  rtPopMatrix();
}

void floorAt(double y, RTid shader, double half) {
  rtPushMatrix();
  rtTranslated(0, y, 0);
  rtRotated(-90, 1, 0, 0);
  square(shader, half);
  rtPopMatrix();
}

void roomOf(RTid floor, RTid ceiling, RTid left, RTid right, RTid back) {
  const auto wall = [](double angle, double x, double y, double z, RTid shader) {
    rtPushMatrix();
    rtRotated(angle, x, y, z);
    rtTranslated(0, 0, -1);
    square(shader, 1);
    rtPopMatrix();
  };
  wall(0, 1, 0, 0, back);
  wall(-90, 1, 0, 0, floor);
  wall(90, 1, 0, 0, ceiling);
  wall(90, 0, 1, 0, left);
  wall(-90, 0, 1, 0, right);
}

void sky(int colors, const float* color, const float* angle, double tilt, float turnOfAxis) {
  const RTid env = shaderOf("VRML97Environment");
  rtBindShader(env);
  rtParameterfv(rtParameterHandle("skyColor"), 3 * colors, color);
  if (colors > 1) rtParameterfv(rtParameterHandle("skyAngle"), colors - 1, angle);
  rtBindShader(0);
  rtPushMatrix();
  rtRotated(tilt, 1, 0, turnOfAxis);
  rtUseEnvironment(env);
  rtPopMatrix();
}

void lookDown(double height) {
  rtPushMatrix();
  rtTranslated(0, 0, 40);
  rtOrtho(height);
  rtPopMatrix();
}

void eyeAt(double x, double y, double z, double degrees) {
  rtPushMatrix();
  rtLookAt(x, y, z, 0, 0, 0, 0, 1, 0);
  rtPerspective(degrees);
  rtPopMatrix();
}

void lensAt(double x, double y, double z, double degrees, float radius, float focus) {
  const RTid lens = shaderOf("ThinLens");
  set(lens, "fovy", float(degrees));
  set(lens, "radius", radius);
  set(lens, "focus", focus);
  rtPushMatrix();
  rtLookAt(x, y, z, 0, 0, 0, 0, 1, 0);
  rtUseCamera(lens);
  rtPopMatrix();
}

double randomNumber(unsigned number,
                    unsigned which) { // T. Mueller's hash, as in render/wave/sampler.h
  uint32_t x = number * 0x9e3779b9u + which * 0x85ebca6bu + 1;
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return double((x ^ (x >> 16)) >> 8) / (1 << 24);
}

} // namespace audit
