// springs_test.cpp: the example plug-in (examples/nodes): its nodes are parsed, written, routed,
// drawn and updated.
#include <gtest/gtest.h>

#include "geometry/mesh.h"
#include "xvrml/browser.h"
#include "xvrml/mapper.h"
#include "xvrml/node_plugin.h"
#include "xvrml/nodes.h"
#include "xvrml/renderer.h"
#include <springs_nodes.h>

namespace {

using namespace xvrml;

class Springs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    EXPECT_EQ(loadNodePlugins(GOOD_PLUGINS), std::vector<std::string>());
  }

  void run(const std::string& text) {
    auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "test");
    for (const Diagnostic& d : world->diagnostics.list()) ADD_FAILURE() << d.text();
    browser = std::make_unique<Browser>(std::move(world));
  }
  Node& node(const char* name) { return *browser->node(name); }
  const nodes::Extrusion& tube() {
    return *nodeCast<nodes::Extrusion>(renderedNode(&node("Coil")));
  }

  std::unique_ptr<Browser> browser;
};

const char* coil = "DEF Holder Shape { geometry DEF Coil Spring { turns 3 height 4 } }\n";

TEST_F(Springs, AreOfTheRegistryAndLoadedOnce) {
  const NodeType* spring = findNodeType("Spring");
  ASSERT_TRUE(spring);
  EXPECT_TRUE(spring->is("geometry") && spring->expand);
  EXPECT_EQ(nodeTypes()[size_t(spring->index)], spring);
  EXPECT_EQ(std::get<SFInt32>(spring->find("turns")->defaultValue), 6);
  const size_t before = nodeTypes().size();
  EXPECT_TRUE(loadNodePlugins(GOOD_PLUGINS).empty());
  EXPECT_EQ(nodeTypes().size(), before);
}

TEST_F(Springs, AreReadCheckedAndWritten) {
  run(coil);
  const std::string text = writeWorld(browser->world());
  EXPECT_NE(text.find("turns 3"), text.npos);
  std::string difference;
  EXPECT_TRUE(
      equalScopes(loadWorldFromMemory(text, "again")->scope, browser->world().scope, &difference))
      << difference;
  const auto wrong = loadWorldFromMemory(
      "#VRML V2.0 utf8\nSpring { }\nShape { geometry Spring { turns 0 coils 2 } }", "wrong");
  EXPECT_EQ(wrong->diagnostics.errors() + wrong->diagnostics.warnings(),
            3u); // not a child, out of range, no such field
}

TEST_F(Springs, StandForAnExtrusion) {
  run(coil);
  EXPECT_EQ(tube().spine.size(), 3u * 16 + 1);
  EXPECT_FLOAT_EQ(tube().spine.back().y, 4);
  EXPECT_EQ(&tube(), &tube());
  const Mesh mesh = buildMesh(node("Coil"), {});
  EXPECT_GT(mesh.indices.size(), 900u);
}

TEST_F(Springs, OfAWorldThatStandsStillFollowItsFields) {
  const auto world = loadWorldFromMemory(std::string("#VRML V2.0 utf8\n") + coil, "test");
  Node& spring = *world->scope.names.at("Coil");
  EXPECT_EQ(nodeCast<nodes::Extrusion>(renderedNode(&spring))->spine.size(), 49u);
  spring.set(*spring.type().find("turns"), SFInt32(1));
  EXPECT_EQ(nodeCast<nodes::Extrusion>(renderedNode(&spring))->spine.size(), 17u);
}

TEST_F(Springs, AreMovedByRoutesAndOnlyWhatDiffersChanges) {
  run(std::string(coil) + "DEF Clock TimeSensor { loop TRUE cycleInterval 1 }\n"
                          "DEF Stretch ScalarInterpolator { key [ 0 1 ] keyValue [ 2 6 ] }\n"
                          "ROUTE Clock.fraction_changed TO Stretch.set_fraction\nROUTE "
                          "Stretch.value_changed TO Coil.set_height\n");
  const Node* before = &tube();
  EXPECT_TRUE(reaches(tube(), Change::geometry)) << "must not be merged with what stands still";
  browser->tick(0);
  browser->takeChanges();
  browser->tick(0.5);
  EXPECT_EQ(&tube(), before);
  EXPECT_FLOAT_EQ(tube().spine.back().y, 4);
  browser->tick(0.75);
  EXPECT_FLOAT_EQ(tube().spine.back().y, 5);
  bool spine = false;
  for (const FieldChange& change : browser->takeChanges()) {
    if (change.node.get() != before) continue;
    EXPECT_EQ(change.field->name, "spine");
    spine = true;
  }
  EXPECT_TRUE(spine);
}

