// texture_calls.cpp: Implements the calls for textures and for the layout of pixels in memory.
#include <algorithm>
#include <cstring>

#include "gl/numbers.h"
#include "gl/pixels.h"
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

void requireTarget(State& s, GLenum target) {
  if (target == GL_TEXTURE_1D)
    s.refuse("GL_TEXTURE_1D", "it counts as GL_TEXTURE_2D with one row");
  else if (target != GL_TEXTURE_2D)
    fail(GL_INVALID_ENUM, "no such target");
}

// glTexImage2D: level 0 alone counts, because textures have no mipmaps here.
void setImage(State& s, GLenum target, GLint level, GLsizei width, GLsizei height, GLint border,
              GLenum format, GLenum type, const void* pixels) {
  requireTarget(s, target);
  if (width < 0 || height < 0 || level < 0) fail(GL_INVALID_VALUE, "a size or level is below 0");
  if (border != 0 && border != 1) fail(GL_INVALID_VALUE, "borders are 0 and 1");
  if (width > maxTextureSize || height > maxTextureSize)
    fail(GL_INVALID_VALUE, "a size is above " + std::to_string(maxTextureSize));
  if (level != 0 || width == 0 || height == 0) return;
  if (border != 0) s.refuse("the border of glTexImage", "use glTexParameterfv");
  Texture& texture = s.textures.at(s.now.texturing.bound);
  texture.picture = pictureOf(s.unpack, width, height, format, type, pixels);
  s.textures.load(texture);
}

void setPart(State& s, GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
             GLenum format, GLenum type, const void* pixels) {
  requireTarget(s, target);
  if (level != 0 || width <= 0 || height <= 0) return;
  Texture& texture = s.textures.at(s.now.texturing.bound);
  Picture& whole = texture.picture;
  if (x < 0 || y < 0 || width > whole.width - x || height > whole.height - y)
    fail(GL_INVALID_VALUE, "the part lies outside of the texture");
  const Picture part = pictureOf(s.unpack, width, height, format, type, pixels);
  if (part.components != whole.components)
    fail(GL_INVALID_OPERATION, "the part has another number of components than the texture");
  const auto row = static_cast<size_t>(width * part.components);
  for (int i = 0; i < height; i++)
    std::memcpy(whole.texels.data() +
                    static_cast<size_t>(((y + i) * whole.width + x) * whole.components),
                part.texels.data() + static_cast<size_t>(i) * row, row);
  s.textures.load(texture);
}

void setParameter(State& s, GLenum target, GLenum name, float value) {
  requireTarget(s, target);
  Texture& texture = s.textures.at(s.now.texturing.bound);
  const GLenum mode = toName(static_cast<double>(value));
  constexpr GLenum clampToEdge = 0x812F; // OpenGL 1.2
  const bool wraps = name == GL_TEXTURE_WRAP_S || name == GL_TEXTURE_WRAP_T;
  if (wraps && mode != GL_REPEAT && mode != GL_CLAMP && mode != clampToEdge)
    fail(GL_INVALID_ENUM, "no such way to go on beyond the edges");
  switch (name) {
  case GL_TEXTURE_WRAP_S: texture.wrapS = mode; break;
  case GL_TEXTURE_WRAP_T: texture.wrapT = mode; break;
  case GL_TEXTURE_MAG_FILTER: texture.magFilter = mode; break;
  case GL_TEXTURE_MIN_FILTER: texture.minFilter = mode; break;
  case GL_TEXTURE_PRIORITY: break;
  default: fail(GL_INVALID_ENUM, "no such property");
  }
}

void parameterCall(GLenum target, GLenum name, float value) {
  listed("glTexParameter", [=](State& s) { setParameter(s, target, name, value); });
}

GLenum parameterOf(State& s, GLenum name) {
  const Texture& texture = s.textures.at(s.now.texturing.bound);
  switch (name) {
  case GL_TEXTURE_WRAP_S: return texture.wrapS;
  case GL_TEXTURE_WRAP_T: return texture.wrapT;
  case GL_TEXTURE_MAG_FILTER: return texture.magFilter;
  case GL_TEXTURE_MIN_FILTER: return texture.minFilter;
  default: fail(GL_INVALID_ENUM, "no such property");
  }
}

void environmentCall(GLenum name, const Color& v) {
  listed("glTexEnv", [=](State& s) {
    if (name == GL_TEXTURE_ENV_COLOR) {
      s.now.texturing.color = v;
      return;
    }
    if (name != GL_TEXTURE_ENV_MODE) fail(GL_INVALID_ENUM, "no such property");
    const GLenum mode = toName(static_cast<double>(v[0]));
    if (mode == GL_BLEND)
      s.refuse("glTexEnv(GL_BLEND)", "make the picture with the colours that it is to have");
    s.now.texturing.mode = mode;
  });
}

} // namespace

void rtglGenTextures(GLsizei n, GLuint* names) {
  guarded("glGenTextures", [&](State& s) { s.textures.make(n, names); });
}
void rtglDeleteTextures(GLsizei n, const GLuint* names) {
  guarded("glDeleteTextures", [&](State& s) {
    if (n < 0) fail(GL_INVALID_VALUE, "the number is below 0");
    for (GLsizei i = 0; i < n; i++) {
      s.textures.remove(names[i]);
      if (s.now.texturing.bound == names[i]) s.now.texturing.bound = 0;
    }
  });
}
GLboolean rtglIsTexture(GLuint name) {
  bool is = false;
  guarded("glIsTexture", [&](State& s) { is = s.textures.has(name); });
  return is;
}
void rtglBindTexture(GLenum target, GLuint name) {
  listed("glBindTexture", [=](State& s) {
    requireTarget(s, target);
    s.textures.at(name);
    s.now.texturing.bound = name;
  });
}
// Every texture is in memory.
void rtglPrioritizeTextures(GLsizei, const GLuint*, const GLclampf*) {}
GLboolean rtglAreTexturesResident(GLsizei, const GLuint*, GLboolean*) { return GL_TRUE; }

