// openrt_api_arrays.cpp: Tests rtDrawArrays and rtDrawElements: layouts, types, and which values
// are checked and copied.
#include <cmath>
#include <cstring>
#include <limits>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt;
using namespace openrt::test;
using Floats = std::vector<float>;
using Indices = std::vector<uint32_t>;

class Arrays : public ApiTest {
 protected:
  const edit::GeometryT& only() {
    rtEndObject();
    last = &commit();
    const auto objects = edits<edit::ObjectT>(*last);
    EXPECT_EQ(objects.at(0)->geometries.size(), 1u);
    return *objects.at(0)->geometries.at(0);
  }
  size_t geometries() {
    rtEndObject();
    last = &commit();
    return edits<edit::ObjectT>(*last).at(0)->geometries.size();
  }
  const Commit* last = nullptr;
  const float square[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
};

TEST_F(Arrays, DrawArraysCopiesPackedFloats) {
  rtBeginObject(0);
  float copy[12];
  std::memcpy(copy, square, sizeof(copy));
  rtVertexPointer(3, RT_FLOAT, 0, copy);
  rtDrawArrays(RT_QUADS, 0, 4);
  std::fill(copy, copy + 12, 99.0f); // the call has made a copy
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points), Floats(square, square + 12));
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), (Indices{0, 1, 2, 0, 2, 3}));
}

TEST_F(Arrays, FirstSkipsElementsOfEveryArray) {
  rtBeginObject(0);
  const float normals[12] = {0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4};
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtNormalPointer(RT_FLOAT, 0, normals);
  rtDrawArrays(RT_TRIANGLES, 1, 3);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points), Floats(square + 3, square + 12));
  EXPECT_EQ(contents<float>(*last, g.normals), (Floats{0, 0, 2, 0, 0, 3, 0, 0, 4}));
}

