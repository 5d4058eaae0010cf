// xvrml_meshes_skins.cpp: skins of glTF as figures of H-Anim. The places of vertices follow from
// glTF 2.0, 3.7.3: joint times inverse bind matrix, summed by weight.
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/figure.h"
#include "geometry/mesh.h"
#include "xvrml/browser.h"
#include "xvrml/deformed.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

// The arrays of a .glb file, with their accessors.
class Arrays {
 public:
  template <class T>
  void add(const char* type, int componentType, size_t count, const std::vector<T>& numbers) {
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                          views_.empty() ? "" : ",", bytes_.size(), numbers.size() * sizeof(T));
    accessors_ += fmt::format(R"({}{{"bufferView":{},"componentType":{},"type":"{}","count":{}}})",
                              accessors_.empty() ? "" : ",", count_++, componentType, type, count);
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
  }
  void floats(const char* type, size_t count, const std::vector<float>& numbers) {
    add(type, 5126, count, numbers);
  }

  std::unique_ptr<World> load(const std::string& members) const {
    std::string document = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{}],"accessors":[{}],{}}})",
        bytes_.size(), views_, accessors_, members);
    document.resize((document.size() + 3) / 4 * 4, ' ');
    const auto size = [](size_t number) {
      const auto n = uint32_t(number);
      return std::string(reinterpret_cast<const char*>(&n), sizeof n);
    };
    return loadWorldFromMemory("glTF" + size(2) + size(28 + document.size() + bytes_.size()) +
                                   size(document.size()) + "JSON" + document + size(bytes_.size()) +
                                   std::string("BIN\0", 4) + bytes_,
                               "a.glb", {});
  }

 private:
  std::string views_, accessors_, bytes_;
  int count_ = 0;
};

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& one : world.diagnostics.list()) text += one.text() + '\n';
  return text;
}

void expectNear(const Vec3f& got, const Vec3f& expected) {
  EXPECT_NEAR(got.x, expected.x, 1e-5);
  EXPECT_NEAR(got.y, expected.y, 1e-5);
  EXPECT_NEAR(got.z, expected.z, 1e-5);
}

nodes::HAnimHumanoid* figureOf(const World& world) {
  for (const NodeRef& root : world.scope.roots)
    if (auto* figure = nodeCast<nodes::HAnimHumanoid>(root)) return figure;
  return nullptr;
}

nodes::Shape& shapeOf(const nodes::HAnimHumanoid& figure, size_t mesh, size_t primitive) {
  auto* group = nodeCast<nodes::Group>(figure.skin.at(mesh));
  return *nodeCast<nodes::Shape>(group->children.at(primitive));
}

// A bar of two joints: 1 stands at the origin, 2 at 1 0 0 and is turned by a quarter about z.
Arrays barArrays() {
  Arrays arrays;
  arrays.floats("VEC3", 3, {0, 0, 0, 1.5f, 0, 0, 2, 0, 0});                    // 0: points
  arrays.floats("VEC3", 3, {0, 1, 0, 0, 1, 0, 0, 1, 0});                       // 1: normals
  arrays.add<uint8_t>("VEC4", 5121, 3, {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});  // 2: joints
  arrays.floats("VEC4", 3, {1, 0, 0, 0, 2, 2, 0, 0, 1, 0, 0, 0});              // 3: weights
  arrays.floats("MAT4", 2, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,   // 4: inverse
                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}); // bind matrices
  arrays.floats("SCALAR", 2, {0, 1});                                          // 5: times
  arrays.floats("VEC4", 2, {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});      // 6: rotations
  return arrays;
}
const std::string barNodes = R"("scene":0,"scenes":[{"nodes":[0,1]}],
    "nodes":[{"mesh":0,"skin":0,"translation":[9,9,9]}, {"children":[2]},
             {"translation":[1,0,0],"rotation":[0,0,0.70710678,0.70710678]}],
    "skins":[{"joints":[1,2],"inverseBindMatrices":4}],)";
const std::string barPrimitive =
    R"({"attributes":{"POSITION":0,"NORMAL":1,"JOINTS_0":2,"WEIGHTS_0":3}})";

