// xvrml_picking_beside.cpp: rays of a moving viewer pass through large meshes until these are
// prepared beside the world; everybody else gets the right hit at once.
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "behaviour/viewer/interaction.h"
#include "geometry/copied.h"
#include "xvrml/browser.h"

namespace xvrml {
namespace {

constexpr int side = 280; // squares each way

std::string grid(const std::string& name, double x, double y) {
  std::string heights;
  for (int i = 0; i < (side + 1) * (side + 1); ++i) heights += i % 3 ? "0 " : "0.25 ";
  return fmt::format("Transform {{ translation {} {} 0 children DEF {}S Shape {{ geometry DEF {} "
                     "ElevationGrid {{ solid FALSE xDimension {} zDimension {} height [ {} ] }} }} "
                     "}}\n",
                     x, y, name, name, side + 1, side + 1, heights);
}

class PickBeside : public testing::Test {
 protected:
  void load(const std::string& body, double patience = .05) {
    BrowserOptions options;
    options.scriptPatience = patience;
    browser_ = std::make_unique<Browser>(
        loadWorldFromMemory("#VRML V2.0 utf8\nDEF All Group { children [ " + body + "] }",
                            "beside.wrl"),
        options);
  }
  bool pick(double x, bool mayLag) {
    Interaction& interaction = interactionOf(browser_->events());
    return interaction.picker.pick({{x, 50, 10.1}, {0, -1, 0}}, {.mayLag = mayLag},
                                   interaction.viewer.view(), browser_->world().scope.roots, hit_);
  }
  bool pickUntilReady(double x) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!pick(x, true) && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return pick(x, true);
  }
  std::unique_ptr<Browser> browser_;
  Hit hit_;
};

TEST_F(PickBeside, AMovingViewerPassesUntilTheMeshIsPrepared) {
  load(grid("A", 0, 1));
  EXPECT_FALSE(pick(10.2, true));
  ASSERT_TRUE(pickUntilReady(10.2));
  const Hit late = hit_;
  load(grid("A", 0, 1));
  ASSERT_TRUE(pick(10.2, false));
  EXPECT_EQ(late.t, hit_.t);
  EXPECT_EQ(late.normal, hit_.normal);
  EXPECT_EQ(late.texCoord, hit_.texCoord);
}

TEST_F(PickBeside, AClickWaits) {
  load(grid("A", 0, 1));
  EXPECT_FALSE(pick(10.2, true));
  ASSERT_TRUE(pick(10.2, false));
  EXPECT_NEAR(hit_.point.y, 1, .26);
  EXPECT_TRUE(pick(10.2, true)) << "it is prepared now";
}

TEST_F(PickBeside, BoundsAreWholeForWhoeverWaits) {
  load(grid("A", 0, 1));
  EXPECT_FALSE(pick(10.2, true));
  Picker& picker = interactionOf(browser_->events()).picker;
  EXPECT_TRUE(picker.bounds(browser_->world().scope.roots, true).empty());
  EXPECT_NEAR(picker.bounds(browser_->world().scope.roots).high.x, side, 1e-5);
}

TEST_F(PickBeside, NobodyPassesWhereTheSameInputGivesTheSameWorld) {
  load(grid("A", 0, 1), 0);
  EXPECT_TRUE(pick(10.2, true));
  browser_->setScriptPatience(.05);
  const auto other = loadWorldFromMemory("#VRML V2.0 utf8\n" + grid("B", 0, 3), "b.wrl");
  browser_->addRoot(other->scope.roots.at(0));
  EXPECT_TRUE(pick(10.2, true));
  EXPECT_NEAR(hit_.point.y, 1, .26) << "the one before is still met";
  browser_->setScriptPatience(0);
  EXPECT_TRUE(pick(10.2, true));
  EXPECT_NEAR(hit_.point.y, 3, .26);
}

TEST_F(PickBeside, AMeshThatChangesMeanwhileIsReadAtOnce) {
  load(grid("A", 0, 1));
  EXPECT_FALSE(pick(10.2, true));
  browser_->set(*browser_->node("A"), "height", MFFloat((side + 1) * (side + 1), 5));
  EXPECT_TRUE(pick(10.2, true));
  EXPECT_NEAR(hit_.point.y, 6, 1e-5);
}

TEST_F(PickBeside, AMeshThatIsRemovedMeanwhileIsNotMet) {
  load(grid("A", 0, 1));
  EXPECT_FALSE(pick(10.2, true));
  browser_->set(*browser_->node("All"), "children", MFNode());
  EXPECT_FALSE(pick(10.2, false));
  EXPECT_FALSE(pick(10.2, true));
}

TEST_F(PickBeside, ABrowserMayGoWhileMeshesArePrepared) {
  load(grid("A", 0, 1) + grid("B", 0, 2) + grid("C", 0, 3));
  EXPECT_FALSE(pick(10.2, true));
  browser_.reset();
}

TEST_F(PickBeside, MoreMeshesThanThreadsAreAllPrepared) {
  std::string body;
  for (int i = 0; i < 5; ++i) body += grid(fmt::format("N{}", i), 300 * i, i);
  load(body);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(pick(300 * i + 10.2, true));
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(pickUntilReady(300 * i + 10.2)) << i;
    EXPECT_NEAR(hit_.point.y, i, .26);
  }
}

