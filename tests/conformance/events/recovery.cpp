// recovery.cpp: worlds that break a rule: as much as possible of them is kept, and one message
// explains the problem.
#include <sstream>

#include "conformance/events/scripted.h"
#include "graph/expander.h"

namespace xvrml {
namespace {

Node& drawn(Running& r, std::string_view name) { return *renderedNode(r.browser.node(name).get()); }
std::string fieldOf(Node& node, const char* field) {
  return textOf(node.get(*node.type().find(field)));
}
uint64_t errors(Running& r) { return r.browser.world().diagnostics.errors(); }

// The key frames of Cosmo Worlds are written like this.
TEST(Recovery, ANodeMayBeUsedWithinAFieldOfItsOwnThatIsNotDrawn) {
  const std::string text = "PROTO Keys [ field MFNode actors [] ] { Group {} } DEF K Keys { actors "
                           "[ DEF T Transform { children [ Group {} USE K ] } ] } USE T";
  Running r(text);
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 0u);
  EXPECT_EQ(r.get("T", "children"), "[Group, K]");
  EXPECT_EQ(r.get("K", "actors"), "[T]");
  const auto again = loadWorldFromMemory(writeWorld(r.browser.world()), "again.wrl");
  std::string difference;
  EXPECT_TRUE(equalScopes(r.browser.world().scope, again->scope, &difference)) << difference;
}

TEST(Recovery, InACopyOfAPrototypesBodyToo) {
  Running r(
      "PROTO Keys [ field MFNode actors [] ] { Group {} } PROTO Film [] { Group { children DEF K "
      "Keys { actors DEF T Transform { children USE K } } } } DEF A Film {} DEF B Film {}");
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 0u);
}

TEST(Recovery, WhatAPrototypeDrawsCannotHoldIt) {
  const std::string p = "PROTO P [ field MFNode c [] ] { Group { children IS c } } ";
  for (const char* world :
       {"DEF K P { c [ USE K ] }", "DEF K P { c [ Group { children [ Group {} USE K ] } ] }",
        "DEF K P { c DEF T Transform { children P { c USE K } } }",
        "DEF K Group { children P { c USE K } }",
        "DEF K Group { children P { c Group { children USE K } } }"}) {
    Running r(p + world);
    EXPECT_EQ(errors(r), 1u) << world;
    r.browser.tick(1);
  }
}

TEST(Recovery, AGroupCannotHoldItselfWhateverIsBetween) {
  Running r("DEF K Group { children Transform { children USE K } }");
  EXPECT_EQ(errors(r), 1u);
}

TEST(Recovery, AFieldThatIsAnExposedFieldTakesTheGivenValue) {
  Running r("PROTO Plane [ exposedField SFVec3f size 10 10 .1 ] { Box { size IS size } } Shape { "
            "geometry DEF A Plane { size 1 2 3 } } Shape { geometry DEF B Plane {} }");
  EXPECT_EQ(errors(r), 0u);
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 1u) << "taken, with a warning";
  EXPECT_EQ(fieldOf(drawn(r, "A"), "size"), "1 2 3");
  EXPECT_EQ(fieldOf(drawn(r, "B"), "size"), "10 10 0.1");
  r.log("A", "size");
  r.set("A", "size", Vec3f{4, 4, 4}); // sets the exposedField of the instance
  EXPECT_EQ(r.take(), Log{"0 A.size 4 4 4"});
  EXPECT_EQ(fieldOf(drawn(r, "A"), "size"), "1 2 3");
}

TEST(Recovery, AnEventOutThatIsAnExposedFieldSends) {
  Running r("PROTO P [ exposedField SFTime beat 0 ] { TimeSensor { loop TRUE time IS beat } } DEF "
            "A P {}");
  EXPECT_EQ(errors(r), 0u);
  EXPECT_EQ(r.browser.world().diagnostics.list().size(), 1u) << "taken, with a warning";
  r.log("A", "beat");
  r.browser.tick(2);
  EXPECT_EQ(r.take(), Log{"2 A.beat 2"});
}

TEST(Recovery, AScriptWithAnExposedFieldRunsAndHasItAsAField) {
  Scripted r(
      "DEF T TimeSensor {} DEF S Script { exposedField SFInt32 n 20 eventIn SFInt32 a eventOut "
      "SFInt32 b url \"test:a: add n b\" } DEF W Switch {} ROUTE S.b TO W.whichChoice");
  EXPECT_EQ(errors(r), 1u);
  r.set("S", "a", 2);
  EXPECT_EQ(r.get("W", "whichChoice"), "22");
}

