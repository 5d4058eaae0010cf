// xvrml_renderer.cpp: the walk of renderers: which nodes it visits in which order, where they are,
// and what it says of Shapes.
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "graph/inline_node.h"
#include "xvrml/browser.h"
#include "xvrml/nodes.h"
#include "xvrml/renderer.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> worldOf(const std::string& text) {
  auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "test");
  for (const Diagnostic& d : world->diagnostics.list())
    if (d.severity == Severity::error) ADD_FAILURE() << d.text();
  return world;
}

// Writes down what it is called for.
struct Log : Renderer {
  std::vector<std::string> lines;
  Visit render(Node& node, const RenderState& state) override {
    EXPECT_EQ(state.path.back(), &node);
    lines.push_back("+" + nameOf(node));
    return Visit::children;
  }
  void leave(Node& node, const RenderState& state) override {
    EXPECT_EQ(state.path.back(), &node);
    lines.push_back("-" + nameOf(node));
  }
  void draw(const DrawnShape& shape) override { lines.push_back("draw " + nameOf(shape.shape)); }

  static std::string nameOf(const Node& node) {
    return node.defName.empty() ? node.type().name : node.defName;
  }
  std::string text() const { return fmt::format("{}", fmt::join(lines, " ")); }
};

// Draws the Shapes, and keeps what is asked of them.
struct Shapes : Renderer {
  struct Drawn {
    std::string name, path;
    std::array<double, 16> matrix;
    GeometryArrays mesh;
    uint64_t uses;
  };
  std::vector<Drawn> all;
  Visit renderShape(nodes::Shape&, const RenderState&) override { return Visit::draw; }
  void draw(const DrawnShape& shape) override {
    std::string path;
    for (const Node* node : shape.state.path)
      path += (path.empty() ? "" : "/") + (node->type().name);
    Drawn& one =
        all.emplace_back(Drawn{std::string(shape.name()), path, {}, shape.mesh(), shape.uses()});
    std::copy_n(shape.matrix(), 16, one.matrix.begin());
  }
};

std::vector<std::string> namesOf(const World& world, const RenderOptions& options = {}) {
  Shapes shapes;
  render(world, shapes, options);
  std::vector<std::string> names;
  for (const auto& one : shapes.all) names.push_back(one.name);
  return names;
}
using Names = std::vector<std::string>;

TEST(Renderer, GoesThroughAWorldInTheOrderOfTheFile) {
  const auto world = worldOf("DEF A Transform { children [ DEF S Shape { geometry DEF B Box { } "
                             "appearance DEF P Appearance { } } DEF L PointLight { } ] } "
                             "DEF C Group { }");
  Log log;
  render(*world, log);
  EXPECT_EQ(log.text(), "+A +S draw S +P -P +B -B -S +L -L -A +C -C");
}

TEST(Renderer, AVisitThatIsSkippedHasNoChildrenAndIsNotLeft) {
  const auto world = worldOf("DEF A Group { children DEF S Shape { geometry Box { } } } "
                             "DEF T Transform { children DEF S2 Shape { geometry Box { } } }");
  struct Skips : Log {
    Visit renderGroup(nodes::Group&, const RenderState&) override { return Visit::skip; }
    Visit renderShape(nodes::Shape&, const RenderState&) override { return Visit::draw; }
  } log;
  render(*world, log);
  EXPECT_EQ(log.text(), "+T draw S2 -T");
  struct Blind : Log {
    Visit renderShape(nodes::Shape&, const RenderState&) override { return Visit::skip; }
    Visit renderTransform(nodes::Transform&, const RenderState&) override { return Visit::draw; }
  } blind;
  render(*world, blind);
  EXPECT_EQ(blind.text(), "+A -A") << "draw is the same as skip for a Transform";
}

