// followers.cpp: step responses of chasers and dampers (ISO/IEC 19775-1 clause 39) against closed
// forms derived by hand, and that they do not depend on the number of ticks.
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

float numberOf(Running& r, const char* name) {
  return std::get<SFFloat>(r.browser.get(r.node(name), "value_changed"));
}

TEST(Followers, AChaserFollowsARaisedCosine) { // 39.3.1: R(t) = (1 - cos(pi t / duration)) / 2
  Running r("DEF C ScalarChaser { duration 2 }");
  r.browser.tick(1);
  r.set("C", "set_destination", 10.0f);
  r.browser.tick(1.5); // a quarter: 10 (1 - cos 45 degrees) / 2
  EXPECT_NEAR(numberOf(r, "C"), 1.46447f, 1e-5f);
  r.browser.tick(2);
  EXPECT_NEAR(numberOf(r, "C"), 5, 1e-5f);
  r.browser.tick(3);
  EXPECT_EQ(numberOf(r, "C"), 10);
}

TEST(Followers, DestinationsOfAChaserAddUp) {
  Running r("DEF C ScalarChaser { }");
  r.browser.tick(1);
  r.set("C", "set_destination", 4.0f);
  r.browser.tick(1.5);
  r.set("C", "set_destination", 0.0f);
  r.browser.tick(1.75); // 4 R(0.75) - 4 R(0.25) = 4 (0.853553 - 0.146447)
  EXPECT_NEAR(numberOf(r, "C"), 2.82843f, 1e-5f);
  r.browser.tick(2.5);
  EXPECT_EQ(numberOf(r, "C"), 0);
}

TEST(Followers, ADamperOfOneFilterIsExponential) { // 39.3.2
  Running r("DEF D ScalarDamper { tau 0.5 order 1 }");
  r.set("D", "set_destination", 1.0f);
  r.browser.tick(0.5);
  EXPECT_NEAR(numberOf(r, "D"), 1 - std::exp(-1.0), 1e-6);
}

TEST(Followers, ADamperOfThreeFilters) { // 1 - exp(-s) (1 + s + s^2/2) at s = 2
  Running r("DEF D ScalarDamper { tau 0.5 order 3 }");
  r.set("D", "set_destination", 1.0f);
  r.browser.tick(1);
  EXPECT_NEAR(numberOf(r, "D"), 1 - std::exp(-2.0) * 5, 1e-6);
}

TEST(Followers, TheNumberOfTicksDoesNotMatter) {
  for (const char* node : {"ScalarDamper { tau 0.3 order 4 }", "ScalarChaser { duration 1.7 }"}) {
    float values[2];
    for (const int ticks : {1, 97}) {
      Running r(std::string("DEF F ") + node);
      r.browser.tick(1);
      r.set("F", "set_destination", 3.0f);
      for (int i = 1; i <= ticks; ++i) r.browser.tick(1 + 0.25 * i / ticks);
      r.set("F", "set_destination", -2.0f);
      for (int i = 1; i <= ticks; ++i) r.browser.tick(1.25 + 0.5 * i / ticks);
      values[ticks > 1] = numberOf(r, "F");
    }
    EXPECT_EQ(values[0], values[1]) << node;
  }
}

TEST(Followers, ArrivalIsExactAndEndsTheEvents) {
  Running r("DEF D ScalarDamper { tau 0.1 tolerance 0.01 }");
  r.log("D", "isActive");
  r.log("D", "value_changed");
  r.set("D", "set_destination", 1.0f);
  EXPECT_EQ(r.take(), Log{"0 D.isActive TRUE"});
  r.browser.tick(5);
  EXPECT_EQ(r.take(), (Log{"5 D.value_changed 1", "5 D.isActive FALSE"}));
  r.browser.tick(6);
  EXPECT_EQ(r.take(), Log{});
}

TEST(Followers, TheDestinationIsReachedAtOnceWithoutATime) {
  for (const char* node : {"ScalarDamper { tau 0 }", "ScalarDamper { order 0 }"}) {
    Running r(std::string("DEF F ") + node);
    r.set("F", "set_destination", 3.0f);
    r.browser.tick(0.01);
    EXPECT_EQ(numberOf(r, "F"), 3) << node;
  }
}

TEST(Followers, TheFirstDestinationIsChasedFromTheStart) {
  Running r("DEF C PositionChaser { initialDestination 2 0 0 duration 2 }");
  r.browser.tick(1);
  EXPECT_EQ(r.get("C", "value_changed"), "1 0 0");
}

TEST(Followers, AValueIsTakenAndLeftForTheDestination) {
  Running r("DEF C ScalarChaser { initialValue 1 initialDestination 1 }");
  r.log("C", "value_changed");
  r.set("C", "set_value", 5.0f);
  EXPECT_EQ(r.take(), Log{"0 C.value_changed 5"});
  r.browser.tick(0.5);
  EXPECT_EQ(r.take(), Log{"0.5 C.value_changed 3"});
  r.browser.tick(2);
  EXPECT_EQ(numberOf(r, "C"), 1);
}

TEST(Followers, RotationsTakeTheShortWay) {
  Running r(
      "DEF C OrientationChaser { initialValue 0 0 1 3 initialDestination 0 0 1 -3 duration 2 }");
  r.browser.tick(1); // half way from 3 over pi to -3
  const auto value = std::get<SFRotation>(r.browser.get(r.node("C"), "value_changed"));
  EXPECT_NEAR(value.angle, M_PI, 1e-5);
}

TEST(Followers, ListsOfAnotherLengthAreTakenOver) {
  Running r("DEF C CoordinateChaser { }");
  r.set("C", "set_destination", MFVec3f{{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(r.get("C", "value_changed"), "[1 2 3, 4 5 6]");
  r.set("C", "set_destination", MFVec3f{{3, 2, 3}, {4, 5, 6}});
  r.browser.tick(0.5);
  EXPECT_EQ(r.get("C", "value_changed"), "[2 2 3, 4 5 6]");
}

TEST(Followers, NumbersThatAreNotFiniteAreIgnored) {
  Running r("DEF D ScalarDamper { }");
  r.set("D", "set_destination", std::numeric_limits<float>::infinity());
  r.browser.tick(9);
  EXPECT_EQ(numberOf(r, "D"), 0);
}

} // namespace
} // namespace xvrml
