// state_calls.cpp: Implements the calls that turn capabilities on and off, ask for state, and set
// what happens to pixels and polygons.
#include <algorithm>
#include <vector>

#include "gl/numbers.h"
#include "gl/state.h"
#include "openrt/gl.h"

using namespace rtgl;

namespace {

// Returns the flag of a capability, or null.
bool* flagOf(Attributes& a, GLenum capability) {
  if (capability >= GL_LIGHT0 && capability < GL_LIGHT0 + lightCount)
    return &a.lighting.lights[capability - GL_LIGHT0].on;
  switch (capability) {
  case GL_LIGHTING: return &a.lighting.on;
  case GL_COLOR_MATERIAL: return &a.lighting.colorMaterial;
  case GL_FOG: return &a.fog.on;
  case GL_CULL_FACE: return &a.polygon.cull;
  case GL_BLEND: return &a.pixels.blend;
  case GL_ALPHA_TEST: return &a.pixels.alphaTest;
  case GL_DEPTH_TEST: return &a.depth.test;
  case GL_TEXTURE_1D:
  case GL_TEXTURE_2D: return &a.texturing.on;
  case GL_NORMALIZE: return &a.normalize;
  default: return nullptr;
  }
}

struct Refused {
  GLenum capability;
  const char *name, *instead;
};
constexpr const char* noClipping = "cut the geometry in the program";
constexpr const char* noTexGen = "give texture coordinates by glTexCoord";
constexpr Refused refusedCapabilities[] = {
    {GL_STENCIL_TEST, "GL_STENCIL_TEST", "shadows and mirrors are traced (rtglLight)"},
    {GL_SCISSOR_TEST, "GL_SCISSOR_TEST", "use rtScissor (openrt/frame.h), or a smaller viewport"},
    {GL_LINE_STIPPLE, "GL_LINE_STIPPLE", "draw the dashes as lines"},
    {GL_POLYGON_STIPPLE, "GL_POLYGON_STIPPLE", "use GL_BLEND and an alpha below 1"},
    {GL_INDEX_LOGIC_OP, "GL_INDEX_LOGIC_OP", "there are no logical operations on pixels"},
    {GL_COLOR_LOGIC_OP, "GL_COLOR_LOGIC_OP", "there are no logical operations on pixels"},
    {GL_AUTO_NORMAL, "GL_AUTO_NORMAL", "tessellate the surface in the program"},
    {GL_CLIP_PLANE0, "GL_CLIP_PLANE0", noClipping},
    {GL_CLIP_PLANE1, "GL_CLIP_PLANE1", noClipping},
    {GL_CLIP_PLANE2, "GL_CLIP_PLANE2", noClipping},
    {GL_CLIP_PLANE3, "GL_CLIP_PLANE3", noClipping},
    {GL_CLIP_PLANE4, "GL_CLIP_PLANE4", noClipping},
    {GL_CLIP_PLANE5, "GL_CLIP_PLANE5", noClipping},
    {GL_TEXTURE_GEN_S, "GL_TEXTURE_GEN_S", noTexGen},
    {GL_TEXTURE_GEN_T, "GL_TEXTURE_GEN_T", noTexGen},
    {GL_TEXTURE_GEN_R, "GL_TEXTURE_GEN_R", noTexGen},
    {GL_TEXTURE_GEN_Q, "GL_TEXTURE_GEN_Q", noTexGen},
};
// Capabilities that need nothing here: pictures are smooth, and coplanar polygons are ordered by
// the depth test.
constexpr GLenum without[] = {
    GL_POINT_SMOOTH,         GL_LINE_SMOOTH,         GL_POLYGON_SMOOTH,     GL_DITHER,
    GL_POLYGON_OFFSET_POINT, GL_POLYGON_OFFSET_LINE, GL_POLYGON_OFFSET_FILL};

bool isWithout(GLenum capability) {
  return std::find(std::begin(without), std::end(without), capability) != std::end(without);
}

void turn(State& s, GLenum capability, bool on) {
  if (bool* flag = flagOf(s.now, capability)) {
    *flag = on;
    s.trackColor();
    return;
  }
  for (const Refused& refused : refusedCapabilities)
    if (refused.capability == capability) {
      if (on) s.refuse(refused.name, refused.instead);
      return;
    }
  if (capability >= GL_MAP1_COLOR_4 && capability <= GL_MAP2_VERTEX_4) {
    if (on) s.refuse("GL_MAP1_* and GL_MAP2_*", "tessellate the surface in the program");
    return;
  }
  if (!isWithout(capability)) fail(GL_INVALID_ENUM, "no such capability");
}

template <class Range> std::vector<double> list(const Range& range) {
  return {range.begin(), range.end()};
}

// Returns the values that glGet writes.
std::vector<double> valuesOf(State& s, GLenum name) {
  const Attributes& a = s.now;
  if (const bool* flag = flagOf(s.now, name)) return {*flag ? 1.0 : 0.0};
  switch (name) {
  case GL_MODELVIEW_MATRIX: return list(s.modelview());
  case GL_PROJECTION_MATRIX: return list(s.projection());
  case GL_TEXTURE_MATRIX: return list(s.textureMatrix());
  case GL_MATRIX_MODE: return {double(a.matrixMode)};
  case GL_VIEWPORT: return list(a.viewport);
  case GL_CURRENT_COLOR: return list(a.current.color);
  case GL_CURRENT_NORMAL: return list(a.current.normal);
  case GL_CURRENT_TEXTURE_COORDS: return {a.current.texCoord[0], a.current.texCoord[1], 0, 1};
  case GL_COLOR_CLEAR_VALUE: return list(a.pixels.clear);
  case GL_LIGHT_MODEL_AMBIENT: return list(a.lighting.ambient);
  case GL_LIGHT_MODEL_TWO_SIDE: return {double(a.lighting.twoSide)};
  case GL_LIGHT_MODEL_LOCAL_VIEWER: return {double(a.lighting.localViewer)};
  case GL_SHADE_MODEL: return {double(a.lighting.shadeModel)};
  case GL_FOG_MODE: return {double(a.fog.mode)};
  case GL_FOG_DENSITY: return {a.fog.density};
  case GL_FOG_START: return {a.fog.start};
  case GL_FOG_END: return {a.fog.end};
  case GL_FOG_COLOR: return list(a.fog.color);
  case GL_LINE_WIDTH: return {a.lineWidth};
  case GL_POINT_SIZE: return {a.pointSize};
  case GL_CULL_FACE_MODE: return {double(a.polygon.cullFace)};
  case GL_FRONT_FACE: return {double(a.polygon.frontFace)};
  case GL_POLYGON_MODE: return list(a.polygon.mode);
  case GL_BLEND_SRC: return {double(a.pixels.source)};
  case GL_BLEND_DST: return {double(a.pixels.destination)};
  case GL_ALPHA_TEST_FUNC: return {double(a.pixels.alphaFunction)};
  case GL_ALPHA_TEST_REF: return {a.pixels.alphaReference};
  case GL_DEPTH_FUNC: return {double(a.depth.function)};
  case GL_DEPTH_WRITEMASK: return {double(a.depth.mask)};
  case GL_DEPTH_CLEAR_VALUE: return {1};
  case GL_DEPTH_RANGE: return {0, 1};
  case GL_TEXTURE_BINDING_2D: return {double(a.texturing.bound)};
  case GL_LIST_BASE: return {double(a.listBase)};
  case GL_LIST_INDEX: return {double(s.listName())};
  case GL_ATTRIB_STACK_DEPTH: return {double(s.attributeDepth())};
  case GL_CLIENT_ATTRIB_STACK_DEPTH: return {double(s.clientStack.size())};
  case GL_COLOR_MATERIAL_FACE: return {double(a.lighting.colorFace)};
  case GL_COLOR_MATERIAL_PARAMETER: return {double(a.lighting.colorMode)};
  case GL_COLOR_WRITEMASK: return {1, 1, 1, 1};
  case GL_DRAW_BUFFER:
  case GL_READ_BUFFER: return {double(s.singleBuffer ? GL_FRONT : GL_BACK)};
  case GL_MODELVIEW_STACK_DEPTH: return {double(s.depthOf(GL_MODELVIEW))};
  case GL_PROJECTION_STACK_DEPTH: return {double(s.depthOf(GL_PROJECTION))};
  case GL_TEXTURE_STACK_DEPTH: return {double(s.depthOf(GL_TEXTURE))};
  case GL_MAX_MODELVIEW_STACK_DEPTH:
  case GL_MAX_PROJECTION_STACK_DEPTH:
  case GL_MAX_TEXTURE_STACK_DEPTH: return {4096};
  case GL_MAX_LIGHTS: return {double(lightCount)};
  case GL_MAX_LIST_NESTING: return {64};
  case GL_MAX_ATTRIB_STACK_DEPTH:
  case GL_MAX_CLIENT_ATTRIB_STACK_DEPTH: return {16};
  case GL_MAX_TEXTURE_SIZE: return {double(maxTextureSize)};
  case GL_MAX_VIEWPORT_DIMS: return {double(maxViewportSide), double(maxViewportSide)};
  case GL_MAX_CLIP_PLANES: return {0};
  case GL_RED_BITS:
  case GL_GREEN_BITS:
  case GL_BLUE_BITS: return {8};
  case GL_DEPTH_BITS: return {32};
  case GL_ALPHA_BITS:
  case GL_INDEX_BITS:
  case GL_STENCIL_BITS:
  case GL_ACCUM_RED_BITS:
  case GL_ACCUM_GREEN_BITS:
  case GL_ACCUM_BLUE_BITS:
  case GL_ACCUM_ALPHA_BITS:
  case GL_INDEX_MODE:
  case GL_STEREO: return {0};
  case GL_DOUBLEBUFFER: return {s.singleBuffer ? 0.0 : 1.0};
  case GL_RGBA_MODE: return {1};
  case GL_RENDER_MODE: return {double(s.selection.mode())};
  case GL_NAME_STACK_DEPTH: return {double(s.selection.nameDepth())};
  case GL_MAX_NAME_STACK_DEPTH: return {double(Selection::maxNameDepth)};
  case GL_SELECTION_BUFFER_SIZE: return {double(s.selection.bufferSize())};
  case GL_UNPACK_ALIGNMENT: return {double(s.unpack.alignment)};
  case GL_PACK_ALIGNMENT: return {double(s.pack.alignment)};
  default: fail(GL_INVALID_ENUM, "no such state");
  }
}

// Numbers of 0 .. 1 or -1 .. 1 that become whole numbers fill their range.
bool isFraction(GLenum name) {
  return name == GL_CURRENT_COLOR || name == GL_CURRENT_NORMAL || name == GL_COLOR_CLEAR_VALUE ||
         name == GL_LIGHT_MODEL_AMBIENT || name == GL_FOG_COLOR || name == GL_DEPTH_RANGE ||
         name == GL_DEPTH_CLEAR_VALUE;
}

template <class T, class Convert>
void get(const char* call, GLenum name, T* out, const Convert& convert) {
  guarded(call, [&](State& s) {
    const std::vector<double> values = valuesOf(s, name);
    std::transform(values.begin(), values.end(), out, convert);
  });
}

} // namespace

