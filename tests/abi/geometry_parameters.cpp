// geometry_parameters.cpp: shader parameters by vertex and by triangle, from the API to the
// picture.
#include <cstdio>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "small_scene.h"

namespace {

using namespace abi_test;

class GeometryParameters : public SmallScene {
 protected:
  void SetUp() override {
    SmallScene::SetUp();
    id = shader("Varying", "varying");
    show = rtParameterHandle("show");
    color = rtParameterHandle("color");
    weight = rtParameterHandle("weight");
    pair = rtParameterHandle("pair");
    triple = rtParameterHandle("triple");
    quad = rtParameterHandle("quad");
    matrix = rtParameterHandle("matrix");
  }
  RTid id = 0;
  int show = -1, color = -1, weight = -1, pair = -1, triple = -1, quad = -1, matrix = -1;
};

// Returns the barycentric weights at pixel x, y of n for the triangle (-1,-1) (1,-1) (-1,1).
void weights(int x, int y, int n, double w[3]) {
  const double u = (x + 0.5) / n, v = 1 - (y + 0.5) / n;
  w[0] = 1 - u - v;
  w[1] = u;
  w[2] = v;
}

TEST_F(GeometryParameters, AColourByVertexInterpolatesExactly) {
  const float colors[3][3] = {{1, 0, 0.25f}, {0, 1, 0.5f}, {0.125f, 0.25f, 1}};
  const float places[3][2] = {{-1, -1}, {1, -1}, {-1, 1}};
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  for (int i = 0; i < 3; i++) {
    rtParameter3f(color, colors[i][0], colors[i][1], colors[i][2]);
    rtVertex3f(places[i][0], places[i][1], 0);
  }
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  constexpr int n = 8;
  const std::vector<float> pixels = picture(n);
  for (int y = 0; y < n; y++)
    for (int x = 0; x < n; x++) {
      double w[3];
      weights(x, y, n, w);
      const bool inside = w[0] > 1e-6;
      for (int k = 0; k < 3 && std::fabs(w[0]) > 1e-6; k++) {
        const double expected =
            inside ? w[0] * colors[0][k] + w[1] * colors[1][k] + w[2] * colors[2][k] : 0;
        EXPECT_NEAR(pixels[size_t(4) * (y * n + x) + k], expected, 2e-6)
            << x << " " << y << " " << k;
      }
    }
}

TEST_F(GeometryParameters, ByTriangleItIsConstantAndOfTheVertexThatCompletesIt) {
  rtParameter1i(show, 3);
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtParameter3f(triple, 5, 6, 7);
  rtVertex3f(-1, -1, 0);
  rtVertex3f(1, -1, 0);
  rtVertex3f(-1, 1, 0);
  rtVertex3f(1, -1, 0);
  rtVertex3f(1, 1, 0);
  rtParameter3f(triple, 8, 9, 10);
  rtVertex3f(-1, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  const std::vector<float> pixels = picture(4);
  for (int y = 0; y < 4; y++)
    for (int x = 0; x < 4; x++) {
      if (x == y) continue; // on the edge between the two triangles
      const float expected = x < y ? 5.0f : 8.0f;
      for (int k = 0; k < 3; k++)
        EXPECT_EQ(pixels[size_t(4) * (y * 4 + x) + k], expected + float(k)) << x << " " << y;
    }
}

TEST_F(GeometryParameters, EveryTypeArrives) {
  float m[16] = {};
  for (int i = 0; i < 16; i++) m[i] = float(i);
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtParameter1f(weight, 0.75f);
  rtParameter2f(pair, 3, 4);
  rtParameter4f(quad, 0.1f, 0.2f, 0.3f, 0.4f);
  rtParameter16f(matrix, m);
  squareVertices();
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  const float expected[6][3] = {{0.25f, 0.5f, 0.75f}, {0.75f, 0.5f, 0}, {3, 4, 0.5f}, {1, 2, 3},
                                {0.1f, 0.2f, 0.3f},   {12, 13, 14}};
  for (int s = 0; s < 6; s++) {
    rtParameter1i(show, s);
    const std::vector<float> pixel = picture(1);
    for (int k = 0; k < 3; k++) EXPECT_NEAR(pixel[k], expected[s][k], 1e-6) << s;
  }
}

TEST_F(GeometryParameters, UntilTheFirstCallTheShadersOwnValueHolds) {
  rtParameter3f(color, 0.5f, 0.25f, 0);
  rtFrameBuffer(1, 1, RT_RGBA);
  rtRender(); // the shader's value is committed; the geometry's value still holds
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(-1, -1, 0);
  rtVertex3f(1, -1, 0);
  rtVertex3f(-1, 1, 0);
  rtParameter3f(color, 1, 1, 1);
  rtVertex3f(1, -1, 0);
  rtVertex3f(1, 1, 0);
  rtVertex3f(-1, 1, 0);
  rtEnd();
  rtBegin(RT_TRIANGLES); // a later list of the object keeps the values that were set
  rtVertex3f(-1, -1, 1);
  rtVertex3f(-0.5f, -1, 1);
  rtVertex3f(-1, -0.5f, 1);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  const std::vector<float> pixels = picture(8);
  EXPECT_EQ(pixels[4 * (5 * 8 + 1)], 0.5f);
  EXPECT_EQ(pixels[4 * (1 * 8 + 5)], 1.0f);
  EXPECT_EQ(pixels[4 * (7 * 8 + 0)], 1.0f);
}

TEST_F(GeometryParameters, ArraysByVertexAndByTriangle) {
  const float points[5][3] = {{9, 9, 9}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const struct {
    float color[3], spare;
  } colors[5] = {{{2, 2, 2}, 0},
                 {{0, 0, 0}, 0},
                 {{1, 0, 0}, 0},
                 {{1, 1, 0}, 0},
                 {{0, 1, 0}, 0}}; // the first vertex is unused
  const float triples[3][3] = {{1, 2, 3}, {-1, -1, -1}, {4, 5, 6}};
  const uint32_t indices[9] = {1, 2, 3, 1, 1, 2, 1, 3, 4}; // the second triangle is degenerate
  rtVertexPointer(3, RT_FLOAT, 0, points);
  rtParameterPointer(color, sizeof colors[0], colors[0].color);
  rtParameterPointer(triple, 0, triples[0]);
  const RTid object = rtBeginObject(0);
  rtDrawElements(RT_TRIANGLES, 9, indices, 5);
  rtEndObject();
  rtInstantiateObject(object);
  constexpr int n = 8;
  const std::vector<float> byVertex = picture(n);
  for (int y = 0; y < n; y++)
    for (int x = 0; x < n; x++) {
      EXPECT_NEAR(byVertex[size_t(4) * (y * n + x)], (x + 0.5) / n, 1e-6);
      EXPECT_NEAR(byVertex[size_t(4) * (y * n + x) + 1], 1 - (y + 0.5) / n, 1e-6);
    }
  rtParameter1i(show, 3);
  const std::vector<float> byTriangle = picture(n);
  EXPECT_EQ(byTriangle[4 * (6 * n + 5)], 1.0f);
  EXPECT_EQ(byTriangle[4 * (1 * n + 2)], 4.0f);
  // The shader's own values apply after the pointer is turned off, and with a shader of another
  // class bound.
  rtParameterPointer(color, 0, nullptr);
  rtParameter1i(show, 0);
  rtBeginObject(object);
  rtDrawElements(RT_TRIANGLES, 9, indices, 5);
  rtEndObject();
  EXPECT_EQ(picture(1)[0], 0.25f);
}

TEST_F(GeometryParameters, AreOfTheClassAlone) {
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtParameter3f(color, 1, 1, 1);
  squareVertices();
  rtEnd();
  rtEndObject();
  const RTid instance = rtInstantiateObject(object);
  EXPECT_EQ(picture(1)[0], 1.0f);
  const RTid same = shader("Varying", "varying"), other = shader("Everything", "everything");
  rtInstanceShader(instance, same);
  EXPECT_EQ(picture(1)[0], 1.0f); // a shader of the same class: the values hold
  rtInstanceShader(instance, other);
  EXPECT_NEAR(picture(1)[0], 0.05f, 1e-6);
  rtInstanceShader(instance, 0);
  rtDeleteShader(id); // the geometry falls back to the default surface, which ignores the values
  rtDefaultShader(other);
  EXPECT_NEAR(picture(1)[0], 0.05f, 1e-6);
}

TEST_F(GeometryParameters, LinesAndNestedAndMovedObjectsHaveThemToo) {
  const RTid object = rtBeginObject(0);
  rtLineWidth(4);
  rtBegin(RT_LINES);
  rtParameter3f(color, 0, 0, 0);
  rtVertex3f(-1, 0, 0);
  rtParameter3f(color, 1, 1, 1);
  rtVertex3f(1, 0, 0);
  rtEnd();
  rtEndObject();
  const RTid line = rtInstantiateObject(object);
  std::vector<float> pixels = picture(16);
  EXPECT_NEAR(pixels[4 * (8 * 16 + 12)], 12.5 / 16, 0.02);
  rtDeleteInstance(line);

  const RTid square = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtParameter3f(color, 0, 0, 1);
  rtVertex3f(-1, -1, 0);
  rtParameter3f(color, 1, 0, 1);
  rtVertex3f(1, -1, 0);
  rtVertex3f(1, 1, 0);
  rtParameter3f(color, 0, 0, 1);
  rtVertex3f(-1, 1, 0);
  rtEnd();
  rtEndObject();
  const RTid group = rtBeginObject(0);
  rtScaled(0.5, 0.5, 1);
  rtTranslated(1, 0, 0);
  rtInstantiateObject(square);
  rtEndObject();
  const RTid place = rtInstantiateObject(group);
  EXPECT_NEAR(picture(16)[4 * (8 * 16 + 12)], 4.5 / 8, 1e-6);
  const RTstats before = stats();
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
  rtInstanceMatrix(place, m);
  picture(16);
  rtInstanceMatrix(place, m); // the same matrix: nothing changes
  EXPECT_NEAR(picture(16)[4 * (8 * 16 + 4)], 4.5 / 8, 1e-6);
  EXPECT_LE(stats().bvh.objectBuilds,
            before.bvh.objectBuilds + 2); // it became dynamic; the parameters add no builds
}

TEST_F(GeometryParameters, EditsCostWhatTheyChange) {
  const auto define = [&](RTid object, float red) {
    rtBeginObject(object);
    rtBegin(RT_QUADS);
    rtParameter3f(color, red, 0, 0);
    squareVertices();
    rtEnd();
    rtEndObject();
  };
  RTid objects[2];
  rtGenObjects(2, objects);
  for (int i = 0; i < 2; i++) {
    rtObjectHint(objects[i], RT_DYNAMIC);
    define(objects[i], 0.25f);
    rtTranslated(0, 0, -1);
    rtInstantiateObject(objects[i]);
  }
  EXPECT_EQ(picture(1)[0], 0.25f);
  const RTstats first = stats();
  // Changing the shader's own value builds nothing, and the geometry keeps its values.
  rtParameter3f(color, 1, 1, 1);
  EXPECT_EQ(picture(1)[0], 0.25f);
  EXPECT_EQ(stats().bvh.objectBuilds, first.bvh.objectBuilds);
  EXPECT_EQ(stats().bvh.topLevelBuilds, first.bvh.topLevelBuilds);
  rtParameter1i(show, 1);
  EXPECT_EQ(picture(1)[0], 0.125f);
  EXPECT_EQ(stats().bvh.objectBuilds, first.bvh.objectBuilds);
  rtParameter1i(show, 0);
  define(objects[0], 0.75f); // other values build only this object
  EXPECT_EQ(picture(1)[0], 0.75f);
  EXPECT_EQ(stats().bvh.objectBuilds, first.bvh.objectBuilds + 1);
}

TEST_F(GeometryParameters, StockClassesHaveThem) {
  const RTid diffuse = shader("Diffuse", nullptr);
  int count = 0, vertex = -1;
  const RTid shaderClass = rtNewShaderClass("Diffuse", nullptr);
  rtGetShaderClass(shaderClass, nullptr, &count);
  for (int i = 0; i < count; i++) {
    RTparameterInfo info{};
    rtGetParameterInfo(shaderClass, i, &info);
    if (info.frequency == RT_PER_VERTEX && info.type == RT_PARAM_COLOR) vertex = i;
  }
  ASSERT_GE(vertex, 0);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
  for (const int transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    rtBindShader(diffuse);
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    for (int i = 0; i < 4; i++) {
      const float x = i == 0 || i == 3 ? -1.0f : 1.0f, y = i < 2 ? -1.0f : 1.0f;
      rtParameter3f(vertex, x < 0 ? 0.0f : 0.5f, 0, 0);
      rtVertex3f(x, y, float(transport) * 1e-3f);
    }
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
    const std::vector<float> pixels = picture(4);
    for (int x = 0; x < 4; x++)
      EXPECT_NEAR(pixels[size_t(4) * (4 + x)], 0.5 * (x + 0.5) / 4, 1e-5) << transport << " " << x;
  }
}

TEST_F(GeometryParameters, ARecordingReplaysToTheSameBytes) {
  rtDeleteContext(context);
  const std::string path =
      std::string(::testing::TempDir()) + "openrt_parameters_" + std::to_string(::getpid());
  std::vector<char> bytes[2];
  for (int pass = 0; pass < 2; pass++) {
    context =
        rtNewContext(("threads=1 record=" + path + " shaderpath=\"" + folders() + "\"").c_str());
    ASSERT_NE(context, nullptr);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtTranslated(0, 0, 10);
    rtOrtho(2);
    rtLoadIdentity();
    shader("Varying", "varying");
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    rtParameter3f(color, 0.5f, 0.25f, 1);
    rtParameter2f(pair, 1, 2);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
    EXPECT_EQ(picture(2)[0], 0.5f);
    rtDeleteContext(context);
    std::ifstream file(path, std::ios::binary);
    bytes[pass].assign(std::istreambuf_iterator<char>(file), {});
    std::remove(path.c_str());
  }
  EXPECT_GT(bytes[0].size(), 500u);
  EXPECT_EQ(bytes[0], bytes[1]);
  context = nullptr;
}

TEST_F(GeometryParameters, SayHowOftenTheyMayChange) {
  RTparameterInfo info{};
  const RTid shaderClass = rtNewShaderClass("Varying", "varying");
  const RTenum expected[8] = {RT_PER_SHADER,   RT_PER_SHADER,   RT_PER_VERTEX, RT_PER_VERTEX,
                              RT_PER_TRIANGLE, RT_PER_TRIANGLE, RT_PER_VERTEX, RT_PER_TRIANGLE};
  for (int i = 0; i < 8; i++) {
    rtGetParameterInfo(shaderClass, i, &info);
    EXPECT_EQ(info.frequency, expected[i]) << info.name;
  }
}

} // namespace
