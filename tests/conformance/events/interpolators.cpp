// interpolators.cpp: the six interpolators: clauses 4.6.8, 6.10, 6.13, 6.31, 6.32, 6.37, 6.39. Each
// is tested in five situations, as in the NIST VRML test suite: simple, equal keys, 1,000 keys, no
// value before set_fraction, in hierarchies.
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

struct Case {
  std::string type;
  std::string a, b;           // values of two keys
  std::string atA, half, atB; // output at the keys and half way
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.type; }

class Interpolator : public testing::TestWithParam<Case> {
 protected:
  static std::string node(const std::string& keys, const std::string& values) {
    return "DEF I " + GetParam().type + " { key [ " + keys + " ] keyValue [ " + values + " ] }";
  }
  // Returns the value sent for a fraction; "nothing" if none is.
  static std::string at(Running& r, float fraction) {
    std::string left = "nothing";
    const uint64_t number =
        r.browser.listen(r.node("I"), "value_changed",
                         [&](Node&, const FieldInfo&, const Value& v) { left = textOf(v); });
    r.set("I", "set_fraction", fraction);
    r.browser.unlisten(r.node("I"), number);
    return left;
  }
};

TEST_P(Interpolator, SimpleBetweenTwoKeys) {
  const Case& c = GetParam();
  Running r(node("0 1", c.a + ", " + c.b));
  EXPECT_EQ(at(r, 0), c.atA);
  EXPECT_EQ(at(r, 0.5f), c.half);
  EXPECT_EQ(at(r, 1), c.atB);
}

TEST_P(Interpolator, FractionsOutsideTheKeysGiveTheEndValues) {
  const Case& c = GetParam();
  Running r(node("2 4", c.a + ", " + c.b));
  EXPECT_EQ(at(r, -1e30f), c.atA);
  EXPECT_EQ(at(r, 0), c.atA);
  EXPECT_EQ(at(r, 3), c.half);
  EXPECT_EQ(at(r, 5), c.atB);
}

TEST_P(Interpolator, EqualKeysMakeAStepWhoseLastValueHoldsAtTheKey) {
  const Case& c = GetParam();
  Running r(node("0 0.5 0.5 1", c.a + ", " + c.a + ", " + c.b + ", " + c.b));
  EXPECT_EQ(at(r, std::nextafter(0.5f, 0.0f)), c.atA);
  EXPECT_EQ(at(r, 0.5f), c.atB);
  EXPECT_EQ(at(r, std::nextafter(0.5f, 1.0f)), c.atB);
}

TEST_P(Interpolator, ThousandKeys) {
  const Case& c = GetParam();
  std::string keys, values;
  for (int i = 0; i <= 1000; ++i) {
    keys += fmt::format("{} ", i);
    values += (i % 2 ? c.b : c.a) + ", ";
  }
  Running r(node(keys, values));
  for (int i = 0; i < 1000; i += 37) {
    EXPECT_EQ(at(r, float(i)), i % 2 ? c.atB : c.atA) << i;
    EXPECT_EQ(at(r, float(i) + 0.5f), c.half) << i;
  }
}

TEST_P(Interpolator, AValueOnlyAfterSetFraction) {
  const Case& c = GetParam();
  Running r(node("0 1", c.a + ", " + c.b));
  for (const char* out : {"value_changed", "key_changed"}) r.log("I", out);
  r.browser.tick(1);
  EXPECT_EQ(r.take(), Log{});
  r.set("I", "set_key", MFFloat{0, 2});
  EXPECT_EQ(r.take(), Log{"1 I.key_changed [0, 2]"});
  r.set("I", "set_fraction", 1.0f);
  EXPECT_EQ(r.take(), Log{"1 I.value_changed " + c.half});
}

TEST_P(Interpolator, ReadBeforeItHasSentItIsTheFirstValue) {
  const Case& c = GetParam();
  Running r(node("0 1", c.b + ", " + c.a)), none(node("", ""));
  EXPECT_EQ(r.get("I", "value_changed"), c.atB);
  EXPECT_EQ(at(r, 1), c.atA);
  r.set("I", "set_keyValue", r.browser.get(r.node("I"), "keyValue"));
  EXPECT_EQ(r.get("I", "value_changed"), c.atA);
  EXPECT_EQ(none.get("I", "value_changed"),
            textOf(defaultValue(r.node("I").type().find("value_changed")->type)));
}

