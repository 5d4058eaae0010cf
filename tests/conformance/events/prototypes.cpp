// prototypes.cpp: prototypes of a running world: clauses 4.8 and 4.9.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "conformance/events/scripted.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

std::string translationOf(Node& node) {
  Node* drawn = renderedNode(&node);
  return textOf(drawn->get(*drawn->type().find("translation")));
}

TEST(Prototypes, FiveDeepWithRoutes) {
  std::string text = "PROTO P1 [ exposedField SFVec3f at 0 0 0 ] { DEF A Transform {} DEF T "
                     "Transform { translation IS at } ROUTE T.translation TO A.translation }";
  for (int i = 2; i <= 5; ++i)
    text += fmt::format(" PROTO P{0} [ exposedField SFVec3f at {0} 0 0 ] {{ DEF I P{1} {{ at IS at "
                        "}} DEF X Transform {{}} ROUTE I.at_changed TO X.translation }}",
                        i, i - 1);
  Running r(text +
            " DEF I P5 {} DEF J P5 { at 9 0 0 } DEF B Transform {} ROUTE I.at TO B.translation");
  EXPECT_EQ(r.get("I", "at"), "5 0 0");
  r.log("I", "at");
  r.set("I", "set_at", Vec3f{1, 2, 3});
  EXPECT_EQ(r.take(), Log{"0 I.at 1 2 3"});
  EXPECT_EQ(translationOf(r.node("I")), "1 2 3");
  EXPECT_EQ(r.get("B", "translation"), "1 2 3");
  EXPECT_EQ(r.get("J", "at"), "9 0 0"); // it has a copy of its own
}

// Events bring URLs into bodies as values of the file do: relative to the file of the instance
// (4.5.3). The body is in another folder; P is an instance within an instance.
class UrlEvents : public testing::Test {
 protected:
  UrlEvents()
      : folder(std::filesystem::temp_directory_path() /
               fmt::format("xvrml_url_events_{}_{}", ::getpid(),
                           testing::UnitTest::GetInstance()->current_test_info()->name())) {
    write("lib/p.wrl",
          "PROTO P [ exposedField MFString u \"p.png\" eventIn MFString in ] { Anchor { "
          "url IS u set_url IS in } }");
    write("deep/q.wrl", "EXTERNPROTO P [ exposedField MFString u eventIn MFString in ] "
                        "\"../lib/p.wrl\" PROTO Q [ exposedField MFString u \"q.png\" eventIn "
                        "MFString in ] { P { u IS u in IS in } }");
    browser.emplace(loadWorld(write("worlds/w.wrl",
                                    "EXTERNPROTO Q [ exposedField MFString u eventIn MFString in ] "
                                    "\"../deep/q.wrl\" DEF A Q { u \"a.png\" } DEF B Q { }")));
  }
  ~UrlEvents() override { std::filesystem::remove_all(folder); }
  std::string write(const std::string& name, const std::string& vrml) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << "#VRML V2.0 utf8\n" << vrml;
    return folder / name;
  }
  Node& node(const char* name) { return *browser->world().scope.names.at(name); }
  MFString u(const char* name) { return std::get<MFString>(browser->get(node(name), "u")); }
  // Returns the file that the Anchor of the instance leads to, relative to the test's folder.
  std::string file(const char* name) {
    const auto& last = dynamic_cast<const nodes::Anchor&>(anchor(name));
    const std::string path = resolveUrl(last.url.at(0), *last.source.file, {}).path;
    return std::filesystem::relative(path, folder).string();
  }
  Node& anchor(const char* name) { return *renderedNode(&node(name)); }

  const std::filesystem::path folder;
  std::optional<Browser> browser;
};

TEST_F(UrlEvents, CountFromTheFileOfTheInstance) {
  EXPECT_EQ(file("A"), "worlds/a.png");
  EXPECT_EQ(file("B"), "deep/q.png");
  browser->set(node("A"), "u", MFString{"b.png"});
  EXPECT_EQ(file("A"), "worlds/b.png");
  EXPECT_EQ(u("A"), MFString{"b.png"});
  browser->set(node("B"), "in", MFString{"c.png"});
  EXPECT_EQ(file("B"), "worlds/c.png");
}

TEST_F(UrlEvents, AValueThatAFieldHasAlreadyChangesNothing) {
  for (const char* name : {"A", "B"}) {
    const std::string before = file(name);
    const MFString value = u(name);
    browser->set(node(name), "u", value);
    EXPECT_EQ(file(name), before);
    EXPECT_EQ(u(name), value);
  }
}

TEST_F(UrlEvents, LeaveTheBodyRelativeToTheFileOfTheInstance) {
  browser->set(anchor("A"), "url", MFString{"in_body.png"});
  EXPECT_EQ(file("A"), "lib/in_body.png");
  const std::string path = resolveUrl(u("A").at(0), *node("A").source.file, {}).path;
  EXPECT_EQ(std::filesystem::relative(path, folder).string(), "lib/in_body.png");
  browser->set(node("A"), "u", u("A"));
  EXPECT_EQ(file("A"), "lib/in_body.png");
}

