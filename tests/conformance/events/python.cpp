// python.cpp: the script engine `python` (plugins/script/python) in a program that does not embed
// Python itself: values of all types, nodes, errors with their lines, programs that do not end.
// Skipped if Python cannot be embedded.
#include <filesystem>
#include <fstream>

#include "conformance/events/scripted.h"
#include "xvrml/script_engines.h"

namespace xvrml {
namespace {

class Python : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasScriptEngine("python", XVRML_SCRIPTS)) GTEST_SKIP() << "built without Python";
  }
  static BrowserOptions trusting() {
    BrowserOptions options;
    options.scriptPath = XVRML_SCRIPTS;
    options.trustScripts = true;
    return options;
  }
};

// Returns what a Script sends on `out` for a value on `in`, or its first message.
std::string echo(const std::string& type, const std::string& program, Value value,
                 const BrowserOptions& options, const std::string& outType = "") {
  Scripted r("DEF S Script { eventIn " + type + " in_ eventOut " +
                 (outType.empty() ? type : outType) + " out\n url \"python:" + program + "\" }",
             options);
  r.log("S", "out");
  r.set("S", "in_", std::move(value));
  const Log sent = r.take(), messages = r.messages();
  return !messages.empty() ? messages[0]
         : sent.empty()    ? "nothing"
                           : sent[0].substr(std::string("0 S.out ").size());
}

const std::string assigns = "\ndef in_(value, timestamp):\n    script.out = value";