TEST(Renderer, CallsACallbackForEachNodeType) {
  struct Calls : Renderer {
    std::vector<std::string> names;
    Visit render(Node& node, const RenderState&) override {
      names.push_back(node.type().name);
      return Visit::skip;
    }
  };
  size_t made = 0;
  for (const NodeType* type : nodeTypes()) {
    const NodeRef node = makeNode(*type);
    if (!node) continue; // Scripts come only from files
    ++made;
    World world;
    world.scope.roots.push_back(node);
    Calls calls;
    render(world, calls);
    EXPECT_EQ(calls.names, std::vector<std::string>{type->name});
  }
  EXPECT_GT(made, 100u);
}

// One callback of each way in which nodes get there.
TEST(Renderer, OverriddenCallbacksGetTheNode) {
  struct Calls : Renderer {
    std::map<std::string, int> count;
    Visit renderMaterial(nodes::Material& node, const RenderState&) override {
      count["material"] += node.transparency == 0.5f;
      return Visit::children;
    }
    Visit renderScript(ScriptNode& node, const RenderState&) override {
      count["script"] += node.type().find("own") != nullptr;
      return Visit::children;
    }
    Visit renderInstance(ProtoInstance& node, const RenderState&) override {
      count["instance"] += node.declaration->type->name == "P";
      return Visit::children;
    }
    Visit renderCoordinate(nodes::Coordinate& node, const RenderState&) override {
      count["points"] += int(node.point.size());
      return Visit::children;
    }
  } calls;
  const auto world = worldOf(
      "PROTO P [ ] { Shape { appearance Appearance { material Material { transparency 0.5 } } "
      "geometry PointSet { coord Coordinate { point [ 0 0 0 1 1 1 ] } } } } P { } P { } "
      "Script { field SFBool own TRUE }");
  render(*world, calls);
  EXPECT_EQ(calls.count, (std::map<std::string, int>{
                             {"material", 2}, {"script", 1}, {"instance", 2}, {"points", 4}}));
}

TEST(Renderer, TheStateSaysWhereANodeIs) {
  const auto world =
      worldOf("PROTO P [ ] { Shape { geometry Sphere { } } } DEF Car Transform { translation 1 2 3 "
              "children "
              "Transform { scale 2 2 2 children [ DEF Eye Viewpoint { } P { } ] } }");
  struct Places : Renderer {
    int checked = 0;
    Visit renderViewpoint(nodes::Viewpoint& node, const RenderState& state) override {
      EXPECT_EQ(state.matrix[0], 2);
      EXPECT_EQ(state.matrix[13], 2);
      EXPECT_EQ(state.local[0], 1);
      EXPECT_EQ(state.name(), "Eye");
      EXPECT_EQ(state.parent(), state.path[1]);
      EXPECT_EQ(state.path.back(), &node);
      ++checked;
      return Visit::children;
    }
    Visit renderTransform(nodes::Transform& node, const RenderState& state) override {
      EXPECT_EQ(state.matrix[12], node.defName == "Car" ? 0 : 1);
      EXPECT_EQ(state.local[12], node.defName == "Car" ? 1 : 0);
      EXPECT_EQ(state.inner[12], 1);
      EXPECT_EQ(state.parent() == nullptr, node.defName == "Car");
      ++checked;
      return Visit::children;
    }
    void draw(const DrawnShape& shape) override {
      EXPECT_EQ(shape.name(), "Car");
      EXPECT_EQ(shape.state.path.size(), 4u);
      EXPECT_TRUE(nodeCast<ProtoInstance>(shape.state.path[2]));
      ++checked;
    }
  } places;
  render(*world, places);
  EXPECT_EQ(places.checked, 4);
}

TEST(Renderer, AMatrixThatNobodySeesThroughHasNoInner) {
  const auto world = worldOf("Transform { scale 0 1 1 children DEF S Shape { geometry Box { } } }");
  struct Flat : Log {
    Visit renderTransform(nodes::Transform& node, const RenderState& state) override {
      EXPECT_EQ(state.inner, nullptr);
      return render(node, state);
    }
  } log;
  render(*world, log);
  EXPECT_EQ(log.text(), "+Transform -Transform");
}

