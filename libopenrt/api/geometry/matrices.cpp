// matrices.cpp: Implements the API functions for the current matrix, rtPushMatrix to rtLookAt. Runs
// on the application's thread.
#include "api/geometry/transform.h"
#include "api/guard.h"

using namespace openrt;

namespace {

Matrix4d fromFloats(const float* m) {
  require(m != nullptr, RT_INVALID_VALUE, "the matrix is NULL");
  double wide[16];
  for (int i = 0; i < 16; i++) wide[i] = m[i];
  return checkedMatrix(wide);
}

} // namespace

void rtPushMatrix(void) {
  guarded("rtPushMatrix", [](Context& c) { c.matrices.push(); });
}

void rtPopMatrix(void) {
  guarded("rtPopMatrix", [](Context& c) { c.matrices.pop(); });
}

void rtLoadIdentity(void) {
  guarded("rtLoadIdentity", [](Context& c) { c.matrices.load(Matrix4d()); });
}

void rtLoadMatrixf(const float m[16]) {
  guarded("rtLoadMatrixf", [&](Context& c) { c.matrices.load(fromFloats(m)); });
}

void rtLoadMatrixd(const double m[16]) {
  guarded("rtLoadMatrixd", [&](Context& c) { c.matrices.load(checkedMatrix(m)); });
}

void rtMultMatrixf(const float m[16]) {
  guarded("rtMultMatrixf", [&](Context& c) { c.matrices.multiply(fromFloats(m)); });
}

void rtMultMatrixd(const double m[16]) {
  guarded("rtMultMatrixd", [&](Context& c) { c.matrices.multiply(checkedMatrix(m)); });
}

void rtTranslatef(float x, float y, float z) {
  guarded("rtTranslatef", [&](Context& c) { c.matrices.multiply(translation(x, y, z)); });
}

void rtTranslated(double x, double y, double z) {
  guarded("rtTranslated", [&](Context& c) { c.matrices.multiply(translation(x, y, z)); });
}

void rtRotatef(float degrees, float x, float y, float z) {
  guarded("rtRotatef", [&](Context& c) { c.matrices.multiply(rotation(degrees, x, y, z)); });
}

void rtRotated(double degrees, double x, double y, double z) {
  guarded("rtRotated", [&](Context& c) { c.matrices.multiply(rotation(degrees, x, y, z)); });
}

void rtScalef(float x, float y, float z) {
  guarded("rtScalef", [&](Context& c) { c.matrices.multiply(scaling(x, y, z)); });
}

void rtScaled(double x, double y, double z) {
  guarded("rtScaled", [&](Context& c) { c.matrices.multiply(scaling(x, y, z)); });
}

void rtGetMatrixd(double m[16]) {
  guarded("rtGetMatrixd", [&](Context& c) {
    require(m != nullptr, RT_INVALID_VALUE, "the matrix is NULL");
    for (int i = 0; i < 16; i++) m[i] = c.matrices.top().m[i];
  });
}

void rtLookAt(double eyeX, double eyeY, double eyeZ, double atX, double atY, double atZ, double upX,
              double upY, double upZ) {
  guarded("rtLookAt", [&](Context& c) {
    c.matrices.multiply(lookAt({eyeX, eyeY, eyeZ}, {atX, atY, atZ}, {upX, upY, upZ}));
  });
}