TEST_F(Springs, HoldTheFieldsOwnChildren) {
  run("DEF Hook Hanging { length 1 children DEF Weight Transform { children Shape { geometry Box { "
      "} } } }");
  auto* place = nodeCast<nodes::Transform>(renderedNode(&node("Hook")));
  ASSERT_TRUE(place);
  EXPECT_EQ(place->children.at(0).get(), &node("Weight"));
  browser->takeChanges();
  EXPECT_TRUE(browser->set(node("Hook"), "length", SFFloat(3)));
  EXPECT_EQ(renderedNode(&node("Hook")), place);
  EXPECT_FLOAT_EQ(place->translation.y, -3);
  bool moved = false;
  for (const FieldChange& change : browser->takeChanges())
    moved |= change.node.get() == place && change.field->name == "translation";
  EXPECT_TRUE(moved);
  EXPECT_TRUE(browser->set(node("Hook"), "children", MFNode{}));
  EXPECT_TRUE(place->children.empty());
}

TEST_F(Springs, CannotHoldThemselves) {
  run("DEF Hook Hanging { children DEF Inner Group { } }");
  browser->set(node("Inner"), "children", MFNode{browser->node("Hook")});
  const auto& group = static_cast<nodes::Group&>(node("Inner"));
  EXPECT_TRUE(group.children.empty());
  EXPECT_NE(browser->world().diagnostics.list().back().message.find("itself"), std::string::npos);
}

TEST_F(Springs, WorkInsidePrototypes) {
  run("PROTO Bed [ exposedField SFFloat h 1 ] { Shape { geometry Spring { height IS h turns 2 } } "
      "}\n"
      "DEF A Bed { h 3 } DEF B Bed { }");
  const auto top = [&](const char* name) {
    auto* shape = nodeCast<nodes::Shape>(renderedNode(&node(name)));
    return nodeCast<nodes::Extrusion>(renderedNode(shape->geometry.get()))->spine.back().y;
  };
  EXPECT_FLOAT_EQ(top("A"), 3);
  EXPECT_FLOAT_EQ(top("B"), 1);
  browser->set(node("A"), "h", SFFloat(7));
  EXPECT_FLOAT_EQ(top("A"), 7);
  EXPECT_FLOAT_EQ(top("B"), 1);
}

struct Visits : Renderer {
  std::string names;
  Visit render(Node& node, const RenderState&) override {
    names += node.type().name + ' ';
    return Visit::children;
  }
};

// A renderer that knows the plug-in.
struct OwnVisits : Visits, SpringsRenderer {
  int turns = 0;
  Visit renderSpring(nodes::Spring& node, const RenderState& state) override {
    EXPECT_EQ(state.path.back(), &node);
    turns += node.turns;
    return Visit::skip;
  }
};

TEST_F(Springs, RenderersVisitThemAndWhatTheyExpandTo) {
  run(std::string(coil) + "Hanging { length 1 children Group { } }");
  Visits visits;
  render(browser->world(), visits);
  EXPECT_EQ(visits.names, "Shape Spring Extrusion Hanging Transform Group ");
  OwnVisits own;
  render(browser->world(), own);
  EXPECT_EQ(own.names, "Shape Transform Group ") << "Hanging has a callback that goes on";
  EXPECT_EQ(own.turns, 3);
}

TEST_F(Springs, CounterBehaves) {
  run("DEF Clock TimeSensor { loop TRUE cycleInterval 1 } DEF Count Counter { value 10 }\n"
      "ROUTE Clock.cycleTime TO Count.count");
  int told = 0;
  browser->listen(node("Count"), "value_changed",
                  [&](Node&, const FieldInfo&, const Value&) { ++told; });
  for (int i = 0; i <= 50; ++i) browser->tick(i * 0.1);
  const int counted = std::get<SFInt32>(browser->get(node("Count"), "value"));
  EXPECT_GE(counted, 15);
  EXPECT_GE(told, 5);
  EXPECT_LE(told, counted - 10);
}

} // namespace