void rtglEnable(GLenum capability) {
  listed("glEnable", [=](State& s) { turn(s, capability, true); });
}
void rtglDisable(GLenum capability) {
  listed("glDisable", [=](State& s) { turn(s, capability, false); });
}
GLboolean rtglIsEnabled(GLenum capability) {
  bool on = false;
  guarded("glIsEnabled", [&](State& s) {
    const bool* flag = flagOf(s.now, capability);
    on = flag && *flag;
  });
  return on;
}
void rtglGetBooleanv(GLenum name, GLboolean* out) {
  get("glGetBooleanv", name, out, [](double v) { return GLboolean(v != 0); });
}
void rtglGetDoublev(GLenum name, GLdouble* out) {
  get("glGetDoublev", name, out, [](double v) { return v; });
}
void rtglGetFloatv(GLenum name, GLfloat* out) {
  get("glGetFloatv", name, out, [](double v) { return static_cast<GLfloat>(v); });
}
void rtglGetIntegerv(GLenum name, GLint* out) {
  const double scale = isFraction(name) ? 2147483647.0 : 1.0;
  get("glGetIntegerv", name, out, [=](double v) { return toInteger(v * scale); });
}
GLenum rtglGetError(void) {
  GLenum error = GL_INVALID_OPERATION; // no context can be made
  guarded("glGetError", [&](State& s) { error = s.takeError(); });
  return error;
}
const GLubyte* rtglGetString(GLenum name) {
  const char* text = name == GL_VENDOR       ? "OpenRT"
                     : name == GL_RENDERER   ? "OpenRT ray tracer"
                     : name == GL_VERSION    ? "1.1 OpenRT"
                     : name == GL_EXTENSIONS ? ""
                                             : nullptr;
  return reinterpret_cast<const GLubyte*>(text);
}
void rtglPushAttrib(GLbitfield mask) {
  listed("glPushAttrib", [=](State& s) { s.pushAttributes(mask); });
}
void rtglPopAttrib(void) {
  listed("glPopAttrib", [](State& s) { s.popAttributes(); });
}
void rtglHint(GLenum, GLenum) {}

