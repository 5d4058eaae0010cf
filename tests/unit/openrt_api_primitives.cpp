// openrt_api_primitives.cpp: Tests rtBegin and rtEnd: modes, latched attributes, merging, positions
// in double, degenerate and bad input.
#include <cmath>
#include <limits>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;
using Indices = std::vector<uint32_t>;

constexpr float infinity = std::numeric_limits<float>::infinity();

class Primitives : public ApiTest {
 protected:
  // Vertices on a convex curve, so that no three are collinear.
  void curve(int count) {
    for (int i = 0; i < count; i++) rtVertex3f(float(i), float(i * i), 0);
  }
  // Ends the object and returns its geometries as committed.
  const edit::ObjectT& end() {
    rtEndObject();
    last = &commit();
    const auto objects = edits<edit::ObjectT>(*last);
    EXPECT_EQ(objects.size(), 1u);
    return *objects.at(0);
  }
  const edit::GeometryT& only() {
    const edit::ObjectT& object = end();
    EXPECT_EQ(object.geometries.size(), 1u);
    return *object.geometries.at(0);
  }
  uint64_t degenerate() {
    RTstats stats;
    stats.size = sizeof(stats);
    rtGetStats(&stats);
    return stats.rejected.primitives - 1; // the capturing backend adds one
  }
  const Commit* last = nullptr;
};

struct ModeCase {
  RTenum mode;
  int vertices;
  edit::Primitive primitive;
  Indices indices;
};

class Modes : public Primitives, public testing::WithParamInterface<ModeCase> {};

TEST_P(Modes, MakeTheseIndices) {
  rtBeginObject(0);
  rtBegin(GetParam().mode);
  curve(GetParam().vertices);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(g.primitive, GetParam().primitive);
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), GetParam().indices);
}

INSTANTIATE_TEST_SUITE_P(
    Api, Modes,
    testing::Values(
        ModeCase{RT_POINTS, 3, edit::Primitive::Points, {0, 1, 2}},
        // The fifth vertex has no partner.
        ModeCase{RT_LINES, 5, edit::Primitive::Lines, {0, 1, 2, 3}},
        ModeCase{RT_LINE_STRIP, 4, edit::Primitive::Lines, {0, 1, 1, 2, 2, 3}},
        ModeCase{RT_TRIANGLES, 7, edit::Primitive::Triangles, {0, 1, 2, 3, 4, 5}},
        ModeCase{RT_TRIANGLE_STRIP, 5, edit::Primitive::Triangles, {0, 1, 2, 2, 1, 3, 2, 3, 4}},
        ModeCase{RT_TRIANGLE_FAN, 5, edit::Primitive::Triangles, {0, 1, 2, 0, 2, 3, 0, 3, 4}},
        ModeCase{RT_QUADS, 9, edit::Primitive::Triangles, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}},
        ModeCase{
            RT_QUAD_STRIP, 7, edit::Primitive::Triangles, {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4}},
        ModeCase{RT_POLYGON, 5, edit::Primitive::Triangles, {0, 1, 2, 0, 2, 3, 0, 3, 4}}));

TEST_F(Primitives, TooFewVerticesMakeNothing) {
  rtBeginObject(0);
  for (RTenum mode : {RT_LINES, RT_LINE_STRIP, RT_TRIANGLES, RT_TRIANGLE_STRIP, RT_TRIANGLE_FAN,
                      RT_QUADS, RT_QUAD_STRIP, RT_POLYGON, RT_POINTS}) {
    rtBegin(mode);
    if (mode != RT_POINTS) curve(1);
    rtEnd();
  }
  EXPECT_TRUE(end().geometries.empty());
}

TEST_F(Primitives, VerticesKeepTheirCoordinates) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex2f(1, 2);
  rtVertex3f(0.1f, 0.2f, 0.3f);
  const float v[3] = {4, 5, 6};
  rtVertex3fv(v);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points),
            (std::vector<float>{1, 2, 0, 0.1f, 0.2f, 0.3f, 4, 5, 6}));
  EXPECT_EQ(g.normals, 0u);
  EXPECT_EQ(g.texCoords, 0u);
  EXPECT_EQ(g.colors, 0u);
}