// --- Copies of geometry ---

void expectSameMesh(const std::string& geometry) {
  const auto world =
      loadWorldFromMemory("#X3D V4.0 utf8\nPROFILE Full\n"
                          "PROTO P [ ] { Coordinate { point [ 0 0 0 1 0 0 1 1 0 0 1 0 ] } }\n"
                          "Shape { geometry " +
                              geometry + " }",
                          "copied.x3dv");
  for (const Diagnostic& d : world->diagnostics.list()) ADD_FAILURE() << d.text();
  Node* original = renderedNode(nodeCast<nodes::Shape>(world->scope.roots.at(0))->geometry.get());
  const NodeRef copy = copyOfGeometry(*original);
  ASSERT_TRUE(copy) << geometry;
  const MeshOptions options{.needTexCoords = true};
  const Mesh a = buildMesh(*original, options);
  Mesh b = buildMesh(*copy, options);
  b.takeAll();
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.solid, b.solid);
  EXPECT_EQ(a.ccw, b.ccw);
  const auto same = [](auto x, auto y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
  };
  EXPECT_FALSE(b.indices.empty());
  EXPECT_TRUE(same(a.points, b.points));
  EXPECT_TRUE(same(a.indices, b.indices));
  EXPECT_TRUE(same(a.normals, b.normals));
  EXPECT_TRUE(same(a.texCoords, b.texCoords));
  EXPECT_TRUE(same(a.colors, b.colors));
  EXPECT_TRUE(same(a.alphas, b.alphas));
  EXPECT_EQ(b.points.data(), b.ownPoints.data()) << "it has its points itself";
}

TEST(CopiedGeometry, HasTheMeshOfItsOriginal) {
  expectSameMesh(
      "IndexedFaceSet { ccw FALSE solid FALSE coord Coordinate { point [ 0 0 0 1 0 0 1 1 "
      "0 0 1 0 ] } coordIndex [ 0 1 2 -1 0 2 3 -1 ] color ColorRGBA { color [ 1 0 0 .5 0 "
      "1 0 1 0 0 1 1 1 1 1 1 ] } texCoord TextureCoordinate { point [ 0 0 1 0 1 1 0 1 ] } "
      "normal Normal { vector [ 0 0 1 0 0 1 0 0 1 0 0 1 ] } }");
  expectSameMesh("IndexedFaceSet { coord P { } coordIndex [ 0 1 2 3 -1 ] creaseAngle 1 }");
  expectSameMesh("ElevationGrid { xDimension 3 zDimension 2 height [ 0 1 0 1 0 1 ] color Color { "
                 "color [ 1 0 0 0 1 0 ] } colorPerVertex FALSE }");
  expectSameMesh(
      "IndexedTriangleSet { index [ 0 1 2 0 2 3 ] coord CoordinateDouble { point [ 0 0 0 "
      "1 0 0 1 1 0 0 1 0 ] } }");
  expectSameMesh("TriangleSet { coord Coordinate { point [ 0 0 0 1 0 0 1 1 0 ] } }");
}

TEST(CopiedGeometry, IsLargeByWhatItsArraysHold) {
  nodes::IndexedFaceSet faces;
  EXPECT_FALSE(isSlowToBuild(faces));
  faces.coordIndex.resize(150'000, -1);
  EXPECT_TRUE(isSlowToBuild(faces));
  nodes::TriangleSet triangles;
  auto* points = new nodes::Coordinate();
  triangles.coord = NodeRef(points);
  EXPECT_FALSE(isSlowToBuild(triangles));
  points->point.resize(150'000);
  EXPECT_TRUE(isSlowToBuild(triangles));
  nodes::Sphere sphere;
  EXPECT_FALSE(isSlowToBuild(sphere));
  EXPECT_FALSE(copyOfGeometry(sphere)) << "it is no list of faces";
}

} // namespace
} // namespace xvrml
