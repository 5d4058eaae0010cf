// array_calls.cpp: Implements vertex arrays. They are read when they are drawn, as if each vertex
// were given between glBegin and glEnd.
#include <cstring>

#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

size_t sizeOf(GLenum type) {
  switch (type) {
  case GL_BYTE:
  case GL_UNSIGNED_BYTE: return 1;
  case GL_SHORT:
  case GL_UNSIGNED_SHORT: return 2;
  case GL_INT:
  case GL_UNSIGNED_INT:
  case GL_FLOAT: return 4;
  case GL_DOUBLE: return 8;
  default: fail(GL_INVALID_ENUM, "no such type of an array");
  }
}

// Reads number c of those at an address, which may be any.
template <class T> T load(const unsigned char* at, size_t c) {
  T value;
  std::memcpy(&value, at + c * sizeof(T), sizeof(T));
  return value;
}

// Reads component c of an element. The range of integers stands for -1 .. 1 or 0 .. 1 if
// `normalised`.
float read(const ClientArray& array, size_t element, size_t c, bool normalised) {
  const size_t stride = array.stride > 0 ? static_cast<size_t>(array.stride)
                                         : static_cast<size_t>(array.size) * sizeOf(array.type);
  const auto* at = static_cast<const unsigned char*>(array.pointer) + element * stride;
  const auto whole = [&](double value, double largest) {
    return static_cast<float>(normalised ? value / largest : value);
  };
  switch (array.type) {
  case GL_BYTE: return whole(load<GLbyte>(at, c), 127);
  case GL_UNSIGNED_BYTE: return whole(at[c], 255);
  case GL_SHORT: return whole(load<GLshort>(at, c), 32767);
  case GL_UNSIGNED_SHORT: return whole(load<GLushort>(at, c), 65535);
  case GL_INT: return whole(load<GLint>(at, c), 2147483647.0);
  case GL_UNSIGNED_INT: return whole(load<GLuint>(at, c), 4294967295.0);
  case GL_DOUBLE: return static_cast<float>(load<GLdouble>(at, c));
  default: return load<GLfloat>(at, c);
  }
}

bool usable(const ClientArray& array) { return array.on && array.pointer != nullptr; }

void element(State& s, size_t i) {
  const ClientArrays& a = s.arrays;
  const auto at = [&](const ClientArray& array, size_t c, bool normalised, float other) {
    return c < static_cast<size_t>(array.size) ? read(array, i, c, normalised) : other;
  };
  if (usable(a.color))
    s.setColor({at(a.color, 0, true, 0), at(a.color, 1, true, 0), at(a.color, 2, true, 0),
                at(a.color, 3, true, 1)});
  if (usable(a.normal))
    s.setNormal(at(a.normal, 0, true, 0), at(a.normal, 1, true, 0), at(a.normal, 2, true, 0));
  if (usable(a.texCoord)) s.setTexCoord(at(a.texCoord, 0, false, 0), at(a.texCoord, 1, false, 0));
  if (usable(a.vertex))
    s.vertex(at(a.vertex, 0, false, 0), at(a.vertex, 1, false, 0), at(a.vertex, 2, false, 0));
}

ClientArray* arrayOf(ClientArrays& arrays, GLenum which) {
  switch (which) {
  case GL_VERTEX_ARRAY: return &arrays.vertex;
  case GL_NORMAL_ARRAY: return &arrays.normal;
  case GL_COLOR_ARRAY: return &arrays.color;
  case GL_TEXTURE_COORD_ARRAY: return &arrays.texCoord;
  default: return nullptr;
  }
}

void enable(const char* name, GLenum which, bool on) {
  guarded(name, [&](State& s) {
    if (ClientArray* array = arrayOf(s.arrays, which))
      array->on = on;
    else if (which == GL_INDEX_ARRAY)
      s.refuse("GL_INDEX_ARRAY", "colours have no indices: use glColorPointer");
    else if (which != GL_EDGE_FLAG_ARRAY)
      fail(GL_INVALID_ENUM, "no such array");
  });
}

