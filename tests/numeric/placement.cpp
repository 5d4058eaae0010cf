// placement.cpp: light scopes and nested instances under matrices of every kind. Tests check which
// surfaces are lit and where normals point, against matrices composed in double precision here.
#include "numeric/support.h"

namespace numeric {
namespace {

using Placement = Scene;

TEST_F(Placement, ScopedLightsShineBelowTheirInstanceOnly) {
  const RTid plane = square(Shader("VRML97"), 1);
  rtPushMatrix();
  rtTranslated(-3, 0, 0);
  const RTid left = place(plane);
  rtTranslated(6, 0, 0);
  const RTid right = place(plane);
  rtPopMatrix();
  const RTid light = use(tilted(0));
  rtLightScope(light, left);
  expectGrey(look(-3), .8);
  expectGrey(look(3), 0);
  rtLightScope(light, right);
  expectGrey(look(-3), 0);
  expectGrey(look(3), .8);
  rtLightScope(light, 0);
  expectGrey(look(-3), .8);
  expectGrey(look(3), .8);
}

TEST_F(Placement, AScopeReachesNestedInstances) {
  const RTid plane = square(Shader("VRML97"), 1);
  const RTid inner = rtBeginObject(0);
  rtInstantiateObject(plane);
  rtEndObject();
  const RTid outer = rtBeginObject(0);
  rtTranslated(2, 0, 0);
  rtInstantiateObject(inner);
  rtEndObject();
  rtPushMatrix();
  const RTid lit = place(outer);
  rtTranslated(-4, 0, 0);
  place(outer);
  rtPopMatrix();
  rtLightScope(use(tilted(0).set("intensity", {.5})), lit);
  use(tilted(0).set("intensity", {.25}));
  expectGrey(look(2), .8 * .75);
  expectGrey(look(-2), .8 * .25);
}

TEST_F(Placement, RemovedLightsAreGone) {
  place(square(Shader("VRML97")));
  const RTid a = use(tilted(0)), b = use(tilted(60));
  expectGrey(look(), 1.2);
  rtRemoveLight(a);
  expectGrey(look(), .4);
  rtRemoveLight(b);
  expectGrey(look(), 0);
}

TEST_F(Placement, LightsMoveWithTheirMatrix) {
  place(square(Shader("VRML97")));
  const RTid light = use(tilted(0));
  expectGrey(look(), .8);
  const double c = std::cos(pi / 3), s = std::sin(pi / 3);
  const double turn[16] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1}; // 60 degrees about y
  rtLightMatrix(light, turn);
  expectGrey(look(), .4);
}

struct Matrix { // 3x3, row-major
  double m[3][3];
};

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix r{};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) r.m[i][j] += a.m[i][k] * b.m[k][j];
  return r;
}

