// tcl_values.cpp: values of all field types in Tcl, in both directions, and values that are
// refused. See docs/scripts.md "Tcl/Tk".
#include "conformance/events/tcl_world.h"

namespace xvrml {
namespace {

class TclValues : public Tcl {};

struct Case {
  const char* type;
  const char* vrml;   // a field's value in the file
  const char* tcl;    // the same value in Tcl
  const char* wrong;  // an invalid value
  const char* reason; // a part of the message
};

const Case cases[] = {
    {"SFBool", "TRUE", "1", "perhaps", "a boolean"},
    {"SFColor", "0.1 0.2 1", "0.1 0.2 1.0", "1 2", "3 numbers"},
    {"SFFloat", "0.1", "0.1", "one", "a number"},
    {"SFImage", "2 1 3 0xff0000 0x0102ff", "2 1 3 {255 0 0 1 2 255}", "2 2 3 {1 2 3}",
     "as many bytes"},
    {"SFInt32", "-2147483648", "-2147483648", "2147483648", "an integer of 32 bits"},
    {"SFNode", "Group {}", "node2", "no node", "the name of a node"},
    {"SFRotation", "0 1 0 1.5", "0.0 1.0 0.0 1.5", "0 1 0 x", "a number"},
    {"SFString", "\"a \\\"b\\\" {\"", "a \"b\" {", nullptr, nullptr},
    {"SFTime", "12345678.25", "12345678.25", "now", "a number"},
    {"SFVec2f", "1 2", "1.0 2.0", "1 2 3", "2 numbers"},
    {"SFVec3f", "1 2 3e-7", "1.0 2.0 3e-7", "{1 2 3} 4", "3 numbers"},
    {"MFColor", "[1 0 0, 0 1 0]", "{1.0 0.0 0.0} {0.0 1.0 0.0}", "{1 0}", "3 numbers"},
    {"MFFloat", "[1 2.5]", "1.0 2.5", "1 x", "a number"},
    {"MFInt32", "[1 -2]", "1 -2", "1 2.5", "an integer"},
    {"MFNode", "[Group {} Shape {}]", "node2 node3", "node2 node99", "the name of a node"},
    {"MFRotation", "[0 0 1 1]", "{0.0 0.0 1.0 1.0}", "{0 0 1}", "4 numbers"},
    {"MFString", "[\"a b\" \"\"]", "{a b} {}", "{", "a list"},
    {"MFTime", "[1 2]", "1.0 2.0", "1 {2 3}", "a number"},
    {"MFVec2f", "[1 2 3 4]", "{1.0 2.0} {3.0 4.0}", "1 2 3", "2 numbers"},
    {"MFVec3f", "[1 2 3]", "{1.0 2.0 3.0}", "1 2", "3 numbers"},
    {"MFBool", "[TRUE FALSE]", "1 0", "1 perhaps", "a boolean"},
    {"SFColorRGBA", "0.1 0.2 1 0.5", "0.1 0.2 1.0 0.5", "1", "4 numbers"},
    {"MFColorRGBA", "[0.1 0.2 1 0.5, 0.1 0.2 1 0.5]", "{0.1 0.2 1.0 0.5} {0.1 0.2 1.0 0.5}", "{1}",
     "4 numbers"},
    {"SFDouble", "0.1", "0.1", "now", "a number"},
    {"MFDouble", "[0.1 1e300]", "0.1 1e+300", "1 x", "a number"},
    {"MFImage", "[2 1 3 0xff0000 0x0102ff, 0 0 0]", "{2 1 3 {255 0 0 1 2 255}} {0 0 0 {}}",
     "{2 2 3 {1 2 3}}", "as many bytes"},
    {"SFMatrix3d", "1 0 0 0 1.5 0 0 0 0.1", "1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1", "1",
     "9 numbers"},
    {"MFMatrix3d", "[1 0 0 0 1.5 0 0 0 0.1, 1 0 0 0 1.5 0 0 0 0.1]",
     "{1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1} {1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1}", "{1}",
     "9 numbers"},
    {"SFMatrix3f", "1 0 0 0 1.5 0 0 0 0.1", "1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1", "1",
     "9 numbers"},
    {"MFMatrix3f", "[1 0 0 0 1.5 0 0 0 0.1, 1 0 0 0 1.5 0 0 0 0.1]",
     "{1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1} {1.0 0.0 0.0 0.0 1.5 0.0 0.0 0.0 0.1}", "{1}",
     "9 numbers"},
    {"SFMatrix4d", "1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1",
     "1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0", "1", "16 numbers"},
    {"MFMatrix4d", "[1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1, 1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1]",
     "{1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0} {1.0 0.0 0.0 0.0 0.0 1.0 "
     "0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0}",
     "{1}", "16 numbers"},
    {"SFMatrix4f", "1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1",
     "1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0", "1", "16 numbers"},
    {"MFMatrix4f", "[1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1, 1 0 0 0 0 1 0 0 0 0 1 0 2 3 0.1 1]",
     "{1.0 0.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0} {1.0 0.0 0.0 0.0 0.0 1.0 "
     "0.0 0.0 0.0 0.0 1.0 0.0 2.0 3.0 0.1 1.0}",
     "{1}", "16 numbers"},
    {"SFVec2d", "0.1 2", "0.1 2.0", "1", "2 numbers"},
    {"MFVec2d", "[0.1 2, 0.1 2]", "{0.1 2.0} {0.1 2.0}", "{1}", "2 numbers"},
    {"SFVec3d", "0.1 2 3e-7", "0.1 2.0 3e-7", "1", "3 numbers"},
    {"MFVec3d", "[0.1 2 3e-7, 0.1 2 3e-7]", "{0.1 2.0 3e-7} {0.1 2.0 3e-7}", "{1}", "3 numbers"},
    {"SFVec4d", "0.1 2 3 4", "0.1 2.0 3.0 4.0", "1", "4 numbers"},
    {"MFVec4d", "[0.1 2 3 4, 0.1 2 3 4]", "{0.1 2.0 3.0 4.0} {0.1 2.0 3.0 4.0}", "{1}",
     "4 numbers"},
    {"SFVec4f", "0.1 2 3 4", "0.1 2.0 3.0 4.0", "1", "4 numbers"},
    {"MFVec4f", "[0.1 2 3 4, 0.1 2 3 4]", "{0.1 2.0 3.0 4.0} {0.1 2.0 3.0 4.0}", "{1}",
     "4 numbers"}};

TEST_F(TclValues, GoBothWays) {
  EXPECT_EQ(std::size(cases), size_t(fieldTypeCount));
  for (const Case& c : cases) {
    const std::string type = c.type;
    TclWorld r(TclWorld::script("field " + type + " f " + c.vrml + " eventOut " + type +
                                    " out eventOut " + type + " again eventIn SFBool go eventIn " +
                                    type + " in",
                                "proc go v {puts $::f; set ::out $::f; set ::f $::f}\nproc in {v "
                                "t} {puts $v; set ::again $v}"));
    const std::string before = r.get("S", "f");
    r.set("S", "go", true);
    EXPECT_EQ(r.printed(), Log{c.tcl}) << c.type;
    EXPECT_EQ(r.get("S", "f"), before) << c.type;
    EXPECT_EQ(r.get("S", "out"), before) << c.type;
    r.set("S", "in", r.browser.get(r.node("S"), "f"));
    EXPECT_EQ(r.printed(), Log{c.tcl}) << c.type;
    EXPECT_EQ(r.get("S", "again"), before) << c.type;
    EXPECT_EQ(r.messages(), Log{}) << c.type;
  }
}

TEST_F(TclValues, AreRefusedAtTheLineThatWritesThem) {
  for (const Case& c : cases) {
    if (!c.wrong) continue;
    TclWorld r(TclWorld::script(
        std::string("field ") + c.type + " f " + c.vrml + " eventOut " + c.type +
            " out eventIn SFBool go",
        std::string("proc go v {\n  set was $::f\n  if {[catch {set ::f {") + c.wrong +
            "}} why]} {puts $why}\n  puts [expr {$::f eq $was}]\n  set ::out {" + c.wrong +
            "}\n}"));
    const std::string before = r.get("S", "f");
    r.set("S", "go", true);
    const Log printed = r.printed();
    if (std::string_view(c.wrong) == "{") { // Tcl itself cannot parse it
      EXPECT_EQ(r.get("S", "f"), before);
      continue;
    }
    ASSERT_EQ(printed.size(), 2u) << c.type;
    EXPECT_EQ(printed[0].find(std::string("can't set \"::f\": expected ")), 0u) << printed[0];
    EXPECT_NE(printed[0].find(c.reason), std::string::npos) << printed[0];
    EXPECT_EQ(printed[1], "1") << c.type;
    EXPECT_EQ(r.get("S", "f"), before) << c.type;
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 1u) << c.type;
    EXPECT_EQ(messages[0].find("6: Script S: can't set \"::out\": expected "), 0u) << messages[0];
  }
}

TEST_F(TclValues, ListsOfTuplesMayBeFlat) {
  TclWorld r(TclWorld::script("eventOut MFVec3f out eventOut MFColor none eventOut SFVec2f two",
                              "set out {0 1 2 3 4 5}\nset none {}\nlset two 1 7"));
  EXPECT_EQ(r.get("S", "out"), "[0 1 2, 3 4 5]");
  EXPECT_EQ(r.get("S", "none"), "[]");
  EXPECT_EQ(r.get("S", "two"), "0 7");
}

TEST_F(TclValues, NumbersAreShortAndExact) {
  TclWorld r(TclWorld::script(
      "field MFFloat f [0.1 3.4028235e38 1.17549435e-38 16777217 1e-45 -0] eventIn SFBool go",
      "proc go {} {puts $::f; catch {set ::f 1e39} why; puts $why; catch {set ::f Inf} why; puts "
      "$why; catch {set ::f NaN} why; puts $why}"));
  r.set("S", "go", true);
  const Log printed = r.printed();
  ASSERT_EQ(printed.size(), 4u);
  EXPECT_EQ(printed[0], "0.1 3.4028235e+38 1.1754944e-38 16777216.0 1e-45 -0.0");
  EXPECT_NE(printed[1].find("single precision"), std::string::npos);
  EXPECT_NE(printed[2].find("a number"), std::string::npos);
  EXPECT_NE(printed[3].find("a number"), std::string::npos);
}

TEST_F(TclValues, TextsAreUtf8) {
  TclWorld r(TclWorld::script("field SFString s \"\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80\" "
                              "eventOut SFString out eventOut SFString half eventOut SFString zero",
                              "puts $s\nset out [string reverse [string reverse $s]]\nset half "
                              "\\ud83d\nset zero a\\u0000b"));
  EXPECT_EQ(r.printed(), Log{"\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80"});
  EXPECT_EQ(r.get("S", "out"), "\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(r.get("S", "half"), "\xef\xbf\xbd");
  EXPECT_EQ(r.get("S", "zero"), std::string("a\0b", 3));
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(TclValues, AVariableOfAFieldCannotBeUnset) {
  TclWorld r(TclWorld::script("field SFInt32 f 3 eventIn SFBool go",
                              "proc go {} {unset ::f; puts $::f; incr ::f; puts $::f}"));
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), (Log{"3", "4"}));
  EXPECT_EQ(r.get("S", "f"), "4");
}

TEST_F(TclValues, WhatUpvarAndListCommandsWriteIsSentToo) {
  TclWorld r(TclWorld::script("eventOut MFInt32 out field MFString f [] eventIn SFBool go",
                              "proc add name {upvar 1 $name v; lappend v 5}\nproc go {} {global "
                              "out f; add out; lappend f x y}"));
  r.log("S", "out");
  r.set("S", "go", true);
  EXPECT_EQ(r.take(), Log{"0 S.out [5]"});
  EXPECT_EQ(r.get("S", "f"), "[x, y]");
}

} // namespace
} // namespace xvrml
