// openrt_api_geometry_parameters.cpp: rtParameter* between rtBegin and rtEnd and
// rtParameterPointer, as the backend receives them.
#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;

class OwnParameters : public ApiTest {
 protected:
  void SetUp() override {
    ApiTest::SetUp();
    shader = rtNewShader(rtNewShaderClass("Varying", "varying"));
    rtBindShader(shader);
    color = rtParameterHandle("color");
    weight = rtParameterHandle("weight");
    pair = rtParameterHandle("pair");
  }
  static void triangle() {
    rtVertex3f(0, 0, 0);
    rtVertex3f(1, 0, 0);
    rtVertex3f(0, 1, 0);
  }
  static const std::vector<std::unique_ptr<edit::GeometryT>>& geometries(const Commit& c) {
    return edits<edit::ObjectT>(c).at(0)->geometries;
  }
  static std::vector<float> valuesOf(const Commit& c, const edit::GeometryT& g, int index) {
    for (const auto& p : g.parameters)
      if (p->index == uint32_t(index)) return contents<float>(c, p->values);
    return {};
  }
  RTid shader = 0;
  int color = -1, weight = -1, pair = -1;
};

using Floats = std::vector<float>;

TEST_F(OwnParameters, AreLatchedByTheVerticesThatFollow) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtParameter1f(weight, 1);
  rtVertex3f(0, 0, 0);
  rtParameter1f(weight, 2);
  rtVertex3f(1, 0, 0);
  rtParameter1f(weight, 3);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  const Commit& c = commit();
  ASSERT_EQ(geometries(c).size(), 1u);
  ASSERT_EQ(geometries(c)[0]->parameters.size(), 1u);
  EXPECT_TRUE(geometries(c)[0]->parameters[0]->perVertex);
  EXPECT_EQ(valuesOf(c, *geometries(c)[0], weight), (Floats{1, 2, 3}));
}

TEST_F(OwnParameters, ListsThatHaveTheSameAreOneGeometry) {
  rtBeginObject(0);
  for (int i = 0; i < 100; i++) {
    rtBegin(RT_TRIANGLES);
    rtParameter2f(pair, float(i), 0);
    rtParameter1f(weight, float(-i));
    triangle();
    rtEnd();
  }
  rtEndObject();
  const Commit& c = commit();
  ASSERT_EQ(geometries(c).size(), 1u);
  const Floats pairs = valuesOf(c, *geometries(c)[0], pair),
               weights = valuesOf(c, *geometries(c)[0], weight);
  ASSERT_EQ(pairs.size(), 200u);
  ASSERT_EQ(weights.size(), 300u);
  for (size_t i = 0; i < 100; i++)
    EXPECT_TRUE(pairs[2 * i] == float(i) && weights[3 * i + 2] == -float(i)) << i;
}

TEST_F(OwnParameters, OneThatIsNewStartsAnotherGeometry) {
  rtParameter1f(weight, 7);
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  triangle();
  rtEnd();
  rtBegin(RT_TRIANGLES);
  triangle();
  rtParameter1f(weight, 8); // set between vertices: earlier vertices have the shader's own value
  triangle();
  rtParameter3f(color, 1, 0, 0);
  rtNormal3f(0, 0, 1);
  triangle();
  rtEnd();
  rtBindShader(0); // none of the values apply to another shader
  rtBegin(RT_TRIANGLES);
  triangle();
  rtEnd();
  rtBindShader(shader); // back to the first shader: its values hold within the object
  rtBegin(RT_TRIANGLES);
  triangle();
  rtEnd();
  rtEndObject();
  rtBeginObject(0); // they do not hold in the next object
  rtBegin(RT_TRIANGLES);
  triangle();
  rtEnd();
  rtEndObject();
  const Commit& c = commit();
  const auto& g = geometries(c);
  ASSERT_EQ(g.size(), 4u);
  EXPECT_TRUE(g[0]->parameters.empty());
  EXPECT_EQ(valuesOf(c, *g[1], weight), (Floats{7, 7, 7, 8, 8, 8, 8, 8, 8}));
  const Floats colors = valuesOf(c, *g[1], color);
  ASSERT_EQ(colors.size(), 27u);
  EXPECT_EQ(colors[0], 0.25f); // the default of the class
  EXPECT_EQ(colors[18], 1.0f);
  EXPECT_EQ(contents<float>(c, g[1]->normals).size(), 27u);
  EXPECT_TRUE(g[2]->shader == 0 && g[2]->parameters.empty());
  EXPECT_EQ(valuesOf(c, *g[3], weight), (Floats{8, 8, 8}));
  EXPECT_TRUE(edits<edit::ObjectT>(c).at(1)->geometries.at(0)->parameters.empty());
}

TEST_F(OwnParameters, ByTriangleTheyAreOfTheVertexThatCompletesIt) {
  struct {
    RTenum mode;
    int vertices;
    Floats expected; // by number of the completing vertex
  } const cases[] = {{RT_TRIANGLES, 6, {2, 5}},
                     {RT_TRIANGLE_STRIP, 5, {2, 3, 4}},
                     {RT_TRIANGLE_FAN, 5, {2, 3, 4}},
                     {RT_QUADS, 8, {3, 3, 7, 7}},
                     {RT_QUAD_STRIP, 6, {3, 3, 5, 5}},
                     {RT_POLYGON, 5, {4, 4, 4}},
                     {RT_LINES, 4, {1, 3}},
                     {RT_LINE_STRIP, 4, {1, 2, 3}},
                     {RT_POINTS, 2, {0, 1}}};
  for (const auto& each : cases) {
    rtBeginObject(0);
    rtBegin(each.mode);
    for (int i = 0; i < each.vertices; i++) {
      rtParameter2f(pair, float(i), 0);
      const double turn = 0.7 * i; // convex, with no three points on a line
      rtVertex3d(float(std::cos(turn)), float(std::sin(turn)), 0);
    }
    rtEnd();
    rtEndObject();
    const Commit& c = commit();
    const Floats values = valuesOf(c, *geometries(c).at(0), pair);
    ASSERT_EQ(values.size(), 2 * each.expected.size()) << each.mode;
    for (size_t i = 0; i < each.expected.size(); i++)
      EXPECT_EQ(values[2 * i], each.expected[i]) << each.mode << " " << i;
  }
}

