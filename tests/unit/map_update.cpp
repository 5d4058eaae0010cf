// Changes between frames: what OpenRTMapper::update() makes of a running world's changes.
#include <memory>

#include <gtest/gtest.h>

#include "event/engine.h"
#include "openrt/openrt.h"
#include "xvrml/openrt.h"

using namespace xvrml;

namespace {

class MapUpdate : public testing::Test {
 protected:
  void SetUp() override {
    context_ = rtNewContext("threads=1");
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
  }
  void TearDown() override {
    mapper_.reset();
    engine_.reset();
    rtDeleteContext(context_);
  }
  void load(const std::string& body) {
    world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "test.wrl");
    engine_ = std::make_unique<Engine>(world_->diagnostics);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    frame();
  }
  Node& node(const std::string& name) { return *world_->scope.names.find(name)->second; }
  void send(const std::string& name, const std::string& in, Value value) {
    EXPECT_TRUE(engine_->dispatch(node(name), in, std::move(value))) << name << "." << in;
  }
  RTstats frame() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(1, 1, RT_RGBA);
    rtRender();
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats;
  }

  RTcontext context_ = nullptr;
  std::unique_ptr<World> world_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<OpenRTMapper> mapper_;
};

TEST_F(MapUpdate, ASwitchShowsWhatItIsTold) {
  load("DEF S Switch { whichChoice -1 choice [ Shape { geometry Box { } } ] }");
  EXPECT_EQ(frame().triangles, 0u);
  send("S", "set_whichChoice", 0);
  EXPECT_EQ(frame().triangles, 12u);
}

TEST_F(MapUpdate, ABoundViewpointIsTheOneFromOutside) {
  load("Viewpoint { } DEF V Viewpoint { position 1 2 3 } NavigationInfo { headlight FALSE }");
  EXPECT_EQ(mapper_->boundViewpoint(), 0);
  BoundNodes bound;
  bound.viewpoint = &node("V");
  mapper_->bind(bound);
  EXPECT_EQ(mapper_->boundViewpoint(), 1);
  EXPECT_EQ(frame().lights, 1u) << "no NavigationInfo is bound: the default has a headlight";
  mapper_->bind({});
  EXPECT_EQ(mapper_->boundViewpoint(), -1);
}

} // namespace
