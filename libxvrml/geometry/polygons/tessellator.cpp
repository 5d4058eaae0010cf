// tessellator.cpp: collects the output of the GLU tessellator's callbacks in arrays.
#include "geometry/polygons/tessellator.h"

#include <GL/glu.h>

#include <new>

namespace xvrml {
namespace {

// Vertex numbers pass through GLU as pointers. They are offset by 1, because 0 is the null pointer.
void* asPointer(uint32_t vertex) { return reinterpret_cast<void*>(uintptr_t(vertex) + 1); }
uint32_t asVertex(void* pointer) { return uint32_t(reinterpret_cast<uintptr_t>(pointer) - 1); }

// An edge flag callback makes GLU emit separate triangles only, never fans or strips.
void edgeFlag(GLboolean, void*) {}
void vertex(void* data, void* self) { static_cast<Tessellator*>(self)->addVertex(asVertex(data)); }
void error(GLenum, void* self) { static_cast<Tessellator*>(self)->fail(); }

void combine(GLdouble point[3], void* data[4], GLfloat weight[4], void** out, void* self) {
  // With only two vertices they coincide, so either can be used.
  if (!data[2] || !data[3]) {
    *out = data[0];
    return;
  }
  Tessellator::Crossing crossing{{point[0], point[1], point[2]}, {}, {}, 0};
  for (int i = 0; i < 4; i++) {
    crossing.from[crossing.count] = asVertex(data[i]);
    crossing.weight[crossing.count++] = weight[i];
  }
  *out = asPointer(static_cast<Tessellator*>(self)->addCrossing(crossing));
}

template <class F> void setCallback(GLUtesselator* tess, GLenum which, F* function) {
  gluTessCallback(tess, which, reinterpret_cast<_GLUfuncptr>(function));
}

} // namespace

Tessellator::Tessellator() : tess_(gluNewTess()) {
  if (!tess_) throw std::bad_alloc();
  setCallback(tess_, GLU_TESS_EDGE_FLAG_DATA, edgeFlag);
  setCallback(tess_, GLU_TESS_VERTEX_DATA, vertex);
  setCallback(tess_, GLU_TESS_ERROR_DATA, error);
  setCallback(tess_, GLU_TESS_COMBINE_DATA, combine);
}

Tessellator::~Tessellator() { gluDeleteTess(tess_); }

void Tessellator::begin(const V3d& normal, Winding winding) {
  triangles_.clear();
  crossings_.clear();
  vertices_ = 0;
  failed_ = false;
  gluTessProperty(tess_, GLU_TESS_WINDING_RULE,
                  winding == Winding::odd ? GLU_TESS_WINDING_ODD : GLU_TESS_WINDING_NONZERO);
  gluTessNormal(tess_, normal.x, normal.y, normal.z);
  gluTessBeginPolygon(tess_, this);
}

void Tessellator::contour(std::span<const V3d> points) {
  gluTessBeginContour(tess_);
  for (const V3d& point : points) {
    GLdouble coordinates[3] = {point.x, point.y, point.z}; // copied by GLU
    gluTessVertex(tess_, coordinates, asPointer(vertices_++));
  }
  gluTessEndContour(tess_);
}

bool Tessellator::end() {
  gluTessEndPolygon(tess_);
  if (failed_ || triangles_.size() % 3 != 0) triangles_.clear();
  return !failed_;
}

uint32_t Tessellator::addCrossing(const Crossing& crossing) {
  crossings_.push_back(crossing);
  return vertices_ + uint32_t(crossings_.size()) - 1;
}

} // namespace xvrml
