// mapper_grouping.cpp: Tests which shapes become objects of their own and why: reachable by events,
// used often, identical, or requested by the author.
#include "mapper/graph/cost.h"
#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapGrouping : public MapRunning {
 protected:
  std::string reasons() {
    std::string all;
    for (const std::string& line : structure(*mapper_)) all += line + "\n";
    return all;
  }
  uint64_t objects() { return mapper_->stats().objects; }
};

const std::string box = "Shape { geometry Box { } }";

TEST_F(MapGrouping, InstancesMustReplaceMuchMoreThanThemselves) {
  using namespace mapper;
  EXPECT_FALSE(worthInstances(1'000'000, 1));
  EXPECT_TRUE(worthInstances(10'000, 2));
  EXPECT_TRUE(worthInstances(32, 100));
  EXPECT_FALSE(worthInstances(12, 10'000)) << "boxes are cheaper as triangles";
  EXPECT_TRUE(worthInstances(12, 1'000'000)) << "unless they fill the memory";
  EXPECT_FALSE(worthInstances(2, ~uint64_t(0))) << "an instance costs more";
  EXPECT_FALSE(worthInstances(10'000, 2, true)) << "asked to merge";
  EXPECT_TRUE(worthInstances(10'000, 10'000, true)) << "but not at any price";
  EXPECT_GT(savedByInstances(~uint64_t(0), ~uint64_t(0)), uint64_t(1) << 60) << "saturates";
}

TEST_F(MapGrouping, StaticGeometryIsOneObjectAlsoWhenTheWorldRuns) {
  load(repeat("Transform { translation 1 0 0 children " + box + " }\n", 20) +
       "DEF Clock TimeSensor { }");
  EXPECT_EQ(reasons(),
            "world | merged static geometry of 20 shapes, each with its own material | 240 20 1\n");
}

TEST_F(MapGrouping, WhatARouteReachesStandsAlone) {
  load("DEF T Transform { children [ " + box + box + " ] }\n" + repeat(box, 5) +
       "DEF I PositionInterpolator { }\nROUTE I.value_changed TO T.set_translation\n");
  EXPECT_EQ(reasons(), "T | split: ROUTE from I.value_changed | 24 2 1\nworld | merged static "
                       "geometry of 5 shapes, each with its own material | 60 5 1\n");
}

TEST_F(MapGrouping, RoutesThatMoveNothingDoNotSplit) {
  load("Shape { appearance Appearance { material DEF M Material { } } geometry Box { } }\n" + box +
       "DEF I ColorInterpolator { }\nROUTE I.value_changed TO M.set_diffuseColor\n");
  EXPECT_EQ(objects(), 1u) << "a parameter";
}

TEST_F(MapGrouping, NestedTransformsNest) {
  load("DEF A Transform { children [ " + box + " DEF B Transform { children [ " + box +
       " ] } ] }\n" +
       "DEF I PositionInterpolator { }\nROUTE I.value_changed TO A.set_translation\nROUTE "
       "I.value_changed TO B.set_translation\n");
  EXPECT_EQ(objects(), 3u);
  send("B", "set_translation", Vec3f{1, 0, 0});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
}

TEST_F(MapGrouping, EqualGeometryIsStoredOnce) {
  load(repeat("Transform { translation 1 0 0 children Shape { geometry " + grid(40) + " } }\n", 4));
  EXPECT_EQ(last_.scene.uniqueTriangles, 0u);
  EXPECT_EQ(frame().scene.uniqueTriangles, 3200u);
  EXPECT_EQ(frame().scene.triangles, 12800u);
  const ExplainedObject* o = explained("4 geometries equal by content");
  ASSERT_NE(o, nullptr);
  EXPECT_EQ(o->instances, 4u);
  EXPECT_EQ(o->reason.rfind("USEd 4 times, saves", 0), 0u) << o->reason;
}

TEST_F(MapGrouping, AlmostEqualGeometryIsNot) {
  const std::string a = grid(40), b = "ElevationGrid { solid FALSE" + grid(40).substr(15);
  load("Shape { geometry " + a + " }\nShape { geometry " + b + " }\n");
  EXPECT_EQ(frame().scene.uniqueTriangles, 6400u) << "one is seen from both sides";
}

TEST_F(MapGrouping, EqualGeometryThatChangesIsNotEqualAnyMore) {
  const std::string f = "coordIndex [ " + [] {
    std::string s;
    for (int i = 0; i < 2000; ++i) s += "0 1 2 -1 ";
    return s;
  }() + "]";
  const auto faces = [&](const std::string& name) {
    return "Shape { geometry IndexedFaceSet { coord DEF " + name +
           " Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } " + f + " } }\n";
  };
  load(faces("A") + faces("B") + faces("C"));
  EXPECT_EQ(frame().scene.uniqueTriangles, 2000u);
  send("B", "set_point", MFVec3f{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  EXPECT_EQ(frame().scene.uniqueTriangles, 4000u);
  send("A", "set_point", MFVec3f{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}});
  EXPECT_EQ(frame().scene.uniqueTriangles, 6000u);
  EXPECT_EQ(frame().scene.triangles, 6000u);
}

TEST_F(MapGrouping, OrtStaticMergesWhatEventsReach) {
  const std::string routes =
      "DEF I PositionInterpolator { }\nROUTE I.value_changed TO T.set_translation\n"
      "ROUTE I.value_changed TO U.set_translation\n";
  const std::string inside =
      "DEF T Transform { children " + box + " } DEF U Transform { children " + box + " }";
  load("Group { children [ " + inside + " ] }\n" + box + routes);
  EXPECT_EQ(objects(), 3u);
  load("ORTStatic { children [ " + inside + " ] }\n" + box + routes);
  EXPECT_EQ(objects(), 2u);
  EXPECT_NE(explained("merged: ORTStatic"), nullptr);
  send("T", "set_translation", Vec3f{5, 0, 0});
  EXPECT_EQ(cost(), (Cost{.defined = 1})) << "by redefinition";
  EXPECT_NEAR(mapper_->bounds().maximum[0], 6, 1e-6);
}

TEST_F(MapGrouping, OrtInstanceIsAnObjectHoweverSmall) {
  load("DEF B ORTInstance { children " + box + " }\n" +
       repeat("Transform { translation 2 0 0 children USE B }\n", 3));
  EXPECT_EQ(
      reasons(),
      "B | split: ORTInstance | 12 1 4\nworld | merged static geometry of 0 shapes | 0 0 1\n");
  EXPECT_EQ(frame().scene.uniqueTriangles, 12u);
}

TEST_F(MapGrouping, TheInnerHintHolds) {
  load("ORTStatic { children [ " + box +
       " DEF B ORTInstance { children DEF T Transform { children " + box + " } } USE B ] }\n" +
       "DEF I PositionInterpolator { }\nROUTE I.value_changed TO T.set_translation\n");
  EXPECT_EQ(objects(), 4u) << "the world, ORTStatic, ORTInstance, T";
  send("T", "set_translation", Vec3f{5, 0, 0});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
}

TEST_F(MapGrouping, HintsAreOrdinaryGroups) {
  load("DEF S ORTStatic { children DEF B ORTInstance { } }\n" + box);
  send("B", "addChildren", MFNode{make(box)});
  EXPECT_EQ(frame().scene.triangles, 24u);
  send("S", "set_children", MFNode{});
  EXPECT_EQ(frame().scene.triangles, 12u);
}

// A tree with 10,000 USEs: only the instances cost memory. The null backend builds no acceleration
// structure.
TEST(MapForest, IsOneObjectWithInstances) {
  RTcontext context = rtNewContext("backend=null");
  std::string body = "DEF Tree Group { children Shape { geometry ElevationGrid { xDimension 72 "
                     "zDimension 72 height [ ";
  for (int i = 0; i < 72 * 72; ++i) body += std::to_string(i % 7) + " ";
  body += "] } } }\n";
  for (int i = 1; i < 10'000; ++i)
    body += "Transform { translation " + std::to_string(i % 100 * 80) + " 0 " +
            std::to_string(i / 100 * 80) + " children USE Tree }\n";
  {
    const std::unique_ptr<World> world =
        loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "forest.wrl");
    OpenRTMapper mapper(*world, MapOptions());
    mapper.map(mapper.viewpointCamera(0));
    const MapStats s = mapper.stats();
    EXPECT_EQ(s.objects, 2u);
    EXPECT_EQ(s.instances, 10'001u);
    EXPECT_EQ(s.triangles, 10'000u * 10'082);
    const std::vector<ExplainedObject> list = mapper.explain();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "Tree");
    EXPECT_EQ(list[0].instances, 10'000u);
    EXPECT_LT(list[0].bytes + list[1].bytes, uint64_t(20) << 20);
  }
  rtDeleteContext(context);
}

} // namespace