void setPointer(const char* name, ClientArray ClientArrays::*which, GLint size, GLint smallest,
                GLenum type, GLsizei stride, const void* pointer) {
  guarded(name, [&](State& s) {
    if (size < smallest || size > 4) fail(GL_INVALID_VALUE, "no such number of components");
    if (stride < 0) fail(GL_INVALID_VALUE, "the stride is below 0");
    sizeOf(type);
    ClientArray& array = s.arrays.*which;
    array = {array.on, size, type, stride, pointer};
  });
}

size_t indexAt(GLenum type, const void* indices, size_t i) {
  switch (type) {
  case GL_UNSIGNED_BYTE: return static_cast<const GLubyte*>(indices)[i];
  case GL_UNSIGNED_SHORT: return static_cast<const GLushort*>(indices)[i];
  case GL_UNSIGNED_INT: return static_cast<const GLuint*>(indices)[i];
  default: fail(GL_INVALID_ENUM, "no such type of indices");
  }
}

// Draws `count` elements of the arrays. at(i) returns the index of the i-th one.
template <class At> void draw(State& s, GLenum mode, GLsizei count, const At& at) {
  if (static_cast<size_t>(count) > maxVertices) failForVertices();
  s.begin(mode);
  if (usable(s.arrays.vertex))
    for (size_t i = 0; i < static_cast<size_t>(count); i++) element(s, at(i));
  s.end();
}

// The layout of glInterleavedArrays: bytes from the start of an element; -1: no such array.
struct Layout {
  GLenum format;
  int texCoords, colors, texCoordAt, colorAt, normalAt, vertices, vertexAt, stride;
  GLenum colorType;
};
constexpr Layout layouts[] = {
    {GL_V2F, 0, 0, -1, -1, -1, 2, 0, 8, GL_FLOAT},
    {GL_V3F, 0, 0, -1, -1, -1, 3, 0, 12, GL_FLOAT},
    {GL_C4UB_V2F, 0, 4, -1, 0, -1, 2, 4, 12, GL_UNSIGNED_BYTE},
    {GL_C4UB_V3F, 0, 4, -1, 0, -1, 3, 4, 16, GL_UNSIGNED_BYTE},
    {GL_C3F_V3F, 0, 3, -1, 0, -1, 3, 12, 24, GL_FLOAT},
    {GL_N3F_V3F, 0, 0, -1, -1, 0, 3, 12, 24, GL_FLOAT},
    {GL_C4F_N3F_V3F, 0, 4, -1, 0, 16, 3, 28, 40, GL_FLOAT},
    {GL_T2F_V3F, 2, 0, 0, -1, -1, 3, 8, 20, GL_FLOAT},
    {GL_T4F_V4F, 4, 0, 0, -1, -1, 4, 16, 32, GL_FLOAT},
    {GL_T2F_C4UB_V3F, 2, 4, 0, 8, -1, 3, 12, 24, GL_UNSIGNED_BYTE},
    {GL_T2F_C3F_V3F, 2, 3, 0, 8, -1, 3, 20, 32, GL_FLOAT},
    {GL_T2F_N3F_V3F, 2, 0, 0, -1, 8, 3, 20, 32, GL_FLOAT},
    {GL_T2F_C4F_N3F_V3F, 2, 4, 0, 8, 24, 3, 36, 48, GL_FLOAT},
    {GL_T4F_C4F_N3F_V4F, 4, 4, 0, 16, 32, 4, 44, 60, GL_FLOAT},
};

} // namespace

