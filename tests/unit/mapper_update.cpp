// mapper_update.cpp: Tests the cost of each kind of change, counted in calls and never in time.
// Each test states what the change touches; everything else must stay.
#include <cmath>

#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapUpdate : public MapRunning {
 protected:
  // A world with a bit of everything, static, next to what a test moves.
  static std::string rest() {
    return "Shape { appearance Appearance { material DEF M Material { } } geometry " + grid(4) +
           " }\nDEF Tree Group { children Shape { geometry " + grid(30) + " } }\n" +
           repeat("Transform { translation 3 0 0 children USE Tree }\n", 3) +
           "Group { children [ DirectionalLight { } Shape { geometry Box { } } ] }\n"
           "Billboard { children Shape { geometry Cone { } } }\nPointLight { }\nViewpoint { }\n";
  }
  static std::string clock(const std::string& to) {
    return "DEF Clock TimeSensor { }\nDEF I PositionInterpolator { }\nROUTE I.value_changed TO " +
           to + "\n";
  }
  // Returns the cost of the second of two changes. The first may have promoted nodes that no event
  // was known to reach.
  Cost twice(const std::string& name, const std::string& in, Value first, Value second) {
    send(name, in, std::move(first));
    cost();
    send(name, in, std::move(second));
    return cost();
  }
};

TEST_F(MapUpdate, NothingChangedCostsNothing) {
  load(rest());
  EXPECT_EQ(cost(), nothing);
}

TEST_F(MapUpdate, ARoutedTransformMovesItsInstanceAlone) {
  load(rest() + "DEF T Transform { children Shape { geometry Sphere { } } }\n" +
       clock("T.set_translation"));
  send("T", "set_translation", Vec3f{1, 2, 3});
  EXPECT_EQ(cost(), (Cost{.moved = 1})) << "also the first time";
  send("T", "set_rotation", Rotation{0, 1, 0, 1});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
  EXPECT_NEAR(mapper_->bounds().maximum[1], 3, 1e-5);
}

TEST_F(MapUpdate, ATransformThatNothingWasKnownToReachIsPromotedOnce) {
  load(rest() + "Transform { translation 9 0 0 children DEF T Transform { children Shape { "
                "geometry Box { } } } }\n");
  const uint64_t before = frame().scene.triangles;
  send("T", "set_translation", Vec3f{1, 2, 3});
  const Cost first = cost();
  EXPECT_EQ(first.regroupings, 1u);
  EXPECT_EQ(first.defined, 2u) << "the world without it, and its own object";
  EXPECT_EQ(last_.scene.triangles, before);
  send("T", "set_translation", Vec3f{30, 2, 3});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
  EXPECT_NEAR(mapper_->bounds().maximum[0], 40, 1e-5);
}

TEST_F(MapUpdate, AUsedTransformMovesAtEachPlace) {
  load(rest() +
       "DEF T Transform { children Shape { geometry Box { } } }\nTransform { translation 5 0 0 "
       "children USE T }\n" +
       clock("T.set_translation"));
  send("T", "set_translation", Vec3f{0, 1, 0});
  EXPECT_EQ(cost(), (Cost{.moved = 2}));
}

TEST_F(MapUpdate, TransformsAboveLightsMoveInstanceAndLight) {
  load(rest() + "DEF T Transform { children [ PointLight { } Shape { geometry Box { } } ] }\n" +
       clock("T.set_translation"));
  send("T", "set_translation", Vec3f{0, 1, 0});
  EXPECT_EQ(cost(), (Cost{.moved = 1, .lights = 1}));
}

TEST_F(MapUpdate, ATransformWithAViewpointAloneIsNoObject) {
  load("DEF T Transform { children DEF V Viewpoint { } }\nShape { geometry Box { } }\n" +
       clock("T.set_translation"));
  EXPECT_EQ(mapper_->stats().objects, 1u);
  send("T", "set_translation", Vec3f{0, 5, 0});
  EXPECT_EQ(cost(), nothing);
  EXPECT_EQ(mapper_->viewpoints().at(0).matrix[13], 5);
  EXPECT_EQ(mapper_->viewpointCamera(0).matrix[13], 5);
}