TEST_F(Arrays, InterleavedAndUnaligned) {
#pragma pack(push, 1)
  struct Vertex {
    char tag;
    float position[3], st[2], color[3];
  } vertices[3] = {{'a', {0, 0, 0}, {0, 0}, {1, 0, 0}},
                   {'b', {1, 0, 0}, {1, 0}, {0, 1, 0}},
                   {'c', {0, 1, 0}, {0, 1}, {0, 0, 1}}};
#pragma pack(pop)
  const char* base = reinterpret_cast<const char*>(vertices);
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, sizeof(Vertex), base + 1);
  rtTexCoordPointer(2, RT_FLOAT, sizeof(Vertex), base + 13);
  rtColorPointer(3, RT_FLOAT, sizeof(Vertex), base + 21);
  rtDrawArrays(RT_TRIANGLES, 0, 3);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points), (Floats{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(contents<float>(*last, g.texCoords), (Floats{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(contents<float>(*last, g.colors), (Floats{1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1}));
}

TEST_F(Arrays, DrawElementsKeepsTheIndices) {
  rtBeginObject(0);
  const uint32_t indices[6] = {2, 1, 0, 0, 3, 2};
  const float colors[16] = {1, 1, 1, 0.5f, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtColorPointer(4, RT_FLOAT, 0, colors);
  rtDrawElements(RT_TRIANGLES, 6, indices, 4);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), Indices(indices, indices + 6));
  EXPECT_EQ(contents<float>(*last, g.colors), Floats(colors, colors + 16));
}

TEST_F(Arrays, DegeneratePrimitivesAreDropped) {
  rtBeginObject(0);
  const uint32_t indices[9] = {0, 1, 1, 0, 1, 2, 3, 3, 3};
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtDrawElements(RT_TRIANGLES, 9, indices, 4);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<uint32_t>(*last, g.indices), (Indices{0, 1, 2}));
  RTstats stats;
  stats.size = sizeof(stats);
  rtGetStats(&stats);
  EXPECT_EQ(stats.rejected.primitives, 3u); // two, plus the one that the backend reports
}

TEST_F(Arrays, NothingDrawnMakesNoGeometry) {
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtDrawArrays(RT_TRIANGLES, 0, 0);
  rtDrawElements(RT_TRIANGLES, 0, nullptr, 4);
  const uint32_t same[3] = {1, 1, 1};
  rtDrawElements(RT_TRIANGLES, 3, same, 4);
  EXPECT_EQ(geometries(), 0u);
}

TEST_F(Arrays, DoublesKeepTheirPrecision) {
  double points[9] = {5e6 + 0.1, 0, 0, 5e6 + 0.101, 0, 0, 5e6 + 0.1, 0.001, 0};
  rtBeginObject(0);
  rtVertexPointer(3, RT_DOUBLE, 0, points);
  rtDrawArrays(RT_TRIANGLES, 0, 3);
  const edit::GeometryT& g = only();
  const std::vector<double> m = matrixOf(*g.matrix);
  const Floats p = contents<float>(*last, g.points);
  for (int i = 0; i < 9; i++) EXPECT_NEAR(m[12 + i % 3] + p[i], points[i], 1e-9) << i;
  EXPECT_NEAR(p[3] - p[0], 0.001, 1e-9);
}

TEST_F(Arrays, DoublesThatFloatHoldsNeedNoOrigin) {
  double points[9] = {4, 0.5, 0, 1, 0, 0, 0, 1, 0};
  rtBeginObject(0);
  rtVertexPointer(3, RT_DOUBLE, 0, points);
  rtDrawArrays(RT_TRIANGLES, 0, 3);
  const edit::GeometryT& g = only();
  EXPECT_EQ(matrixOf(*g.matrix)[12], 0.0);
  EXPECT_EQ(contents<float>(*last, g.points), (Floats{4, 0.5f, 0, 1, 0, 0, 0, 1, 0}));
}

TEST_F(Arrays, AttributesWithoutAnArrayHaveTheCurrentValue) {
  rtBeginObject(0);
  rtColor3f(0.5f, 0.25f, 0);
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtDrawArrays(RT_TRIANGLES, 0, 3);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.colors),
            (Floats{0.5f, 0.25f, 0, 1, 0.5f, 0.25f, 0, 1, 0.5f, 0.25f, 0, 1}));
  EXPECT_EQ(g.normals, 0u);
}

TEST_F(Arrays, OnlyVerticesInUseMustBeFinite) {
  float points[12];
  std::memcpy(points, square, sizeof(points));
  points[9] = std::nanf("");
  const uint32_t without[3] = {0, 1, 2}, with[3] = {1, 2, 3};
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, points);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawElements(RT_TRIANGLES, 3, with, 4));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_QUADS, 0, 4));
  rtDrawElements(RT_TRIANGLES, 3, without, 4);
  const edit::GeometryT& g = only();
  EXPECT_EQ(contents<float>(*last, g.points).at(9), 0.0f);
}

TEST_F(Arrays, BadCallsAreErrorsAndDrawNothing) {
  const uint32_t indices[3] = {0, 1, 4};
  const float infinite[12] = {1, 1, 1, 1, 1, 1, 1, 1, std::numeric_limits<float>::infinity(),
                              1, 1, 1};
  const double wide[9] = {0, 0, 0, 1, 0, 0, 0, 1e39, 0},
               notANumber[9] = {0, 0, 0, 1, 0, 0, 0, std::nan(""), 0};
  rtVertexPointer(3, RT_FLOAT, 0, square);
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDrawArrays(RT_TRIANGLES, 0, 3)); // outside an object
  rtBeginObject(0);
  EXPECT_FAILS(RT_INVALID_ENUM, rtDrawArrays(2, 0, 3));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawElements(RT_TRIANGLES, 3, indices, 4));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawElements(RT_TRIANGLES, 3, nullptr, 4));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, size_t(1) << 40, 3));
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, size_t(1) << 40));
  rtVertexPointer(3, RT_FLOAT, 0, infinite);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, 3));
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  // The vertex array is disabled.
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDrawArrays(RT_TRIANGLES, 0, 3));
  for (const double* points : {wide, notANumber}) {
    rtVertexPointer(3, RT_DOUBLE, 0, points);
    EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, 3));
  }
  EXPECT_EQ(geometries(), 0u);
}

