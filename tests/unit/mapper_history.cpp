// mapper_history.cpp: objects and picture must not depend on the world's history. A world that was
// mapped once and then changed many times is compared, after each of many random changes, with the
// same world mapped from scratch.
#include "unit/mapper_history.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

class MapRandomHistory : public MapHistory, public testing::WithParamInterface<int> {};

std::string world(const std::string& grid) {
  return "Viewpoint { position 0 2 14 }\nDEF Sky Background { skyColor 0.1 0.1 0.3 }\nDEF Mist Fog "
         "{ visibilityRange 80 }\n"
         "DEF Sun DirectionalLight { direction -1 -2 -1 intensity 0.6 }\n"
         "DEF T0 Transform { translation -3 0 0 children [\n"
         "  DEF Ball Shape { appearance DEF A0 Appearance { material DEF M0 Material { "
         "diffuseColor 1 0.2 0.1 } } geometry Sphere { } }\n"
         "  DEF T1 Transform { translation 0 2 0 children [ DEF Lamp PointLight { location 0 1 1 "
         "on FALSE } Shape { appearance     DEF A1 Appearance { material DEF M1 Material { "
         "diffuseColor 0.2 0.4 1 } } geometry DEF F IndexedFaceSet { coord DEF FC     Coordinate { "
         "point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } coordIndex [ 0 1 2 3 -1 ] solid FALSE } } ] } "
         "] }\n"
         "DEF G0 Group { children [ DEF T2 Transform { translation 3 0 0 children [ USE Ball DEF "
         "Small DirectionalLight { intensity   0.3 direction 1 0 -1 } ] } ] }\n"
         "DEF Tree Transform { translation 0 -2 -2 children Shape { appearance USE A0 geometry DEF "
         "Bush " +
         grid +
         " } }\n"
         "DEF Wood Group { children [ Transform { translation -4 0 0 children USE Tree } Transform "
         "{ translation 4 0 0 children USE Tree } ] }\n"
         "DEF S Switch { whichChoice 0 choice [ Shape { appearance USE A1 geometry Cone { } } DEF "
         "SG Group { children [ USE Tree   PointLight { location 0 3 3 } ] } DEF BB Billboard { "
         "children Shape { appearance USE A0 geometry USE F } } ] }\n"
         "DEF L LOD { range [ 10 ] level [ Shape { appearance USE A0 geometry Box { } } DEF Far "
         "Transform { translation 0 4 0 children   Shape { appearance USE A1 geometry Cylinder { } "
         "} } ] }\n"
         "DEF Lines Shape { appearance DEF AL Appearance { material DEF ML Material { "
         "emissiveColor 1 1 0 } } geometry IndexedLineSet   { coord DEF LC Coordinate { point [ -5 "
         "-3 0, 5 -3 0, 5 4 0 ] } coordIndex [ 0 1 2 -1 ] } }\n"
         "DEF Still Group { children [ Shape { appearance USE A1 geometry USE F } Shape { geometry "
         "DEF Cube Box { size 1 1 1 } } ] }\n"
         "DEF Merged ORTStatic { children DEF T3 Transform { translation 0 -3 2 children Shape { "
         "geometry Box { size 3 0.5 1 } } } }\n"
         "DEF Pic Switch { choice [ Shape { appearance DEF AP Appearance { texture DEF P "
         "PixelTexture { image 2 1 3 0xFF8040 0x2040FF }   } } ] }\n";
}

TEST_P(MapRandomHistory, ChangedAndMappedFromNothingAreTheSame) {
  load(world(grid(32)));
  random_.seed(unsigned(GetParam()));
  expectAsFromNothing("at first");
  const std::vector<std::string> transforms{"T0", "T1", "T2", "T3", "Tree", "Far"},
      groups{"G0", "Wood", "SG", "Still", "BB", "Merged", "T1"};
  const std::vector<std::string> children{"Ball", "Tree", "Lines", "L", "T2", "Far", "Small", "S"};
  for (int step = 0; step < 40; ++step) {
    std::string what =
        "seed " + std::to_string(GetParam()) + ", step " + std::to_string(step) + ": ";
    for (size_t n = 1 + below(2); n-- > 0;) {
      const auto change = [&](const std::string& name, const std::string& in, Value value) {
        what += name + "." + in + " ";
        send(name, in, std::move(value));
      };
      switch (below(16)) {
      case 0: change(transforms[below(6)], "set_translation", vector(4)); break;
      case 1: change(transforms[below(6)], "set_rotation", Rotation{0, 1, 0, number(0, 6)}); break;
      case 2: change("FC", "set_point", MFVec3f{vector(1), vector(1), vector(1), vector(1)}); break;
      case 3: change(below(2) ? "M0" : "M1", "set_diffuseColor", color()); break;
      case 4:
        if (below(2))
          change("ML", "set_emissiveColor", color());
        else
          change("ML", "set_transparency", number(0, 1));
        break;
      case 5: change("S", "set_whichChoice", int32_t(below(4)) - 1); break;
      case 6:
        change(groups[below(7)], "addChildren", MFNode{NodeRef(&node(children[below(8)]))});
        break;
      case 7:
        change(groups[below(7)], "removeChildren", MFNode{NodeRef(&node(children[below(8)]))});
        break;
      case 8: change("Lamp", "set_on", below(2) == 0); break;
      case 9: change("Small", "set_intensity", number(0, 1)); break;
      case 10: change("Sky", "set_skyColor", MFColor{color()}); break;
      case 11: change("Mist", "set_visibilityRange", number(0, 100)); break;
      case 12: change("A1", "set_texture", below(2) ? NodeRef(&node("P")) : NodeRef()); break;
      case 13: change("Ball", "set_appearance", NodeRef(&node(below(2) ? "A0" : "A1"))); break;
      case 14: change("Ball", "set_geometry", NodeRef(&node(below(2) ? "Cube" : "Bush"))); break;
      case 15: change("P", "set_image", Image{1, 1, 3, {uint8_t(below(255)), 9, 9}}); break;
      }
    }
    expectAsFromNothing(what);
    if (HasFailure()) return;
  }
}