TEST_F(Primitives, AttributesAreLatchedByVertices) {
  rtBeginObject(0);
  const float normal[3] = {0, 1, 0}, color[4] = {0.1f, 0.2f, 0.3f, 0.4f}, st[2] = {0.5f, 0.75f};
  rtBegin(RT_TRIANGLES);
  rtNormal3f(0, 0, 1);
  rtTexCoord2f(0, 1);
  rtColor3f(1, 0, 0);
  rtVertex3f(0, 0, 0);
  rtNormal3fv(normal);
  rtTexCoord2fv(st);
  rtColor4fv(color);
  rtVertex3f(1, 0, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.normals), (std::vector<float>{0, 0, 1, 0, 1, 0, 0, 1, 0}));
  EXPECT_EQ(contents<float>(*last, g.texCoords),
            (std::vector<float>{0, 1, 0.5f, 0.75f, 0.5f, 0.75f}));
  EXPECT_EQ(contents<float>(*last, g.colors),
            (std::vector<float>{1, 0, 0, 1, 0.1f, 0.2f, 0.3f, 0.4f, 0.1f, 0.2f, 0.3f, 0.4f}));
}

TEST_F(Primitives, AnAttributeThatComesLateLeavesEarlierVerticesUnset) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  curve(3);
  rtEnd();
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 1);
  rtColor4f(0, 1, 0, 0.5f);
  rtNormal3f(1, 0, 0);
  rtVertex3f(1, 0, 1);
  rtVertex3f(0, 1, 1);
  rtEnd();
  rtBegin(RT_TRIANGLES); // merged with the list before, which has the same attributes
  curve(3);
  rtEnd();
  const edit::ObjectT& object = end();
  ASSERT_EQ(object.geometries.size(), 2u); // the first list stays without colours
  EXPECT_EQ(object.geometries[0]->colors, 0u);
  const edit::GeometryT& g = *object.geometries[1];
  EXPECT_EQ(contents<float>(*last, g.colors),
            (std::vector<float>{1, 1, 1, 1,    0, 1, 0, 0.5f, 0, 1, 0, 0.5f,
                                0, 1, 0, 0.5f, 0, 1, 0, 0.5f, 0, 1, 0, 0.5f}));
  EXPECT_EQ(contents<float>(*last, g.normals),
            (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), (Indices{0, 1, 2, 3, 4, 5}));
}

TEST_F(Primitives, ADefinitionForgetsTheAttributesBeforeIt) {
  rtColor3f(1, 0, 0);
  rtBeginObject(0);
  rtColor3f(0, 1, 0);
  rtEndObject();
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  curve(3);
  rtEnd();
  rtEndObject();
  const Commit& c = commit();
  EXPECT_EQ(edits<edit::ObjectT>(c).at(1)->geometries.at(0)->colors, 0u);
}

TEST_F(Primitives, StateIsLatchedAtBegin) {
  rtBeginObject(0);
  rtTranslated(1, 2, 3);
  rtLoadName(7);
  rtEnable(RT_CULL_FACE);
  rtEnable(RT_CW_FRONT);
  rtPointSize(3);
  rtLineWidth(5);
  rtBegin(RT_POINTS);
  curve(1);
  rtLoadIdentity();
  rtLoadName(8);
  rtDisable(RT_CULL_FACE);
  rtDisable(RT_CW_FRONT);
  rtPointSize(4);
  curve(1);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(g.name, 7u);
  EXPECT_TRUE(g.cull && g.clockwise);
  EXPECT_EQ(g.width, 3.0f);
  EXPECT_EQ(matrixOf(*g.matrix)[12], 1.0);
}

TEST_F(Primitives, ListsWithTheSameStateBecomeOneGeometry) {
  rtBeginObject(0);
  for (int i = 0; i < 1000; i++) {
    rtBegin(i % 2 ? RT_QUADS : RT_TRIANGLES); // one kind of primitive
    curve(4);
    rtEnd();
  }
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<uint32_t>(*last, g.indices).size(), 500 * 3 + 500 * 6u);
  EXPECT_EQ(contents<float>(*last, g.points).size(), 12000u);
  const Indices indices = contents<uint32_t>(*last, g.indices);
  EXPECT_EQ(Indices(indices.end() - 6, indices.end()),
            (Indices{3996, 3997, 3998, 3996, 3998, 3999}));
}

