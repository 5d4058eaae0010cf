// frame_calls.cpp: Implements the calls that begin and end frames and read their pictures.
#include <algorithm>

#include "gl/pixels.h"
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

// Writes one component of a pixel as glReadPixels asks for it.
void write(unsigned char* at, size_t i, GLenum type, float value) {
  if (type == GL_FLOAT)
    reinterpret_cast<float*>(at)[i] = value;
  else
    at[i] = static_cast<unsigned char>(255 * value + 0.5f);
}

// Returns component i of a format of pixels.
float componentOf(const Film& film, int x, int y, GLenum format, int i) {
  switch (format) {
  case GL_RED: return film.shown(x, y, 0);
  case GL_GREEN: return film.shown(x, y, 1);
  case GL_BLUE: return film.shown(x, y, 2);
  case GL_ALPHA: return film.shown(x, y, 3);
  case GL_LUMINANCE:
  case GL_LUMINANCE_ALPHA:
    return i == 1 ? film.shown(x, y, 3)
                  : std::min(film.shown(x, y, 0) + film.shown(x, y, 1) + film.shown(x, y, 2), 1.0f);
  default: return film.shown(x, y, i);
  }
}

// Renders the frame; what is drawn next still belongs to it.
void showFrame(State& s) {
  s.textures.decode(s.scene.linear());
  s.showFrame();
}

bool endFrame(State& s) {
  s.textures.decode(s.scene.linear());
  return s.endFrame();
}

void flush(const char* name) {
  guarded(name, [](State& s) {
    if (s.singleBuffer && s.drewSomething()) endFrame(s);
  });
}

} // namespace

void rtglClearColor(GLclampf r, GLclampf g, GLclampf b, GLclampf a) {
  listed("glClearColor", [=](State& s) {
    s.now.pixels.clear = {std::clamp(r, 0.0f, 1.0f), std::clamp(g, 0.0f, 1.0f),
                          std::clamp(b, 0.0f, 1.0f), std::clamp(a, 0.0f, 1.0f)};
  });
}
// Rays meet the nearest surface, whatever its depth.
void rtglClearDepth(GLclampd) {}
void rtglClear(GLbitfield mask) {
  listed("glClear", [=](State& s) { s.clear(mask); });
}
// There is one picture.
void rtglDrawBuffer(GLenum) {}
void rtglReadBuffer(GLenum) {}
void rtglFlush(void) { flush("glFlush"); }
void rtglFinish(void) { flush("glFinish"); }

void rtglReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                    GLvoid* pixels) {
  guarded("glReadPixels", [&](State& s) {
    if (format == GL_DEPTH_COMPONENT || format == GL_STENCIL_INDEX) {
      s.refuse("glReadPixels(GL_DEPTH_COMPONENT or GL_STENCIL_INDEX)",
               "ask for distances by rtCastRays (openrt/query.h)");
      return;
    }
    if (type != GL_UNSIGNED_BYTE && type != GL_FLOAT)
      fail(GL_INVALID_ENUM, "pixels are GL_UNSIGNED_BYTE or GL_FLOAT");
    if (width < 0 || height < 0) fail(GL_INVALID_VALUE, "a size is below 0");
    if (s.drewSomething()) showFrame(s);
    const Film& film = s.scene.film();
    if (film.samples == 0) fail(GL_INVALID_OPERATION, "there is no picture yet");
    const int components = componentsOf(format);
    const size_t row = rowBytes(s.pack, width, format, type);
    const size_t pixel = static_cast<size_t>(components) * (type == GL_FLOAT ? sizeof(float) : 1);
    auto* first = static_cast<unsigned char*>(pixels) + static_cast<size_t>(s.pack.skipRows) * row +
                  static_cast<size_t>(s.pack.skipPixels) * pixel;
    // Pixels beyond the picture are left as they are.
    const int64_t left = std::max(-int64_t(x), int64_t(0)), low = std::max(-int64_t(y), int64_t(0));
    const int64_t right = std::min(int64_t(width), film.width - int64_t(x));
    const int64_t high = std::min(int64_t(height), film.height - int64_t(y));
    for (int64_t j = low; j < high; j++)
      for (int64_t i = left; i < right; i++) {
        const auto column = static_cast<int>(x + i);
        const auto line = static_cast<int>(film.height - 1 - (y + j)); // rows run upwards in OpenGL
        unsigned char* at = first + static_cast<size_t>(j) * row + static_cast<size_t>(i) * pixel;
        for (int c = 0; c < components; c++)
          write(at, static_cast<size_t>(c), type, componentOf(film, column, line, format, c));
      }
  });
}

void rtglLight(int light) {
  guarded("rtglLight", [&](State& s) {
    if (light < RTGL_OPENGL || light > RTGL_LINEAR) fail(GL_INVALID_ENUM, "no such light");
    s.scene.lightMode = light;
  });
}
void rtglSamples(int samples) {
  guarded("rtglSamples", [&](State& s) {
    if (samples < 1 || samples > 65536) fail(GL_INVALID_VALUE, "samples are 1 to 65536");
    s.scene.samples = samples;
  });
}
int rtglEndFrame(void) {
  bool rendered = false;
  guarded("rtglEndFrame", [&](State& s) {
    if (s.open()) fail(GL_INVALID_OPERATION, "glEnd is missing");
    rendered = endFrame(s);
  });
  return rendered;
}
int rtglRefine(void) {
  int samples = 0;
  guarded("rtglRefine", [&](State& s) { samples = s.scene.refine(); });
  return samples;
}
const unsigned char* rtglPicture(int* width, int* height) {
  const unsigned char* bytes = nullptr;
  guarded("rtglPicture", [&](State& s) {
    bytes = s.scene.film().bytes();
    *width = s.scene.film().width;
    *height = s.scene.film().height;
  });
  return bytes;
}
void rtglSingleBuffer(int single) {
  guarded("rtglSingleBuffer", [&](State& s) { s.singleBuffer = single != 0; });
}
void rtglErrorCallback(RTerrorCallback callback, void* user) {
  guarded("rtglErrorCallback", [&](State& s) { s.setErrorCallback(callback, user); });
}
const char* rtglGetErrorMessage(void) { return lastErrorText(); }
void rtglReset(void) { resetState(); }