TEST_F(OwnParameters, DegenerateTrianglesTakeTheirValuesAlong) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtParameter2f(pair, 1, 1);
  triangle();
  rtParameter2f(pair, 2, 2);
  rtVertex3f(0, 0, 0);
  rtVertex3f(0, 0, 0);
  rtVertex3f(0, 1, 0);
  rtParameter2f(pair, 3, 3);
  triangle();
  rtEnd();
  rtEndObject();
  const Commit& c = commit();
  EXPECT_EQ(valuesOf(c, *geometries(c).at(0), pair), (Floats{1, 1, 3, 3}));
}

TEST_F(OwnParameters, PointersAreReadByTheDrawCalls) {
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
              weights[4] = {1, 2, 3, 4};
  const float pairs[3][4] = {{1, 2, 0, 0}, {3, 4, 0, 0}, {5, 6, 0, 0}};
  rtVertexPointer(3, RT_FLOAT, 0, points);
  rtParameterPointer(weight, 0, weights);
  rtParameterPointer(pair, sizeof pairs[0], pairs[0]);
  rtBeginObject(0);
  rtDrawArrays(RT_TRIANGLES, 1, 3); // skips the first vertex; it is the first triangle of the call
  rtBindShader(rtNewShader(rtNewShaderClass("Everything", "everything")));
  rtDrawArrays(RT_TRIANGLES, 0, 3); // a shader of another class
  rtBindShader(rtNewShader(rtNewShaderClass("Varying", "varying")));
  rtDrawArrays(RT_TRIANGLE_STRIP, 0, 4); // another shader of the class
  rtEndObject();
  const Commit& c = commit();
  const auto& g = geometries(c);
  ASSERT_EQ(g.size(), 3u);
  EXPECT_EQ(valuesOf(c, *g[0], weight), (Floats{2, 3, 4}));
  EXPECT_EQ(valuesOf(c, *g[0], pair), (Floats{1, 2}));
  EXPECT_TRUE(g[1]->parameters.empty());
  EXPECT_EQ(valuesOf(c, *g[2], pair), (Floats{1, 2, 3, 4}));
}

TEST_F(OwnParameters, BadValuesOfArraysAreErrorsWhereTheyAreUsed) {
  const float points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  float colors[4][3] = {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.5f, 0.5f}, {2, NAN, 0}};
  const uint32_t first[3] = {0, 1, 2}, last[3] = {1, 3, 2};
  rtVertexPointer(3, RT_FLOAT, 0, points);
  rtParameterPointer(color, 0, colors[0]);
  rtBeginObject(0);
  rtDrawElements(RT_TRIANGLES, 3, first, 4);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawElements(RT_TRIANGLES, 3, last, 4));
  rtEndObject();
  const Commit& c = commit();
  ASSERT_EQ(geometries(c).size(), 1u);
  const Floats values = valuesOf(c, *geometries(c)[0], color);
  ASSERT_EQ(values.size(), 12u);
  EXPECT_EQ(values[9], 0.25f); // unused by any vertex: the default
}

TEST_F(OwnParameters, OfAShaderThatIsDeletedAreDropped) {
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtParameter1f(weight, 1);
  triangle();
  rtEnd();
  rtEndObject();
  rtDeleteShader(shader);
  const Commit& c = commit();
  EXPECT_TRUE(geometries(c).at(0)->shader == 0 && geometries(c)[0]->parameters.empty());
}

TEST_F(OwnParameters, TheShaderOfTheListIsMeant) {
  const RTid other = rtNewShader(rtNewShaderClass("Everything", "everything"));
  rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtBindShader(other);
  rtParameter1f(weight, 5); // a parameter of Varying, which the list has latched
  triangle();
  rtEnd();
  rtBindShader(0);
  rtBegin(RT_TRIANGLES);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtParameter1f(weight, 5));
  triangle();
  rtEnd();
  rtEndObject();
  const Commit& c = commit();
  EXPECT_EQ(valuesOf(c, *geometries(c).at(0), weight), (Floats{5, 5, 5}));
}

TEST_F(OwnParameters, VerticesFarApartInDoubleKeepTheirs) {
  rtBeginObject(0);
  for (const double x : {1e7, 2e9}) {
    rtBegin(RT_TRIANGLES);
    rtParameter1f(weight, float(x));
    rtVertex3d(x, 0.1, 0);
    rtVertex3d(x + 1, 0, 0);
    rtVertex3d(x, 1, 0);
    rtEnd();
  }
  rtEndObject();
  const Commit& c = commit();
  ASSERT_EQ(geometries(c).size(), 2u); // each has an origin of its own
  EXPECT_EQ(valuesOf(c, *geometries(c)[0], weight), (Floats{1e7f, 1e7f, 1e7f}));
  EXPECT_EQ(valuesOf(c, *geometries(c)[1], weight), (Floats{2e9f, 2e9f, 2e9f}));
}

} // namespace