TEST_F(MapUpdate, ATransformOutOfAllNumbersAndBack) {
  load(rest() + "DEF T Transform { children Shape { geometry Box { } } }\n" +
       clock("T.set_translation"));
  const uint64_t before = frame().scene.triangles;
  send("T", "set_scale", Vec3f{1e38f, 1e38f, 1e38f});
  cost();
  send("T", "set_scale", Vec3f{0, 0, 0});
  cost();
  send("T", "set_scale", Vec3f{1, 1, 1});
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
  EXPECT_EQ(last_.scene.triangles, before);
}

TEST_F(MapUpdate, ACoordinateRebuildsItsObjectAlone) {
  load(rest() + "Shape { geometry " + square("F") +
       " }\nDEF I CoordinateInterpolator { }\nROUTE I.value_changed TO FC.set_point\n");
  const uint64_t before = frame().scene.triangles;
  send("FC", "set_point", MFVec3f{{-1, -1, 0}, {1, -1, 0}, {1, 5, 0}, {-1, 1, 0}});
  EXPECT_EQ(cost(), (Cost{.defined = 1}));
  EXPECT_EQ(last_.scene.triangles, before);
  send("FC", "set_point", MFVec3f{{-1, -1, 0}, {1, -1, 0}, {1, 5, 0}});
  EXPECT_EQ(cost(), (Cost{.defined = 1}));
  EXPECT_EQ(last_.scene.triangles, before - 2) << "a face without its fourth point";
  EXPECT_EQ(mapper_->stats().triangles, last_.scene.triangles);
  EXPECT_NE(explained("ROUTE from I.value_changed"), nullptr);
}

