// control_values.cpp: Tests the conversion of field values to and from JSON: every type there and
// back, and every kind of wrong value.
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "as_json/field_json.h"
#include "as_json/node_numbers.h"
#include "control/limits.h"
#include "xvrml/world.h"

using namespace xvrml;
using namespace vv::control;

namespace {

// A prototype has fields of all types, without ranges.
std::string interfaceOfAllTypes() {
  std::string text = "PROTO All [ ";
  for (int i = 0; i < fieldTypeCount; ++i) {
    const std::string name(fieldTypeName(FieldType(i)));
    text += "eventIn " + name + " a" + name + " ";
  }
  return text + "] { Group {} } DEF Node All {}";
}

class ControlValues : public testing::Test {
 protected:
  ControlValues()
      : world(loadWorldFromMemory("#VRML V2.0 utf8\n" + interfaceOfAllTypes() +
                                      " Shape { appearance Appearance { material DEF Paint "
                                      "Material {} } geometry DEF Ball Sphere {} }"
                                      " DEF Turn Transform {} DEF Time TimeSensor {}",
                                  "test.wrl", {})) {}

  Node& node(const char* name) { return *world->scope.names.find(name)->second; }

  Value read(Node& owner, const char* field, const std::string& json) {
    return readValue(Json::parse(json), owner, *owner.type().find(field), [&](const Json& name) {
      if (name.is_string() && world->scope.names.count(name.get<std::string>()))
        return world->scope.names.find(name.get<std::string>())->second;
      if (name.is_number() && numbers.find(name.get<uint64_t>()))
        return numbers.find(name.get<uint64_t>());
      throw CommandError("node", "no such node");
    });
  }
  std::string text(const Value& value) {
    std::string out;
    appendValue(out, value, [&](const NodeRef& one) { return numbers.of(one); });
    return out;
  }
  void refused(Node& owner, const char* field, const std::string& json, const std::string& words) {
    try {
      read(owner, field, json);
      FAIL() << field << " took " << json;
    } catch (const CommandError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  std::unique_ptr<World> world;
  NodeNumbers numbers{limits.nodes};
};

TEST_F(ControlValues, EveryTypeGoesThereAndBack) {
  const std::pair<const char*, const char*> cases[] = {
      {"aSFBool", "true"},
      {"aSFColor", "[0.1,0.2,1]"},
      {"aSFFloat", "0.1"},
      {"aSFImage", R"({"width":2,"height":1,"components":3,"pixels":[16711680,65535]})"},
      {"aSFInt32", "-2147483648"},
      {"aSFNode", "1"},
      {"aSFRotation", "[0,1,0,1.5707964]"},
      {"aSFString", R"("a \"b\" \u0001 é")"},
      {"aSFTime", "1729728000.125"},
      {"aSFVec2f", "[1,-2.5]"},
      {"aSFVec3f", "[1e-10,2,3.4028235e+38]"},
      {"aMFColor", "[[0,0,0],[1,1,1]]"},
      {"aMFFloat", "[]"},
      {"aMFInt32", "[0,-1,2147483647]"},
      {"aMFNode", "[1,null]"},
      {"aMFRotation", "[[0,0,1,0]]"},
      {"aMFString", R"(["","x"])"},
      {"aMFTime", "[0.1,-1]"},
      {"aMFVec2f", "[[0,1]]"},
      {"aMFVec3f", "[[0,1,2],[3,4,5]]"},
      {"aMFBool", "[true,false]"},
      {"aSFColorRGBA", "[0.1,0.2,1,0.5]"},
      {"aMFColorRGBA", "[[0.1,0.2,1,0.5],[0.1,0.2,1,0.5]]"},
      {"aSFDouble", "0.1"},
      {"aMFDouble", "[0.1,1e+300]"},
      {"aMFImage", R"([{"width":2,"height":1,"components":3,"pixels":[16711680,65535]}])"},
      {"aSFMatrix3d", "[1,0,0,0,1.5,0,0,0,0.1]"},
      {"aMFMatrix3d", "[[1,0,0,0,1.5,0,0,0,0.1],[1,0,0,0,1.5,0,0,0,0.1]]"},
      {"aSFMatrix3f", "[1,0,0,0,1.5,0,0,0,0.1]"},
      {"aMFMatrix3f", "[[1,0,0,0,1.5,0,0,0,0.1],[1,0,0,0,1.5,0,0,0,0.1]]"},
      {"aSFMatrix4d", "[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1]"},
      {"aMFMatrix4d", "[[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1],[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1]]"},
      {"aSFMatrix4f", "[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1]"},
      {"aMFMatrix4f", "[[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1],[1,0,0,0,0,1,0,0,0,0,1,0,2,3,0.1,1]]"},
      {"aSFVec2d", "[0.1,2]"},
      {"aMFVec2d", "[[0.1,2],[0.1,2]]"},
      {"aSFVec3d", "[0.1,2,3e-07]"},
      {"aMFVec3d", "[[0.1,2,3e-07],[0.1,2,3e-07]]"},
      {"aSFVec4d", "[0.1,2,3,4]"},
      {"aMFVec4d", "[[0.1,2,3,4],[0.1,2,3,4]]"},
      {"aSFVec4f", "[0.1,2,3,4]"},
      {"aMFVec4f", "[[0.1,2,3,4],[0.1,2,3,4]]"},
  };
  numbers.of(NodeRef(&node("Turn")));
  EXPECT_EQ(std::size(cases), size_t(fieldTypeCount));
  for (const auto& [field, json] : cases) EXPECT_EQ(text(read(node("Node"), field, json)), json);
  EXPECT_EQ(text(read(node("Node"), "aSFNode", "null")), "null");
  EXPECT_EQ(text(read(node("Node"), "aSFInt32", "3.0")), "3");
  EXPECT_EQ(text(Value(std::numeric_limits<float>::infinity())), "null");
  EXPECT_EQ(text(Value(std::string("\xff"))), "\"\xef\xbf\xbd\"");
}

TEST_F(ControlValues, WrongTypesAndCountsAreNamed) {
  Node& all = node("Node");
  refused(all, "aSFBool", "1", "All.aSFBool (SFBool): true or false was expected, not 1");
  refused(all, "aSFVec3f", "[1,2]", "an array of 3 numbers was expected, not an array of 2");
  refused(all, "aSFVec3f", R"([1,2,"x"])", "not \"x\" at value[2]");
  refused(all, "aMFVec3f", "[[1,2,3],[1,2]]", "not an array of 2 at value[1]");
  refused(all, "aMFVec3f", "[[1,2,3],[1,2,null]]", "not null at value[1][2]");
  refused(all, "aMFVec3f", "[1,2,3]", "not 1 at value[0]");
  refused(all, "aSFVec4d", "[1,2,3]", "an array of 4 numbers was expected, not an array of 3");
  refused(all, "aMFMatrix3f", "[[1]]", "an array of arrays of 9 numbers was expected");
  refused(all, "aMFBool", "[true,1]", "an array of truth values was expected, not 1 at value[1]");
  refused(all, "aMFImage", "[[]]", "an array of objects with width");
  refused(all, "aSFDouble", "null", "a number was expected, not null");
  refused(all, "aSFFloat", "true", "a number was expected, not true");
  refused(all, "aSFFloat", "1e39", "a number of 32 bits was expected, not 1e+39");
  refused(all, "aSFInt32", "1.5", "a whole number of 32 bits was expected, not 1.5");
  refused(all, "aSFInt32", "2147483648", "not 2147483648");
  refused(all, "aMFString", R"("x")", "an array of texts was expected");
  refused(all, "aSFString", "[]", "a text was expected, not an array of 0");
  refused(all, "aSFNode", "-1", "not -1");
  refused(all, "aSFNode", R"("Nobody")", "no such node");
}

TEST_F(ControlValues, ImagesAreCounted) {
  Node& all = node("Node");
  refused(all, "aSFImage", "[]", "an object with width");
  refused(all, "aSFImage", R"({"height":1,"components":1,"pixels":[]})", "\"width\"");
  refused(all, "aSFImage", R"({"width":1,"height":1,"components":5,"pixels":[1]})",
          "components: a whole number from 0 to 4");
  refused(all, "aSFImage", R"({"width":2,"height":2,"components":1,"pixels":[1,2,3]})",
          "pixels: 4 numbers were expected, not 3");
  refused(all, "aSFImage", R"({"width":1,"height":1,"components":1,"pixels":[256]})",
          "pixels[0]: a whole number from 0 to 255 was expected, not 256");
  refused(all, "aSFImage",
          R"({"width":18446744073709551615,"height":0,"components":1,"pixels":[]})",
          "a whole number from 0 to 65536");
  refused(all, "aSFImage", R"({"width":0,"height":0,"components":9223372036854775809,"pixels":[]})",
          "a whole number from 0 to 4");
  refused(all, "aSFImage", R"({"width":65536,"height":65536,"components":4,"pixels":[1]})",
          "pixels: 4294967296 numbers");
  EXPECT_EQ(text(read(all, "aSFImage", R"({"width":0,"height":0,"components":0,"pixels":[]})")),
            R"({"width":0,"height":0,"components":0,"pixels":[]})");
}

TEST_F(ControlValues, RangesAreThoseOfTheNodes) {
  refused(node("Paint"), "transparency", "1.5",
          "Material.transparency (SFFloat): numbers in [0,1] were expected, not 1.5");
  refused(node("Paint"), "diffuseColor", "[0,2,0]", "not 2 at value[1]");
  refused(node("Ball"), "radius", "0", "numbers in (0,inf) were expected, not 0");
  refused(node("Turn"), "bboxSize", "[-1,-1,-2]",
          "numbers in [0,inf) or -1 were expected, not -2 at value[2]");
  EXPECT_EQ(text(read(node("Turn"), "bboxSize", "[-1,-1,-1]")), "[-1,-1,-1]");
  EXPECT_EQ(text(read(node("Turn"), "rotation", "[0,5,0,1]")), "[0,5,0,1]");
}

TEST_F(ControlValues, NodesMustFit) {
  refused(node("Turn"), "children", R"(["Paint"])", "not a Material at value[0]");
  refused(node("Turn"), "children", "[null]", "not null at value[0]");
  EXPECT_EQ(text(read(node("Turn"), "children", R"(["Time","Node"])")), "[1,2]");
}

TEST_F(ControlValues, NumbersStayUntilTheyAreReleased) {
  const NodeRef turn(&node("Turn")), paint(&node("Paint"));
  EXPECT_EQ(numbers.of(turn), 1u);
  EXPECT_EQ(numbers.of(paint), 2u);
  EXPECT_EQ(numbers.of(turn), 1u);
  EXPECT_TRUE(numbers.release(1));
  EXPECT_FALSE(numbers.release(1));
  EXPECT_FALSE(numbers.find(1));
  EXPECT_EQ(numbers.of(turn), 3u);
  numbers.releaseAll();
  EXPECT_EQ(numbers.size(), 0u);
}

} // namespace