TEST(Recovery, AScriptWithADeclarationOfAnUnknownTypeRunsWithoutIt) {
  Scripted r("DEF S Script { field SFVec5f v 1 2 3 4 5 field MFLong d [ 1 2 ] eventOut SFLong o "
             "field SFInt32 n 20 eventIn SFInt32 a eventOut SFInt32 b url \"test:a: add n b\" } "
             "DEF W Switch {} ROUTE S.b TO W.whichChoice");
  EXPECT_EQ(errors(r), 3u);
  r.set("S", "a", 2);
  EXPECT_EQ(r.get("W", "whichChoice"), "22");
}

TEST(Recovery, AMisplacedNodeKeepsItsName) {
  Running r(
      "DEF RED Material { diffuseColor 1 0 0 } DEF S Shape { appearance DEF A Appearance { "
      "material USE RED } geometry Group { children DEF IN Group {} } } Group { children USE IN }");
  EXPECT_EQ(errors(r), 2u); // the Material at the root, and the Group as geometry
  EXPECT_EQ(r.browser.world().diagnostics.warnings(), 0u);
  EXPECT_EQ(r.get("A", "material"), "RED");
  EXPECT_EQ(r.get("S", "geometry"), "NULL");
  EXPECT_EQ(r.browser.world().scope.roots.size(), 2u);
  const auto again = loadWorldFromMemory(writeWorld(r.browser.world()), "again.wrl");
  EXPECT_EQ(again->diagnostics.list().size(), 0u); // the Material is DEFined where it is USEd first
}

TEST(Recovery, ScriptsSendToNodesWhereOldWorldsMay) {
  const std::string world = "DEF S Script { field SFNode g USE G eventIn SFInt32 go url \"test:go: "
                            "post g set_whichChoice\" }";
  for (const bool old : {false, true}) {
    Scripted r("DEF G Switch {} " + world, {}, {.epoch = 0, .directOutputAlways = old});
    r.set("S", "go", 3);
    EXPECT_EQ(r.get("G", "whichChoice"), old ? "3" : "-1");
    EXPECT_EQ(r.messages().size(), old ? 0u : 1u);
  }
}

// Returns the number of nodes of a type that a world draws or holds; shared nodes count once.
size_t count(const World& world, std::string_view type) {
  std::vector<Node*> roots, nodes;
  for (const NodeRef& root : world.scope.roots) roots.push_back(root.get());
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes(roots, nodes, index);
  return std::count_if(nodes.begin(), nodes.end(),
                       [&](const Node* node) { return node && node->type().name == type; });
}

std::unique_ptr<World> read(const std::string& text) {
  return loadWorldFromMemory("#VRML V2.0 utf8\n" + text, "damaged.wrl");
}

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& diagnostic : world.diagnostics.list()) text += diagnostic.text() + '\n';
  return text;
}

// Any one token of a file may be lost or doubled. Everything around its statement is kept, and a
// few messages explain why.
TEST(Recovery, OneTokenCostsAtMostOneStatement) {
  std::vector<std::string> tokens;
  std::istringstream in("Transform { translation 1 0 0 children [ Shape { geometry Box { } } ] }");
  for (std::string token; in >> token;) tokens.push_back(token);
  std::string rest = "\n";
  constexpr size_t more = 20;
  for (size_t i = 0; i < more; ++i)
    rest += "Transform { children [ Shape { geometry Sphere { } } ] }\n";
  for (const bool twice : {false, true}) {
    for (size_t at = 0; at < tokens.size(); ++at) {
      std::string first;
      for (size_t i = 0; i < tokens.size(); ++i)
        for (size_t times = i == at ? (twice ? 2 : 0) : 1; times > 0; --times)
          first += tokens[i] + ' ';
      for (const std::string& before :
           {std::string(), std::string("Group { children [ Group { } ] } ")}) {
        const auto world = read(before + first + rest);
        EXPECT_EQ(count(*world, "Sphere"), more) << first << messages(*world);
        EXPECT_EQ(world->diagnostics.errors(), 1u) << first << messages(*world);
        const bool brace = tokens[at] == "{" || tokens[at] == "}" || (tokens[at] == "]") ||
                           (tokens[at] == "[" && twice);
        EXPECT_GE(count(*world, "Box"), brace ? 1u : 0u) << first << messages(*world);
      }
    }
  }
}