TEST_F(Python, EveryTypeGoesInAndComesOut) {
  const auto same = [](const char* type, Value value) {
    return echo(type, assigns, std::move(value), trusting());
  };
  EXPECT_EQ(same("SFBool", true), "TRUE");
  EXPECT_EQ(same("SFFloat", 0.5f), "0.5");
  EXPECT_EQ(same("SFInt32", int32_t(-7)), "-7");
  EXPECT_EQ(same("SFTime", 1.25), "1.25");
  EXPECT_EQ(same("SFString", std::string("gr\xc3\xbc\xc3\x9f")), "gr\xc3\xbc\xc3\x9f");
  EXPECT_EQ(same("SFVec2f", Vec2f{1, 2}), "1 2");
  EXPECT_EQ(same("SFVec3f", Vec3f{1, 2, 3}), "1 2 3");
  EXPECT_EQ(same("SFColor", Color{0, 0.5f, 1}), "0 0.5 1");
  EXPECT_EQ(same("SFRotation", Rotation{0, 1, 0, 2}), "0 1 0 2");
  EXPECT_EQ(same("MFFloat", MFFloat{1, 2.5f}), "[1, 2.5]");
  EXPECT_EQ(same("MFFloat", MFFloat{}), "[]");
  EXPECT_EQ(same("MFInt32", MFInt32{1, -2}), "[1, -2]");
  EXPECT_EQ(same("MFTime", MFTime{1, 2.5}), "[1, 2.5]");
  EXPECT_EQ(same("MFString", MFString{"a", ""}), same("MFString", MFString{"a", ""}));
  EXPECT_EQ(same("MFVec2f", MFVec2f{{1, 2}, {3, 4}}), "[1 2, 3 4]");
  EXPECT_EQ(same("MFVec3f", MFVec3f{{1, 2, 3}, {4, 5, 6}}), "[1 2 3, 4 5 6]");
  EXPECT_EQ(same("MFVec3f", MFVec3f{}), "[]");
  EXPECT_EQ(same("MFColor", MFColor{{1, 0, 0}}), "[1 0 0]");
  EXPECT_EQ(same("MFRotation", MFRotation{{1, 0, 0, 3}}), "[1 0 0 3]");
  EXPECT_EQ(same("MFBool", MFBool{true, false}), "[TRUE, FALSE]");
  EXPECT_EQ(same("SFDouble", Double{0.5}), "0.5");
  EXPECT_EQ(same("MFDouble", MFDouble{{1e300}, {2.5}}), "[1.0000000000000001e+300, 2.5]");
  EXPECT_EQ(same("SFColorRGBA", ColorRGBA{0, 0.5f, 1, 0.25f}), "0 0.5 1 0.25");
  EXPECT_EQ(same("MFColorRGBA", MFColorRGBA{{0, 0.5f, 1, 0.25f}}), "[0 0.5 1 0.25]");
  EXPECT_EQ(same("SFVec2d", Vec2d{1, 2}), "1 2");
  EXPECT_EQ(same("SFVec3d", Vec3d{1, 2, 1e100}), "1 2 1e+100");
  EXPECT_EQ(same("SFVec4d", Vec4d{1, 2, 3, 4}), "1 2 3 4");
  EXPECT_EQ(same("SFVec4f", Vec4f{1, 2, 3, 4}), "1 2 3 4");
  EXPECT_EQ(same("MFVec4f", MFVec4f{{1, 2, 3, 4}, {5, 6, 7, 8}}), "[1 2 3 4, 5 6 7 8]");
  EXPECT_EQ(same("SFMatrix3d", SFMatrix3d()), "1 0 0 0 1 0 0 0 1");
  EXPECT_EQ(same("SFMatrix3f", Matrix3f()), "1 0 0 0 1 0 0 0 1");
  EXPECT_EQ(same("MFMatrix3f", MFMatrix3f(1)), "[1 0 0 0 1 0 0 0 1]");
  EXPECT_EQ(same("SFMatrix4f", SFMatrix4f()), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
}

TEST_F(Python, ListsTuplesAndArraysAreTaken) {
  const auto gives = [](const char* type, const char* what) {
    return echo("SFBool", std::string("\ndef in_(value): script.out = ") + what, true, trusting(),
                type);
  };
  EXPECT_EQ(gives("SFVec3f", "[1, 2, 3.5]"), "1 2 3.5");
  EXPECT_EQ(gives("MFVec3f", "[(1, 2, 3), [4, 5, 6]]"), "[1 2 3, 4 5 6]");
  EXPECT_EQ(gives("MFInt32", "range(3)"), "[0, 1, 2]");
  EXPECT_EQ(gives("MFFloat", "[i / 2 for i in range(3)]"), "[0, 0.5, 1]");
  EXPECT_EQ(gives("MFString", "('a', 'b')"), gives("MFString", "['a', 'b']"));
  EXPECT_EQ(gives("SFVec3f", "(1, 2)"),
            "4: Script S: ValueError: out (SFVec3f): 3 numbers expected, not 2");
  EXPECT_EQ(gives("SFMatrix3f", "(1, 2)"),
            "4: Script S: ValueError: out (SFMatrix3f): 9 numbers expected, not 2");
  EXPECT_EQ(gives("MFBool", "[True, 1]"),
            "4: Script S: TypeError: out (MFBool): a sequence of True and False expected, not int");
  EXPECT_EQ(gives("SFVec3d", "(1e300, 0, 0)"), "1.0000000000000001e+300 0 0");
  EXPECT_EQ(gives("SFVec3f", "'no'"),
            "4: Script S: TypeError: out (SFVec3f): 3 numbers expected, not str");
  EXPECT_EQ(gives("SFFloat", "True"),
            "4: Script S: TypeError: out (SFFloat): a number expected, not bool");
  EXPECT_EQ(gives("SFFloat", "float('nan')"),
            "4: Script S: ValueError: out (SFFloat): a number expected, not infinity or NaN");
  EXPECT_EQ(gives("SFFloat", "1e300"), "4: Script S: ValueError: out (SFFloat): a number expected, "
                                       "within the range of 32 bit floats");
  EXPECT_EQ(
      gives("SFInt32", "2**31"),
      "4: Script S: ValueError: out (SFInt32): a whole number of 32 bits expected, not 2147483648");
  EXPECT_EQ(gives("SFInt32", "1.0"),
            "4: Script S: TypeError: out (SFInt32): a whole number of 32 bits expected, not float");
  EXPECT_EQ(gives("SFBool", "1"),
            "4: Script S: TypeError: out (SFBool): True or False expected, not int");
  EXPECT_EQ(gives("MFString", "'text'"),
            "4: Script S: TypeError: out (MFString): a sequence of str expected, not str");
  EXPECT_EQ(gives("SFNode", "3"), "4: Script S: TypeError: a Node or None expected, not int");
}

TEST_F(Python, WithNumpyListsOfNumbersAreReadOnlyArrays) {
  const std::string program =
      "\ndef in_(value):\n    try:\n        import numpy\n    except ImportError:\n"
      "        script.out = 'no numpy'\n        return\n"
      "    script.out = '%s %s %s' % (value.shape, value.dtype, value.flags.writeable)";
  const std::string got = echo("MFVec3f", program, MFVec3f{{1, 2, 3}}, trusting(), "SFString");
  if (got == "no numpy") GTEST_SKIP() << got;
  EXPECT_EQ(got, "(1, 3) float32 False");
  EXPECT_EQ(echo("MFInt32", program, MFInt32{1, 2}, trusting(), "SFString"), "(2,) int32 False");
  EXPECT_EQ(echo("MFTime", program, MFTime{1, 2}, trusting(), "SFString"), "(2,) float64 False");
  EXPECT_EQ(echo("MFVec3f", "\ndef in_(value): script.out = value * 2 + 1", MFVec3f{{1, 2, 3}},
                 trusting()),
            "[3 5 7]");
  EXPECT_EQ(echo("MFFloat", "\nimport numpy\ndef in_(value): script.out = numpy.arange(6)[::2]",
                 MFFloat{}, trusting()),
            "[0, 2, 4]");
  Scripted r("DEF S Script { eventIn SFImage in_ eventOut SFImage out url \"python:\ndef "
             "in_(value): script.out = value[::-1]\" }",
             trusting());
  r.set("S", "in_", Image{1, 2, 2, {1, 2, 3, 4}});
  EXPECT_EQ(std::get<Image>(r.browser.get(r.node("S"), "out")).pixels,
            (std::vector<uint8_t>{3, 4, 1, 2}));
  EXPECT_EQ(r.messages(), Log{});
}

// The classes have the names that numpy's have, so that the test needs no version of numpy.
TEST_F(Python, TruthValuesOfNumpyAreTakenByTheirNamesBeforeAndSinceVersion2) {
  const auto gives = [](const std::string& module, const std::string& name, const char* value) {
    return echo("SFBool",
                "\ndef in_(value): script.out = type('" + name + "', (), {'__module__': '" +
                    module + "', '__bool__': lambda self: " + value + "})()",
                true, trusting());
  };
  for (const char* name : {"bool_", "bool"}) {
    EXPECT_EQ(gives("numpy", name, "True"), "TRUE");
    EXPECT_EQ(gives("numpy", name, "False"), "FALSE");
  }
  EXPECT_EQ(gives("elsewhere", "bool", "True"),
            "4: Script S: TypeError: out (SFBool): True or False expected, not bool");
  EXPECT_EQ(gives("numpy", "int64", "True"),
            "4: Script S: TypeError: out (SFBool): True or False expected, not int64");
}

TEST_F(Python, FieldsAreAttributes) {
  Scripted r("DEF S Script { eventIn SFInt32 add field SFInt32 sum 10 eventOut SFInt32 out field "
             "MFString words [ \"a\" \"b\" ]\n"
             "url \"python:\n"
             "    def add(value):\n"
             "        script.sum += value\n"
             "        script.out = script.sum\n"
             "        print(script.words, script.out, dir(script), sep=';')\n"
             "\" }",
             trusting());
  r.set("S", "add", int32_t(3));
  r.set("S", "add", int32_t(4));
  EXPECT_EQ(r.get("S", "sum"), "17");
  EXPECT_EQ(r.get("S", "out"), "17");
  EXPECT_EQ(r.printed(), (Log{"('a', 'b');13;['out', 'sum', 'words']",
                              "('a', 'b');17;['out', 'sum', 'words']"}));
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Python, FunctionsAreCalledAsTheStandardSays) {
  Scripted r("DEF C TimeSensor { loop TRUE } DEF S Script { eventIn SFTime tick eventOut SFTime "
             "out url \"python:print('module')\n"
             "def initialize(): print('initialize')\ndef tick(value, timestamp): print('tick', "
             "value == timestamp)\n"
             "def eventsProcessed(): print('processed')\ndef shutdown(): print('shutdown')\" } "
             "ROUTE C.time TO S.tick",
             trusting());
  EXPECT_EQ(r.printed(), (Log{"module", "initialize"}));
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), (Log{"tick True", "processed"}));
  r.browser.replaceWorld({});
  EXPECT_EQ(r.printed(), Log{"shutdown"});
  EXPECT_EQ(r.messages(), Log{});
}

