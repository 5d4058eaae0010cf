// event_utilities.cpp: filters, triggers and sequencers (ISO/IEC 19775-1 clause 30).
#include <limits>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

TEST(EventUtilities, AFilterTellsTrueFromFalse) { // 30.4.1
  Running r("DEF F BooleanFilter { }");
  for (const char* out : {"inputTrue", "inputFalse", "inputNegate"}) r.log("F", out);
  r.set("F", "set_boolean", true);
  EXPECT_EQ(r.take(), (Log{"0 F.inputTrue TRUE", "0 F.inputNegate FALSE"}));
  r.set("F", "set_boolean", false);
  EXPECT_EQ(r.take(), (Log{"0 F.inputFalse FALSE", "0 F.inputNegate TRUE"}));
}

TEST(EventUtilities, AToggleAnswersTrueOnly) { // 30.4.3
  Running r("DEF T BooleanToggle { }");
  r.log("T", "toggle");
  r.set("T", "set_boolean", true);
  r.set("T", "set_boolean", false);
  r.set("T", "set_boolean", true);
  EXPECT_EQ(r.take(), (Log{"0 T.toggle TRUE", "0 T.toggle FALSE"}));
  r.set("T", "toggle", true);
  EXPECT_EQ(r.get("T", "toggle"), "TRUE");
}

TEST(EventUtilities, AToggleInALoopEnds) {
  Running r("DEF T BooleanToggle { } ROUTE T.toggle TO T.set_boolean");
  r.log("T", "toggle");
  r.set("T", "set_boolean", true);
  EXPECT_EQ(r.take(), Log{"0 T.toggle TRUE"});
  EXPECT_EQ(r.get("T", "toggle"), "TRUE");
}

TEST(EventUtilities, TriggersSendForEachEvent) { // 30.4.4, 30.4.6, 30.4.7
  Running r("DEF B BooleanTrigger { } DEF I IntegerTrigger { integerKey 7 } DEF T TimeTrigger { }");
  r.log("B", "triggerTrue");
  r.log("I", "triggerValue");
  r.log("T", "triggerTime");
  r.browser.tick(2.5);
  r.set("B", "set_triggerTime", 1.0);
  r.set("I", "set_boolean", false);
  r.set("T", "set_boolean", false);
  EXPECT_EQ(r.take(),
            (Log{"2.5 B.triggerTrue TRUE", "2.5 I.triggerValue 7", "2.5 T.triggerTime 2.5"}));
  r.set("I", "integerKey", int32_t(8));
  EXPECT_EQ(r.take(), Log{});
}

TEST(EventUtilities, AFractionSendsWhenItReachesAnotherKey) { // 30.3.1
  Running r("DEF S IntegerSequencer { key [ 0 0.5 1 ] keyValue [ 10 20 30 ] }");
  r.log("S", "value_changed");
  for (const float f : {-1.0f, 0.25f, 0.5f, 0.75f, 1.0f, 9.0f, 0.0f}) r.set("S", "set_fraction", f);
  EXPECT_EQ(r.take(), (Log{"0 S.value_changed 10", "0 S.value_changed 20", "0 S.value_changed 30",
                           "0 S.value_changed 10"}));
  r.set("S", "set_fraction", std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(r.take(), Log{});
}

TEST(EventUtilities, StepsGoRound) { // 30.3.1
  Running r("DEF S BooleanSequencer { key [ 0 1 2 ] keyValue [ TRUE FALSE FALSE ] }"
            "DEF I IntegerSequencer { key [ 0 1 2 ] keyValue [ 1 2 3 ] }"
            "DEF E IntegerSequencer { key [ 0 ] }");
  for (const char* name : {"S", "I", "E"}) r.log(name, "value_changed");
  for (const char* name : {"S", "I", "E"}) {
    for (int i = 0; i < 4; ++i) r.set(name, "next", true);
    r.set(name, "next", false);
    r.set(name, "previous", true);
    r.set(name, "previous", false);
  }
  EXPECT_EQ(r.take(), (Log{"0 S.value_changed TRUE", "0 S.value_changed FALSE",
                           "0 S.value_changed FALSE", "0 S.value_changed TRUE",
                           "0 S.value_changed FALSE", "0 I.value_changed 1", "0 I.value_changed 2",
                           "0 I.value_changed 3", "0 I.value_changed 1", "0 I.value_changed 3"}));
}

TEST(EventUtilities, AShorterListIsNotReadBeyondItsEnd) {
  Running r("DEF I IntegerSequencer { key [ 0 1 2 ] keyValue [ 1 2 3 ] }");
  r.set("I", "set_fraction", 2.0f);
  r.set("I", "keyValue", MFInt32{5});
  r.log("I", "value_changed");
  r.set("I", "previous", true);
  r.set("I", "set_fraction", 2.0f);
  EXPECT_EQ(r.take(), Log{"0 I.value_changed 5"});
}

} // namespace
} // namespace xvrml
