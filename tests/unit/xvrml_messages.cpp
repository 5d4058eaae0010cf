// xvrml_messages.cpp: messages about values, X3D statements and missing files name the value, say
// how it was handled, and why.
#include <algorithm>

#include <gtest/gtest.h>

#include "xvrml/browser.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

std::vector<std::string> messagesOf(const std::string& vrml) {
  std::vector<std::string> messages;
  const auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "test.wrl");
  for (const Diagnostic& d : world->diagnostics.list())
    messages.push_back(d.text().substr(0, d.text().find('\n')));
  return messages;
}
using Messages = std::vector<std::string>;

float number(const std::string& vrml, std::string_view field) {
  const auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "test.wrl");
  const Node& node = *world->scope.roots.at(0);
  return std::get<SFFloat>(node.get(*node.type().find(field)));
}

TEST(Messages, AnglesMayBeRounded) {
  for (const char* angle : {"1.5708", "1.571", "1.57080", "1.570797"})
    EXPECT_EQ(
        messagesOf(std::string("SpotLight { cutOffAngle ") + angle + " beamWidth " + angle + " }"),
        Messages{})
        << angle;
  EXPECT_EQ(messagesOf("Background { groundAngle [ 0.1 1.5708 ] groundColor [ 0 0 0 0 0 0 0 0 0 ] "
                       "skyAngle 3.1416 skyColor [ 0 0 0 0 0 0 ] }"),
            Messages{});
  EXPECT_EQ(messagesOf("CylinderSensor { diskAngle 1.5708 maxAngle 6.28319 minAngle -6.2832 }"),
            Messages{});
  EXPECT_EQ(messagesOf("Viewpoint { fieldOfView 3.14159 }"), Messages{});
  EXPECT_EQ(number("SpotLight { cutOffAngle 1.571 }", "cutOffAngle"), 1.5707964f);
  // The range excludes pi. The value becomes the largest number below it, not the default.
  EXPECT_LT(number("Viewpoint { fieldOfView 3.1416 }", "fieldOfView"), 3.1415927f);
  EXPECT_GT(number("Viewpoint { fieldOfView 3.1416 }", "fieldOfView"), 3.1415f);
  EXPECT_EQ(messagesOf("SpotLight { cutOffAngle 1.58 }").size(), 1u);
}

TEST(Messages, RangesNameTheValueAndWhatBecomesOfIt) {
  EXPECT_EQ(messagesOf("SpotLight { cutOffAngle 1.9 }"),
            Messages{"test.wrl:2:13: warning: SpotLight.cutOffAngle: 1.9 is outside of its range "
                     "(0,pi/2] and becomes 1.5707964"});
  EXPECT_EQ(messagesOf("PointLight { intensity 3 }"),
            Messages{"test.wrl:2:14: warning: PointLight.intensity: 3 is outside of its range "
                     "[0,1] and becomes 1"});
  EXPECT_EQ(messagesOf("PointLight { intensity 1.0000001 }"), Messages{});
  const Messages colors = messagesOf("Background { skyColor [ 1 1 1, 2 0 0, 0 3 0 ] }");
  ASSERT_EQ(colors.size(), 1u);
  EXPECT_EQ(colors[0], "test.wrl:2:14: warning: Background.skyColor[1]: 2 0 0 is outside of its "
                       "range [0,1] and becomes 1 0 0, as do 1 further elements");
}

TEST(Messages, StatementsOfX3dAreNamed) {
  EXPECT_EQ(
      messagesOf("PROFILE Interchange\nCOMPONENT Scripting : 1\nCOMPONENT Text:2\nMETA \"title\" "
                 "\"a { b\"\nShape { }"),
      (Messages{
          "test.wrl:2:1: warning: PROFILE is a statement of X3D, not of VRML97: it is left out",
          "test.wrl:3:1: warning: COMPONENT is a statement of X3D, not of VRML97: it is left out",
          "test.wrl:4:1: warning: COMPONENT is a statement of X3D, not of VRML97: it is left out",
          "test.wrl:5:1: warning: META is a statement of X3D, not of VRML97: it is left out"}));
  const auto world = loadWorldFromMemory(
      "#VRML V2.0 utf8\nMETA \"a\" \"b\"\nUNIT angle deg 0.0175\nGroup { }\nEXPORT A AS B\n"
      "DEF D Group { }",
      "test.wrl");
  EXPECT_EQ(world->scope.roots.size(), 2u);
  EXPECT_EQ(world->diagnostics.errors(), 2u);
  EXPECT_EQ(world->diagnostics.warnings(), 1u);
  EXPECT_EQ(messagesOf("DEF META Group { } Group { children USE META }"), Messages{});
}

// A size that no picture depends on is kept, and nothing is skipped because of it.
TEST(Messages, SizesOfBoundsHaveNoEffect) {
  EXPECT_EQ(messagesOf("Group { bboxSize 0 0 0 }"),
            Messages{"test.wrl:2:9: warning: Group.bboxSize: 0 0 0 is outside of its range (0,inf) "
                     "or -1 and is kept; no picture depends on it"});
  const Messages box = messagesOf("Shape { geometry Box { size 0 1 1 } }");
  ASSERT_EQ(box.size(), 1u);
  EXPECT_NE(box[0].find("parts that cannot be drawn are skipped"), std::string::npos) << box[0];
}

// Table 4.4 forbids it, but the value arrives, so that it is no error.
TEST(Messages, AFieldThatIsAnExposedFieldIsTaken) {
  const std::string vrml = "PROTO P [ exposedField SFVec3f size 1 1 1 ] { Shape { geometry Box { "
                           "size IS size } } } P { size 2 3 4 }";
  EXPECT_EQ(messagesOf(vrml),
            Messages{"test.wrl:2:78: warning: field 'size' of Box cannot be exposedField 'size' of "
                     "the interface (4.8.2): it takes the value of the instance, but no events"});
  const auto world = loadWorldFromMemory("#VRML V2.0 utf8\n" + vrml, "test.wrl");
  const auto* shape = nodeCast<nodes::Shape>(renderedNode(world->scope.roots[0].get()));
  ASSERT_TRUE(shape);
  EXPECT_EQ(nodeCast<nodes::Box>(shape->geometry)->size, (Vec3f{2, 3, 4}));
}

// All that refers to a node which was left out has one cause.
TEST(Messages, ANodeThatWasLeftOutIsNamedOnce) {
  std::string vrml = "DEF T Transform { } DEF L Nothing { }\n";
  for (int i = 0; i < 5; ++i) vrml += "ROUTE T.translation_changed TO L.set_x\n";
  const Messages messages = messagesOf(vrml);
  EXPECT_EQ(std::count_if(messages.begin(), messages.end(),
                          [](const std::string& one) {
                            return one.find("'L' was left out above") != std::string::npos;
                          }),
            1);
}

TEST(Messages, MissingMediaSayWhy) {
  Browser browser(
      loadWorldFromMemory("#VRML V2.0 utf8\nSound { source AudioClip { url \"no.wav\" } }\nShape { "
                          "appearance Appearance { texture MovieTexture { url \"no.mpg\" } } }",
                          "test.wrl"));
  browser.tick(0);
  ASSERT_EQ(browser.world().diagnostics.list().size(), 2u);
  for (const Diagnostic& d : browser.world().diagnostics.list())
    EXPECT_NE(d.message.find("nothing to play: no."), std::string::npos) << d.message;
  EXPECT_NE(browser.world().diagnostics.list()[0].message.find("No such file or directory"),
            std::string::npos);
}

} // namespace
} // namespace xvrml
