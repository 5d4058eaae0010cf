// native.cpp: the script engine `native` (plugins/script/native): C functions with VRML's types.
// Its functions are those of tests/script/native_library.c. Skipped if libffi is not installed.
#include <cstdlib>
#include <filesystem>

#include "conformance/events/scripted.h"
#include "xvrml/script_engines.h"

namespace xvrml {
namespace {

class Native : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XVRML_NATIVE_PATH", XVRML_TEST_NATIVE, 1);
    if (!hasScriptEngine("native", XVRML_SCRIPTS)) GTEST_SKIP() << "built without libffi";
  }
  static BrowserOptions trusting() {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.trustScripts = true;
    return options;
  }
};

// A Script with one eventIn and one eventOut of the same type: the value that it sends for a value,
// and its messages.
struct Echo {
  Echo(const std::string& type, const std::string& call, const BrowserOptions& options,
       const std::string& outType = "")
      : scripted("DEF S Script { eventIn " + type + " in eventOut " +
                     (outType.empty() ? type : outType) + " out url \"native:native_test#" + call +
                     "\" } ",
                 options) {
    scripted.log("S", "out");
  }
  std::string operator()(Value value) {
    scripted.set("S", "in", std::move(value));
    const Log sent = scripted.take();
    const Log messages = scripted.messages();
    return !messages.empty() ? messages[0]
           : sent.empty()    ? "nothing"
                             : sent[0].substr(std::string("0 S.out ").size());
  }
  Scripted scripted;
};

TEST_F(Native, NumbersGoInAndComeOut) {
  const auto options = trusting();
  EXPECT_EQ(Echo("SFFloat", "twice", options)(1.5f), "3");
  EXPECT_EQ(Echo("SFTime", "half", options)(3.0), "1.5");
  EXPECT_EQ(Echo("SFBool", "invert", options)(true), "FALSE");
  EXPECT_EQ(Echo("SFInt32", "invert", options)(int32_t(0)), "1");
  // The function half returns a double, but the declared call says float.
  EXPECT_EQ(Echo("SFFloat", "float out = half(double in)", options)(5.0f), "0");
  EXPECT_EQ(Echo("SFFloat", "double out = half(double in)", options)(5.0f), "2.5");
  EXPECT_EQ(Echo("SFInt32", "int64_t out = wide(long in, uint8_t 7)", options)(int32_t(-2)),
            "-1993");
  EXPECT_EQ(Echo("SFFloat", "in: read_double(3, double out)", options)(0.0f), "3.5");
}

TEST_F(Native, FunctionsOfTheSystemsLibraries) {
  const char* folder = "/lib/x86_64-linux-gnu";
  if (!std::filesystem::exists(std::string(folder) + "/libm.so.6"))
    GTEST_SKIP() << "no libm.so.6 there";
  setenv("XVRML_NATIVE_PATH", folder, 1);
  Scripted r("DEF S Script { eventIn SFFloat set_x eventOut SFFloat y url "
             "\"native:libm.so.6#sqrtf\" } DEF P Script { eventIn SFFloat a eventIn SFFloat b "
             "eventOut SFFloat y url \"native:libm.so.6#double y = pow(double b, double a)\" }",
             trusting());
  r.set("S", "set_x", 9.0f);
  EXPECT_EQ(r.get("S", "y"), "3");
  r.set("P", "a", 2.0f);
  r.set("P", "b", 3.0f);
  EXPECT_EQ(r.get("P", "y"), "9");
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Native, VectorsArePointers) {
  const auto options = trusting();
  EXPECT_EQ(Echo("SFVec2f", "swap2", options)(Vec2f{1, 2}), "2 1");
  EXPECT_EQ(Echo("SFVec3f", "shift3(in, float 0.5, out)", options)(Vec3f{1, 2, 3}), "1.5 2.5 3.5");
  EXPECT_EQ(Echo("SFColor", "shift3(in, float .25, &out)", options)(Color{0, 0.25f, 0.5f}),
            "0.25 0.5 0.75");
  EXPECT_EQ(Echo("SFRotation", "turn", options)(Rotation{0, 1, 0, 0.5f}), "0 1 0 1.5");
  EXPECT_EQ(Echo("SFVec3f", "length2", options, "SFFloat")(Vec3f{1, 2, 3}), "14");
}