TEST_F(Python, NodesAreThoseOfTheBinding) {
  Scripted r("DEF T Transform { translation 1 2 3 children DEF G Shape { } } DEF S Script { "
             "directOutput TRUE eventIn SFNode in_ field SFNode t USE T eventOut SFNode out "
             "eventOut MFNode all eventOut SFBool same eventOut SFVec3f was\n"
             "url \"python:\n"
             "import xvrml\n"
             "def in_(node):\n"
             "    assert isinstance(node, xvrml.Node)\n"
             "    script.same = node == script.t and hash(node) == hash(script.t) and node != "
             "node.children[0]\n"
             "    script.out = node.children[0]\n"
             "    script.all = [node, script.t.children[0], script]\n"
             "    node.translation = (4, 5, 6)\n"
             "    node.set_scale = 2, 2, 2\n"
             "    script.was = node.translation\n"
             "    print(node.node_type, node.def_name)\n\" }",
             trusting());
  const NodeRef t = r.browser.node("T"), g = r.browser.node("G"), s = r.browser.node("S");
  r.set("S", "in_", t);
  EXPECT_EQ(r.messages(), Log{});
  EXPECT_EQ(r.get("S", "same"), "TRUE");
  EXPECT_EQ(std::get<NodeRef>(r.browser.get(*s, "out")), g);
  EXPECT_EQ(std::get<MFNode>(r.browser.get(*s, "all")), (MFNode{t, g, s}));
  EXPECT_EQ(r.get("S", "was"), "1 2 3"); // assigned values are sent when the function returns
  EXPECT_EQ(r.get("T", "translation"), "4 5 6");
  EXPECT_EQ(r.get("T", "scale"), "2 2 2");
  EXPECT_EQ(r.printed(), Log{"Transform T"});
}