// The position in the scene has no effect (4.6.8): below a Switch that shows nothing, in a PROTO.
TEST_P(Interpolator, InHierarchies) {
  const Case& c = GetParam();
  const std::string type = c.type == "CoordinateInterpolator" || c.type == "NormalInterpolator"
                               ? "MFVec3f"
                           : c.type == "ColorInterpolator"       ? "SFColor"
                           : c.type == "OrientationInterpolator" ? "SFRotation"
                           : c.type == "PositionInterpolator"    ? "SFVec3f"
                                                                 : "SFFloat";
  Running r("PROTO Q [ eventIn SFFloat f eventOut " + type +
            " v ] { Transform { translation 9 9 9 children Switch { choice " + c.type +
            " { set_fraction IS f value_changed IS v key [ 0 1 ] keyValue [ " + c.a + ", " + c.b +
            " ] } } } }" + "PROTO P [ eventIn SFFloat f eventOut " + type +
            " v ] { Group { children Q { f IS f v IS v } } }" +
            "Transform { children DEF I P {} } DEF S ScalarInterpolator { key [ 0 10 ] keyValue [ "
            "0 10 ] } ROUTE S.value_changed TO I.f");
  r.log("I", "v");
  r.set("S", "set_fraction", 0.5f);
  EXPECT_EQ(r.take(), Log{"0 I.v " + c.half});
}

TEST_P(Interpolator, OneKeyGivesItsValueEverywhere) {
  Running r(node("0.5", GetParam().b));
  for (float f : {0.0f, 0.5f, 1.0f}) EXPECT_EQ(at(r, f), GetParam().atB);
}

TEST_P(Interpolator, WithoutKeysOrValuesNothingIsSent) {
  Running none(node("", "")), noValues(node("0 1", "")), noKeys(node("", GetParam().a));
  EXPECT_EQ(at(none, 0.5f), "nothing");
  EXPECT_EQ(at(noValues, 0.5f), "nothing");
  EXPECT_EQ(at(noKeys, 0.5f), "nothing");
}

TEST_P(Interpolator, TooFewOrTooManyValuesAreSaidOnceAndNeverReadBeyond) {
  const Case& c = GetParam();
  Running few(node("0 1 2", c.a + ", " + c.b)), many(node("0 1", c.a + ", " + c.b + ", " + c.a));
  for (Running* r : {&few, &many}) {
    for (float f : {0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f}) at(*r, f);
    EXPECT_EQ(r->browser.world().diagnostics.warnings(), 1u);
  }
}

TEST_P(Interpolator, UnorderedKeysAndOddFractionsAreHarmless) {
  const Case& c = GetParam();
  Running r(node("1 0 0.5 -1e38 3e38", c.a + ", " + c.b + ", " + c.a + ", " + c.b + ", " + c.a));
  for (float f : {-3e38f, -1.0f, 0.0f, 0.3f, 0.7f, 1.0f, 3e38f, INFINITY, -INFINITY})
    EXPECT_NE(at(r, f), "nothing") << f;
  EXPECT_EQ(at(r, NAN), "nothing");
}

INSTANTIATE_TEST_SUITE_P(
    All, Interpolator,
    testing::Values(
        Case{"ScalarInterpolator", "1", "3", "1", "2", "3"},
        Case{"PositionInterpolator", "0 0 0", "2 4 -6", "0 0 0", "1 2 -3", "2 4 -6"},
        Case{"ColorInterpolator", "1 0 0", "1 1 0", "1 0 0", "1 0.5 0", "1 1 0"},
        Case{"OrientationInterpolator", "0 1 0 0", "0 1 0 1", "0 1 0 0", "0 1 0 0.5", "0 1 0 1"},
        Case{"CoordinateInterpolator", "0 0 0", "2 4 -6", "[0 0 0]", "[1 2 -3]", "[2 4 -6]"},
        Case{"NormalInterpolator", "1 0 0", "0 1 0", "[1 0 0]", "[0.707107 0.707107 0]",
             "[0 1 0]"}),
    [](const auto& info) { return info.param.type; });

std::string valueAt(const std::string& node, float fraction) {
  Running r("DEF I " + node);
  r.set("I", "set_fraction", fraction);
  return r.get("I", "value_changed");
}

TEST(ScalarInterpolator, ATinyDistanceFromAKeyIsNoStep) {
  Running r("DEF I ScalarInterpolator { key [ -100 1 ] keyValue [ 0 10 ] }");
  r.set("I", "set_fraction", std::nextafter(1.0f, 0.0f)); // 1 - 6e-10 of the way
  EXPECT_EQ(r.get("I", "value_changed"), "10");
  r.set("I", "set_key", MFFloat{-INFINITY, INFINITY});
  r.set("I", "set_fraction", 0.5f);
  EXPECT_EQ(r.get("I", "value_changed"), "0");
}

TEST(ColorInterpolator, TakesTheShortWayRoundTheHues) {
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 1 0 0, 0 0 1 ] }", 0.5f),
            "1 0 1"); // through magenta
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 1 0 0, 0 1 0 ] }", 0.5f),
            "1 1 0"); // through yellow
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 0 0 1, 1 0 0 ] }", 0.25f),
            "0.5 0 1");
}