TEST(Renderer, InlinesLeadToWhatTheyLoaded) {
  const auto world = worldOf("DEF Site Inline { url \"none.wrl\" }");
  auto content = worldOf("DEF Wall Shape { geometry Box { } }");
  auto scope = std::make_shared<Scope>();
  scope->roots = content->scope.roots;
  nodeCast<InlineNode>(world->scope.roots[0].get())->content = scope;
  Shapes shapes;
  render(*world, shapes);
  ASSERT_EQ(shapes.all.size(), 1u);
  EXPECT_EQ(shapes.all[0].path, "Inline/Shape");
}

TEST(Renderer, SeesWhatAViewerSees) {
  const auto world =
      worldOf("Switch { whichChoice 1 choice [ DEF No Shape { geometry Box { } } "
              "DEF Chosen Shape { geometry Box { } } ] } "
              "Switch { choice DEF None Shape { geometry Box { } } } "
              "LOD { range [ 10 ] level [ DEF Near Shape { geometry Box { } } "
              "DEF Far Shape { geometry Sphere { } } ] } "
              "Collision { proxy DEF Proxy Shape { geometry Box { } } "
              "children DEF Child Shape { geometry Box { } } } "
              "Group { visible FALSE children DEF Hidden Shape { geometry Box { } } } "
              "CADLayer { visible [ FALSE, TRUE ] children [ DEF Off Shape { geometry Box { } } "
              "DEF On Shape { geometry Box { } } ] } "
              "DEF Empty Shape { }");
  EXPECT_EQ(namesOf(*world), (Names{"Chosen", "Near", "Child", "On"}));
  const double view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 20, 1};
  EXPECT_EQ(namesOf(*world, {.view = view}), (Names{"Chosen", "Far", "Child", "On"}));
  EXPECT_EQ(namesOf(*world, {.view = view, .finestLevels = true}),
            (Names{"Chosen", "Near", "Child", "On"}));
  EXPECT_EQ(namesOf(*world, {.allChoices = true}),
            (Names{"No", "Chosen", "None", "Near", "Far", "Child", "On"}));
}

TEST(Renderer, BillboardsTurnToTheViewer) {
  const auto world =
      worldOf("Billboard { axisOfRotation 0 1 0 children Shape { geometry Box { } } }");
  const double view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
  Shapes shapes;
  render(*world, shapes, {.view = view});
  ASSERT_EQ(shapes.all.size(), 1u);
  EXPECT_NEAR(shapes.all[0].matrix[8], 1, 1e-9) << "its z axis points along x";
}

TEST(Renderer, MeshesAreCutByClipPlanes) {
  const auto world =
      worldOf("Transform { translation 0 1 0 children [ ClipPlane { plane 0 1 0 0 } "
              "DEF Cut Shape { geometry Box { } } ] } DEF Whole Shape { geometry Box { } }");
  struct Cuts : Renderer {
    int checked = 0;
    void draw(const DrawnShape& shape) override {
      float lowest = 0;
      for (const Vec3f& p : shape.mesh().points) lowest = std::min(lowest, p.y);
      const bool cut = shape.name() == "Cut";
      EXPECT_EQ(lowest, cut ? 0 : -1);
      EXPECT_EQ(shape.kept().size(), cut ? 1u : 0u);
      ASSERT_EQ(shape.state.kept.size(), cut ? 1u : 0u);
      if (cut) {
        EXPECT_EQ(shape.state.kept[0], (std::array<double, 4>{0, 1, 0, -1})) << "in the world";
        EXPECT_EQ(shape.kept()[0], (std::array<double, 4>{0, 1, 0, 0})) << "in the shape";
      }
      ++checked;
    }
  } cuts;
  render(*world, cuts);
  EXPECT_EQ(cuts.checked, 2);
}

