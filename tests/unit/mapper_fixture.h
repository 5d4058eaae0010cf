// mapper_fixture.h: a running world, its engine and its mapper, in a context of their own.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "behaviour/viewer/interaction.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"
#include "xvrml/nodes.h"

namespace xvrml::test {

// API calls made for a frame.
struct Cost {
  uint64_t defined = 0, moved = 0, parameters = 0, textures = 0, regroupings = 0, lights = 0;
  bool operator==(const Cost&) const = default;
};
inline constexpr Cost nothing{};
inline std::ostream& operator<<(std::ostream& out, const Cost& c) {
  return out << c.defined << " defined, " << c.moved << " moved, " << c.parameters
             << " parameters, " << c.textures << " textures, " << c.regroupings << " regroupings, "
             << c.lights << " lights";
}

class MapRunning : public testing::Test {
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

  void load(const std::string& body) { loadText("#VRML V2.0 utf8\n" + body, "test.wrl"); }
  void loadX3d(const std::string& body) {
    loadText("#X3D V4.0 utf8\nPROFILE Full\n" + body, "test.x3dv");
  }
  void loadText(const std::string& text, const std::string& name) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory(text, name);
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    frame();
  }
  Node& node(const std::string& name) {
    const auto found = world_->scope.names.find(name);
    EXPECT_NE(found, world_->scope.names.end()) << name;
    return *found->second;
  }
  void send(const std::string& name, const std::string& in, Value value) {
    EXPECT_TRUE(engine_->dispatch(node(name), in, std::move(value))) << name << "." << in;
  }
  // Parses one root node. It belongs to the world's engine once it is sent somewhere.
  NodeRef make(const std::string& text) {
    scraps_.push_back(loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "scrap.wrl"));
    return scraps_.back()->scope.roots.at(0);
  }

  // Applies the changes to the scene, renders, and returns the scene's statistics.
  RTstats frame() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(1, 1, RT_RGBA);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats;
  }

  // Returns the cost of the frame that shows the events sent before.
  Cost cost() {
    const MapStats before = mapper_->stats();
    last_ = frame();
    const MapStats s = mapper_->stats();
    return {s.objectsDefined - before.objectsDefined, s.instancesMoved - before.instancesMoved,
            s.parametersSet - before.parametersSet,   s.texturesLoaded - before.texturesLoaded,
            s.regroupings - before.regroupings,       s.lightsChanged - before.lightsChanged};
  }

  // Describes the objects in an order that does not depend on when they were made.
  static std::vector<std::string> structure(const OpenRTMapper& mapper) {
    std::vector<std::string> lines;
    for (const ExplainedObject& o : mapper.explain())
      lines.push_back(o.name + " | " + o.reason + " | " + std::to_string(o.triangles) + " " +
                      std::to_string(o.shapes) + " " + std::to_string(o.instances));
    std::sort(lines.begin(), lines.end());
    return lines;
  }
  const ExplainedObject* explained(const std::string& reason) {
    list_ = mapper_->explain();
    for (const ExplainedObject& o : list_)
      if (o.reason.find(reason) != std::string::npos) return &o;
    return nullptr;
  }

  static std::string repeat(const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
  }
  // Returns an ElevationGrid of 2 n^2 triangles.
  static std::string grid(int n) {
    return "ElevationGrid { xDimension " + std::to_string(n + 1) + " zDimension " +
           std::to_string(n + 1) + " height [" + repeat("0 ", (n + 1) * (n + 1)) + "] }";
  }
  // Returns a shape of two triangles.
  static std::string square(const std::string& name, const std::string& more = "") {
    return "DEF " + name + " IndexedFaceSet { coord DEF " + name +
           "C Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } " +
           "coordIndex [ 0 1 2 3 -1 ] " + more + " }";
  }

  RTcontext context_ = nullptr;
  std::vector<std::unique_ptr<World>> scraps_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<OpenRTMapper> mapper_;
  std::vector<ExplainedObject> list_;
  RTstats last_{}; // statistics after cost()
};

} // namespace xvrml::test
