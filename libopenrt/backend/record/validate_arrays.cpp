// validate_arrays.cpp: checks sizes, indices and values of vertices and texels. Pure functions.
#include "backend/record/validate_arrays.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "picture_size.h"
#include "scene/analytic.h"
#include "scene/stipple.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

void demand(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(what);
}

const Array* arrayOf(const Commit& commit, ArrayId id) {
  if (id == 0) return nullptr;
  const auto found = commit.arrays.find(id);
  demand(found != commit.arrays.end() && found->second, "an array did not arrive with its edit");
  return found->second.get();
}

void checkFinite(const Array& array, const char* what) {
  const float* values = array.as<float>();
  for (size_t i = 0; i < array.count<float>(); i++) demand(std::isfinite(values[i]), what);
}

void checkAttribute(const Commit& commit, ArrayId id, size_t vertices, size_t components,
                    const char* what) {
  const Array* array = arrayOf(commit, id);
  if (!array) return;
  demand(array->size() == vertices * components * sizeof(float), what);
  checkFinite(*array, what);
}

bool hasVertices(edit::Primitive primitive) {
  return primitive != edit::Primitive::Sphere && !AnalyticSurface::isAnalytic(primitive);
}

size_t cornersOf(edit::Primitive primitive) {
  switch (primitive) {
  case edit::Primitive::Triangles: return 3;
  case edit::Primitive::Lines: return 2;
  case edit::Primitive::Points: return 1;
  case edit::Primitive::Sphere:
  case edit::Primitive::Quadric:
  case edit::Primitive::Asphere: break;
  }
  throw std::runtime_error("an unknown primitive");
}

} // namespace

void checkGeometryArrays(const edit::GeometryT& g, const Commit& commit) {
  demand(g.texGen <= edit::TexGen::MAX, "unknown texture coordinates");
  demand(g.stippleFactor >= 1 && g.stippleFactor <= Stipple::largestFactor,
         "the factor of a stipple is not 1 to 256");
  const std::string problem = AnalyticSurface::problemOf(g.primitive, g.surface);
  if (!problem.empty()) throw std::runtime_error(problem);
  if (!hasVertices(g.primitive)) {
    demand(!g.points && !g.indices && !g.normals && !g.texCoords && !g.colors && !g.fogCoords &&
               !g.rest,
           g.primitive == edit::Primitive::Sphere ? "a sphere has vertices"
                                                  : "an analytic surface has vertices");
    return;
  }
  const size_t corners = cornersOf(g.primitive);
  const Array* points = arrayOf(commit, g.points);
  const Array* indices = arrayOf(commit, g.indices);
  demand(points && indices, "a geometry has no vertices");
  demand(points->size() % (3 * sizeof(float)) == 0, "the points have a wrong size");
  demand(indices->size() % (corners * sizeof(uint32_t)) == 0, "the indices have a wrong size");
  const size_t vertices = points->count<float>() / 3;
  checkFinite(*points, "a point is not finite");
  for (size_t i = 0; i < indices->count<uint32_t>(); i++)
    demand(indices->as<uint32_t>()[i] < vertices, "an index is beyond the points");
  checkAttribute(commit, g.normals, vertices, 3, "the normals have a wrong size or are not finite");
  checkAttribute(commit, g.texCoords, vertices, 2,
                 "the texture coordinates have a wrong size or are not finite");
  checkAttribute(commit, g.colors, vertices, 4, "the colours have a wrong size or are not finite");
  checkAttribute(commit, g.fogCoords, vertices, 1,
                 "the fog coordinates have a wrong size or are not finite");
  demand(!g.rest || g.primitive == edit::Primitive::Triangles, "only meshes deform");
  checkAttribute(commit, g.rest, vertices, 3,
                 "the points at rest have a wrong size or are not finite");
}

void checkParameterValues(const edit::GeometryT& g, const edit::GeometryParameterT& own,
                          const Commit& commit, const RtsParam* param) {
  demand(hasVertices(g.primitive), "a sphere has parameters of its own, or an analytic surface");
  const Array* values = arrayOf(commit, own.values);
  demand(values != nullptr, "a parameter has no values");
  const Array& counted = *arrayOf(commit, own.perVertex ? g.points : g.indices);
  const size_t count = own.perVertex ? counted.count<float>() / 3
                                     : counted.count<uint32_t>() / cornersOf(g.primitive);
  demand(count > 0 && values->size() % (count * sizeof(float)) == 0,
         "the values of a parameter have a wrong size");
  const size_t floats = values->count<float>() / count;
  demand(param ? floats == parameterFloats(param->type) : floats >= 1 && floats <= 16,
         "the values of a parameter have a wrong size");
  checkFinite(*values, "a parameter's value is not finite");
  for (size_t i = 0; param && i < count; i++) {
    const std::string problem =
        valueProblem(*param, std::span<const float>(values->as<float>() + floats * i, floats));
    if (!problem.empty()) throw std::runtime_error(problem);
  }
}

void checkTexture(const edit::TextureT& t, const Commit& commit, const edit::TextureT* current) {
  demand(t.components >= 1 && t.components <= 4 && isVolumeSize(t.width, t.height, t.depth),
         "a texture has an impossible size");
  demand(t.wrapS <= edit::Wrap::MAX && t.wrapT <= edit::Wrap::MAX && t.wrapR <= edit::Wrap::MAX,
         "an unknown wrap");
  demand(t.border.empty() || t.border.size() == 4, "a border colour needs four numbers");
  for (const float part : t.border)
    demand(part >= 0 && part <= 1, "a border colour is out of range");
  demand(t.texels != 0, "a texture has no texels");
  const auto found = commit.arrays.find(t.texels);
  if (found == commit.arrays.end()) {
    demand(current && t.texels == current->texels, "the texels did not arrive with their edit");
    demand(t.width == current->width && t.height == current->height && t.depth == current->depth &&
               t.components == current->components && t.isFloat == current->isFloat,
           "the texels have a wrong size");
    return;
  }
  const uint64_t values = uint64_t(t.width) * t.height * t.depth * t.components;
  demand(found->second->size() == values * (t.isFloat ? sizeof(float) : 1),
         "the texels have a wrong size");
  if (t.isFloat) checkFinite(*found->second, "a texel is not finite");
}

} // namespace openrt