TEST_F(MapUpdate, GeometryThatSeveralShapesUseIsRebuiltOnce) {
  load(rest() + "Shape { geometry " + square("F") +
       " }\nTransform { translation 4 0 0 children Shape { geometry USE F } }\n");
  EXPECT_EQ(twice("FC", "set_point", MFVec3f{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                  MFVec3f{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}),
            (Cost{.defined = 1}));
}

TEST_F(MapUpdate, AnIndexAndAColourAreGeometry) {
  load(rest() + "Shape { geometry " +
       square("F", "color DEF K Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] }") + " }\n");
  EXPECT_EQ(twice("K", "set_color", MFColor{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}},
                  MFColor{{1, 1, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}),
            (Cost{.defined = 1}));
  send("F", "set_coordIndex", MFInt32{0, 1, 2, -1});
  EXPECT_EQ(cost(), (Cost{.defined = 1}));
}

TEST_F(MapUpdate, AnExtrusionsSpineIsGeometry) {
  load(rest() + "Shape { geometry DEF E Extrusion { } }\n");
  EXPECT_EQ(twice("E", "set_spine", MFVec3f{{0, 0, 0}, {0, 2, 0}},
                  MFVec3f{{0, 0, 0}, {0, 2, 0}, {1, 3, 0}}),
            (Cost{.defined = 1}));
}

TEST_F(MapUpdate, AFontIsGeometryOfItsText) {
  load(rest() +
       "Shape { geometry DEF X Text { string \"a\" fontStyle DEF Style FontStyle { } } }\n");
  send("X", "set_string", MFString{"b"});
  cost();
  send("X", "set_string", MFString{"bc"});
  EXPECT_EQ(cost(), (Cost{.defined = 1}));
}

TEST_F(MapUpdate, AMaterialChangesParametersAlone) {
  load(rest());
  send("M", "set_diffuseColor", Color{1, 0, 0});
  const Cost first = cost();
  EXPECT_GT(first.parameters, 0u);
  EXPECT_EQ(first, (Cost{.parameters = first.parameters}));
}

TEST_F(MapUpdate, AMaterialThatComesAndGoes) {
  load(rest() + "Shape { appearance DEF A Appearance { } geometry Box { } }\n");
  send("A", "set_material", NodeRef(&node("M")));
  const Cost c = cost();
  EXPECT_GT(c.parameters, 0u);
  EXPECT_EQ(c.defined, 0u);
  send("A", "set_material", NodeRef());
  EXPECT_EQ(cost().defined, 0u);
}

// Equal appearances of a large world share a shader. The first change of one of them gives it a
// shader of its own; the others keep their look.
TEST_F(MapUpdate, AMaterialThatIsSharedBecomesSeparate) {
  const auto at = [](int x, const std::string& material) {
    return "Transform { translation " + std::to_string(x) +
           " 0 -10 children Shape { appearance Appearance { material " + material +
           " } geometry Box { size 40 40 1 } } }\n";
  };
  load("NavigationInfo { headlight FALSE }\n" + repeat(at(1000, "Material { }"), 400) +
       at(-25, "DEF A Material { emissiveColor 1 1 1 }") +
       at(25, "DEF B Material { emissiveColor 1 1 1 }"));
  const auto greens = [&] { // green of the two boxes
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(3, 1, RT_RGBA);
    rtRender();
    float p[12] = {};
    rtReadPixels(RT_RGBA, p, 12);
    return std::pair(p[1], p[9]);
  };
  EXPECT_EQ(greens(), std::pair(1.f, 1.f));
  send("A", "set_emissiveColor", Color{1, 0, 0});
  EXPECT_EQ(greens(), std::pair(0.f, 1.f));
  send("A", "set_emissiveColor", Color{1, .5f, 0});
  const Cost second = cost();
  EXPECT_EQ(second, (Cost{.parameters = second.parameters})) << "it has a shader of its own now";
  EXPECT_GT(second.parameters, 0u);
  const auto orange = greens();
  EXPECT_GT(orange.first, 0);
  EXPECT_LT(orange.first, 1);
  EXPECT_EQ(orange.second, 1);
  send("B", "set_emissiveColor", Color{0, 0, 1});
  EXPECT_EQ(greens(), std::pair(orange.first, 0.f));
}

// Equal boxes share the arrays of one mesh. One that changes becomes separate.
TEST_F(MapUpdate, ABoxThatEqualsOthersBecomesSeparate) {
  load("Transform { translation -2 0 0 children Shape { geometry DEF A Box { } } }\n"
       "Transform { translation 2 0 0 children Shape { geometry Box { } } }\n");
  EXPECT_EQ(mapper_->bounds().minimum[0], -3);
  EXPECT_EQ(mapper_->bounds().maximum[0], 3);
  for (const float width : {4.f, 2.f, 6.f}) {
    Node& box = node("A");
    EXPECT_TRUE(engine_->store(box, *box.type().find("size"), Vec3f{width, 2, 2}));
    EXPECT_EQ(frame().scene.triangles, 24u);
    EXPECT_EQ(mapper_->bounds().minimum[0], -2 - double(width) / 2);
    EXPECT_EQ(mapper_->bounds().maximum[0], 3) << "the other box";
  }
}

TEST_F(MapUpdate, OptionsOfAShaderAreParametersAlone) {
  load(rest() +
       "Shape { appearance ORTAppearance { material DEF O Material { } shader DEF S ORTShader { "
       "file \"plastic\" options [ \"1f index 1.5\" \"1f roughness .1\" ] } } geometry " +
       grid(20) + " }\n");
  send("S", "set_options", MFString{"1f index 1.6", "1f roughness .2"});
  const Cost first = cost();
  EXPECT_GT(first.parameters, 0u);
  EXPECT_EQ(first, (Cost{.parameters = first.parameters}));
  send("O", "set_diffuseColor", Color{1, 0, 0});
  const Cost second = cost();
  EXPECT_EQ(second, (Cost{.parameters = second.parameters}));
}

TEST_F(MapUpdate, AShaderOfAnotherClassRebuildsNothing) {
  load(rest() +
       "Shape { appearance ORTAppearance { shader DEF S ORTShader { file \"plastic\" options \"1f "
       "index 1.5\" } } geometry " +
       grid(20) + " }\n");
  send("S", "set_file", std::string("marble"));
  send("S", "set_options", MFString{"1f veins 3"});
  const Cost first = cost();
  EXPECT_EQ(first.defined, 0u);
  EXPECT_EQ(first.regroupings, 0u);
  EXPECT_GT(first.parameters, 0u);
}

TEST_F(MapUpdate, PixelsAreLoadedAgainAndNothingElse) {
  load(rest() +
       "Shape { appearance Appearance { texture DEF P PixelTexture { image 1 1 3 0xFF0000 } } "
       "geometry " +
       square("F") + " }\n");
  send("P", "set_image", Image{2, 1, 3, {255, 0, 0, 0, 255, 0}});
  EXPECT_EQ(cost(), (Cost{.textures = 1}));
}

TEST_F(MapUpdate, AFirstTextureNeedsCoordinatesTheSecondDoesNot) {
  load(rest() + "Shape { appearance DEF A Appearance { } geometry " + square("F") +
       " }\nSwitch { choice Shape { appearance Appearance { texture DEF P PixelTexture { image 1 1 "
       "3 0xFF0000 } } } }\n"
       "Switch { choice Shape { appearance Appearance { texture DEF Q PixelTexture { image 1 1 3 "
       "0x00FF00 } } } }\n");
  send("A", "set_texture", NodeRef(&node("P")));
  EXPECT_GE(cost().defined, 1u);
  send("A", "set_texture", NodeRef(&node("Q")));
  const Cost second = cost();
  EXPECT_EQ(second.defined, 0u);
  EXPECT_EQ(second.textures, 1u);
  send("A", "set_texture", NodeRef());
  EXPECT_EQ(cost().defined, 0u);
}

TEST_F(MapUpdate, AShapeThatGetsAnotherAppearance) {
  load(
      rest() + "DEF S Shape { appearance Appearance { material Material { } } geometry " +
      square("F") + " }\n" +
      "Shape { appearance DEF A Appearance { material Material { diffuseColor 1 0 0 } } geometry " +
      square("G") + " }\n" +
      "Shape { appearance DEF B Appearance { material Material { diffuseColor 1 1 0 } } geometry " +
      square("H") + " }\n");
  EXPECT_EQ(twice("S", "set_appearance", NodeRef(&node("A")), NodeRef(&node("B"))), nothing)
      << "its instance has another shader";
  EXPECT_NE(explained("it has been changed"), nullptr);
}

TEST_F(MapUpdate, LinesAreRewrittenWhenTheirColourChanges) {
  load(rest() +
       "Shape { appearance Appearance { material DEF L Material { emissiveColor 1 0 0 } } geometry "
       "IndexedLineSet { coord Coordinate { point [ 0 0 0, 1 1 1 ] } coordIndex [ 0 1 ] } }\n");
  EXPECT_EQ(twice("L", "set_emissiveColor", Color{0, 1, 0}, Color{0, 0, 1}).defined, 1u)
      << "their own object";
  send("L", "set_diffuseColor", Color{0, 1, 0});
  EXPECT_EQ(cost().defined, 0u);
}

TEST_F(MapUpdate, ASwitchRegroupsItselfAlone) {
  load(rest() + "DEF S Switch { whichChoice 0 choice [ Shape { geometry Box { } } Group { children "
                "[ Shape { geometry Box { } } PointLight { } ] } ] }\nDEF I Script { eventOut "
                "SFInt32 value }\nROUTE I.value TO S.whichChoice\n");
  const uint64_t with = frame().scene.triangles;
  send("S", "set_whichChoice", 1);
  EXPECT_EQ(cost(), (Cost{.defined = 1, .regroupings = 1, .lights = 3}))
      << "its object, its light, the headlight, which is made again behind it";
  EXPECT_EQ(last_.scene.triangles, with);
  send("S", "set_whichChoice", -1);
  EXPECT_EQ(cost(), (Cost{.defined = 1, .regroupings = 1, .lights = 1}));
  EXPECT_EQ(last_.scene.triangles, with - 12);
  send("S", "set_whichChoice", 0);
  EXPECT_EQ(cost(), (Cost{.defined = 1, .regroupings = 1}));
}

TEST_F(MapUpdate, ChildrenComeAndGo) {
  load(rest() + "Transform { translation 1 0 0 children DEF G Group { } }\n");
  const uint64_t without = frame().scene.triangles;
  const NodeRef box = make("Shape { geometry Box { } }"),
                more = make("Transform { children Shape { geometry Box { } } }");
  send("G", "addChildren", MFNode{box});
  EXPECT_EQ(cost().defined, 2u) << "the world, which it was part of, and its own object";
  EXPECT_EQ(last_.scene.triangles, without + 12);
  send("G", "addChildren", MFNode{more});
  EXPECT_EQ(cost(), (Cost{.defined = 1, .regroupings = 1}));
  send("G", "removeChildren", MFNode{box, more});
  EXPECT_EQ(cost(), (Cost{.defined = 1, .regroupings = 1}));
  EXPECT_EQ(last_.scene.triangles, without);
}

TEST_F(MapUpdate, AnInsertedTransformMovesLikeAnyOther) {
  load(rest() + "DEF G Group { }\n");
  const NodeRef moving = make("Transform { children Shape { geometry Box { } } }");
  send("G", "addChildren", MFNode{moving});
  cost();
  EXPECT_TRUE(engine_->dispatch(*moving, "set_translation", Vec3f{1, 0, 0}));
  cost();
  EXPECT_TRUE(engine_->dispatch(*moving, "set_translation", Vec3f{2, 0, 0}));
  EXPECT_EQ(cost(), (Cost{.moved = 1}));
}

TEST_F(MapUpdate, AShapeWithAnotherGeometry) {
  load(rest() + "DEF S Shape { }\nSwitch { choice [ Shape { geometry DEF Ball Sphere { } } Shape { "
                "geometry DEF Cube Box { } } ] }\n");
  const uint64_t without = frame().scene.triangles;
  send("S", "set_geometry", NodeRef(&node("Cube")));
  cost();
  EXPECT_EQ(last_.scene.triangles, without + 12);
  send("S", "set_geometry", NodeRef());
  EXPECT_EQ(cost().defined, 1u);
  EXPECT_EQ(last_.scene.triangles, without);
}

TEST_F(MapUpdate, AGeometryAfterTheOther) {
  load(rest() +
       "DEF S Shape { appearance Appearance { material Material { } } geometry Box { } }\n");
  const uint64_t without = frame().scene.triangles - 12;
  Node& shape = node("S");
  EXPECT_TRUE(engine_->dispatch(shape, "set_appearance",
                                NodeRef())); // from here on it is an instance of its geometry
  EXPECT_EQ(frame().scene.triangles, without + 12);
  for (int n = 2; n < 9; ++n) {
    const NodeRef scrap = make("Shape { geometry " + grid(n) + " }");
    send("S", "set_geometry", static_cast<nodes::Shape&>(*scrap).geometry);
    scraps_.clear(); // releases the previous mesh
    EXPECT_EQ(frame().scene.triangles, without + 2 * uint64_t(n * n));
  }
}

TEST_F(MapUpdate, ALightChangesItsParameters) {
  load(rest() + "DEF L PointLight { }\n");
  send("L", "set_intensity", 0.5f);
  const Cost c = cost();
  EXPECT_EQ(c, (Cost{.parameters = c.parameters}));
  EXPECT_GT(c.parameters, 0u);
  send("L", "set_on", false);
  EXPECT_EQ(cost().lights, 1u);
  EXPECT_EQ(last_.scene.lights, 3u);
  send("L", "set_on", true);
  EXPECT_EQ(cost(), (Cost{.parameters = c.parameters, .lights = 3}))
      << "it, and the headlight again behind it";
  EXPECT_EQ(last_.scene.lights, 4u);
}

TEST_F(MapUpdate, ALightThatIsTurnedOnForTheFirstTime) {
  load(rest() +
       "Group { children [ DEF L DirectionalLight { on FALSE } Shape { geometry Box { } } ] }\n");
  send("L", "set_on", true);
  cost();
  EXPECT_EQ(last_.scene.lights, 4u);
  EXPECT_NE(explained("scope of a light or a LocalFog"), nullptr);
}

TEST_F(MapUpdate, TheSkyAndTheFogAreParameters) {
  load("DEF B Background { skyColor 1 0 0 }\nDEF F Fog { visibilityRange 10 }\nDEF C Background { "
       "skyColor 0 1 0 }\n" +
       rest());
  send("B", "set_skyColor", MFColor{{0, 0, 1}});
  const Cost sky = cost();
  EXPECT_GT(sky.parameters, 0u);
  EXPECT_EQ(sky, (Cost{.parameters = sky.parameters}));
  send("F", "set_visibilityRange", 0.0f);
  EXPECT_GT(cost().parameters, 0u);
  send("C", "set_skyColor", MFColor{{0, 0, 1}});
  EXPECT_EQ(cost(), nothing) << "it is not bound";
}

TEST_F(MapUpdate, TimeCostsNothing) {
  load(rest() + "DEF Clock TimeSensor { }\n");
  send("Clock", "set_startTime", 5.0);
  EXPECT_EQ(cost(), nothing);
}

TEST_F(MapUpdate, LevelsOfAnLodAreReplaced) {
  load(rest() + "DEF L LOD { range 100 level [ Shape { geometry Box { } } Group { } ] }\n");
  const uint64_t before = frame().scene.triangles;
  const NodeRef grown = make("Shape { geometry " + grid(3) + " }");
  send("L", "set_level", MFNode{grown});
  cost();
  EXPECT_EQ(last_.scene.triangles, before - 12 + 18);
}

TEST_F(MapUpdate, WhatIsInNoPictureCostsNothing) {
  load(rest() + "Switch { whichChoice -1 choice DEF T Transform { children Shape { geometry DEF X "
                "Text { string \"a\" } } } }\n");
  send("T", "set_translation", Vec3f{1, 2, 3});
  send("X", "set_string", MFString{"b"});
  EXPECT_EQ(cost(), nothing);
}

TEST_F(MapUpdate, PrototypesPassChangesOn) {
  load(rest() + "PROTO P [ exposedField SFVec3f at 0 0 0 exposedField SFColor c 1 0 0 exposedField "
                "MFVec3f points [ 0 0 0, 1 0 0, 1 1 0 ] ] {\nTransform { translation IS at "
                "children Shape { appearance Appearance { material Material { diffuseColor IS c } "
                "} geometry IndexedFaceSet { coord Coordinate { point IS points } coordIndex [ 0 1 "
                "2 ] } } } }\nDEF X P { }\nDEF Y P { }\n");
  EXPECT_EQ(twice("X", "set_at", Vec3f{1, 0, 0}, Vec3f{2, 0, 0}), (Cost{.moved = 1}));
  send("X", "set_c", Color{0, 1, 0});
  EXPECT_EQ(cost().defined, 0u);
  EXPECT_EQ(twice("X", "set_points", MFVec3f{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}},
                  MFVec3f{{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}),
            (Cost{.defined = 1}));
}

TEST_F(MapUpdate, ABoundViewpointIsTheOneFromOutside) {
  load("Viewpoint { } DEF V Viewpoint { position 1 2 3 } NavigationInfo { headlight FALSE }");
  EXPECT_EQ(mapper_->boundViewpoint(), 0);
  BoundNodes bound;
  bound.viewpoint = &node("V");
  mapper_->bind(bound);
  EXPECT_EQ(mapper_->boundViewpoint(), 1);
  EXPECT_EQ(frame().scene.lights, 1u) << "no NavigationInfo is bound: the default has a headlight";
  mapper_->bind({});
  EXPECT_EQ(mapper_->boundViewpoint(), -1);
}

TEST_F(MapUpdate, ARootThatComesLaterIsSeen) {
  load(rest());
  const uint64_t before = frame().scene.triangles;
  const NodeRef box = make("Shape { geometry Box { } }");
  engine_->adopt(*box);
  world_->scope.roots.push_back(box);
  cost();
  EXPECT_EQ(last_.scene.triangles, before + 12);
  world_->scope.roots.pop_back();
  cost();
  EXPECT_EQ(last_.scene.triangles, before);
}

TEST_F(MapUpdate, ASecondMapperInTheSameContextFindsAnEmptyScene) {
  load(rest());
  const RTstats first = frame();
  mapper_ = nullptr;
  mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  const RTstats second = frame();
  EXPECT_EQ(first.scene.triangles, second.scene.triangles);
  EXPECT_EQ(first.scene.lights, second.scene.lights);
  EXPECT_EQ(first.scene.objects, second.scene.objects);
}

} // namespace