TEST_F(Python, ThreadsOfAScriptCannotChangeNodes) {
  Scripted r(
      "DEF T Transform { } DEF S Script { directOutput TRUE eventIn SFBool go field SFNode t USE "
      "T\n"
      "url \"python:\nimport threading\ndef go(v):\n    t, said = script.t, []\n    def work():\n"
      "        for f in (lambda: setattr(t, 'scale', (2, 2, 2)), lambda: script.t):\n            "
      "try: f()\n"
      "            except ValueError as e: said.append(str(e))\n"
      "    thread = threading.Thread(target=work)\n    thread.start()\n    thread.join()\n    "
      "print(*said, sep='; ')\" }",
      trusting());
  r.set("S", "go", true);
  EXPECT_EQ(r.printed(), Log{"only the functions of a Script can change nodes here, on the thread "
                             "on which they are called; no function of this Script is running"});
  EXPECT_EQ(r.get("T", "scale"), "1 1 1");
}

TEST_F(Python, EventsToOtherNodesNeedDirectOutput) {
  Scripted r("DEF T Transform { } DEF S Script { eventIn SFBool go field SFNode t USE T\n"
             "url \"python:\ndef go(v):\n    script.t.translation = 1, 1, 1\" }",
             trusting());
  r.set("S", "go", true);
  EXPECT_EQ(r.get("T", "translation"), "0 0 0");
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[1],
            "5: Script S: PermissionError: an event to another node needs directOutput TRUE");
}