TEST_F(Arrays, BadAttributesAreErrors) {
  const float nan = std::nanf("");
  const float bad[16] = {0, 0, 0, 0, nan, nan, nan, nan, nan, nan, nan, nan, 0, 0, 0, 0};
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtNormalPointer(RT_FLOAT, 0, bad);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, 3));
  rtNormalPointer(RT_FLOAT, 0, nullptr);
  rtTexCoordPointer(2, RT_FLOAT, 0, bad);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, 3));
  rtTexCoordPointer(2, RT_FLOAT, 0, nullptr);
  rtColorPointer(4, RT_FLOAT, 0, bad);
  EXPECT_FAILS(RT_INVALID_VALUE, rtDrawArrays(RT_TRIANGLES, 0, 3));
  rtColorPointer(4, RT_FLOAT, 0, nullptr);
  EXPECT_EQ(geometries(), 0u);
}

TEST_F(Arrays, PointersAreChecked) {
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertexPointer(2, RT_FLOAT, 0, square));
  EXPECT_FAILS(RT_INVALID_ENUM, rtVertexPointer(3, RT_UNSIGNED_BYTE, 0, square));
  EXPECT_FAILS(RT_INVALID_ENUM, rtNormalPointer(RT_DOUBLE, 0, square));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTexCoordPointer(3, RT_FLOAT, 0, square));
  EXPECT_FAILS(RT_INVALID_VALUE, rtColorPointer(5, RT_FLOAT, 0, square));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertexPointer(3, RT_FLOAT, 8, square));
  EXPECT_FAILS(RT_INVALID_VALUE, rtVertexPointer(3, RT_DOUBLE, 12, square));
  rtBeginObject(0);
  // None of the calls had an effect.
  EXPECT_FAILS(RT_INVALID_OPERATION, rtDrawArrays(RT_TRIANGLES, 0, 3));
  rtEndObject();
}

TEST_F(Arrays, EqualArraysTravelOnce) {
  const uint32_t left[] = {0, 1, 2}, right[] = {0, 2, 3};
  float copy[12];
  std::memcpy(copy, square, sizeof(copy));
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, square);
  rtDrawElements(RT_TRIANGLES, 3, left, 4);
  rtLoadName(1);
  rtDrawElements(RT_TRIANGLES, 3, right, 4);
  rtVertexPointer(3, RT_FLOAT, 0, copy);
  rtLoadName(2);
  rtDrawElements(RT_TRIANGLES, 3, left, 4);
  copy[0] = 0.5f;
  rtLoadName(3);
  rtDrawElements(RT_TRIANGLES, 3, left, 4);
  EXPECT_EQ(geometries(), 4u);
  const auto& g = edits<edit::ObjectT>(*last).at(0)->geometries;
  EXPECT_EQ(g[0]->points, g[1]->points);
  EXPECT_EQ(g[0]->points, g[2]->points);
  EXPECT_EQ(g[0]->indices, g[2]->indices);
  EXPECT_NE(g[0]->indices, g[1]->indices);
  EXPECT_NE(g[0]->points, g[3]->points);
  EXPECT_EQ(last->arrays.size(), 4u);
}

TEST_F(Arrays, AMillionVerticesArriveWhole) {
  constexpr size_t count = 999999;
  Floats points(3 * count);
  for (size_t i = 0; i < count; i++) {
    points[3 * i] = float(i);
    points[3 * i + 1] = float(i % 3 == 1);
    points[3 * i + 2] = float(i % 3 == 2);
  }
  rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawArrays(RT_TRIANGLES, 0, count);
  const edit::GeometryT& g = only();
  EXPECT_TRUE(contents<float>(*last, g.points) == points);
  EXPECT_EQ(contents<uint32_t>(*last, g.indices).back(), count - 1);
}

} // namespace
