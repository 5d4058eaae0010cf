// xvrml_parser_recovery.cpp: Tests that an error in a world costs no more than it must. All that is
// left of single values and lists is tested in xvrml_values_kept.cpp.
#include <algorithm>

#include "unit/xvrml_parser_support.h"

namespace {

using namespace parser_test;

std::vector<std::string> rootTypes(const World& world) {
  std::vector<std::string> names;
  for (const NodeRef& root : world.scope.roots) names.push_back(root->type().name);
  return names;
}

using Names = std::vector<std::string>;

TEST(ParserRecovery, ABadValueLosesItsFieldOnly) {
  const auto world = parse("Group { children [ Shape { } Transform { translation 1 2 children [ "
                           "Shape { } ] } WorldInfo { } ] } Group { }");
  EXPECT_EQ(world->diagnostics.errors(), 1u) << messages(*world);
  EXPECT_EQ(rootTypes(*world), (Names{"Group", "Group"}));
  const auto* group = nodeCast<nodes::Group>(world->scope.roots[0]);
  ASSERT_EQ(group->children.size(), 3u);
  EXPECT_EQ(nodeCast<nodes::Transform>(group->children[1])->translation, Vec3f());
  EXPECT_EQ(nodeCast<nodes::Transform>(group->children[1])->children.size(), 1u);
  EXPECT_EQ(group->children[2]->type().name, "WorldInfo");
}

TEST(ParserRecovery, AnUnknownNodeIsLeftOutWithAllInIt) {
  const auto world =
      parse("Group { children [ Torus { a [ 1 2 ] b Box { c { } } \"}\" } Shape { } ] }");
  EXPECT_EQ(world->diagnostics.errors(), 1u);
  EXPECT_EQ(nodeCast<nodes::Group>(world->scope.roots[0])->children.size(), 1u);
}

TEST(ParserRecovery, AnUnknownFieldLosesNothingElse) {
  for (const char* value :
       {"TRUE", "1 2 3", "[ 1 2 3 ]", "\"text\"", "USE X", "NULL", "Torus { inner { } }",
        "[ A { } B { children [ ] } ]", "DEF Y Shape { }"}) {
    const auto world = parse(std::string("Transform { translation 1 2 3 unknown ") + value +
                             " scale 2 2 2 children [ Shape { } ] }");
    EXPECT_EQ(world->diagnostics.errors(), 1u) << value << messages(*world);
    const auto* transform = nodeCast<nodes::Transform>(world->scope.roots.at(0));
    EXPECT_EQ(transform->translation, (Vec3f{1, 2, 3})) << value;
    EXPECT_EQ(transform->scale, (Vec3f{2, 2, 2})) << value;
    EXPECT_EQ(transform->children.size(), 1u) << value;
  }
}

TEST(ParserRecovery, GarbageBetweenStatements) {
  const auto world =
      parse("Group { } ] } 1 2 \"x\" Foo bar { Shape { } } } DEF G Shape { } ' . WorldInfo { }");
  EXPECT_EQ(rootTypes(*world), (Names{"Group", "Shape", "WorldInfo"}));
  EXPECT_GE(world->diagnostics.errors(), 3u);
}

TEST(ParserRecovery, ATextThatEndsEarlyKeepsWhatWasRead) {
  const auto world =
      parse("Transform { translation 1 2 3 children [ Shape { } Group { children [ Shape { }");
  EXPECT_EQ(world->diagnostics.errors(), 1u) << messages(*world);
  const auto* transform = nodeCast<nodes::Transform>(world->scope.roots.at(0));
  EXPECT_EQ(transform->translation, (Vec3f{1, 2, 3}));
  ASSERT_EQ(transform->children.size(), 2u);
  EXPECT_EQ(nodeCast<nodes::Group>(transform->children[1])->children.size(), 1u);
}

TEST(ParserRecovery, NamesThatWentWithANodeAreNotErrorsAgain) {
  const auto world =
      parse("Torus { a DEF A Group { } } Group { children USE A } Knot { b DEF B Transform { "
            "children DEF C Group { } } } USE B USE C ROUTE B.translation TO C.translation");
  EXPECT_EQ(world->diagnostics.errors(), 2u) << messages(*world); // they concern Torus and Knot
  EXPECT_GE(world->diagnostics.warnings(), 3u);
  EXPECT_TRUE(world->scope.names.empty());
  EXPECT_TRUE(world->scope.routes.empty());
}

TEST(ParserRecovery, APrototypeWithABadInterfaceIsLeftOutWhole) {
  const auto world = parse("PROTO P [ field SFNode x one field MFNode n [ Group { } ] ] { Shape { "
                           "} Group { } } P { x NULL } Group { }");
  EXPECT_EQ(world->diagnostics.errors(), 1u) << messages(*world);
  EXPECT_EQ(rootTypes(*world), (Names{"Group"}));
}

TEST(ParserRecovery, ABadNodeInAPrototypeBody) {
  const auto world = parse("PROTO P [ ] { Group { } Torus { scale x } Shape { } } P { }");
  EXPECT_EQ(world->diagnostics.errors(), 1u);
  const auto& instance = dynamic_cast<ProtoInstance&>(*world->scope.roots.at(0));
  EXPECT_EQ(instance.body.roots.size(), 2u);
}

TEST(ParserRecovery, WhatNamesMayBeIsGenerous) {
  const auto world =
      parse("DEF 1stRoom Group { } DEF it's Group { } DEF a.b Transform { } Group { children [ USE "
            "1stRoom USE it's ] } ROUTE a.b.translation TO a.b.scale");
  EXPECT_EQ(world->diagnostics.errors(), 0u) << messages(*world);
  EXPECT_GE(world->diagnostics.warnings(), 3u);
  EXPECT_EQ(world->scope.routes.size(), 1u);
  const auto again = loadWorldFromMemory(writeWorld(*world), "again.wrl");
  EXPECT_TRUE(equalScopes(world->scope, again->scope));
}

TEST(ParserRecovery, OutOfRangeValuesAreBroughtBack) {
  const auto world = parse(
      "Shape { appearance Appearance { material Material { diffuseColor 2 -1 0.5 transparency 3 } "
      "} geometry Sphere { radius -1 } } Viewpoint { fieldOfView 7 } Transform { scale -1 1 1 }");
  EXPECT_EQ(world->diagnostics.errors(), 0u);
  EXPECT_GE(world->diagnostics.warnings(), 4u) << messages(*world);
  const auto* shape = nodeCast<nodes::Shape>(world->scope.roots.at(0));
  const auto* material =
      nodeCast<nodes::Material>(nodeCast<nodes::Appearance>(shape->appearance)->material);
  EXPECT_EQ(material->diffuseColor, (Color{1, 0, 0.5f}));
  EXPECT_EQ(material->transparency, 1.0f);
  EXPECT_EQ(nodeCast<nodes::Sphere>(shape->geometry)->radius, 1.0f);
  EXPECT_NEAR(nodeCast<nodes::Viewpoint>(world->scope.roots.at(1))->fieldOfView, 0.785398f, 1e-6);
  EXPECT_EQ(nodeCast<nodes::Transform>(world->scope.roots.at(2))->scale,
            (Vec3f{-1, 1, 1})); // real files contain mirrors
}

// A file must not be able to control the terminal that shows its errors.
TEST(ParserRecovery, MessagesHoldNoControlCharacters) {
  const auto world =
      parse("\x1b[31m\x07 \xc2\x9b"
            "31m Bax\x7f { } WorldInfo { title red\x1b } Group { children \"a\nb\x1b\" }");
  EXPECT_GE(world->diagnostics.errors(), 3u);
  for (const Diagnostic& diagnostic : world->diagnostics.list()) {
    const std::string text = diagnostic.text();
    EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](unsigned char c) {
      return (c < 0x20 && c != '\n') || c == 0x7f;
    })) << text;
    EXPECT_EQ(text.find("\xc2\x9b"), std::string::npos);
  }
}

TEST(ParserRecovery, OnlySoManyMessagesAreKept) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "Bax { }\n";
  const auto world = parse(text);
  EXPECT_EQ(world->diagnostics.errors(), 5000u);
  EXPECT_EQ(world->diagnostics.list().size(), world->diagnostics.limit);
  EXPECT_EQ(world->diagnostics.dropped(), 5000 - world->diagnostics.limit);
}

} // namespace