TEST(Renderer, MeshesHaveWhatIsDrawn) {
  const auto world = worldOf(
      "Shape { geometry Sphere { radius 3 } } "
      "Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 0 0 1 0 0 1 1 0 ] } "
      "coordIndex [ 0 1 2 -1 ] } } "
      "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 0 0 1 1 0 ] } "
      "coordIndex [ 0 1 2 -1 ] color ColorRGBA { color [ 1 0 0 .5 0 1 0 .5 0 0 1 .25 ] } } } "
      "Shape { geometry PointSet { coord Coordinate { point [ 0 0 0 1 0 0 ] } } }");
  Shapes shapes;
  render(*world, shapes);
  ASSERT_EQ(shapes.all.size(), 4u);
  EXPECT_EQ(shapes.all[0].mesh.kind, GeometryArrays::Kind::triangles);
  EXPECT_EQ(shapes.all[0].mesh.radius, 3);
  EXPECT_EQ(shapes.all[1].mesh.kind, GeometryArrays::Kind::lines);
  EXPECT_EQ(shapes.all[1].mesh.indices.size(), 4u);
  EXPECT_EQ(shapes.all[2].mesh.alphas.size(), 3u);
  EXPECT_EQ(shapes.all[2].mesh.alphas.back(), .25f);
  EXPECT_EQ(shapes.all[2].mesh.texCoords.size(), 3u);
  EXPECT_EQ(shapes.all[3].mesh.indices.size(), 2u);
  Shapes exact;
  render(*world, exact, {.sphereSteps = 0});
  EXPECT_EQ(exact.all[0].mesh.kind, GeometryArrays::Kind::sphere);
}

TEST(Renderer, CountsHowOftenAGeometryIsUsed) {
  const auto world = worldOf("DEF Pair Group { children [ Shape { geometry DEF B Box { } } "
                             "Shape { geometry USE B } ] } USE Pair Shape { geometry Cone { } } "
                             "Switch { choice Shape { geometry USE B } }");
  Shapes shapes;
  render(*world, shapes);
  std::vector<uint64_t> uses;
  for (const auto& one : shapes.all) uses.push_back(one.uses);
  EXPECT_EQ(uses, (std::vector<uint64_t>{4, 4, 4, 4, 1}));
}

TEST(Renderer, SaysWhatEventsReach) {
  auto world = worldOf(
      "DEF Still Transform { children DEF A Shape { geometry Box { } } } "
      "DEF Moving Transform { children DEF B Shape { geometry Box { } } } "
      "DEF Choice Switch { whichChoice 0 choice DEF C Shape { geometry Box { } } } "
      "DEF D Shape { geometry IndexedFaceSet { coord DEF Points Coordinate { } } appearance "
      "Appearance { material DEF Paint Material { } } } "
      "DEF Clock TimeSensor { loop TRUE } DEF P PositionInterpolator { } DEF I IntegerSequencer { "
      "} "
      "DEF Q CoordinateInterpolator { } DEF R ColorInterpolator { } "
      "ROUTE Clock.fraction_changed TO P.set_fraction ROUTE P.value_changed TO Moving.translation "
      "ROUTE I.value_changed TO Choice.whichChoice ROUTE Q.value_changed TO Points.point "
      "ROUTE R.value_changed TO Paint.diffuseColor");
  Browser browser(std::move(world));
  struct Changes : Renderer {
    std::map<std::string, std::string> reasons;
    void draw(const DrawnShape& shape) override {
      std::string& text = reasons[std::string(shape.name())];
      const auto add = [&](const char* what, const Reach& reach) {
        if (reach) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", what, reach.reason());
      };
      add("matrix", shape.reachOfMatrix());
      add("presence", shape.reachOfPresence());
      add("geometry", shape.reachOfGeometry());
      add("appearance", shape.reachOfAppearance());
    }
  } changes;
  render(browser.world(), changes);
  EXPECT_EQ(changes.reasons["A"], "");
  EXPECT_EQ(changes.reasons["B"], "matrix: ROUTE from P.value_changed");
  EXPECT_EQ(changes.reasons["C"], "presence: ROUTE from I.value_changed");
  EXPECT_EQ(changes.reasons["D"],
            "geometry: ROUTE from Q.value_changed, appearance: ROUTE from R.value_changed");
}

