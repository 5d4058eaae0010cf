// browser_object.cpp: the Browser object: clause 4.12.10, called by Scripts and by programs.
#include <algorithm>

#include "conformance/events/scripted.h"

namespace xvrml {
namespace {

class BrowserObject : public ScriptsSomewhere {};
XVRML_SCRIPTS_SOMEWHERE(BrowserObject);

TEST_P(BrowserObject, TellsWhatItKnows) {
  Scripted r(
      "DEF S Script { eventIn SFBool in eventOut MFString out url \"test:in: browser out\" }");
  r.browser.setFrameRate(25);
  r.set("S", "in", true);
  EXPECT_EQ(r.get("S", "out"),
            fmt::format("[{}, {}, test.wrl, 0, 25]", r.browser.name(), r.browser.version()));
  EXPECT_FALSE(r.browser.name().empty());
}

TEST_P(BrowserObject, TakesADescription) {
  Scripted r("Script { url \"test:initialize: description A world of cubes\" }");
  EXPECT_EQ(r.browser.description(), "A world of cubes");
}

TEST_P(BrowserObject, MakesNodesOfAString) {
  Scripted r("DEF G Group {} DEF S Script { eventIn SFBool in eventOut MFNode out url \"test:in: "
             "create out DEF A Transform {} DEF B Transform {} ROUTE A.translation TO "
             "B.translation\" } ROUTE S.out TO G.children");
  r.set("S", "in", true);
  EXPECT_EQ(r.get("G", "children"), "[A, B]");
  EXPECT_EQ(r.browser.node("A"), NodeRef()); // the string has a name space of its own
  const auto children = std::get<MFNode>(r.browser.get(r.node("G"), "children"));
  r.browser.set(*children[0], "translation", Vec3f{1, 2, 3});
  EXPECT_EQ(textOf(r.browser.get(*children[1], "translation")), "1 2 3"); // its routes are active
}

TEST_P(BrowserObject, PrototypesAndBehaviourOfAStringAreAlive) {
  Running r("DEF G Group {}");
  const MFNode nodes = r.browser.createVrmlFromString(
      "PROTO P [ exposedField SFVec3f at 0 0 0 eventOut SFTime beat ] { Transform { translation IS "
      "at } DEF C TimeSensor { loop TRUE time IS beat } } DEF I P { at 5 0 0 } DEF T Transform {} "
      "ROUTE I.at TO T.translation");
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(textOf(renderedNode(nodes[0].get())
                       ->get(*renderedNode(nodes[0].get())->type().find("translation"))),
            "5 0 0");
  std::vector<double> beats;
  r.browser.listen(*nodes[0], "beat", [&](Node&, const FieldInfo&, const Value& value) {
    beats.push_back(std::get<double>(value));
  });
  r.browser.tick(3);
  EXPECT_EQ(beats, std::vector<double>{3});
  r.browser.set(*nodes[0], "set_at", Vec3f{7, 0, 0});
  EXPECT_EQ(textOf(r.browser.get(*nodes[1], "translation")), "7 0 0");
}

TEST_P(BrowserObject, AStringThatIsWrongIsToldWithItsPlace) {
  Running r("Group {}");
  const MFNode nodes = r.browser.createVrmlFromString("Group {}\nGrup {}");
  EXPECT_EQ(nodes.size(), 1u);
  ASSERT_EQ(r.browser.world().diagnostics.errors(), 1u);
  const Diagnostic& d = r.browser.world().diagnostics.list().back();
  EXPECT_EQ(d.file, "test.wrl (createVrmlFromString)");
  EXPECT_EQ(d.line, 2u);
  EXPECT_EQ(r.browser.createVrmlFromString("").size(), 0u);
}

TEST_P(BrowserObject, NodesOfAStringGoWhenNobodyHoldsThem) {
  Scripted r("DEF G Group {}");
  const std::string text =
      "PROTO P [ eventOut SFTime beat ] { TimeSensor { loop TRUE time IS beat } Script { url "
      "\"test:shutdown: print gone\" } } DEF I P {} DEF S Script { eventIn SFTime in url "
      "\"test:in: print beat\nshutdown: print end\" } ROUTE I.beat TO S.in";
  r.set("G", "children", r.browser.createVrmlFromString(text));
  r.browser.tick(1);
  EXPECT_EQ(r.printed(), Log{"beat"});
  r.set("G", "children", MFNode{});
  Log gone = r.printed();
  std::sort(gone.begin(), gone.end());
  EXPECT_EQ(gone, (Log{"end", "gone"}));
  r.browser.tick(2);
  EXPECT_EQ(r.printed(), Log{});
}

TEST_P(BrowserObject, ALongChainOfRoutesEndsWithoutRecursion) {
  Running r("DEF G Group {}");
  std::string text;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    text += fmt::format("DEF T{} Transform {{}}\n", i);
    if (i > 0) text += fmt::format("ROUTE T{}.translation TO T{}.translation\n", i - 1, i);
  }
  MFNode nodes = r.browser.createVrmlFromString(text);
  ASSERT_EQ(nodes.size(), size_t(n));
  NodeRef first = nodes[0];
  const NodeRef last = nodes.back();
  nodes.clear(); // the remaining nodes are held by routes only
  r.browser.set(*first, "translation", Vec3f{1, 0, 0});
  EXPECT_EQ(textOf(r.browser.get(*last, "translation")), "1 0 0");
  r.browser.takeChanges();
  first = {};
  EXPECT_TRUE(last->live);
}

TEST_P(BrowserObject, ReadsNodesFromAFile) {
  Scripted r("DEF G Group {} DEF S Script { field SFNode to USE G eventIn SFBool in url \"test:in: "
             "fromUrl to set_children tests/conformance/good/def-use.wrl\" }");
  r.log("G", "children");
  r.set("S", "in", true);
  ASSERT_EQ(r.take().size(), 1u);
  EXPECT_EQ(r.messages(), Log{});
  r.browser.createVrmlFromUrl({"absent.wrl", "urn:x"}, r.node("G"), "children");
  ASSERT_EQ(r.messages().size(), 1u);
}

TEST_P(BrowserObject, AnotherWorldTakesThePlaceOfThisOne) {
  Scripted r("DEF V Viewpoint {} Script { url \"test:shutdown: print old\" } DEF S Script { "
             "eventIn SFBool in url \"test:in: load tests/conformance/good/def-use.wrl\" }");
  const uint64_t generation = r.browser.generation();
  r.set("S", "in", true);
  EXPECT_EQ(r.browser.generation(), generation + 1);
  EXPECT_EQ(r.printed(), Log{"old"});
  EXPECT_EQ(r.browser.node("V"), NodeRef());
  EXPECT_EQ(r.browser.worldUrl(), "tests/conformance/good/def-use.wrl");
  EXPECT_TRUE(r.browser.takeChanges().empty());
  EXPECT_FALSE(r.browser.bound().viewpoint);
  r.browser.tick(1);
}

TEST_P(BrowserObject, AnApplicationMayLoadItself) {
  BrowserOptions options;
  std::vector<std::string> asked;
  options.loadUrl = [&](const std::vector<std::string>& urls,
                        const std::vector<std::string>& parameters, const std::string& base) {
    EXPECT_EQ(base, "test.wrl");
    asked = urls;
    asked.insert(asked.end(), parameters.begin(), parameters.end());
    return true;
  };
  Scripted r("Script { url \"test:initialize: load other.wrl target=left\" }", options);
  EXPECT_EQ(asked, (std::vector<std::string>{"other.wrl", "target=left"}));
  EXPECT_EQ(r.browser.generation(), 1u);
}

TEST_P(BrowserObject, AFragmentAloneBindsAViewpoint) {
  Running r("DEF A Viewpoint {} DEF B Viewpoint {}");
  r.browser.loadUrl({"#B"});
  EXPECT_EQ(r.browser.bound().viewpoint, r.browser.node("B").get());
  r.browser.loadUrl({"#C"});
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 1u);
  EXPECT_EQ(r.browser.generation(), 1u);
}

