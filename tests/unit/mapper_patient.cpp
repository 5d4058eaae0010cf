// mapper_patient.cpp: a patient mapper leaves out what appears with a large mesh until a job has
// read the mesh. In the end the scene is that of a mapper that waits, whatever happens meanwhile.
#include <chrono>
#include <thread>

#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

constexpr int side = 280; // squares each way of a mesh that is read beside
constexpr uint64_t many = 2 * side * side;

class MapPatient : public MapRunning {
 protected:
  // A Switch that shows nothing at first, and a group around it.
  void loadHidden(const std::string& content) {
    load("DEF Around Group { children [ Shape { geometry Box { } }\n"
         "DEF S Switch { choice [ Group { } " +
         content + " ] } ] }\nViewpoint { position 4 4 30 }\n");
    mapper_->setPatient(true);
  }
  void show() { send("S", "set_whichChoice", int32_t(1)); }
  static std::string large(const std::string& more = "") {
    return "Shape { " + more + " geometry DEF G " + MapRunning::grid(side) + " }";
  }
  NodeRef grid() {
    const NodeRef shape = make("Shape { geometry " + MapRunning::grid(side) + " }");
    return static_cast<nodes::Shape&>(*shape).geometry;
  }
  uint64_t triangles() { return frame().scene.triangles; }
  // Draws frames until nothing is left out. Returns the triangles of the last one.
  uint64_t finish() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    uint64_t last = triangles();
    while (mapper_->isBehind() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      last = triangles();
    }
    EXPECT_FALSE(mapper_->isBehind());
    return last;
  }
  std::vector<float> pixels() {
    std::vector<float> rgba(40 * 30 * 4);
    rtFrameBuffer(40, 30, RT_RGBA);
    rtRender();
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  // Compares the scene with that of a mapper that has just read the world.
  void expectSameAsAnew() {
    const std::vector<std::string> found = structure(*mapper_);
    const std::vector<float> seen = pixels();
    mapper_.reset();
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    frame();
    EXPECT_EQ(found, structure(*mapper_));
    EXPECT_EQ(seen, pixels());
  }
};

TEST_F(MapPatient, ALargeMeshComesLaterAndTheSceneIsTheSame) {
  loadHidden(large());
  const uint64_t before = triangles();
  show();
  EXPECT_EQ(triangles(), before);
  EXPECT_TRUE(mapper_->isBehind());
  EXPECT_EQ(finish(), before + many);
  EXPECT_EQ(mapper_->readBeside(), 1u);
  expectSameAsAnew();
}

