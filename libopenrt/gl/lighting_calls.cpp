// lighting_calls.cpp: Implements the calls for lights, materials and fog.
#include <algorithm>

#include "gl/numbers.h"
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

using Values = std::array<float, 4>;

// Returns the number of values of a property; throws for others.
size_t countOf(GLenum name) {
  switch (name) {
  case GL_AMBIENT:
  case GL_DIFFUSE:
  case GL_SPECULAR:
  case GL_EMISSION:
  case GL_POSITION:
  case GL_AMBIENT_AND_DIFFUSE:
  case GL_LIGHT_MODEL_AMBIENT:
  case GL_FOG_COLOR: return 4;
  case GL_SPOT_DIRECTION:
  case GL_COLOR_INDEXES: return 3;
  default: return 1;
  }
}

bool isColor(GLenum name) { return countOf(name) == 4 && name != GL_POSITION; }

// Copies the values of a call. Integers of colours stand for -1 .. 1.
Values copied(GLenum name, const float* values) {
  Values out = {};
  std::copy_n(values, countOf(name), out.begin());
  return out;
}
Values copied(GLenum name, const GLint* values) {
  Values out = {};
  for (size_t i = 0; i < countOf(name); i++)
    out[i] = isColor(name) ? static_cast<float>((2.0 * values[i] + 1) / 4294967295.0)
                           : static_cast<float>(values[i]);
  return out;
}

size_t lightIndex(GLenum light) {
  if (light < GL_LIGHT0 || light >= GL_LIGHT0 + lightCount) fail(GL_INVALID_ENUM, "no such light");
  return light - GL_LIGHT0;
}

void setLight(State& s, GLenum which, GLenum name, const Values& v) {
  Light& light = s.now.lighting.lights[lightIndex(which)];
  const Matrix& m = s.modelview();
  switch (name) {
  case GL_AMBIENT: light.ambient = v; break;
  case GL_DIFFUSE: light.diffuse = v; break;
  case GL_SPECULAR: light.specular = v; break;
  case GL_POSITION: {
    const std::array<double, 4> eye = transform(m, {v[0], v[1], v[2], v[3]});
    for (size_t i = 0; i < 4; i++) light.position[i] = static_cast<float>(eye[i]);
    break;
  }
  case GL_SPOT_DIRECTION: {
    const std::array<double, 4> eye = transform(m, {v[0], v[1], v[2], 0});
    for (size_t i = 0; i < 3; i++) light.direction[i] = static_cast<float>(eye[i]);
    break;
  }
  case GL_SPOT_EXPONENT:
    if (!(v[0] >= 0 && v[0] <= 128)) fail(GL_INVALID_VALUE, "the exponent is not 0 to 128");
    light.exponent = v[0];
    break;
  case GL_SPOT_CUTOFF:
    if (!(v[0] == 180 || (v[0] >= 0 && v[0] <= 90)))
      fail(GL_INVALID_VALUE, "the cutoff is neither 180 nor 0 to 90");
    light.cutoff = v[0];
    break;
  case GL_CONSTANT_ATTENUATION:
  case GL_LINEAR_ATTENUATION:
  case GL_QUADRATIC_ATTENUATION:
    if (!(v[0] >= 0)) fail(GL_INVALID_VALUE, "the attenuation is below 0");
    light.attenuation[name - GL_CONSTANT_ATTENUATION] = v[0];
    break;
  default: fail(GL_INVALID_ENUM, "no such property");
  }
}

template <class T> void lightCall(GLenum light, GLenum name, const T* values) {
  const Values v = copied(name, values);
  listed("glLight", [=](State& s) { setLight(s, light, name, v); });
}

void setMaterial(State& s, GLenum which, GLenum name, const Values& v) {
  if (which != GL_FRONT && which != GL_BACK && which != GL_FRONT_AND_BACK)
    fail(GL_INVALID_ENUM, "no such face");
  for (size_t side = 0; side < 2; side++) {
    if (which == (side == 0 ? GL_BACK : GL_FRONT)) continue;
    Face& face = s.now.lighting.faces[side];
    switch (name) {
    case GL_AMBIENT: face.ambient = v; break;
    case GL_DIFFUSE: face.diffuse = v; break;
    case GL_SPECULAR: face.specular = v; break;
    case GL_EMISSION: face.emission = v; break;
    case GL_AMBIENT_AND_DIFFUSE: face.ambient = face.diffuse = v; break;
    case GL_SHININESS:
      if (!(v[0] >= 0 && v[0] <= 128)) fail(GL_INVALID_VALUE, "the shininess is not 0 to 128");
      face.shininess = v[0];
      break;
    default: fail(GL_INVALID_ENUM, "no such property");
    }
  }
}