TEST(Recovery, WhatIsReadBehindAMissingBraceStandsWhereItBelongs) {
  const auto roots = read("Transform { children [ Shape { geometry Box { } } ] Transform { } DEF A "
                          "Transform { } USE A Group { }");
  EXPECT_EQ(roots->diagnostics.errors(), 1u) << messages(*roots);
  EXPECT_EQ(roots->scope.roots.size(), 5u);
  const auto list =
      read("DEF G Group { children [ Shape { geometry Box { } Group { } Group { } ] } Group { }");
  EXPECT_EQ(list->diagnostics.errors(), 1u) << messages(*list);
  EXPECT_EQ(list->scope.roots.size(), 2u);
  Node& group = *list->scope.names.at("G");
  EXPECT_EQ(static_cast<MFNode*>(group.storage(*group.type().find("children")))->size(), 3u);
  const auto body =
      read("PROTO P [ ] { Group { children [ Shape { geometry Box { } ] } } P { } Group { }");
  EXPECT_EQ(body->diagnostics.errors(), 1u) << messages(*body);
  EXPECT_EQ(body->scope.roots.size(), 2u);
  const auto value = read("PROTO P [ field SFNode n Shape { geometry Box { } field SFInt32 i 0 ] { "
                          "Group { } } P { i 1 } Group { }");
  EXPECT_EQ(value->scope.roots.size(), 2u) << messages(*value);
}

TEST(Recovery, ValuesOfAListWithoutItsBracketAreKept) {
  Running r("Shape { geometry DEF F IndexedFaceSet { coord DEF C Coordinate { point [ 0 0 0, 1 0 "
            "0, 0 1 0 } coordIndex [ 0 1 2 -1 ccw FALSE } } Group { }");
  EXPECT_EQ(errors(r), 2u);
  EXPECT_EQ(r.get("C", "point"), "[0 0 0, 1 0 0, 0 1 0]");
  EXPECT_EQ(r.get("F", "coordIndex"), "[0, 1, 2, -1]");
  EXPECT_EQ(r.get("F", "ccw"), "FALSE");
  EXPECT_EQ(r.browser.world().scope.roots.size(), 2u);
}

TEST(Recovery, WhatIsLeftOutEndsWhereANodeShowsThatItsBraceIsMissing) {
  for (const char* first :
       {"Foo { bar Bar { x 1 ", "LOD { range wide level [ Shape { geometry Box { } ] ",
        "Foo { a [ Bar { x 1 ] b 2 ", "Group { foo [ 1 2 ] ", "PROTO P [ field SFFoo x 1 ] ",
        "PROTO P [ ] ", "PROTO P [ field SFFoo x 1 ] { Group { } Transform { } } ",
        "PROTO { } [ ] { Group { } Transform { } } "}) {
    const auto world =
        read(std::string(first) + "Transform { } DEF T Transform { } Group { children USE T }");
    EXPECT_EQ(count(*world, "Transform"), 2u) << first << messages(*world);
    EXPECT_LE(world->diagnostics.errors(), 3u) << messages(*world);
  }
}

// Costs that grow with the square of the size would take many minutes here.
TEST(Recovery, DamageOfAnySizeIsReadInLinearTime) {
  const auto repeated = [](std::string_view text, size_t times) {
    std::string all;
    for (size_t i = 0; i < times; ++i) all += text;
    return all;
  };
  constexpr size_t many = 30'000;
  for (const char* text : {"Group { ",
                           "Group { children [ ",
                           "Group { } } ",
                           "{ ",
                           "} ",
                           "] ",
                           "[ ",
                           "Group { { ",
                           "Group { ] ",
                           "Foo { 1 Box { ",
                           "DEF A ",
                           "USE USE ",
                           "Group { USE ",
                           "Group { DEF A Box { } ",
                           "Shape { Box { ",
                           "Group children ",
                           "Group { children [ { ",
                           "PROTO P ",
                           "PROTO P [ ",
                           "Group { foo Foo { 1 ",
                           "Group { children Shape { "}) {
    const auto world = read(repeated(text, many));
    EXPECT_GT(world->diagnostics.errors(), 0u) << text;
  }
  const std::string deep = "Foo " + repeated("{ ", many) + repeated("1 Box { } ", many);
  EXPECT_GT(read(deep)->diagnostics.errors(), 0u);
  const std::string nested =
      repeated("Group { children Group { children [ ", 400) + repeated("Shape { Box { } } ", many);
  EXPECT_GT(read(nested + repeated("] ", 400))->diagnostics.errors(), 0u);
}

} // namespace
} // namespace xvrml