TEST(ColorInterpolator, AGreyHasTheHueOfTheOther) {
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 1 1 1, 0 0 1 ] }", 0.5f),
            "0.5 0.5 1");
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 0 1 0, 1 1 1 ] }", 0.5f),
            "0.5 1 0.5");
  EXPECT_EQ(valueAt("ColorInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 1 1 1 ] }", 0.5f),
            "0.5 0.5 0.5");
}

TEST(OrientationInterpolator, TakesTheShorterWay) {
  Running r("DEF I OrientationInterpolator { key [ 0 1 ] keyValue [ 0 1 0 0.5, 0 1 0 5.7831853 ] "
            "}"); // 0.5 and -0.5
  r.set("I", "set_fraction", 0.25f);
  const auto quarter = std::get<Rotation>(r.browser.get(r.node("I"), "value_changed"));
  EXPECT_NEAR(quarter.y * quarter.angle, 0.25f, 1e-5);
}

TEST(OrientationInterpolator, OppositeAxesOfOneTurnMeetAtNoTurn) {
  Running r("DEF I OrientationInterpolator { key [ 0 1 ] keyValue [ 0 1 0 1, 0 -1 0 1 ] }");
  r.set("I", "set_fraction", 0.5f);
  EXPECT_NEAR(std::get<Rotation>(r.browser.get(r.node("I"), "value_changed")).angle, 0, 1e-6);
}

TEST(OrientationInterpolator, HalfTurnsWrittenInSequenceMakeAWholeTurn) {
  for (const char* pi : {"3.14159", "3.1416", "3.14"}) {
    Running r(fmt::format("DEF I OrientationInterpolator {{ key [ 0 0.5 1 ] keyValue [ 0 1 0 0, 0 "
                          "1 0 {}, 0 1 0 {} ] }}",
                          pi, 2 * std::stod(pi)));
    for (float f : {0.25f, 0.75f}) {
      r.set("I", "set_fraction", f);
      const auto v = std::get<Rotation>(r.browser.get(r.node("I"), "value_changed"));
      const double turn = v.y > 0 ? v.angle : 2 * M_PI - v.angle;
      EXPECT_NEAR(turn, 2 * M_PI * f, 0.01) << pi;
    }
  }
}

TEST(OrientationInterpolator, AnAxisOfZeroIsNoRotationAndTheResultHasAUnitAxis) {
  Running r("DEF I OrientationInterpolator { key [ 0 1 ] keyValue [ 1 0 0 0, 1 0 0 0 ] }");
  r.set("I", "set_keyValue", MFRotation{{0, 0, 0, 1}, {0, 3, 0, 1}});
  r.set("I", "set_fraction", 0.5f);
  EXPECT_EQ(r.get("I", "value_changed"), "0 1 0 0.5");
}

TEST(OrientationInterpolator, TheAngleIsAtMostHalfATurn) {
  Running r("DEF I OrientationInterpolator { key [ 0 1 ] keyValue [ 0 1 0 3, 0 1 0 4 ] }");
  r.set("I", "set_fraction", 0.5f);
  const auto v = std::get<Rotation>(r.browser.get(r.node("I"), "value_changed"));
  EXPECT_EQ(v.y, -1);
  EXPECT_NEAR(v.angle, 2 * M_PI - 3.5, 1e-6);
}

TEST(NormalInterpolator, AZeroVectorHasTheOthersDirection) {
  EXPECT_EQ(
      valueAt("NormalInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 0 2 0, 0 3 0, 0 0 0 ] }", 0.5f),
      "[0 1 0, 0 1 0]");
}

TEST(NormalInterpolator, StaysOnTheUnitSphereAtEqualSpeed) {
  Running r("DEF I NormalInterpolator { key [ 0 1 ] keyValue [ 0 0 1, 0 0 1, 0 0 1, 1 0 0, 0 0 1, "
            "0 0 -1 ] }");
  for (float t : {0.1f, 0.5f, 0.9f}) {
    r.set("I", "set_fraction", t);
    const auto n = std::get<MFVec3f>(r.browser.get(r.node("I"), "value_changed"));
    ASSERT_EQ(n.size(), 3u);
    EXPECT_NEAR(n[0].x, std::sin(t * M_PI / 2), 1e-6);
    EXPECT_NEAR(n[1].z, 1, 1e-6);
    EXPECT_NEAR(n[2].z, std::cos(t * M_PI), 1e-6); // opposite directions: any great circle
    for (const Vec3f& v : n) EXPECT_NEAR(v.x * v.x + v.y * v.y + v.z * v.z, 1, 1e-6);
  }
}

TEST(CoordinateInterpolator, HasAListOfPointsForEachKey) {
  EXPECT_EQ(valueAt("CoordinateInterpolator { key [ 0 1 2 ] keyValue [ 0 0 0, 1 1 1,  2 0 0, 3 1 "
                    "1,  4 0 0, 5 1 1 ] }",
                    1.5f),
            "[3 0 0, 4 1 1]");
}

} // namespace
} // namespace xvrml