// Visibility of X3D 4, of shapes and groups that may be used in several places (ISO/IEC
// 19775-1:2023 10.3.2, 12.2.3).
class MapRandomVisibility : public MapHistory, public testing::WithParamInterface<int> {
 protected:
  void loadX3d(const std::string& body) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory("#X3D V4.0 utf8\nPROFILE Full\n" + body, "test.x3dv");
    EXPECT_EQ(world_->diagnostics.list().size(), 0u);
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  }
};

TEST_P(MapRandomVisibility, ChangedAndMappedFromNothingAreTheSame) {
  loadX3d(
      "Viewpoint { position 0 1 14 }\n"
      "DEF S0 Shape { appearance DEF A Appearance { material DEF M Material { diffuseColor 1 .2 "
      ".1 } } geometry Sphere { } }\n"
      "DEF T0 Transform { translation -3 0 0 children [ USE S0 DEF S1 Shape { visible FALSE "
      "appearance USE A geometry DEF Bush " +
      grid(24) +
      " } DEF L PointLight { global TRUE location 0 2 2 } ] }\n"
      "DEF T1 Transform { translation 3 0 0 children [ USE S0 DEF G0 Group { visible FALSE "
      "children [ USE S1 DEF T2 Transform { translation 0 2 0 children [ DEF S2 Shape { geometry "
      "USE Bush } USE S1 ] } ] } ] }\n"
      "DEF W Switch { whichChoice 0 children [ USE G0 DEF B Billboard { children [ USE S2 ] } ] "
      "}\n"
      "DEF D LOD { range [ 10 ] children [ USE S1 DEF G1 StaticGroup { children Transform { "
      "translation 0 -3 0 children [ USE S2 Shape { appearance USE A geometry USE Bush } ] } } "
      "] }\n"
      "DEF C Collision { children Transform { translation 0 -2 1 children USE S0 } }\n"
      "DEF E Shape { appearance Appearance { material Material { emissiveColor 1 1 0 } } "
      "geometry Box { size .5 .5 .5 } }\n"
      "DEF G2 Group { children [ DEF Sun DirectionalLight { direction -1 -1 -1 } USE E DEF S3 "
      "Shape { appearance Appearance { texture PixelTexture { image 2 1 3 0xFF8040 0x2040FF } } "
      "geometry DEF F IndexedFaceSet { coord Coordinate { point [ -4 -3 0, -2 -3 0, -2 -1 0, -4 "
      "-1 0 ] } coordIndex [ 0 1 2 3 -1 ] } } DEF S4 Shape { geometry LineSet { vertexCount 3 "
      "coord Coordinate { point [ -5 -3 0, 5 -3 0, 5 4 0 ] } } } Transform { translation 4 0 0 "
      "children [ USE S3 USE S4 Shape { geometry USE F } ] } ] }\n"
      "DEF CL CADLayer { visible [ TRUE FALSE ] children [ DEF CA CADAssembly { children DEF CP "
      "CADPart { translation 0 3 0 children DEF CF CADFace { shape USE S1 } } } DEF AN Anchor { "
      "children [ USE S2 USE E ] } ] }\n"
      "DEF I ORTInstance { children [ USE S1 USE S3 ] }\n");
  random_.seed(unsigned(GetParam()));
  expectAsFromNothing("at first");
  const std::vector<std::string> names{"S0", "S1", "S2", "S3", "S4", "E", "T0", "T1", "T2", "G0",
                                       "G1", "G2", "W",  "B",  "D",  "C", "CA", "CP", "AN"};
  for (int step = 0; step < 40; ++step) {
    std::string what =
        "seed " + std::to_string(GetParam()) + ", step " + std::to_string(step) + ": ";
    for (size_t n = 1 + below(3); n-- > 0;) {
      const auto change = [&](const std::string& name, const std::string& in, Value value) {
        what += name + "." + in + " ";
        send(name, in, std::move(value));
      };
      switch (below(13)) {
      case 0: change("T1", "set_translation", vector(4)); break;
      case 1: change("W", "set_whichChoice", int32_t(below(3)) - 1); break;
      case 2: change("S1", "set_geometry", NodeRef(&node("Bush"))); break;
      case 3:
        change("T0", below(2) ? "addChildren" : "removeChildren", MFNode{NodeRef(&node("S2"))});
        break;
      case 4: change("Sun", "set_on", below(2) == 0); break;
      case 5: change("A", "set_material", below(2) ? NodeRef(&node("M")) : NodeRef()); break;
      case 6: change("CL", "set_visible", MFBool{below(2) == 0, below(2) == 0}); break;
      default: change(names[below(names.size())], "set_visible", below(2) == 0); break;
      }
    }
    expectAsFromNothing(what);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapRandomVisibility, testing::Range(0, 8));

INSTANTIATE_TEST_SUITE_P(Seeds, MapRandomHistory, testing::Range(0, 12));

} // namespace