TEST_F(Primitives, EachChangeOfStateStartsAGeometry) {
  rtBeginObject(0);
  const auto list = [&](RTenum mode) {
    rtBegin(mode);
    curve(3);
    rtEnd();
  };
  list(RT_TRIANGLES);
  rtLoadName(1);
  list(RT_TRIANGLES);
  rtTranslated(1, 0, 0);
  list(RT_TRIANGLES);
  rtEnable(RT_CULL_FACE);
  list(RT_TRIANGLES);
  rtEnable(RT_CW_FRONT);
  list(RT_TRIANGLES);
  list(RT_LINE_STRIP);
  rtLineWidth(2);
  list(RT_LINE_STRIP);
  rtPointSize(9);
  list(RT_LINE_STRIP); // does not apply to lines
  rtColor3f(1, 1, 1);
  list(RT_LINE_STRIP);
  EXPECT_EQ(end().geometries.size(), 8u);
}

TEST_F(Primitives, DegenerateOnesAreDroppedAndCounted) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 0, 0);
  rtVertex3f(1, 0, 0); // two corners coincide
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 2, 3);
  rtVertex3f(3, 6, 9); // collinear
  rtVertex3f(0.1f, 0.1f, 0.1f);
  rtVertex3f(0.2f, 0.2f, 0.2f);
  rtVertex3f(0.7f, 0.7f, 0.7f);
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 0, 0);
  rtVertex3f(0.5f, 1e-30f, 0); // thin, but not degenerate
  rtVertex3f(5, 5, 5);
  rtVertex3f(5, 5, 5);
  rtVertex3f(5, 5, 5);
  rtEnd();
  rtBegin(RT_LINES);
  rtVertex3f(1, 1, 1);
  rtVertex3f(1, 1, 1);
  rtVertex3f(1, 1, 1);
  rtVertex3f(1, 1, 2);
  rtEnd();
  const edit::ObjectT& object = end();
  ASSERT_EQ(object.geometries.size(), 2u);
  EXPECT_EQ(contents<uint32_t>(*last, object.geometries[0]->indices), (Indices{9, 10, 11}));
  EXPECT_EQ(contents<uint32_t>(*last, object.geometries[1]->indices), (Indices{2, 3}));
  EXPECT_EQ(degenerate(), 5u);
}

TEST_F(Primitives, AnObjectOfNothingButDegenerateOnesIsEmpty) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  for (int i = 0; i < 30; i++) rtVertex3f(float(i), 0, 0);
  rtEnd();
  EXPECT_TRUE(end().geometries.empty());
  EXPECT_EQ(degenerate(), 10u);
}

TEST_F(Primitives, BadVerticesAreErrorsAndAddNothing) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 0);
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex3f(std::nanf(""), 0, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex2f(0, infinity));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex3d(0, 0, -double(infinity)));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex3d(0, 1e39, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex3fv(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertex3dv(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtNormal3f(0, std::nanf(""), 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexCoord2f(infinity, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtColor4f(0, 0, 0, -infinity));
  EXPECT_FAILS(RT_INVALID_VALUE, rtNormal3fv(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexCoord2fv(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtColor3fv(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtColor4fv(nullptr));
  rtVertex3f(1, 0, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(g.colors + g.normals + g.texCoords, 0u);
}

TEST_F(Primitives, BracketsMustBalance) {
  EXPECT_FAILS(RT_INVALID_OPERATION, rtBegin(RT_TRIANGLES));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtEnd());
  EXPECT_FAILS(RT_INVALID_OPERATION, rtVertex3f(0, 0, 0));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtSphere(1));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtEndObject());
  const RTid object = rtBeginObject(0);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtBeginObject(0));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtVertex3f(0, 0, 0));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtVertex3d(0, 0, 0));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtEnd());
  EXPECT_FAILS(RT_INVALID_ENUM, rtBegin(2));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtRender());
  EXPECT_FAILS(RT_INVALID_OPERATION, rtSwapBuffers());
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDeleteObject(object));
  rtBegin(RT_TRIANGLES);
  curve(3);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtBegin(RT_TRIANGLES));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtSphere(1));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtEndObject());
  EXPECT_FAILS(RT_INVALID_OPERATION, rtInstantiateObject(object));
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDrawArrays(RT_TRIANGLES, 0, 0));
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), (Indices{0, 1, 2})); // failed calls left nothing
}

