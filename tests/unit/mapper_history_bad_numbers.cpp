// mapper_history_bad_numbers.cpp: numbers that nothing can be drawn with (not a number, infinite, a
// scale of 0, beyond the float range) come and go. The picture must be that of the world as it is,
// whatever was drawn before: each state is compared with the same world mapped from scratch.
#include <limits>

#include "unit/mapper_history.h"
#include "write/value_writer.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

constexpr const char* world = R"(
DEF View Viewpoint { position 0 2 14 }
DEF Turned Transform { children
  DEF Sky Background { skyColor [ 0.1 0.1 0.3, 0.8 0.2 0.1 ] skyAngle 1.6 } }
DEF Wet Transform { children DEF Mist Fog { visibilityRange 80 color 0.5 0.6 0.7 } }
DEF T0 Transform { translation -3 0 0 children [
  DEF Ball Shape {
    appearance DEF A0 Appearance {
      material DEF M0 Material { diffuseColor 1 0.2 0.1 transparency 0.3 } }
    geometry Sphere { } }
  DEF T1 Transform { translation 0 2 0 children [
    DEF Lamp PointLight { location 0 1 1 }
    Shape {
      appearance DEF A1 Appearance {
        material DEF M1 Material { }
        textureTransform DEF TT TextureTransform { }
        texture DEF P PixelTexture { image 2 2 3 0xFF8040 0x20A0F0 0x808000 0xC0C0C0 } }
      geometry DEF F IndexedFaceSet {
        color DEF FK Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 0 ] }
        normal DEF FN Normal { vector [ 0 0 1, 0 0 1, 0 0 1, 0 0 1 ] }
        coord DEF FC Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
        coordIndex [ 0 1 2 3 -1 ] solid FALSE } } ] } ] }
DEF T2 Transform { translation 3 0 0 children [
  USE Ball DEF Sun DirectionalLight { direction 1 -1 -1 } ] }
DEF T3 Transform { translation 0 -2 0 children
  DEF BB Billboard { children Shape { appearance USE A1 geometry USE F } } }
DEF T4 Transform { translation 0 3 0 children LOD { range [ 16 ] level [
  Shape { appearance USE A0 geometry Box { } }
  DEF Far Transform { translation 0 1 0 children Shape { appearance USE A1 geometry Cylinder { } } } ] } }
DEF T5 Transform { children [
  Shape {
    appearance Appearance { material DEF ML Material { emissiveColor 1 1 0 } }
    geometry IndexedLineSet {
      coord DEF LC Coordinate { point [ -5 -3 0, 5 -3 0, 5 4 0 ] } coordIndex [ 0 1 2 -1 ] } }
  DEF T6 Transform { translation 2 -2 1 children [
    Shape { geometry Cone { } }
    Shape { geometry PointSet { coord Coordinate { point [ 0 2 0 ] } } } ] } ] }
DEF Spot SpotLight { location 0 5 5 direction 0 -1 -1 }
ORTStatic { children
  DEF T7 Transform { translation 0 -3 2 children Shape { geometry Box { size 3 0.5 1 } } } }
DEF T8 Transform { translation -4 -2 0 children Shape {
  appearance ORTAppearance { shader DEF Paint ORTShader {
    name "Plastic" file "plastic" options [ "1f roughness 0.3" "color color 1 0 0" ] } }
  geometry Sphere { radius 0.7 } } }
)";

class MapBadNumbers : public MapHistory, public testing::WithParamInterface<int> {
 protected:
  // Returns a number of a usual size most of the time.
  float anyNumber() {
    static constexpr float odd[] = {nan,   infinite, -infinite, 0,     -1,    1e-20f,
                                    1e15f, 1e20f,    3e37f,     3e38f, -3e38f};
    return below(2) ? odd[below(std::size(odd))] : number(-3, 3);
  }
  Vec3f anyVector() { return below(3) ? vector(3) : Vec3f{anyNumber(), anyNumber(), anyNumber()}; }
  Color anyColor() { return below(2) ? color() : Color{anyNumber(), anyNumber(), anyNumber()}; }

  Value orNone(const std::string& name) { return below(2) ? NodeRef(&node(name)) : NodeRef(); }