TEST_F(Native, ListsArePointerAndCount) {
  const auto options = trusting();
  EXPECT_EQ(Echo("MFFloat", "more_floats", options)(MFFloat{5, 6}), "[5, 6, 2]");
  EXPECT_EQ(Echo("MFFloat", "more_floats", options)(MFFloat{}), "[0]");
  EXPECT_EQ(Echo("MFInt32", "more_ints(in, out)", options)(MFInt32{7}), "[7, 1]");
  EXPECT_EQ(Echo("MFTime", "more_times", options)(MFTime{0.5}), "[0.5, 1]");
  EXPECT_EQ(Echo("MFVec3f", "reverse3", options)(MFVec3f{{1, 2, 3}, {4, 5, 6}}), "[4 5 6, 1 2 3]");
  EXPECT_EQ(Echo("MFColor", "reverse3(in.data, in.count, out.data, out.count)",
                 options)(MFColor{{1, 0, 0}, {0, 1, 0}}),
            "[0 1 0, 1 0 0]");
  EXPECT_EQ(Echo("MFVec2f", "reverse2", options)(MFVec2f{{1, 2}, {3, 4}}), "[3 4, 1 2]");
  EXPECT_EQ(Echo("MFRotation", "reverse4", options)(MFRotation{{0, 0, 1, 2}, {1, 0, 0, 3}}),
            "[1 0 0 3, 0 0 1 2]");
}

TEST_F(Native, TextsPicturesAndNodes) {
  const auto options = trusting();
  Echo asked("SFString", "out = greet(in)", options);
  EXPECT_EQ(asked(std::string("you")), "hello you");
  EXPECT_EQ(asked(std::string()), "nothing"); // NULL
  EXPECT_EQ(Echo("SFString", "upper", options)(std::string("abC")), "ABC");
  EXPECT_EQ(Echo("SFString", "upper(in, out[3], uint32_t 3)", options)(std::string("abcdef")),
            "AB");
  EXPECT_EQ(Echo("MFString", "letters", options, "SFInt32")(MFString{"abc", "", "de"}), "5");
  EXPECT_EQ(Echo("SFImage", "brightness", options, "SFInt32")(Image{1, 2, 2, {1, 2, 3, 4}}), "10");
  Scripted r("DEF B Shape { } DEF C Shape { } DEF S Script { eventIn SFNode a eventIn MFNode b "
             "eventIn MFNode c eventOut SFNode x eventOut SFNode y eventOut MFNode z url "
             "\"native:native_test#a: x = same_node(a); b: last_node(b, y)\n"
             "c: all_nodes(c, z)\" }",
             options);
  const NodeRef box = r.browser.node("B"), cube = r.browser.node("C");
  r.set("S", "a", box);
  EXPECT_EQ(std::get<NodeRef>(r.browser.get(r.node("S"), "x")), box);
  r.set("S", "b", MFNode{box, cube});
  EXPECT_EQ(std::get<NodeRef>(r.browser.get(r.node("S"), "y")), cube);
  r.set("S", "c", MFNode{cube, box});
  EXPECT_EQ(std::get<MFNode>(r.browser.get(r.node("S"), "z")), (MFNode{cube, box}));
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Native, TheAnswerSaysWhetherAnEventIsSent) {
  const auto options = trusting();
  Echo solver("SFVec3f", "if solve(in, out[3])", options, "MFFloat");
  EXPECT_EQ(solver(Vec3f{1, 2, 3}), "[10, 20, 30]");
  EXPECT_EQ(solver(Vec3f{-1, 2, 3}), "nothing");
  Echo reader("SFFloat", "unless status(in, out)", options);
  EXPECT_EQ(reader(4.0f), "4");
  EXPECT_EQ(reader(-4.0f), "nothing");
}

TEST_F(Native, FieldsAreConstantsAndState) {
  Scripted r("DEF S Script { eventIn SFFloat in field SFFloat state 8 eventOut SFFloat out url "
             "\"native:native_test#in: smooth(in, &state, out)\" }",
             trusting());
  r.set("S", "in", 4.0f);
  EXPECT_EQ(r.get("S", "out"), "6");
  EXPECT_EQ(r.get("S", "state"), "6");
  r.set("S", "in", 4.0f);
  EXPECT_EQ(r.get("S", "out"), "5");
}

TEST_F(Native, InputsOfOneCascadeAreOneCall) {
  Scripted r("DEF S Script { eventIn SFVec3f v eventIn SFFloat by eventOut SFVec3f out url "
             "\"native:native_test#shift3\" } DEF F Script { eventIn SFBool go eventOut SFVec3f v "
             "eventOut SFFloat x url \"test:go: print go\" } DEF V Viewpoint { } ROUTE F.v TO S.v "
             "ROUTE F.x TO S.by",
             trusting());
  r.log("S", "out");
  r.set("S", "by", 1.0f);
  r.set("S", "v", Vec3f{1, 1, 1});
  EXPECT_EQ(r.take(), (Log{"0 S.out 1 1 1", "0 S.out 2 2 2"}));
}