template <class T> void materialCall(GLenum face, GLenum name, const T* values) {
  const Values v = copied(name, values);
  listed("glMaterial", [=](State& s) { setMaterial(s, face, name, v); });
}

template <class T> void lightModelCall(GLenum name, const T* values) {
  const Values v = copied(name, values);
  listed("glLightModel", [=](State& s) {
    switch (name) {
    case GL_LIGHT_MODEL_AMBIENT: s.now.lighting.ambient = v; break;
    case GL_LIGHT_MODEL_TWO_SIDE: s.now.lighting.twoSide = v[0] != 0; break;
    case GL_LIGHT_MODEL_LOCAL_VIEWER: s.now.lighting.localViewer = v[0] != 0; break;
    default: fail(GL_INVALID_ENUM, "no such property");
    }
  });
}

template <class T> void fogCall(GLenum name, const T* values) {
  const Values v = copied(name, values);
  listed("glFog", [=](State& s) {
    Fog& fog = s.now.fog;
    switch (name) {
    case GL_FOG_MODE: {
      const GLenum mode = toName(static_cast<double>(v[0]));
      if (mode != GL_LINEAR && mode != GL_EXP && mode != GL_EXP2)
        fail(GL_INVALID_ENUM, "no such mode of fog");
      fog.mode = mode;
      break;
    }
    case GL_FOG_DENSITY:
      if (!(v[0] >= 0)) fail(GL_INVALID_VALUE, "the density is below 0");
      fog.density = v[0];
      break;
    case GL_FOG_START: fog.start = v[0]; break;
    case GL_FOG_END: fog.end = v[0]; break;
    case GL_FOG_COLOR: fog.color = v; break;
    case GL_FOG_INDEX: s.refuse("GL_FOG_INDEX", "colours have no indices: use GL_FOG_COLOR"); break;
    default: fail(GL_INVALID_ENUM, "no such property");
    }
  });
}

Values lightValues(const Light& light, GLenum name) {
  switch (name) {
  case GL_AMBIENT: return light.ambient;
  case GL_DIFFUSE: return light.diffuse;
  case GL_SPECULAR: return light.specular;
  case GL_POSITION: return light.position;
  case GL_SPOT_DIRECTION: return {light.direction[0], light.direction[1], light.direction[2], 0};
  case GL_SPOT_EXPONENT: return {light.exponent};
  case GL_SPOT_CUTOFF: return {light.cutoff};
  case GL_CONSTANT_ATTENUATION: return {light.attenuation[0]};
  case GL_LINEAR_ATTENUATION: return {light.attenuation[1]};
  case GL_QUADRATIC_ATTENUATION: return {light.attenuation[2]};
  default: fail(GL_INVALID_ENUM, "no such property");
  }
}

Values materialValues(const Face& face, GLenum name) {
  switch (name) {
  case GL_AMBIENT: return face.ambient;
  case GL_DIFFUSE: return face.diffuse;
  case GL_SPECULAR: return face.specular;
  case GL_EMISSION: return face.emission;
  case GL_SHININESS: return {face.shininess};
  default: fail(GL_INVALID_ENUM, "no such property");
  }
}

// Writes values as the call asks for them: integers of colours stand for -1 .. 1.
void write(GLenum name, const Values& v, float* out) { std::copy_n(v.begin(), countOf(name), out); }
void write(GLenum name, const Values& v, GLint* out) {
  for (size_t i = 0; i < countOf(name); i++)
    out[i] = toInteger(static_cast<double>(v[i]) * (isColor(name) ? 2147483647.0 : 1.0));
}

