// xvrml_picking_edits.cpp: picking in worlds that are edited at random. Cached boxes and meshes
// must never be older than the world. Binding, pointer and navigation must survive any order of
// edits, with finite cameras.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "behaviour/viewer/interaction.h"
#include "xvrml/browser.h"

namespace xvrml {
namespace {

constexpr const char* types[] = {"Group",
                                 "Transform",
                                 "Transform",
                                 "Transform",
                                 "Shape",
                                 "Shape",
                                 "TouchSensor",
                                 "PlaneSensor",
                                 "SphereSensor",
                                 "CylinderSensor",
                                 "ProximitySensor",
                                 "VisibilitySensor",
                                 "Viewpoint",
                                 "Fog",
                                 "NavigationInfo",
                                 "Collision",
                                 "Billboard",
                                 "Switch",
                                 "LOD",
                                 "Anchor",
                                 "Box",
                                 "Sphere",
                                 "IndexedFaceSet",
                                 "Coordinate",
                                 "Inline"};

class Editor {
 public:
  explicit Editor(unsigned seed)
      : random_(seed), browser(loadWorldFromMemory(
                           "#VRML V2.0 utf8\nViewpoint {} TouchSensor {} Shape { geometry Box {} }",
                           "random.wrl")) {
    for (int i = 0; i < 60; ++i) {
      nodes_.push_back(make());
      if (below(3) == 0) browser.addRoot(nodes_.back());
    }
  }

  void step() {
    switch (below(16)) {
    case 0:
    case 1: set("addChildren", MFNode{any()}); break;
    case 2: set("removeChildren", MFNode{any()}); break;
    case 3:
    case 4:
      set("translation", Vec3f{number() / 3, number() / 3, below(20) ? number() : NAN});
      break;
    case 5: set("scale", Vec3f{number() / 3, number() / 3, below(5) ? number() : 0}); break;
    case 6: set("set_bind", below(3) != 0); break;
    case 7:
      set("enabled", below(2) == 0);
      set("collide", below(2) == 0);
      set("size", Vec3f{10, 10, 10});
      break;
    case 8:
      set("geometry", any());
      set("coord", any());
      break;
    case 9:
      set("point", MFVec3f{{number(), number(), number()},
                           {number(), number(), number()},
                           {number(), number(), number()}});
      set("set_coordIndex", MFInt32{0, 1, 2});
      break;
    case 10:
      set("choice", MFNode{any(), any()});
      set("level", MFNode{any()});
      set("whichChoice", below(3) - 1);
      break;
    case 11: below(3) ? browser.addRoot(any()) : browser.removeRoot(*any()); break;
    case 12: browser.pointer(number() / 10, number() / 10, below(2) == 0); break;
    case 13:
      browser.setNavigation(Navigation(below(4)));
      browser.navigate({.ahead = number() / 10,
                        .right = number() / 10,
                        .turn = number() / 10,
                        .tilt = number() / 10},
                       0.1);
      break;
    case 14:
      browser.key(Key(below(9)), below(2) == 0);
      browser.setTransition(below(2));
      browser.tick(browser.now() + 0.1);
      browser.takeChanges();
      break;
    default: nodes_[size_t(below(int(nodes_.size())))] = make(); break;
    }
  }

  // Compares the hit of a random ray towards the centre with that of a new picker without cached
  // data.
  void compare() {
    Interaction& interaction = interactionOf(browser.events());
    const Vector from(number() / 2, number() / 2, 30), to(number() / 4, number() / 4, 0);
    const PickRay ray{from, to - from};
    const PickRules rules{below(2) == 0, below(2) == 0};
    const Matrix view = interaction.viewer.view();
    ASSERT_TRUE(finite(view));
    Hit kept, fresh;
    Picker other(interaction.engine);
    const bool meets = interaction.picker.pick(ray, rules, view, browser.world().scope.roots, kept);
    ASSERT_EQ(meets, other.pick(ray, rules, view, browser.world().scope.roots, fresh));
    hits += meets;
    if (!meets) return;
    ASSERT_EQ(kept.t, fresh.t);
    ASSERT_EQ(kept.path.size(), fresh.path.size());
  }

 private:
  int below(int n) { return int(random_() % unsigned(n)); }
  float number() { return float(below(200) - 100) / 10; }
  NodeRef any() { return nodes_[size_t(below(int(nodes_.size())))]; }
  // Sets the field of a random node that has it.
  void set(std::string_view field, const Value& value) {
    for (int i = 0; i < 20; ++i)
      if (browser.set(*any(), field, value)) return;
  }
  NodeRef make() {
    const NodeRef node = browser.createNode(types[below(int(std::size(types)))]);
    if (below(3)) browser.set(*node, "geometry", browser.createNode(below(2) ? "Box" : "Sphere"));
    return node;
  }

  std::mt19937 random_;
  std::vector<NodeRef> nodes_; // declared before the browser, which is destroyed first
 public:
  Browser browser;
  int hits = 0;
};

TEST(PickingEdits, WhatIsKeptIsNeverOlderThanTheWorld) {
  int hits = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Editor editor(seed);
    for (int i = 0; i < 300; ++i) {
      editor.step();
      for (int ray = 0; ray < 4; ++ray) editor.compare();
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << "seed " << seed << " step " << i;
    }
    hits += editor.hits;
  }
  EXPECT_GT(hits, 3000);
}

} // namespace
} // namespace xvrml
