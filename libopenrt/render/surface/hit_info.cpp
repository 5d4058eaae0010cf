// hit_info.cpp: data about hits that shaders may request beyond RtsHits; computed on request.
// Called by host.cpp. [render]
#include "render/surface/hit_info.h"

#include <algorithm>
#include <cmath>

#include "render/surface/batch.h"

namespace openrt {
namespace {

// Fills three arrays of a batch without hits; `arrays` may be null.
void fillVectors(const RtsBatch& batch, float* const arrays[3], float value) {
  for (int k = 0; arrays && k < 3; k++) std::fill_n(arrays[k], batch.lanesWithoutHits(), value);
}
void fillNumbers(const RtsBatch& batch, uint32_t* array, uint32_t value) {
  if (array) std::fill_n(array, batch.lanesWithoutHits(), value);
}

const Record& recordAt(const RtsBatch& batch, uint32_t i) {
  return batch.scene->records[batch.points->record[batch.pointOf(i)]];
}
uint32_t primitiveAt(const RtsBatch& batch, uint32_t i) {
  return batch.points->rayHits->primitive[batch.points->order[batch.pointOf(i)]];
}

void applyLinear(const Affine& m, const double v[3], float* const out[3], uint32_t i) {
  for (int k = 0; k < 3; k++)
    out[k][i] = float(m.r[k][0] * v[0] + m.r[k][1] * v[1] + m.r[k][2] * v[2]);
}

void triangleDerivatives(const RtsBatch& batch, uint32_t i, float* const alongS[3],
                         float* const alongT[3]) {
  const Record& r = recordAt(batch, i);
  if (!r.texCoords) return;
  const uint32_t primitive = primitiveAt(batch, i);
  float p[3][3];
  cornersOf(r, primitive, p);
  const uint32_t* corner = r.indices + 3 * size_t(primitive);
  const float *a = r.texCoords + 2 * size_t(corner[0]), *b = r.texCoords + 2 * size_t(corner[1]),
              *c = r.texCoords + 2 * size_t(corner[2]);
  const double s1 = double(b[0]) - a[0], t1 = double(b[1]) - a[1], s2 = double(c[0]) - a[0],
               t2 = double(c[1]) - a[1];
  const double area = s1 * t2 - s2 * t1;
  if (area == 0) return;
  for (int k = 0; k < 3; k++) {
    const double e1 = double(p[1][k]) - p[0][k], e2 = double(p[2][k]) - p[0][k];
    alongS[k][i] = float((t2 * e1 - t1 * e2) / area);
    alongT[k][i] = float((s1 * e2 - s2 * e1) / area);
  }
}

// Computes the derivatives of the position by the texture coordinates of rtSphere.
void sphereDerivatives(const RtsBatch& batch, uint32_t i, float* const alongS[3],
                       float* const alongT[3]) {
  const Record& r = recordAt(batch, i);
  const uint32_t point = batch.pointOf(i);
  double l[3], length = 0;
  for (int k = 0; k < 3; k++) {
    l[k] = r.fromRender.r[k][3];
    for (int j = 0; j < 3; j++)
      l[k] += double(r.fromRender.r[k][j]) * batch.points->hits.position[j][point];
    length += l[k] * l[k];
  }
  length = std::sqrt(length);
  if (!(length > 0)) return;
  for (double& x : l) x /= length;
  const double round = std::hypot(l[0], l[2]), s[3] = {2 * M_PI * l[2], 0, -2 * M_PI * l[0]};
  const double slope = round > 0 ? -l[1] / round : 0,
               t[3] = {M_PI * slope * l[0], M_PI * round, M_PI * slope * l[2]};
  applyLinear(r.toRender, s, alongS, i);
  applyLinear(r.toRender, t, alongT, i);
}

} // namespace

void localOf(const RtsBatch& batch, float* const position[3], float* const normal[3]) {
  if (!batch.points) {
    fillVectors(batch, position, 0);
    fillVectors(batch, normal, 0);
    return;
  }
  const RtsHits& hits = batch.points->hits;
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    const Affine& m = recordAt(batch, i).toObject;
    const uint32_t at = batch.pointOf(i);
    const float p[3] = {hits.position[0][at], hits.position[1][at], hits.position[2][at]};
    if (position)
      for (int k = 0; k < 3; k++)
        position[k][i] = m.r[k][0] * p[0] + m.r[k][1] * p[1] + m.r[k][2] * p[2] + m.r[k][3];
    if (!normal) continue;
    const Affine back = inverseOf(m); // normals are transformed by the transpose of the inverse
    for (int k = 0; k < 3; k++)
      normal[k][i] = back.r[0][k] * hits.geometric[0][at] + back.r[1][k] * hits.geometric[1][at] +
                     back.r[2][k] * hits.geometric[2][at];
  }
}

void derivativesOf(const RtsBatch& batch, float* const alongS[3], float* const alongT[3]) {
  if (!batch.points) {
    fillVectors(batch, alongS, 0);
    fillVectors(batch, alongT, 0);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    for (int k = 0; k < 3; k++) alongS[k][i] = alongT[k][i] = 0;
    const edit::Primitive primitive = recordAt(batch, i).primitive;
    if (primitive == edit::Primitive::Triangles) triangleDerivatives(batch, i, alongS, alongT);
    if (primitive == edit::Primitive::Sphere) sphereDerivatives(batch, i, alongS, alongT);
  }
}

void idsOf(const RtsBatch& batch, uint32_t* name, uint32_t* instance, uint32_t* primitive) {
  if (!batch.points) {
    for (uint32_t* array : {name, instance, primitive}) fillNumbers(batch, array, 0);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    const Record& r = recordAt(batch, i);
    if (name) name[i] = r.name;
    if (instance) instance[i] = r.instance;
    if (primitive) primitive[i] = primitiveAt(batch, i);
  }
}

void pathsOf(const RtsBatch& batch, uint32_t level, uint32_t* depth, float* const throughput[3]) {
  if (!batch.points) {
    fillNumbers(batch, depth, 0);
    fillVectors(batch, throughput, 1);
    return;
  }
  for (uint32_t i = 0; i < batch.hitCount(); i++) {
    if (depth) depth[i] = level;
    for (int k = 0; throughput && k < 3; k++)
      throughput[k][i] = batch.order ? batch.states->throughput[k][batch.order[i]] : 1.0f;
  }
}

} // namespace openrt