// A chain of groups that is deeper than any stack, and ends in a Shape.
TEST(Renderer, DepthCostsNoStack) {
  World world;
  NodeRef inner(makeNode(nodes::Shape::nodeType()));
  nodeCast<nodes::Shape>(inner)->geometry = makeNode(nodes::Box::nodeType());
  constexpr size_t depth = 200'000;
  for (size_t i = 0; i < depth; ++i) {
    NodeRef group = makeNode(nodes::Group::nodeType());
    nodeCast<nodes::Group>(group)->children.push_back(std::move(inner));
    inner = std::move(group);
  }
  world.scope.roots.push_back(std::move(inner));
  struct Deep : Renderer {
    size_t left = 0, path = 0;
    void leave(Node&, const RenderState&) override { ++left; }
    void draw(const DrawnShape& shape) override { path = shape.state.path.size(); }
  } deep;
  render(world, deep);
  EXPECT_EQ(deep.path, depth + 1);
  EXPECT_GE(deep.left, depth + 1);
}

TEST(Renderer, ANodeThatContainsItselfIsNotEnteredAgain) {
  const auto world = worldOf("DEF A Group { children DEF B Group { } }");
  auto* a = nodeCast<nodes::Group>(world->scope.names.at("A"));
  auto* b = nodeCast<nodes::Group>(world->scope.names.at("B"));
  b->children.push_back(NodeRef(a));
  Log log;
  render(*world, log);
  EXPECT_EQ(log.text(), "+A +B -B -A");
  b->children.clear();
}

TEST(Renderer, VisitsHaveALimit) {
  std::string text = "DEF G0 Group { }\n"; // 2^11 visits to G0
  for (int i = 1; i < 12; ++i)
    text += fmt::format("DEF G{0} Group {{ children [ USE G{1} USE G{1} ] }}\n", i, i - 1);
  const auto world = worldOf(text);
  Renderer nothing;
  EXPECT_NO_THROW(render(*world, nothing));
  try {
    render(*world, nothing, {.maximumVisits = 1000});
    FAIL();
  } catch (const std::length_error& error) {
    EXPECT_NE(std::string(error.what()).find("1000 nodes"), std::string::npos) << error.what();
  }
}

TEST(Renderer, ExceptionsOfCallbacksPassThrough) {
  const auto world = worldOf("Group { children Shape { geometry Box { } } }");
  struct Stops : Renderer {
    void draw(const DrawnShape&) override { throw std::runtime_error("enough"); }
  } stops;
  EXPECT_THROW(render(*world, stops), std::runtime_error);
  EXPECT_EQ(namesOf(*world).size(), 1u) << "the world is as before";
}

TEST(Renderer, ACallbackMayTakeNodesOutOfTheWorld) {
  const auto world = worldOf("DEF A Group { children [ DEF S Shape { geometry Box { } } "
                             "DEF T Shape { geometry Box { } } ] }");
  struct Clears : Log {
    World* world;
    void draw(const DrawnShape& shape) override {
      Log::draw(shape);
      world->scope.names.clear();
      world->scope.roots.clear();
      shape.shape.geometry = {};
      EXPECT_EQ(shape.mesh().indices.size(), 36u) << "the Box that is drawn stays";
    }
  } clears;
  clears.world = world.get();
  render(*world, clears);
  EXPECT_EQ(clears.text(), "+A +S draw S -S +T draw T -T -A");
}

TEST(Renderer, PlacedShapesAreItsShapes) {
  const auto world = worldOf("Transform { translation 1 0 0 children [ ClipPlane { plane 1 0 0 0 } "
                             "DEF S Shape { geometry DEF B Box { } } ] }");
  const std::vector<PlacedShape> placed = placedShapes(*world);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_EQ(placed[0].shape.get(), world->scope.names.at("S").get());
  EXPECT_EQ(placed[0].geometry.get(), world->scope.names.at("B").get());
  EXPECT_EQ(placed[0].matrix[12], 1);
  EXPECT_EQ(placed[0].kept, (std::vector<std::array<double, 4>>{{1, 0, 0, 0}}));
}

} // namespace