TEST_F(Python, TheBrowserObject) {
  Scripted r(
      "DEF T Transform { } DEF B Transform { } DEF S Script { directOutput TRUE eventIn SFBool go "
      "field SFNode t USE T field SFNode b USE B eventIn MFNode made eventOut SFVec3f out\n"
      "url \"python:\n"
      "def go(v):\n"
      "    print(browser.name, browser.world_url, browser.now, browser.current_speed, "
      "browser.current_frame_rate)\n"
      "    browser.set_description('hello')\n"
      "    browser.add_route(script.t, 'translation_changed', script.b, 'set_translation')\n"
      "    nodes = browser.create_vrml_from_string('DEF New Transform { scale 2 2 2 }')\n"
      "    print(len(nodes), nodes[0].scale)\n"
      "    script.t.children = nodes\n"
      "    browser.add_route(script, 'out', nodes[0], 'translation')\n"
      "    script.t.translation = 7, 8, 9\n"
      "    script.out = 1, 1, 1\n"
      "def made(nodes): print('made', len(nodes))\n\" }",
      trusting());
  r.set("S", "go", true);
  EXPECT_EQ(r.messages(), Log{});
  EXPECT_EQ(r.printed(), (Log{"OpenRT XVRML test.wrl 0.0 0.0 0.0", "1 (2.0, 2.0, 2.0)"}));
  EXPECT_EQ(r.browser.description(), "hello");
  EXPECT_EQ(r.get("B", "translation"), "7 8 9");
  const auto children = std::get<MFNode>(r.browser.get(r.node("T"), "children"));
  ASSERT_EQ(children.size(), 1u);
  EXPECT_EQ(textOf(r.browser.get(*children[0], "translation")), "1 1 1");
}

TEST_F(Python, ErrorsHaveTheWorldsLine) {
  const auto message = [](const std::string& program) {
    Scripted r("DEF S Script { eventIn SFBool go url \"python:" + program + "\" }", trusting());
    r.set("S", "go", true);
    const Log all = r.messages();
    return all.empty() ? std::string() : all[0];
  };
  EXPECT_EQ(message("\n\nx ="), "4: Script S: SyntaxError: invalid syntax");
  EXPECT_EQ(message("\nx = 1 / 0"), "3: Script S: ZeroDivisionError: division by zero");
  EXPECT_EQ(message("\ndef f():\n    raise KeyError('k')\ndef go(v):\n    f()"),
            "4: Script S: KeyError: 'k'");
  EXPECT_EQ(message("\ndef go(v):\n    script.nothing = 3"),
            "4: Script S: AttributeError: the Script has no field or eventOut nothing");
  EXPECT_EQ(message("\nimport json\ndef go(v):\n    json.loads('{')").substr(0, 40),
            "5: Script S: JSONDecodeError: Expecting ");
  EXPECT_EQ(message("import no_such_module_at_all"),
            "2: Script S: ModuleNotFoundError: No module named 'no_such_module_at_all'");
  EXPECT_EQ(message("\ndef go(v):\n  def f(): f()\n  f()").substr(0, 30),
            "4: Script S: RecursionError: m");
}

TEST_F(Python, AScriptThatFailsGoesOn) {
  Scripted r("DEF S Script { eventIn SFInt32 in_ eventOut SFInt32 out url \"python:\ndef in_(v): "
             "script.out = 10 // v\" }",
             trusting());
  r.set("S", "in_", int32_t(0));
  r.set("S", "in_", int32_t(5));
  EXPECT_EQ(r.get("S", "out"), "2");
}

TEST_F(Python, AnEndlessLoopIsStoppedWhateverItCatches) {
  BrowserOptions options = trusting();
  options.scriptSeconds = 0.2;
  for (const char* loop :
       {"while True: pass",
        "while True:\n        try:\n            x = 1\n        except Exception: pass",
        "while True:\n        try:\n            while True:\n                x = 1\n        "
        "except: pass",
        "while True:\n        try: x = 1\n        except BaseException: pass\n        finally: y = "
        "2",
        "def f():\n        try: f()\n        except: f()\n    f()"}) {
    Scripted r("DEF S Script { eventIn SFBool go eventOut SFBool out\n"
               "url \"python:\ndef go(v):\n    script.out = v\n    " +
                   std::string(loop) +
                   "\" } DEF T Script { eventIn SFBool go eventOut SFBool out url \"python:def "
                   "go(v): script.out = v\" }",
               options);
    r.set("S", "go", true);
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 2u) << loop;
    EXPECT_NE(messages[0].find("stopped here"), std::string::npos) << messages[0];
    EXPECT_GT(std::stoi(messages[0]), 3); // a line of the program
    EXPECT_EQ(messages[1], "3: Script S: event took too long: the Script is stopped");
    EXPECT_EQ(r.get("S", "out"), "FALSE"); // the event that it sent is discarded
    r.set("S", "go", true);                // it receives no more events
    r.set("T", "go", true);
    EXPECT_EQ(r.get("T", "out"), "TRUE"); // the world continues
    EXPECT_EQ(r.messages(), Log{});
  }
}