void rtglEnableClientState(GLenum array) { enable("glEnableClientState", array, true); }
void rtglDisableClientState(GLenum array) { enable("glDisableClientState", array, false); }
void rtglVertexPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* pointer) {
  setPointer("glVertexPointer", &ClientArrays::vertex, size, 2, type, stride, pointer);
}
void rtglNormalPointer(GLenum type, GLsizei stride, const GLvoid* pointer) {
  setPointer("glNormalPointer", &ClientArrays::normal, 3, 3, type, stride, pointer);
}
void rtglColorPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* pointer) {
  setPointer("glColorPointer", &ClientArrays::color, size, 3, type, stride, pointer);
}
void rtglTexCoordPointer(GLint size, GLenum type, GLsizei stride, const GLvoid* pointer) {
  setPointer("glTexCoordPointer", &ClientArrays::texCoord, size, 1, type, stride, pointer);
}
// Edges are drawn by glPolygonMode without exception.
void rtglEdgeFlagPointer(GLsizei, const GLvoid*) {}
void rtglGetPointerv(GLenum name, GLvoid** out) {
  guarded("glGetPointerv", [&](State& s) {
    if (name == GL_SELECTION_BUFFER_POINTER) {
      *out = s.selection.buffer();
      return;
    }
    const ClientArray* array = name == GL_VERTEX_ARRAY_POINTER          ? &s.arrays.vertex
                               : name == GL_NORMAL_ARRAY_POINTER        ? &s.arrays.normal
                               : name == GL_COLOR_ARRAY_POINTER         ? &s.arrays.color
                               : name == GL_TEXTURE_COORD_ARRAY_POINTER ? &s.arrays.texCoord
                                                                        : nullptr;
    if (!array) fail(GL_INVALID_ENUM, "no such pointer");
    *out = const_cast<void*>(array->pointer);
  });
}
void rtglInterleavedArrays(GLenum format, GLsizei stride, const GLvoid* pointer) {
  guarded("glInterleavedArrays", [&](State& s) {
    for (const Layout& layout : layouts) {
      if (layout.format != format) continue;
      const GLsizei step = stride > 0 ? stride : layout.stride;
      const auto* base = static_cast<const unsigned char*>(pointer);
      const auto array = [&](int at, GLint size, GLenum type) {
        return at < 0 ? ClientArray{false, 4, GL_FLOAT, 0, nullptr}
                      : ClientArray{true, size, type, step, base + at};
      };
      s.arrays.texCoord = array(layout.texCoordAt, layout.texCoords, GL_FLOAT);
      s.arrays.color = array(layout.colorAt, layout.colors, layout.colorType);
      s.arrays.normal = array(layout.normalAt, 3, GL_FLOAT);
      s.arrays.vertex = array(layout.vertexAt, layout.vertices, GL_FLOAT);
      return;
    }
    fail(GL_INVALID_ENUM, "no such format");
  });
}
void rtglArrayElement(GLint i) {
  guarded("glArrayElement", [&](State& s) {
    if (i < 0) fail(GL_INVALID_VALUE, "the index is below 0");
    element(s, static_cast<size_t>(i));
  });
}
void rtglDrawArrays(GLenum mode, GLint first, GLsizei count) {
  guarded("glDrawArrays", [&](State& s) {
    if (first < 0 || count < 0) fail(GL_INVALID_VALUE, "a number is below 0");
    draw(s, mode, count, [=](size_t i) { return static_cast<size_t>(first) + i; });
  });
}
void rtglDrawElements(GLenum mode, GLsizei count, GLenum type, const GLvoid* indices) {
  guarded("glDrawElements", [&](State& s) {
    if (count < 0) fail(GL_INVALID_VALUE, "the number is below 0");
    if (type != GL_UNSIGNED_BYTE && type != GL_UNSIGNED_SHORT && type != GL_UNSIGNED_INT)
      fail(GL_INVALID_ENUM, "no such type of indices");
    draw(s, mode, count, [=](size_t i) { return indexAt(type, indices, i); });
  });
}
void rtglPushClientAttrib(GLbitfield mask) {
  guarded("glPushClientAttrib", [mask](State& s) {
    if (s.clientStack.size() >= 16) fail(GL_STACK_OVERFLOW, "too many glPushClientAttrib");
    s.clientStack.push_back({mask, s.arrays, s.unpack, s.pack});
  });
}
void rtglPopClientAttrib(void) {
  guarded("glPopClientAttrib", [](State& s) {
    if (s.clientStack.empty()) fail(GL_STACK_UNDERFLOW, "glPushClientAttrib is missing");
    const State::SavedClient& saved = s.clientStack.back();
    if (saved.mask & GL_CLIENT_VERTEX_ARRAY_BIT) s.arrays = saved.arrays;
    if (saved.mask & GL_CLIENT_PIXEL_STORE_BIT) {
      s.unpack = saved.unpack;
      s.pack = saved.pack;
    }
    s.clientStack.pop_back();
  });
}