void rtglTexImage1D(GLenum target, GLint level, GLint, GLsizei width, GLint border, GLenum format,
                    GLenum type, const GLvoid* pixels) {
  guarded("glTexImage1D",
          [&](State& s) { setImage(s, target, level, width, 1, border, format, type, pixels); });
}
void rtglTexImage2D(GLenum target, GLint level, GLint, GLsizei width, GLsizei height, GLint border,
                    GLenum format, GLenum type, const GLvoid* pixels) {
  guarded("glTexImage2D", [&](State& s) {
    setImage(s, target, level, width, height, border, format, type, pixels);
  });
}
void rtglTexSubImage1D(GLenum target, GLint level, GLint x, GLsizei width, GLenum format,
                       GLenum type, const GLvoid* pixels) {
  guarded("glTexSubImage1D",
          [&](State& s) { setPart(s, target, level, x, 0, width, 1, format, type, pixels); });
}
void rtglTexSubImage2D(GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                       GLenum format, GLenum type, const GLvoid* pixels) {
  guarded("glTexSubImage2D",
          [&](State& s) { setPart(s, target, level, x, y, width, height, format, type, pixels); });
}
void rtglTexParameterf(GLenum target, GLenum name, GLfloat value) {
  parameterCall(target, name, value);
}
void rtglTexParameteri(GLenum target, GLenum name, GLint value) {
  parameterCall(target, name, static_cast<float>(value));
}
void rtglTexParameterfv(GLenum target, GLenum name, const GLfloat* v) {
  if (name == GL_TEXTURE_BORDER_COLOR)
    guarded("glTexParameter", [](State& s) {
      s.refuse("GL_TEXTURE_BORDER_COLOR", "GL_CLAMP continues the edge of the picture");
    });
  else
    parameterCall(target, name, v[0]);
}
void rtglTexParameteriv(GLenum target, GLenum name, const GLint* v) {
  const GLfloat values[4] = {static_cast<float>(v[0])};
  rtglTexParameterfv(target, name, values);
}
void rtglGetTexParameterfv(GLenum, GLenum name, GLfloat* out) {
  guarded("glGetTexParameter", [&](State& s) { *out = static_cast<float>(parameterOf(s, name)); });
}
void rtglGetTexParameteriv(GLenum, GLenum name, GLint* out) {
  guarded("glGetTexParameter", [&](State& s) { *out = static_cast<GLint>(parameterOf(s, name)); });
}
void rtglTexEnvf(GLenum, GLenum name, GLfloat value) { environmentCall(name, {value, 0, 0, 0}); }
void rtglTexEnvi(GLenum, GLenum name, GLint value) {
  environmentCall(name, {static_cast<float>(value), 0, 0, 0});
}
void rtglTexEnvfv(GLenum, GLenum name, const GLfloat* v) {
  Color values = {};
  std::copy_n(v, name == GL_TEXTURE_ENV_COLOR ? 4 : 1, values.begin());
  environmentCall(name, values);
}
void rtglTexEnviv(GLenum, GLenum name, const GLint* v) {
  Color values = {static_cast<float>(v[0])};
  if (name == GL_TEXTURE_ENV_COLOR)
    for (size_t i = 0; i < 4; i++) values[i] = static_cast<float>((2.0 * v[i] + 1) / 4294967295.0);
  environmentCall(name, values);
}
void rtglGetTexEnvfv(GLenum, GLenum name, GLfloat* out) {
  guarded("glGetTexEnv", [&](State& s) {
    if (name == GL_TEXTURE_ENV_COLOR)
      std::copy_n(s.now.texturing.color.begin(), 4, out);
    else
      *out = static_cast<float>(s.now.texturing.mode);
  });
}
void rtglGetTexEnviv(GLenum, GLenum name, GLint* out) {
  guarded("glGetTexEnv", [&](State& s) {
    if (name != GL_TEXTURE_ENV_MODE) fail(GL_INVALID_ENUM, "use glGetTexEnvfv");
    *out = static_cast<GLint>(s.now.texturing.mode);
  });
}

void rtglPixelStorei(GLenum name, GLint value) {
  guarded("glPixelStore", [&](State& s) {
    if (value < 0) fail(GL_INVALID_VALUE, "the value is below 0");
    if ((name == GL_UNPACK_ALIGNMENT || name == GL_PACK_ALIGNMENT) && value != 1 && value != 2 &&
        value != 4 && value != 8)
      fail(GL_INVALID_VALUE, "alignments are 1, 2, 4 and 8");
    switch (name) {
    case GL_UNPACK_ALIGNMENT: s.unpack.alignment = value; break;
    case GL_UNPACK_ROW_LENGTH: s.unpack.rowLength = value; break;
    case GL_UNPACK_SKIP_ROWS: s.unpack.skipRows = value; break;
    case GL_UNPACK_SKIP_PIXELS: s.unpack.skipPixels = value; break;
    case GL_PACK_ALIGNMENT: s.pack.alignment = value; break;
    case GL_PACK_ROW_LENGTH: s.pack.rowLength = value; break;
    case GL_PACK_SKIP_ROWS: s.pack.skipRows = value; break;
    case GL_PACK_SKIP_PIXELS: s.pack.skipPixels = value; break;
    default: s.refuse("glPixelStore(GL_*_SWAP_BYTES or GL_*_LSB_FIRST)", "swap them before");
    }
  });
}
void rtglPixelStoref(GLenum name, GLfloat value) {
  rtglPixelStorei(name, toInteger(static_cast<double>(value)));
}