TEST_F(Native, FunctionsAreFoundByTheNamesOfEvents) {
  Scripted r("DEF S Script { eventIn SFInt32 set_from field SFInt32 from 100 eventOut SFInt32 "
             "count url \"native:native_test\" }",
             trusting());
  r.log("S", "count");
  for (int i = 1; i <= 4; ++i) r.browser.tick(i);
  EXPECT_EQ(r.take(), (Log{"2 S.count 102", "4 S.count 104"}));
  r.set("S", "set_from", int32_t(1));
  EXPECT_EQ(r.take(), Log{"4 S.count 101"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Native, FunctionsGetTheHostIfTheyAskForIt) {
  Scripted r("DEF S Script { url \"native:native_test#\n initialize: hello(host, self, time)\" }",
             trusting());
  EXPECT_EQ(r.printed(), Log{"from C"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Native, WhatDoesNotFitIsSaid) {
  const auto message = [](const std::string& program) {
    Scripted r("DEF S Script { eventIn SFFloat in eventIn MFString list eventOut SFFloat out "
               "eventOut MFString texts\n url \"native:" +
                   program + "\" }",
               trusting());
    const Log all = r.messages();
    return all.empty() ? std::string() : all[0];
  };
  EXPECT_EQ(message("native_test#twise"), "3: Script S: native_test has no function 'twise'");
  EXPECT_EQ(message("native_test#\n\nin: out = twise(in)"),
            "5: Script S: native_test has no function 'twise'");
  EXPECT_EQ(message("native_test#out = twice(inn)"),
            "3: Script S: 'inn' is not a field or event of the Script");
  EXPECT_EQ(message("native_test#out = twice(in"), "3: Script S: ',' or ')' was expected");
  EXPECT_EQ(message("native_test#out = "), "3: Script S: the name of a function was expected");
  EXPECT_EQ(
      message("native_test#start: twice(in)"),
      "3: Script S: 'start:' is neither an eventIn of the Script nor initialize, poll or shutdown");
  EXPECT_EQ(message("native_test#twice(&in)"), "3: Script S: '&in': an eventIn cannot be written");
  EXPECT_EQ(
      message("native_test#twice(in, texts)"),
      "3: Script S: 'texts': a function cannot write an SFImage, MFImage or MFString; give it host "
      "and self");
  EXPECT_EQ(message("native_test#texts = twice(in)").substr(0, 50),
            "3: Script S: 'texts': a function returns SFBool, S");
  EXPECT_EQ(message("native_test#twice(double list)"),
            "3: Script S: 'list': only SFBool, SFDouble, SFFloat, SFInt32 and SFTime can have "
            "another type in C");
  EXPECT_EQ(message("native_test#out = twice(in)"), "2: Script S: native: no function takes list");
}

TEST_F(Native, AListThatIsLongerThanItsRoomIsRefused) {
  Echo liar("SFInt32", "liar", trusting(), "MFInt32");
  EXPECT_EQ(liar(int32_t(1)),
            "2: Script S: liar says that it wrote 65537 elements to out, which has room for 65536");
}

TEST_F(Native, LibrariesComeFromConfiguredFoldersOnly) {
  const auto message = [](const std::string& library) {
    Scripted r("DEF S Script { eventIn SFFloat in eventOut SFFloat out url \"native:" + library +
                   "#twice\" }",
               trusting());
    const Log all = r.messages();
    return all.empty() ? std::string() : all[0];
  };
  EXPECT_EQ(message("native_test"), "");
  EXPECT_EQ(message("libnative_test.so"), "");
  EXPECT_EQ(message("/lib/libm.so"),
            "2: Script S: native library \"/lib/libm.so\": only a bare name is allowed, no path");
  EXPECT_EQ(message("../native/native_test"),
            "2: Script S: native library \"../native/native_test\": only a bare name is allowed, "
            "no path");
  EXPECT_EQ(message("..").substr(0, 40), "2: Script S: native library \"..\": only a");
  EXPECT_EQ(message("no_such_thing").substr(0, 70),
            "2: Script S: there is no library \"no_such_thing\" in the folders of $XV");
  namespace fs = std::filesystem;
  const fs::path open = fs::path(testing::TempDir()) / "xvrml_open_to_all";
  fs::create_directories(open);
  fs::copy_file(fs::path(XVRML_TEST_NATIVE) / "libnative_test.so", open / "libopen_test.so",
                fs::copy_options::overwrite_existing);
  fs::permissions(open, fs::perms::all);
  setenv("XVRML_NATIVE_PATH", open.c_str(), 1);
  EXPECT_NE(message("open_test").find("(refused: others may write to it)"), std::string::npos);
  fs::remove_all(open);
}

TEST_F(Native, OnlyInTrustedWorlds) {
  BrowserOptions options = trusting();
  options.trustScripts = false;
  Scripted r(
      "DEF S Script { eventIn SFFloat in eventOut SFFloat out url \"native:native_test#twice\" }",
      options);
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("only in worlds that are trusted"), std::string::npos) << messages[0];
  r.set("S", "in", 1.0f);
  EXPECT_EQ(r.get("S", "out"), "0");
}

} // namespace
} // namespace xvrml