TEST_F(Python, MemoryIsLimited) {
  BrowserOptions options = trusting();
  options.scriptMemory = 64 << 20;
  options.scriptSeconds = 60;
  for (const char* bomb : {"x = 'a' * 10**9", "x = []\n    while True: x.append(bytearray(10**6))",
                           "x = [0]\n    while True: x = [x, x]", "x = [0] * 10**12"}) {
    Scripted r("DEF S Script { eventIn SFBool go eventIn SFBool again eventOut SFBool out url "
               "\"python:\ndef go(v):\n    " +
                   std::string(bomb) + "\ndef again(v):\n    script.out = v\" }",
               options);
    r.set("S", "go", true);
    const Log messages = r.messages();
    ASSERT_EQ(messages.size(), 1u) << bomb;
    EXPECT_NE(messages[0].find("MemoryError (a Script may use 64 MiB)"), std::string::npos)
        << messages[0];
    r.set("S", "again", true);
    EXPECT_EQ(r.get("S", "out"), "TRUE");
  }
}

TEST_F(Python, SysExitEndsTheScriptAlone) {
  Scripted r("DEF S Script { eventIn SFBool go eventOut SFBool out url \"python:\nimport sys\ndef "
             "go(v):\n    script.out = v\n"
             "    sys.exit('done')\" }",
             trusting());
  r.log("S", "out");
  r.set("S", "go", true);
  r.set("S", "go", false);
  EXPECT_EQ(r.take(), Log{"0 S.out TRUE"});
  EXPECT_EQ(r.messages(), Log{"6: Script S: the Script has ended itself (SystemExit: done)"});
}

TEST_F(Python, ProgramsOfFilesHaveTheirOwnLinesAndModules) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "xvrml_python_files";
  fs::create_directories(folder);
  std::ofstream(folder / "own.py") << "import xvrml_test_helper\ndef go(v):\n    script.out = "
                                      "xvrml_test_helper.answer\n    nothing\n";
  std::ofstream(folder / "xvrml_test_helper.py")
      << "answer = open(__file__).read().count('a')\n"; // reading files is allowed
  BrowserOptions options = trusting();
  Browser browser(
      loadWorldFromMemory(
          "#VRML V2.0 utf8\nDEF S Script { eventIn SFBool go eventOut SFInt32 out url \"own.py\" }",
          (folder / "world.wrl").string()),
      options);
  browser.set(*browser.node("S"), "go", true);
  EXPECT_EQ(textOf(browser.get(*browser.node("S"), "out")), "3");
  const auto& list = browser.world().diagnostics.list();
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].line, 4u);
  EXPECT_EQ(fs::path(list[0].file).filename(), "own.py");
  EXPECT_EQ(list[0].message, "Script S: NameError: name 'nothing' is not defined");
  fs::remove_all(folder);
}

TEST_F(Python, OnlyInTrustedWorlds) {
  BrowserOptions options = trusting();
  options.trustScripts = false;
  Scripted r("DEF S Script { url \"python:print('never')\" }", options);
  EXPECT_EQ(r.printed(), Log{});
  const Log messages = r.messages();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages[0].find("only in worlds that are trusted"), std::string::npos) << messages[0];
}

TEST_F(Python, ObjectsOfAScriptThatHasEndedSaySo) {
  Scripted r("DEF S Script { eventIn SFBool go url \"python:import builtins\nbuiltins.kept_script "
             "= script\" } DEF T Script { eventIn SFBool go url \"python:\ndef go(v):\n    try: "
             "kept_script.x\n"
             "    except ValueError as e: print(e)\" }",
             trusting());
  r.set("T", "go", true);
  EXPECT_EQ(r.printed(), Log{"no function of this Script is running"});
  r.set("S", "url", MFString{"python:pass"});
  r.set("T", "go", true);
  EXPECT_EQ(r.printed(), Log{"the Script has ended"});
}

} // namespace
} // namespace xvrml