  static std::string textOf(const Value& value) {
    std::string text;
    std::visit([&](const auto& v) { writeValue(text, FieldType(value.index()), &v, 0); }, value);
    return text;
  }

  // Sends one random event and adds it to `what`.
  void change(std::string& what) {
    const auto set = [&](const std::string& name, const std::string& in, Value value) {
      what += name + "." + in + " " + textOf(value) + "; ";
      send(name, in, std::move(value));
    };
    static const std::vector<std::string> transforms{"T0", "T1", "T2",  "T3",     "T4",  "T5",
                                                     "T6", "T7", "Far", "Turned", "Wet", "T8"};
    const std::string& transform = transforms[below(transforms.size())];
    switch (below(31)) {
    case 0:
    case 1: set(transform, "set_translation", anyVector()); break;
    case 2: set(transform, "set_scale", anyVector()); break;
    case 3:
      set(transform, "set_rotation", Rotation{anyNumber(), anyNumber(), anyNumber(), anyNumber()});
      break;
    case 4: set(transform, "set_center", anyVector()); break;
    case 5: set("M0", "set_diffuseColor", anyColor()); break;
    case 6: set("M1", "set_transparency", anyNumber()); break;
    case 7: set("M0", "set_shininess", anyNumber()); break;
    case 8: set("ML", "set_emissiveColor", anyColor()); break;
    case 9: set("TT", "set_scale", Vec2f{anyNumber(), anyNumber()}); break;
    case 10: set("TT", "set_rotation", anyNumber()); break;
    case 11: set("Lamp", "set_location", anyVector()); break;
    case 12: set(below(2) ? "Lamp" : "Spot", "set_attenuation", anyVector()); break;
    case 13: set(below(2) ? "Sun" : "Spot", "set_direction", anyVector()); break;
    case 14: set(below(2) ? "Sun" : "Spot", "set_intensity", anyNumber()); break;
    case 15: set("FC", "set_point", MFVec3f{anyVector(), vector(1), vector(1), vector(1)}); break;
    case 16: set("Sky", "set_skyColor", MFColor{anyColor(), color()}); break;
    case 17: set("Mist", "set_visibilityRange", anyNumber()); break;
    case 18:
      if (below(2))
        set("View", "set_position", anyVector());
      else
        set("View", "set_orientation",
            Rotation{anyNumber(), anyNumber(), anyNumber(), anyNumber()});
      break;
    case 19:
      set("Paint", "set_options",
          MFString{"1f roughness " + std::to_string(below(2) ? 0.5 : -7),
                   std::string("color color ") + (below(2) ? "0 0 1" : "-1 0 3")});
      break;
    case 20: set(below(2) ? "A0" : "A1", "set_material", orNone("M1")); break;
    case 21: set("A1", "set_texture", orNone("P")); break;
    case 22: set("A1", "set_textureTransform", orNone("TT")); break;
    case 23:
      set("P", "set_image",
          below(2) ? Image{1, 1, 3, {uint8_t(below(255)), 9, 9}} : Image{0, 0, 0, {}});
      break;
    case 24: set("View", "set_fieldOfView", anyNumber()); break;
    case 25: set("Sky", "set_skyAngle", MFFloat{anyNumber()}); break;
    case 26: set("LC", "set_point", MFVec3f{anyVector(), vector(3), anyVector()}); break;
    case 27: set("Spot", "set_cutOffAngle", anyNumber()); break;
    case 28: set("BB", "set_axisOfRotation", anyVector()); break;
    case 29: set("FK", "set_color", MFColor{anyColor(), color(), color(), color()}); break;
    case 30: set("FN", "set_vector", MFVec3f{anyVector(), vector(1), vector(1), vector(1)}); break;
    }
  }
};

TEST_P(MapBadNumbers, LeaveNothingBehind) {
  load(world);
  random_.seed(unsigned(GetParam()));
  expectAsFromNothing("at first");
  EXPECT_EQ(world_->diagnostics.errors(), 0u) << "all shaders are there";
  for (int step = 0; step < 40 && !HasFailure(); ++step) {
    std::string what =
        "seed " + std::to_string(GetParam()) + ", step " + std::to_string(step) + ": ";
    for (size_t n = 1 + below(3); n-- > 0;) change(what);
    expectAsFromNothing(what, false);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MapBadNumbers, testing::Range(0, 12));

} // namespace
