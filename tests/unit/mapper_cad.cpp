// mapper_cad.cpp: CADPart, CADFace, CADLayer and CADAssembly (ISO/IEC 19775-1 clause 32) in what is
// drawn: placing, changes by events, and the list `visible` of a layer.
#include <cmath>

#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapCad : public MapRunning {
 protected:
  void loadX3d(const std::string& body) {
    world_ = loadWorldFromMemory("#X3D V3.3 utf8\nPROFILE CADInterchange\n" + body, "test.x3dv");
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    frame();
  }
  std::string extent() {
    const Bounds b = mapper_->bounds();
    if (b.empty) return "empty";
    std::string text;
    for (int i = 0; i < 3; ++i)
      text += (text.empty() ? "" : " ") + std::to_string(std::lround(b.minimum[i])) + ".." +
              std::to_string(std::lround(b.maximum[i]));
    return text;
  }
};

const std::string box = "Shape { geometry Box { } }";

TEST_F(MapCad, PartsPlaceTheirFaces) {
  loadX3d(
      "CADAssembly { children CADPart { translation 10 0 0 scale 2 2 2 children CADFace { shape " +
      box + " } } }\n");
  EXPECT_EQ(extent(), "8..12 -2..2 -2..2");
}

TEST_F(MapCad, EventsMoveAPart) {
  loadX3d("DEF P CADPart { children CADFace { shape " + box + " } }\n" + box + "\n");
  EXPECT_EQ(extent(), "-1..1 -1..1 -1..1");
  for (const float x : {5.f, 6.f, 7.f}) {
    send("P", "set_translation", Vec3f{x, 0, 0});
    const Cost now = cost();
    EXPECT_EQ(extent(), "-1.." + std::to_string(int(x) + 1) + " -1..1 -1..1");
    if (x > 5) { EXPECT_EQ(now, (Cost{.moved = 1})); }
  }
}

TEST_F(MapCad, ALayerShowsItsChildrenOneByOne) {
  loadX3d("DEF L CADLayer { visible [ TRUE FALSE ] children [ " + box +
          " Transform { translation 5 0 0 children " + box +
          " } Transform { translation 0 9 0 "
          "children " +
          box + " } ] }\n");
  EXPECT_EQ(extent(), "-1..1 -1..10 -1..1"); // beyond the end of the list: TRUE
  send("L", "set_visible", MFBool{false, true, false});
  frame();
  EXPECT_EQ(extent(), "4..6 -1..1 -1..1");
  send("L", "set_visible", MFBool{});
  frame();
  EXPECT_EQ(extent(), "-1..6 -1..10 -1..1");
}

TEST_F(MapCad, AFaceWithoutShapeIsEmpty) {
  loadX3d("DEF F CADFace { }\n");
  EXPECT_EQ(extent(), "empty");
  send("F", "set_shape", make(box));
  frame();
  EXPECT_EQ(extent(), "-1..1 -1..1 -1..1");
}

} // namespace
