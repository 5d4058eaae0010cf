// mapper_vertex_alpha.cpp: Tests events that change the geometry of X3D and its opacities while a
// world runs: what the next frame shows.
#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapVertexAlpha : public MapRunning {
 protected:
  void loadX3d(const std::string& body) {
    world_ = loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE Full\n" + body, "test.x3dv");
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  }
  // Returns red, green and blue of the next frame's pixel.
  std::vector<float> pixel() {
    frame();
    std::vector<float> rgba(4);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  void expectColor(float r, float g, float b) {
    const std::vector<float> p = pixel();
    EXPECT_NEAR(p[0], r, 1e-5);
    EXPECT_NEAR(p[1], g, 1e-5);
    EXPECT_NEAR(p[2], b, 1e-5);
  }
  NodeRef colors(float alpha) {
    const NodeType& type = *findNodeType("ColorRGBA");
    NodeRef made(type.create(type));
    nodeCast<nodes::ColorRGBA>(made)->color.assign(4, {1, 0, 0, alpha});
    return made;
  }
  static std::string wall(const std::string& more) {
    return "NavigationInfo { headlight FALSE }\nBackground { skyColor 0 0 1 }\nShape { appearance "
           "DEF A Appearance { } geometry DEF Q QuadSet { coord DEF C Coordinate { point [ -50 -50 "
           "0, 50 -50 0, 50 50 0, -50 50 0 ] } " +
           more + " } }\n";
  }
};

TEST_F(MapVertexAlpha, ColoursChangeAtRunTime) {
  loadX3d(wall("color DEF R ColorRGBA { color [ 1 0 0 1, 1 0 0 1, 1 0 0 1, 1 0 0 1 ] }"));
  expectColor(1, 0, 0);
  send("R", "set_color", MFColorRGBA(4, {0, 1, 0, .25f}));
  expectColor(0, .25f, .75f);
  send("R", "set_color", MFColorRGBA(4, {0, 1, 0, 0}));
  expectColor(0, 0, 1);
}

// The transparency of a material reaches lines while the world runs.
TEST_F(MapVertexAlpha, TheTransparencyOfLinesChangesAtRunTime) {
  loadX3d("NavigationInfo { headlight FALSE }\nBackground { skyColor 0 0 1 }\nShape { appearance "
          "Appearance { material DEF M Material { emissiveColor 1 0 0 } } geometry LineSet { "
          "vertexCount 3 coord Coordinate { point [ -50 0 0, 0 0 0, 50 0 0 ] } } }\n");
  expectColor(1, 0, 0);
  for (const float transparency : {.75f, 1.0f, 0.0f, .5f}) {
    send("M", "set_transparency", transparency);
    expectColor(1 - transparency, 0, transparency);
  }
}

TEST_F(MapVertexAlpha, AColorMakesRoomForAColorRGBAAndBack) {
  for (const bool routed : {false, true}) {
    loadX3d(
        wall("color DEF O Color { color [ 0 1 0, 0 1 0, 0 1 0, 0 1 0 ] }") +
        (routed ? "DEF I CoordinateInterpolator { }\nROUTE I.value_changed TO C.set_point\n" : ""));
    const NodeRef opaque(&node("O"));
    expectColor(0, 1, 0);
    send("Q", "set_color", colors(.25f));
    expectColor(.25f, 0, .75f);
    send("Q", "set_color", opaque);
    expectColor(0, 1, 0);
    send("Q", "set_color", NodeRef());
    expectColor(1, 1, 1);
    send("Q", "set_color", colors(.5f));
    expectColor(.5f, 0, .5f);
    mapper_.reset();
    engine_.reset();
  }
}

TEST_F(MapVertexAlpha, IndicesCountsAndVerticesChangeAtRunTime) {
  const std::string points = "coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }";
  loadX3d("Shape { geometry DEF T IndexedTriangleSet { index [ 0 1 2 ] " + points +
          " } }\nShape { geometry DEF F TriangleFanSet { fanCount [ 3 ] " + points +
          " } }\nShape { geometry DEF P TriangleSet2D { vertices [ 0 0, 1 0, 0 1 ] } }\n");
  EXPECT_EQ(frame().scene.triangles, 3u);
  send("T", "set_index", MFInt32{0, 1, 2, 0, 2, 3});
  EXPECT_EQ(frame().scene.triangles, 4u);
  send("F", "set_fanCount", MFInt32{4});
  EXPECT_EQ(frame().scene.triangles, 5u);
  send("P", "set_vertices", MFVec2f{{0, 0}, {1, 0}, {0, 1}, {0, 0}, {2, 0}, {0, 2}});
  EXPECT_EQ(frame().scene.triangles, 6u);
  send("T", "set_index", MFInt32{INT32_MAX, -1, INT32_MIN});
  send("F", "set_fanCount", MFInt32{2'000'000'000, -1});
  EXPECT_EQ(frame().scene.triangles, 4u);
}

} // namespace