// The node of the mesh has a translation that does not count (3.7.3.1). Weights are made to add up
// to 1.
TEST(MeshSkins, ABarOfTwoJoints) {
  const auto world =
      barArrays().load(barNodes + R"("meshes":[{"primitives":[)" + barPrimitive + "]}]");
  EXPECT_EQ(messages(*world), "");
  ASSERT_EQ(world->scope.roots.size(), 1u);
  auto* figure = figureOf(*world);
  ASSERT_TRUE(figure);
  EXPECT_EQ(figure->joints.size(), 2u);
  EXPECT_EQ(deform(*figure, &world->diagnostics).size(), 2u);
  auto& faces = *nodeCast<nodes::IndexedFaceSet>(shapeOf(*figure, 0, 0).geometry);
  EXPECT_EQ(faces.coord, figure->skinCoord);
  EXPECT_EQ(faces.normal, figure->skinNormal);
  const auto points = drawnPoints(*nodeCast<nodes::Coordinate>(faces.coord));
  const auto normals = drawnNormals(*nodeCast<nodes::Normal>(faces.normal));
  ASSERT_EQ(points.size(), 3u);
  expectNear(points[0], {0, 0, 0});
  expectNear(points[1], {1.25f, 0.25f, 0});
  expectNear(points[2], {1, 1, 0});
  expectNear(normals[2], {-1, 0, 0});
  EXPECT_EQ(messages(*world), "");
}

// Two primitives stand in one Coordinate; the second one has colours, which keep their own indices.
TEST(MeshSkins, SeveralPrimitivesShareTheVertices) {
  Arrays arrays = barArrays();
  arrays.floats("VEC3", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}); // 7: colours
  const auto world =
      arrays.load(barNodes + R"("meshes":[{"primitives":[)" + barPrimitive +
                  R"(,{"attributes":{"POSITION":0,"COLOR_0":7,"JOINTS_0":2,"WEIGHTS_0":3}}]}])");
  EXPECT_EQ(messages(*world), "");
  auto* figure = figureOf(*world);
  ASSERT_TRUE(figure);
  deform(*figure, &world->diagnostics);
  EXPECT_EQ(drawnPoints(*nodeCast<nodes::Coordinate>(figure->skinCoord)).size(), 6u);
  auto& second = *nodeCast<nodes::IndexedFaceSet>(shapeOf(*figure, 0, 1).geometry);
  EXPECT_EQ(second.coordIndex, (MFInt32{3, 4, 5, -1}));
  EXPECT_EQ(second.colorIndex, (MFInt32{0, 1, 2, -1}));
  EXPECT_FALSE(second.normal);
  MeshOptions options;
  const Mesh mesh = buildMesh(second, options);
  ASSERT_EQ(mesh.indices.size(), 3u);
  const uint32_t last = mesh.indices[2];
  expectNear(mesh.points[last], {1, 1, 0});
  EXPECT_EQ(mesh.colors[last], (Color{0, 0, 1}));
}

// A joint that an animation turns bends the skin at every time.
TEST(MeshSkins, AnimationsOfJointsMoveTheSkin) {
  auto world = barArrays().load(barNodes + R"("animations":[{"samplers":[{"input":5,"output":6}],
      "channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}}]}],
      "meshes":[{"primitives":[)" +
                                barPrimitive + "]}]");
  EXPECT_EQ(messages(*world), "");
  auto* coord = nodeCast<nodes::Coordinate>(figureOf(*world)->skinCoord);
  Browser browser(std::move(world));
  browser.tick(0);
  expectNear(drawnPoints(*coord)[2], {2, 0, 0});
  browser.tick(0.5); // an eighth of a turn
  expectNear(drawnPoints(*coord)[2], {1 + std::sqrt(0.5f), std::sqrt(0.5f), 0});
  expectNear(coord->point[2], {2, 0, 0});
}

TEST(MeshSkins, WhatIsWrongIsSaidOnce) {
  Arrays arrays = barArrays();
  arrays.add<uint8_t>("VEC4", 5121, 3, {9, 0, 0, 0, 0, 1, 0, 0, 200, 0, 0, 0}); // 7: joints
  const auto world = arrays.load(
      R"("scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0},{},{}],
      "skins":[{"joints":[1,2],"inverseBindMatrices":4}],"meshes":[{"primitives":[
      {"attributes":{"POSITION":0,"JOINTS_0":7,"WEIGHTS_0":3}},
      {"mode":0,"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}}]}])");
  const std::string text = messages(*world);
  EXPECT_NE(text.find("2 joints are not in the skin"), std::string::npos) << text;
  EXPECT_NE(text.find("points have no skin"), std::string::npos) << text;
  EXPECT_NE(text.find("1 joints of skins are not in their scene"), std::string::npos) << text;
  EXPECT_EQ(world->diagnostics.list().size(), 3u) << text;
}

} // namespace