TEST(Prototypes, OneInterfaceReachesAllItIsConnectedTo) {
  Running r("PROTO P [ eventIn SFVec3f in exposedField SFVec3f both 0 0 0 eventOut SFVec3f out ] { "
            "DEF A Transform { set_translation IS in translation_changed IS out scale IS both } "
            "DEF B Transform { translation IS both } } DEF I P {} DEF C Transform {} ROUTE I.out "
            "TO C.translation");
  r.log("I", "out");
  r.set("I", "in", Vec3f{1, 0, 0});
  EXPECT_EQ(r.take(), Log{"0 I.out 1 0 0"});
  EXPECT_EQ(r.get("C", "translation"), "1 0 0");
  r.set("I", "both", Vec3f{2, 2, 2});
  auto& instance = static_cast<ProtoInstance&>(r.node("I"));
  EXPECT_EQ(textOf(r.browser.get(*instance.body.names.at("A"), "scale")), "2 2 2");
  EXPECT_EQ(textOf(r.browser.get(*instance.body.names.at("B"), "translation")), "2 2 2");
}

TEST(Prototypes, ScriptsInBodiesTakeAndGiveEvents) {
  Scripted r("PROTO P [ eventIn SFInt32 in eventOut SFInt32 out field SFInt32 start 5 ] { Group {} "
             "Script { eventIn SFInt32 a IS in eventOut SFInt32 b IS out field SFInt32 sum IS "
             "start url \"test:a: add sum b\" } } DEF I P {} DEF J P { start 100 }");
  r.log("I", "out");
  r.log("J", "out");
  r.set("I", "in", 1);
  r.set("J", "in", 1);
  r.set("I", "in", 1);
  EXPECT_EQ(r.take(), (Log{"0 I.out 6", "0 J.out 101", "0 I.out 7"}));
}

TEST(Prototypes, NodesOfAFieldAreSharedWithTheirOwner) {
  Running r("PROTO P [ field MFNode parts [] ] { Group { children IS parts } } DEF I P { parts [ "
            "DEF A Transform {} ] } ");
  r.set("A", "translation", Vec3f{1, 0, 0});
  const auto& group = *renderedNode(&r.node("I"));
  EXPECT_EQ(std::get<MFNode>(group.get(*group.type().find("children"))),
            MFNode{r.browser.node("A")});
}

TEST(Prototypes, NodesBehindTheFirstRunButAreNotDrawn) {
  Running r("PROTO P [ eventOut SFTime beat ] { Group {} DEF C TimeSensor { loop TRUE time IS beat "
            "} } DEF I P {}");
  EXPECT_EQ(renderedNode(&r.node("I"))->type().name, "Group");
  r.log("I", "beat");
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{"2 I.beat 2"});
}

TEST(Prototypes, AUrnThatNamesANodeOfThisBrowserIsThatNode) {
  Running r("EXTERNPROTO MyTransform [ exposedField SFVec3f translation field SFVec3f scale "
            "eventIn MFNode addChildren ] [ \"urn:example:unknown\" "
            "\"urn:example.org:node:Transform\" \"absent.wrl\" ] DEF I MyTransform { translation 1 "
            "2 3 } DEF T Transform {} ROUTE T.translation TO I.translation");
  EXPECT_EQ(r.browser.world().diagnostics.warnings() + r.browser.world().diagnostics.errors(), 0u);
  ASSERT_TRUE(renderedNode(&r.node("I")));
  EXPECT_EQ(renderedNode(&r.node("I"))->type().name, "Transform");
  EXPECT_EQ(translationOf(r.node("I")), "1 2 3");
  r.set("T", "translation", Vec3f{4, 5, 6});
  EXPECT_EQ(translationOf(r.node("I")), "4 5 6");
}

TEST(Prototypes, AUrnOfAnotherNodeLeadsToTheNextUrl) {
  Running r("EXTERNPROTO Thing [] [ \"urn:example:Script\" \"urn:example:nothing\" ] Thing {}");
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 1u);
}

TEST(Switches, NullKeepsItsPlaceAmongTheChoices) {
  const std::string text =
      "#VRML V2.0 utf8\nDEF S Switch { whichChoice 1 choice [ NULL DEF A Group {} NULL DEF B Group "
      "{} ] }\n"
      "DEF L LOD { level [ DEF C Group {} NULL ] range 10 }\nPROTO P [ field MFNode list [ NULL "
      "Group {} ] ] { Switch { choice IS list } }\nDEF I P {} DEF J P { list [ NULL NULL DEF D "
      "Group {} ] }\nDEF G Group { children [ NULL ] }";
  const auto world = loadWorldFromMemory(text, "test.wrl");
  EXPECT_EQ(world->diagnostics.warnings(), 1u); // only about the Group
  const auto again = loadWorldFromMemory(writeWorld(*world), "again.wrl");
  std::string difference;
  EXPECT_TRUE(equalScopes(world->scope, again->scope, &difference)) << difference;
  Running r(text);
  EXPECT_EQ(r.get("S", "choice"), "[NULL, A, NULL, B]");
  EXPECT_EQ(r.get("L", "level"), "[C, NULL]");
  EXPECT_EQ(r.get("G", "children"), "[]");
  const auto choices = [&](const char* name) {
    Node* drawn = renderedNode(&r.node(name));
    return textOf(drawn->get(*drawn->type().find("choice")));
  };
  EXPECT_EQ(choices("I"), "[NULL, Group]");
  EXPECT_EQ(choices("J"), "[NULL, NULL, D]");
  r.set("G", "children", MFNode{NodeRef(), r.browser.node("A")});
  EXPECT_EQ(r.get("G", "children"), "[A]");
  r.set("S", "choice", MFNode{NodeRef(), r.browser.node("B")});
  EXPECT_EQ(r.get("S", "choice"), "[NULL, B]");
}

} // namespace
} // namespace xvrml