TEST_F(Primitives, SizesAndCapabilities) {
  EXPECT_FAILS(RT_INVALID_VALUE, rtLineWidth(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtPointSize(-1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtPointSize(infinity));
  EXPECT_FAILS(RT_INVALID_ENUM, rtEnable(12345));
  EXPECT_FAILS(RT_INVALID_ENUM, rtDisable(0));
}

TEST_F(Primitives, Spheres) {
  rtBeginObject(0);
  EXPECT_FAILS(RT_INVALID_VALUE, rtSphere(0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtSphere(-1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtSphere(std::nanf("")));
  rtTranslated(1, 2, 3);
  rtLoadName(4);
  rtSphere(2.5f);
  const edit::GeometryT& g = only();
  EXPECT_EQ(g.primitive, edit::Primitive::Sphere);
  EXPECT_EQ(g.width, 2.5f);
  EXPECT_EQ(g.name, 4u);
  EXPECT_EQ(matrixOf(*g.matrix)[14], 3.0);
  EXPECT_EQ(g.points + g.indices, 0u);
}

TEST_F(Primitives, AnalyticSurfaces) {
  rtBeginObject(0);
  const double sphere[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, low[3] = {-1, -1, -1},
               high[3] = {1, 1, 1}, terms[9] = {1e-3};
  EXPECT_FAILS(RT_INVALID_VALUE, rtQuadric(nullptr, low, high));
  EXPECT_FAILS(RT_INVALID_VALUE, rtQuadric(sphere, high, low));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCylinder(0, 0, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCylinder(-1, 0, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCylinder(1, 1, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtCone(1, double(infinity), 0, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtAsphere(1, 0, 0, nullptr, 0, 2)); // beyond the sphere
  EXPECT_FAILS(RT_INVALID_VALUE, rtAsphere(1, 0, 1, nullptr, 0, .5));
  EXPECT_FAILS(RT_INVALID_VALUE, rtAsphere(1, 0, 9, terms, 0, .5));
  EXPECT_FAILS(RT_INVALID_VALUE, rtAsphere(double(std::nanf("")), 0, 0, nullptr, 0, .5));
  rtTranslated(1, 2, 3);
  rtLoadName(4);
  rtEnable(RT_CW_FRONT);
  rtAsphere(.5, -1, 1, terms, .1, 1);
  rtDisable(RT_CW_FRONT);
  const edit::GeometryT& g = only();
  EXPECT_EQ(g.primitive, edit::Primitive::Asphere);
  EXPECT_EQ(g.surface, (std::vector<double>{.5, -1, .1, 1, 1e-3}));
  EXPECT_TRUE(g.clockwise);
  EXPECT_EQ(g.name, 4u);
  EXPECT_EQ(matrixOf(*g.matrix)[14], 3.0);
  EXPECT_EQ(g.points + g.indices, 0u);
}

// Returns world positions in double: the origin (in the matrix) plus the points.
std::vector<double> positions(const Commit& c, const edit::GeometryT& g) {
  const std::vector<double> m = matrixOf(*g.matrix);
  const std::vector<float> points = contents<float>(c, g.points);
  std::vector<double> result;
  for (size_t i = 0; i < points.size(); i++) result.push_back(points[i] + m[12 + i % 3]);
  return result;
}

TEST_F(Primitives, DoublesThatFloatHoldsAreKeptAsTheyAre) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(0.5, 0.25, 1e6);
  rtVertex3d(1, 0, 0);
  rtVertex3d(0, 1, 0);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points),
            (std::vector<float>{0.5f, 0.25f, 1e6f, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(matrixOf(*g.matrix)[12], 0.0);
}

// A room on the Earth's surface, where float would round to half a metre.
TEST_F(Primitives, DoublesFarFromTheOriginStayApart) {
  const double x = 6378137.123456789, y = -1234567.987654321, z = 42.000000001;
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(x, y, z);
  rtVertex3d(x + 0.001, y, z);
  rtVertex3d(x, y + 0.002, z);
  rtEnd();
  const edit::GeometryT& g = only();
  const std::vector<double> world = positions(*last, g);
  const std::vector<double> expected{x, y, z, x + 0.001, y, z, x, y + 0.002, z};
  for (int i = 0; i < 9; i++) EXPECT_NEAR(world[i], expected[i], 1e-9) << i;
  EXPECT_NEAR(world[3] - world[0], 0.001, 2e-9); // the resolution of double there
}

TEST_F(Primitives, ShortFractionsFarOutAreExact) {
  rtBeginObject(0);
  rtBegin(RT_QUADS);
  const double x = 1e9 + 0.25;
  rtVertex3d(x, 0.5, 0);
  rtVertex3d(x + 8.5, 0.5, 0);
  rtVertex3d(x + 8.5, 3.75, 0);
  rtVertex3d(x, 3.75, 0);
  rtEnd();
  const edit::GeometryT& g = only();
  EXPECT_EQ(positions(*last, g),
            (std::vector<double>{x, 0.5, 0, x + 8.5, 0.5, 0, x + 8.5, 3.75, 0, x, 3.75, 0}));
}

TEST_F(Primitives, NeighboursInDoubleMergeAndDistantOnesDoNot) {
  rtBeginObject(0);
  const auto triangle = [](double x) {
    rtBegin(RT_TRIANGLES);
    rtVertex3d(x, 0.1, 0);
    rtVertex3d(x + 1, 0.1, 0);
    rtVertex3d(x, 1.1, 0);
    rtEnd();
  };
  for (int i = 0; i < 10; i++) triangle(1e7 + 0.3 + i);
  triangle(2e7 + 0.3);
  rtBegin(RT_TRIANGLES); // given in float, so it keeps its own origin
  curve(3);
  rtEnd();
  const edit::ObjectT& object = end();
  ASSERT_EQ(object.geometries.size(), 3u);
  EXPECT_EQ(contents<uint32_t>(*last, object.geometries[0]->indices).size(), 30u);
  const std::vector<double> far = positions(*last, *object.geometries[1]);
  EXPECT_NEAR(far[0], 2e7 + 0.3, 1e-7);
  EXPECT_EQ(matrixOf(*object.geometries[2]->matrix)[12], 0.0);
  EXPECT_EQ(contents<float>(*last, object.geometries[2]->points)[3], 1.0f);
}

TEST_F(Primitives, FloatsAndDoublesInOneList) {
  rtBeginObject(0);
  rtColor3f(1, 0, 0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(1, 2, 3);
  rtVertex3d(1.1, 2, 3);
  rtVertex3f(1, 3, 3);
  rtEnd();
  const edit::GeometryT& g = only();
  const std::vector<double> world = positions(*last, g);
  EXPECT_EQ(world[0], 1.0);
  EXPECT_NEAR(world[3], 1.1, 1e-8);
  EXPECT_EQ(contents<float>(*last, g.colors).size(), 12u);
}

TEST_F(Primitives, TheMatrixGoesBeforeTheOrigin) {
  rtBeginObject(0);
  rtRotated(90, 0, 0, 1);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(1e8 + 0.1, 0, 0);
  rtVertex3d(1e8 + 1.1, 0, 0);
  rtVertex3d(1e8 + 0.1, 1, 0);
  rtEnd();
  const edit::GeometryT& g = only();
  const std::vector<double> m = matrixOf(*g.matrix);
  const std::vector<float> p = contents<float>(*last, g.points);
  EXPECT_NEAR(m[1] * p[0] + m[5] * p[1] + m[13], 1e8 + 0.1, 1e-7); // x rotated to y
  EXPECT_NEAR(m[0] * p[0] + m[4] * p[1] + m[12], 0, 1e-7);
}

} // namespace