TEST_P(BrowserObject, AWorldThatCannotBeReadChangesNothing) {
  Running r("DEF A Group {}");
  r.browser.loadUrl({"absent.wrl"});
  EXPECT_EQ(r.browser.generation(), 1u);
  EXPECT_TRUE(r.browser.node("A"));
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 1u);
}

TEST_P(BrowserObject, ReplaceWorldKeepsNodesTheirRoutesAndTheirScripts) {
  Scripted r("DEF S Script { url \"test:shutdown: print old\" eventIn MFNode in }");
  const MFNode nodes = r.browser.createVrmlFromString(
      "DEF V Viewpoint {} DEF A Transform {} DEF B Transform {} Script { url \"test:initialize: "
      "print new\nshutdown: print no\" } ROUTE A.translation TO B.translation");
  EXPECT_EQ(r.printed(), Log{"new"});
  r.browser.replaceWorld(nodes);
  EXPECT_EQ(r.printed(), Log{"old"});
  EXPECT_EQ(r.browser.world().scope.roots.size(), 4u);
  EXPECT_EQ(r.browser.bound().viewpoint, nodes[0].get());
  r.browser.set(*nodes[1], "translation", Vec3f{4, 0, 0});
  EXPECT_EQ(textOf(r.browser.get(*nodes[2], "translation")), "4 0 0");
}

TEST_P(BrowserObject, AScriptReplacesTheWorldItIsIn) {
  Scripted r("DEF S Script { eventIn MFNode in url \"test:in: replace\nshutdown: print end\" }");
  r.set("S", "in", MFNode{r.browser.createVrmlFromString("DEF N Group {}")});
  EXPECT_EQ(r.printed(), Log{"end"});
  EXPECT_EQ(r.browser.world().scope.roots.size(), 1u);
}

TEST_P(BrowserObject, AWorldThatReplacesItselfForEverDoesNotHang) {
  Scripted r(
      "Script { url \"test:initialize: load tests/conformance/good/script-loads-itself.wrl\" }");
  const uint64_t generation = r.browser.generation();
  r.browser.tick(1);
  EXPECT_LE(r.browser.generation(), generation + 2);
}

} // namespace
} // namespace xvrml