TEST_F(MapPatient, SmallMeshesComeAtOnce) {
  loadHidden("Shape { geometry " + MapRunning::grid(100) + " }");
  const uint64_t before = triangles();
  show();
  EXPECT_EQ(triangles(), before + 20'000);
  EXPECT_FALSE(mapper_->isBehind());
}

TEST_F(MapPatient, WhoeverIsNotPatientGetsAllAtOnce) {
  loadHidden(large());
  const uint64_t before = triangles();
  show();
  EXPECT_EQ(triangles(), before);
  mapper_->setPatient(false);
  EXPECT_EQ(triangles(), before + many) << "also what has waited";
  EXPECT_EQ(mapper_->readBeside(), 1u) << "that is taken over";
  EXPECT_FALSE(mapper_->isBehind());
  expectSameAsAnew();
}

TEST_F(MapPatient, OtherChangesAreShownMeanwhile) {
  loadHidden(large() + " Transform { }");
  send("Around", "addChildren", MFNode{make("Transform { children Shape { geometry Box { } } }")});
  const uint64_t before = triangles();
  show();
  send("Around", "addChildren",
       MFNode{make("Transform { translation 0 9 0 children Shape { geometry Box { } } }")});
  EXPECT_EQ(triangles(), before + 12);
  EXPECT_TRUE(mapper_->isBehind());
  EXPECT_NEAR(mapper_->bounds().maximum[1], 10, 1e-5);
  EXPECT_EQ(finish(), before + 12 + many);
  expectSameAsAnew();
}

TEST_F(MapPatient, WhatIsHiddenAgainNeverComes) {
  loadHidden(large());
  const uint64_t before = triangles();
  show();
  triangles();
  send("S", "set_whichChoice", int32_t(-1));
  EXPECT_EQ(triangles(), before);
  EXPECT_FALSE(mapper_->isBehind());
  EXPECT_EQ(triangles(), before);
  show(); // and once more
  EXPECT_EQ(finish(), before + many);
}

TEST_F(MapPatient, WhatIsRemovedWhileItWaitsNeverComes) {
  loadHidden(large());
  const uint64_t before = triangles();
  show();
  triangles();
  send("Around", "removeChildren", MFNode{NodeRef(&node("S"))});
  EXPECT_EQ(triangles(), before);
  EXPECT_FALSE(mapper_->isBehind());
}

TEST_F(MapPatient, AMapperMayGoWhileAMeshIsRead) {
  loadHidden(large());
  show();
  triangles();
  ASSERT_TRUE(mapper_->isBehind());
  mapper_.reset();
  mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  EXPECT_EQ(triangles(), 12 + many) << "another one reads all that there is";
}

TEST_F(MapPatient, AMeshThatChangesMeanwhileIsReadAtOnce) {
  loadHidden(large());
  show();
  triangles();
  ASSERT_TRUE(mapper_->isBehind());
  MFFloat heights((side + 1) * (side + 1), 0);
  heights[0] = 7;
  send("G", "set_height", heights);
  triangles();
  EXPECT_FALSE(mapper_->isBehind()) << "what changes in each frame is shown, too";
  EXPECT_NEAR(mapper_->bounds().maximum[1], 7, 1e-5);
  expectSameAsAnew();
}

TEST_F(MapPatient, AMeshThatIsNewInEachFrameIsShown) {
  load("DEF A Shape { geometry Box { } }\nViewpoint { position 4 4 30 }\n");
  mapper_->setPatient(true);
  int shown = 0;
  for (int i = 0; i < 12; ++i) {
    send("A", "set_geometry", grid());
    triangles();
    shown += !mapper_->isBehind();
  }
  EXPECT_GE(shown, 8);
  EXPECT_EQ(finish(), many);
}

TEST_F(MapPatient, WhatMovesWhileItWaitsComesAtItsPlace) {
  loadHidden("DEF T Transform { children " + large() + " }");
  show();
  triangles();
  send("T", "set_translation", Vec3f{0, 20, 0});
  finish();
  EXPECT_NEAR(mapper_->bounds().maximum[1], 20, 1e-5);
  expectSameAsAnew();
}

TEST_F(MapPatient, AShapeKeepsItsGeometryUntilTheOtherIsRead) {
  load("DEF A Shape { geometry Box { } }\nViewpoint { position 4 4 30 }\n");
  mapper_->setPatient(true);
  EXPECT_EQ(triangles(), 12u);
  send("A", "set_geometry", grid());
  EXPECT_EQ(triangles(), 12u);
  EXPECT_EQ(finish(), many);
  expectSameAsAnew();
}

TEST_F(MapPatient, UsesOfOneGeometryWithAndWithoutTextures) {
  const std::string texture =
      "appearance Appearance { texture PixelTexture { image 1 1 3 0xff8000 } }";
  loadHidden("Group { children [ " + large() + " Shape { " + texture +
             " geometry USE G } Transform { translation 3 0 0 children Shape { geometry USE G } } "
             "] }");
  show();
  triangles();
  EXPECT_TRUE(mapper_->isBehind());
  finish();
  EXPECT_EQ(mapper_->readBeside(), 1u);
  expectSameAsAnew();
}

TEST_F(MapPatient, MoreMeshesThanThreadsComeTogether) {
  std::string content = "Group { children [ ";
  for (int i = 0; i < 5; ++i)
    content += "Transform { translation 0 " + std::to_string(i) + " 0 children Shape { geometry " +
               MapRunning::grid(side) + " } } ";
  loadHidden(content + "] }");
  const uint64_t before = triangles();
  show();
  EXPECT_EQ(triangles(), before);
  EXPECT_EQ(finish(), before + 5 * many);
  EXPECT_EQ(mapper_->readBeside(), 5u);
  expectSameAsAnew();
}

TEST_F(MapPatient, ProblemsOfAMeshAreReportedOnce) {
  loadHidden("Shape { geometry ElevationGrid { xDimension " + std::to_string(side + 1) +
             " zDimension " + std::to_string(side + 2) + " height [" +
             repeat("0 ", (side + 1) * (side + 1)) + "] } }");
  const size_t before = world_->diagnostics.list().size();
  show();
  finish();
  ASSERT_EQ(world_->diagnostics.list().size(), before + 1);
  EXPECT_NE(world_->diagnostics.list().back().message.find("height has"), std::string::npos)
      << world_->diagnostics.list().back().message;
}

} // namespace