Matrix scaling(double x, double y, double z) { return {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }
Matrix turning(double degrees) { // rotation about y, as by rtRotate
  const double t = degrees * pi / 180, c = std::cos(t), s = std::sin(t);
  return {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
}

Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Returns the unit normal of the image of the plane with normal n, by the cofactor matrix (the
// inverse transpose times the determinant).
Vec normalUnder(const Matrix& a, Vec n) {
  const auto row = [&](int i) { return Vec{a.m[i][0], a.m[i][1], a.m[i][2]}; };
  const Vec c0 = cross(row(1), row(2)), c1 = cross(row(2), row(0)), c2 = cross(row(0), row(1));
  const Vec v{c0.x * n.x + c0.y * n.y + c0.z * n.z, c1.x * n.x + c1.y * n.y + c1.z * n.z,
              c2.x * n.x + c2.y * n.y + c2.z * n.z};
  const double l =
      std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) * (v.z < 0 ? -1 : 1); // towards the camera
  return {v.x / l, v.y / l, v.z / l};
}

// A square through the origin with normal (1, 0, 2), spanned by (2, 0, -1) and y; with or without
// vertex normals.
RTid slope(RTid shader, bool normals) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  if (normals) rtNormal3f(1, 0, 2);
  rtVertex3f(-2, -2, 1);
  rtVertex3f(2, -2, -1);
  rtVertex3f(2, 2, -1);
  rtVertex3f(-2, 2, 1);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return object;
}

void apply(const Matrix& a) {
  const double m[16] = {a.m[0][0], a.m[1][0], a.m[2][0], 0, a.m[0][1], a.m[1][1], a.m[2][1], 0,
                        a.m[0][2], a.m[1][2], a.m[2][2], 0, 0,         0,         0,         1};
  rtMultMatrixd(m);
}

TEST_F(Placement, NormalsUnderNestedScalesAndMirrors) {
  use(tilted(0));
  const Shader s("VRML97");
  const Matrix outers[] = {scaling(1, 1, 1), scaling(3, 1, .5), scaling(1, 1, -1),
                           scaling(-2, 1, 1), scaling(-1, -1, -1)};
  const Matrix inners[] = {scaling(1, 1, 1), turning(20), scaling(.25, 5, 1) * turning(-35),
                           scaling(1, -1, 2)};
  for (const bool normals : {false, true})
    for (const Matrix& outer : outers)
      for (const Matrix& inner : inners) {
        SCOPED_TRACE(testing::Message() << "own normals " << normals << ", outer "
                                        << (&outer - outers) << ", inner " << (&inner - inners));
        const RTid leaf = slope(s, normals);
        const RTid middle = rtBeginObject(0);
        apply(inner);
        rtInstantiateObject(leaf);
        rtEndObject();
        rtPushMatrix();
        apply(outer);
        const RTid instance = place(middle);
        rtPopMatrix();
        const Vec n = normalUnder(outer * inner, {1, 0, 2});
        rtPushMatrix();
        rtLoadIdentity();
        rtTranslated(0, 0, 20);
        rtOrtho(1e-6);
        rtPopMatrix();
        const Rgba pixel = render(RT_RGBA | RT_NORMAL);
        expectGrey(pixel, .8 * n.z);
        float seen[3] = {};
        rtReadPixels(RT_NORMAL, seen, 3);
        EXPECT_NEAR(seen[0], n.x, 1e-5);
        EXPECT_NEAR(seen[1], n.y, 1e-5);
        EXPECT_NEAR(seen[2], n.z, 1e-5);
        rtDeleteInstance(instance);
      }
}

TEST_F(Placement, AThousandNestedTurns) { // N12
  const double step = .36, growth = 1.001;
  RTid object = square(Shader("VRML97"), 1);
  for (int k = 0; k < 1000; k++) {
    const RTid next = rtBeginObject(0);
    rtRotated(step, 0, 0, 1);
    rtScaled(growth, growth, growth);
    rtInstantiateObject(object);
    rtEndObject();
    object = next;
  }
  place(object);
  use(tilted(0));
  const double half = std::pow(growth, 1000); // one full turn, so the square is upright again
  expectGrey(look(half * .99999, half * .99999), .8);
  expectGrey(look(half * 1.00001, 0), 0);
  expectGrey(look(0, half * 1.00001), 0);
}

// A sphere that is scaled to an ellipsoid becomes an instance internally. Queries must give its
// normal in world space for every placement.
TEST_F(Placement, NormalsOfEllipsoidsInQueries) {
  const RTid ball = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  for (const RTenum hint : {RT_STATIC, RT_DYNAMIC}) {
    rtPushMatrix();
    apply(scaling(1, 2, -1));
    const RTid instance = place(ball);
    rtInstanceHint(instance, hint);
    rtPopMatrix();
    look();
    const RTray ray{{0, 1, 5}, 0, {0, 0, -1}, 10};
    RThit hit;
    rtCastRays(1, &ray, &hit);
    const double z = std::sqrt(.75), l = std::sqrt(.0625 + .75);
    EXPECT_NEAR(hit.t, 5 - z, 1e-5);
    EXPECT_NEAR(hit.normal[0], 0, 1e-5);
    EXPECT_NEAR(hit.normal[1], .25 / l, 1e-5);
    EXPECT_NEAR(hit.normal[2], z / l, 1e-5);
    rtDeleteInstance(instance);
  }
}

TEST_F(Placement, TheNearestOfTwoSquaresIsSeen) {
  place(square(Shader("VRML97").setInt("lit", 0), 10));
  rtPushMatrix();
  rtTranslated(0, 0, 1e-4);
  place(square(Shader("VRML97").set("emissiveColor", {.25, .25, .25}), 1));
  rtPopMatrix();
  expectGrey(look(0, 0), .25);
  expectGrey(look(2, 0), 1);
}

} // namespace
} // namespace numeric