void rtglAlphaFunc(GLenum function, GLclampf reference) {
  listed("glAlphaFunc", [=](State& s) {
    if (function != GL_ALWAYS && function != GL_GREATER && function != GL_GEQUAL)
      s.refuse("glAlphaFunc other than GL_GREATER, GL_GEQUAL and GL_ALWAYS",
               "invert the alpha of the picture");
    s.now.pixels.alphaFunction = function;
    s.now.pixels.alphaReference = std::clamp(reference, 0.0f, 1.0f);
  });
}
void rtglBlendFunc(GLenum source, GLenum destination) {
  listed("glBlendFunc", [=](State& s) {
    const bool usual = source == GL_SRC_ALPHA && destination == GL_ONE_MINUS_SRC_ALPHA;
    if (!usual && !(source == GL_ONE && destination == GL_ZERO))
      s.refuse("glBlendFunc other than GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA",
               "surfaces let light through by their alpha; those that shine have GL_EMISSION");
    s.now.pixels.source = source;
    s.now.pixels.destination = destination;
  });
}
void rtglDepthFunc(GLenum function) {
  listed("glDepthFunc", [=](State& s) {
    if (function != GL_LESS && function != GL_LEQUAL)
      s.refuse("glDepthFunc other than GL_LESS and GL_LEQUAL", "rays meet the nearest surface");
    s.now.depth.function = function;
  });
}
void rtglDepthMask(GLboolean flag) {
  listed("glDepthMask", [=](State& s) { s.now.depth.mask = flag; });
}
void rtglColorMask(GLboolean r, GLboolean g, GLboolean b, GLboolean a) {
  listed("glColorMask", [=](State& s) {
    if (!(r && g && b && a)) s.refuse("glColorMask", "change the colours of lights and materials");
  });
}
void rtglCullFace(GLenum mode) {
  listed("glCullFace", [=](State& s) {
    if (mode != GL_FRONT && mode != GL_BACK && mode != GL_FRONT_AND_BACK)
      fail(GL_INVALID_ENUM, "no such face");
    s.now.polygon.cullFace = mode;
  });
}
void rtglFrontFace(GLenum mode) {
  listed("glFrontFace", [=](State& s) {
    if (mode != GL_CW && mode != GL_CCW) fail(GL_INVALID_ENUM, "no such direction");
    s.now.polygon.frontFace = mode;
  });
}
void rtglPolygonMode(GLenum face, GLenum mode) {
  listed("glPolygonMode", [=](State& s) {
    if (mode != GL_POINT && mode != GL_LINE && mode != GL_FILL)
      fail(GL_INVALID_ENUM, "no such mode");
    if (face != GL_FRONT && face != GL_BACK && face != GL_FRONT_AND_BACK)
      fail(GL_INVALID_ENUM, "no such face");
    if (face != GL_BACK) s.now.polygon.mode[0] = mode;
    if (face != GL_FRONT) s.now.polygon.mode[1] = mode;
  });
}
void rtglPolygonOffset(GLfloat, GLfloat) {}
void rtglPointSize(GLfloat size) {
  listed("glPointSize", [=](State& s) {
    if (!(size > 0)) fail(GL_INVALID_VALUE, "the size is not above 0");
    s.now.pointSize = size;
  });
}
void rtglLineWidth(GLfloat width) {
  listed("glLineWidth", [=](State& s) {
    if (!(width > 0)) fail(GL_INVALID_VALUE, "the width is not above 0");
    s.now.lineWidth = width;
  });
}
