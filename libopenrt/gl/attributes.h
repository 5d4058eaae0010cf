// attributes.h: the state that glPushAttrib saves, in the groups of OpenGL 1.1 (specification,
// table 6.5 to 6.20), with its initial values.
#pragma once

#include <array>

#include "openrt/gl_types.h"
#include "openrt/gl_values.h"

namespace rtgl {

using Color = std::array<float, 4>;

struct Current {
  Color color = {1, 1, 1, 1};
  std::array<float, 3> normal = {0, 0, 1};
  std::array<float, 2> texCoord = {0, 0};
  bool operator==(const Current&) const = default;
};

struct Light {
  bool on = false;
  Color ambient = {0, 0, 0, 1}, diffuse = {0, 0, 0, 1}, specular = {0, 0, 0, 1};
  Color position = {0, 0, 1, 0};               // in eye space
  std::array<float, 3> direction = {0, 0, -1}; // axis of the spot, in eye space
  float exponent = 0, cutoff = 180;            // spot: falloff and angle in degrees
  std::array<float, 3> attenuation = {1, 0, 0};
  bool operator==(const Light&) const = default;
};

struct Face {
  Color ambient = {.2f, .2f, .2f, 1}, diffuse = {.8f, .8f, .8f, 1}, specular = {0, 0, 0, 1},
        emission = {0, 0, 0, 1};
  float shininess = 0;
};

inline constexpr size_t lightCount = 8;

struct Lighting {
  Lighting() { lights[0].diffuse = lights[0].specular = {1, 1, 1, 1}; }
  bool on = false, twoSide = false, localViewer = false, colorMaterial = false;
  std::array<Light, lightCount> lights;
  std::array<Face, 2> faces; // front, back
  Color ambient = {.2f, .2f, .2f, 1};
  GLenum colorFace = GL_FRONT_AND_BACK, colorMode = GL_AMBIENT_AND_DIFFUSE;
  GLenum shadeModel = GL_SMOOTH;
};

struct Fog {
  bool on = false;
  GLenum mode = GL_EXP;
  float density = 1, start = 0, end = 1;
  Color color = {0, 0, 0, 0};
  bool operator==(const Fog&) const = default;
};

struct Polygon {
  bool cull = false;
  GLenum cullFace = GL_BACK, frontFace = GL_CCW;
  std::array<GLenum, 2> mode = {GL_FILL, GL_FILL}; // front, back

  // Returns whether a polygon is left out. area: in the picture, positive if its corners are
  // counter-clockwise there.
  bool culls(double area) const {
    const bool front = (area > 0) == (frontFace == GL_CCW);
    return cull && (cullFace == GL_FRONT_AND_BACK || front == (cullFace == GL_FRONT));
  }
};

struct Pixels { // what happens to the colours of a picture
  bool blend = false, alphaTest = false;
  GLenum source = GL_ONE, destination = GL_ZERO, alphaFunction = GL_ALWAYS;
  float alphaReference = 0;
  Color clear = {0, 0, 0, 0};
};

struct Depth {
  bool test = false, mask = true;
  GLenum function = GL_LESS;
};

struct Texturing {
  bool on = false;
  GLuint bound = 0;
  GLenum mode = GL_MODULATE;
  Color color = {0, 0, 0, 0};
};

struct Attributes {
  Current current;
  Lighting lighting;
  Fog fog;
  Polygon polygon;
  Pixels pixels;
  Depth depth;
  Texturing texturing;
  float lineWidth = 1, pointSize = 1;
  GLenum matrixMode = GL_MODELVIEW;
  bool normalize = false;
  GLuint listBase = 0;
  std::array<GLint, 4> viewport = {0, 0, 0, 0};
};

// Copies the groups that a mask of glPushAttrib names.
void restore(const Attributes& from, GLbitfield mask, Attributes& to);

} // namespace rtgl