template <class T> void getLight(GLenum light, GLenum name, T* out) {
  guarded("glGetLight", [&](State& s) {
    write(name, lightValues(s.now.lighting.lights[lightIndex(light)], name), out);
  });
}
template <class T> void getMaterial(GLenum face, GLenum name, T* out) {
  guarded("glGetMaterial", [&](State& s) {
    if (face != GL_FRONT && face != GL_BACK) fail(GL_INVALID_ENUM, "no such face");
    write(name, materialValues(s.now.lighting.faces[face == GL_BACK], name), out);
  });
}

// Calls with one value may only set properties that have one.
template <class T, class Call> void single(GLenum name, T value, const Call& call) {
  const T values[4] = {value, 0, 0, 0};
  if (countOf(name) != 1)
    guarded("glLight, glMaterial, glLightModel or glFog",
            [](State&) { fail(GL_INVALID_ENUM, "the property has several values"); });
  else
    call(values);
}

} // namespace

void rtglShadeModel(GLenum mode) {
  listed("glShadeModel", [mode](State& s) {
    if (mode != GL_FLAT && mode != GL_SMOOTH) fail(GL_INVALID_ENUM, "no such model");
    s.now.lighting.shadeModel = mode;
  });
}
void rtglLightf(GLenum light, GLenum name, GLfloat value) {
  single(name, value, [&](const GLfloat* v) { lightCall(light, name, v); });
}
void rtglLighti(GLenum light, GLenum name, GLint value) {
  single(name, value, [&](const GLint* v) { lightCall(light, name, v); });
}
void rtglLightfv(GLenum light, GLenum name, const GLfloat* v) { lightCall(light, name, v); }
void rtglLightiv(GLenum light, GLenum name, const GLint* v) { lightCall(light, name, v); }
void rtglGetLightfv(GLenum light, GLenum name, GLfloat* out) { getLight(light, name, out); }
void rtglGetLightiv(GLenum light, GLenum name, GLint* out) { getLight(light, name, out); }
void rtglLightModelf(GLenum name, GLfloat value) {
  single(name, value, [&](const GLfloat* v) { lightModelCall(name, v); });
}
void rtglLightModeli(GLenum name, GLint value) {
  single(name, value, [&](const GLint* v) { lightModelCall(name, v); });
}
void rtglLightModelfv(GLenum name, const GLfloat* v) { lightModelCall(name, v); }
void rtglLightModeliv(GLenum name, const GLint* v) { lightModelCall(name, v); }
void rtglMaterialf(GLenum face, GLenum name, GLfloat value) {
  single(name, value, [&](const GLfloat* v) { materialCall(face, name, v); });
}
void rtglMateriali(GLenum face, GLenum name, GLint value) {
  single(name, value, [&](const GLint* v) { materialCall(face, name, v); });
}
void rtglMaterialfv(GLenum face, GLenum name, const GLfloat* v) { materialCall(face, name, v); }
void rtglMaterialiv(GLenum face, GLenum name, const GLint* v) { materialCall(face, name, v); }
void rtglGetMaterialfv(GLenum face, GLenum name, GLfloat* out) { getMaterial(face, name, out); }
void rtglGetMaterialiv(GLenum face, GLenum name, GLint* out) { getMaterial(face, name, out); }
void rtglColorMaterial(GLenum face, GLenum mode) {
  listed("glColorMaterial", [=](State& s) {
    if (face != GL_FRONT && face != GL_BACK && face != GL_FRONT_AND_BACK)
      fail(GL_INVALID_ENUM, "no such face");
    if (mode != GL_EMISSION && mode != GL_AMBIENT && mode != GL_DIFFUSE && mode != GL_SPECULAR &&
        mode != GL_AMBIENT_AND_DIFFUSE)
      fail(GL_INVALID_ENUM, "no such property");
    s.now.lighting.colorFace = face;
    s.now.lighting.colorMode = mode;
    s.trackColor();
  });
}
void rtglFogf(GLenum name, GLfloat value) {
  single(name, value, [&](const GLfloat* v) { fogCall(name, v); });
}
void rtglFogi(GLenum name, GLint value) {
  single(name, value, [&](const GLint* v) { fogCall(name, v); });
}
void rtglFogfv(GLenum name, const GLfloat* v) { fogCall(name, v); }
void rtglFogiv(GLenum name, const GLint* v) { fogCall(name, v); }
