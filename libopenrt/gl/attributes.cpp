// attributes.cpp: Restores the groups of state that glPopAttrib names (OpenGL 1.1, section 6.1.11).
#include "gl/attributes.h"

namespace rtgl {

void restore(const Attributes& from, GLbitfield mask, Attributes& to) {
  if (mask & GL_CURRENT_BIT) to.current = from.current;
  if (mask & GL_POINT_BIT) to.pointSize = from.pointSize;
  if (mask & GL_LINE_BIT) to.lineWidth = from.lineWidth;
  if (mask & GL_POLYGON_BIT) to.polygon = from.polygon;
  if (mask & GL_LIGHTING_BIT) to.lighting = from.lighting;
  if (mask & GL_FOG_BIT) to.fog = from.fog;
  if (mask & GL_DEPTH_BUFFER_BIT) to.depth = from.depth;
  if (mask & GL_VIEWPORT_BIT) to.viewport = from.viewport;
  if (mask & GL_COLOR_BUFFER_BIT) to.pixels = from.pixels;
  if (mask & GL_LIST_BIT) to.listBase = from.listBase;
  if (mask & GL_TEXTURE_BIT) to.texturing = from.texturing;
  if (mask & GL_TRANSFORM_BIT) {
    to.matrixMode = from.matrixMode;
    to.normalize = from.normalize;
  }
  if (mask & GL_ENABLE_BIT) {
    to.lighting.on = from.lighting.on;
    to.lighting.colorMaterial = from.lighting.colorMaterial;
    for (size_t i = 0; i < lightCount; i++) to.lighting.lights[i].on = from.lighting.lights[i].on;
    to.fog.on = from.fog.on;
    to.polygon.cull = from.polygon.cull;
    to.pixels.blend = from.pixels.blend;
    to.pixels.alphaTest = from.pixels.alphaTest;
    to.depth.test = from.depth.test;
    to.texturing.on = from.texturing.on;
    to.normalize = from.normalize;
  }
}

} // namespace rtgl
