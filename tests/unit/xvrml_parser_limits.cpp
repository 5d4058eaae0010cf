// xvrml_parser_limits.cpp: every limit on reading stops what it bounds, with a message that names
// the limit, and can be raised. Hostile worlds are refused before they cost anything.
#include <fmt/format.h>

#include "parse/parser.h"
#include "unit/xvrml_parser_support.h"

namespace {

using namespace parser_test;

std::string repeated(const std::string& text, size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string nested(size_t depth) {
  return repeated("Group { children ", depth - 1) + "Group { } " + std::string(depth - 1, '}');
}

TEST(ParserLimits, Nesting) {
  const auto allowed = parse(nested(1000));
  EXPECT_EQ(messages(*allowed), "");
  const auto refused = parse(nested(1001));
  EXPECT_EQ(refused->diagnostics.errors(), 1u);
  EXPECT_TRUE(says(*refused, "limit nesting=1000")) << messages(*refused);
  EXPECT_EQ(refused->scope.roots.size(), 1u);
}

TEST(ParserLimits, NestingRaisedAsFarAsTheStackBears) {
  LoadOptions options;
  options.limits.nesting = ~0ull;
  const auto deep = parse(nested(Parser::maximumNesting), options);
  EXPECT_EQ(messages(*deep), "");
  const auto again = loadWorldFromMemory(writeWorld(*deep), "again.wrl", options);
  EXPECT_TRUE(equalScopes(deep->scope, again->scope));
  EXPECT_TRUE(says(*parse(nested(Parser::maximumNesting + 1), options), "the most there can be"));
}

// Programs can nest nodes deeper than files can.
TEST(ParserLimits, WorldsNestedTooDeepAreNotWritten) {
  const auto nest = [](size_t depth) {
    auto world = std::make_unique<World>();
    const NodeType& group = *findNodeType("Group");
    NodeRef node(group.create(group));
    for (size_t i = 1; i < depth; ++i) {
      auto* outer = static_cast<nodes::Group*>(group.create(group));
      const NodeRef kept(outer);
      outer->children = {node};
      node = kept;
    }
    world->scope.roots = {node};
    return world;
  };
  EXPECT_FALSE(writeWorld(*nest(Parser::maximumNesting)).empty());
  EXPECT_THROW(writeWorld(*nest(Parser::maximumNesting + 1)), std::length_error);
  EXPECT_THROW(writeWorld(*nest(100'000)), std::length_error);
}

TEST(ParserLimits, AMillionBraces) {
  for (const char* opening : {"Group { children ", "Group { children [ ", "Bax { ", "{ ", "[ ",
                              "PROTO P [ ] { ", "PROTO P [ field SFNode n Group { children "}) {
    const auto world = parse(repeated(opening, 1'000'000));
    EXPECT_GT(world->diagnostics.errors(), 0u) << opening;
  }
}

TEST(ParserLimits, ExpandedNodesByUse) {
  std::string text = "DEF L0 Group { }\n";
  for (int i = 1; i <= 30; ++i)
    text += fmt::format("DEF L{} Group {{ children [ USE L{} USE L{} ] }}\n", i, i - 1, i - 1);
  const auto world = parse(text);
  EXPECT_TRUE(says(*world, "limit expandedNodes=10000000")) << messages(*world);
  EXPECT_LT(world->nodeCount, 100u);
}

TEST(ParserLimits, ExpandedNodesByPrototypes) {
  std::string text = "PROTO P0 [ ] { Group { } }\n";
  for (int i = 1; i <= 40; ++i)
    text += fmt::format("PROTO P{} [ ] {{ Group {{ children [ P{} {{ }} P{} {{ }} ] }} }}\n", i,
                        i - 1, i - 1);
  const auto world = parse(text + "P40 { } Shape { }");
  EXPECT_TRUE(says(*world, "limit expandedNodes")) << messages(*world);
  EXPECT_LT(world->nodeCount, 1000u);
  EXPECT_EQ(world->scope.roots.size(), 2u);
  EXPECT_EQ(renderedNode(world->scope.roots[0].get()), nullptr);
  LoadOptions unbounded;
  unbounded.limits.expandedNodes = ~0ull; // then memory is the bound
  EXPECT_TRUE(says(*parse(text + "P40 { }", unbounded), "limit worldBytes"));
}

TEST(ParserLimits, ExpandedNodesByDefaultsOfPrototypes) {
  std::string text = "PROTO P0 [ ] { Group { } }\n";
  for (int i = 1; i <= 40; ++i) {
    text += fmt::format(
        "PROTO P{} [ field MFNode c [ P{} {{ }} P{} {{ }} ] ] {{ Group {{ children IS c }} }}\n", i,
        i - 1, i - 1);
  }
  const auto world = parse(text + "P40 { }");
  EXPECT_TRUE(says(*world, "limit expandedNodes")) << messages(*world);
  EXPECT_LT(world->nodeCount, 1000u);
}

// The fields double from one prototype to the next. Values are shared, but each use is counted.
TEST(ParserLimits, ExpandedNodesByValuesOfPrototypes) {
  std::string text = "PROTO P [ field MFNode c [ ] ] { Group { children [ Group { children IS c } "
                     "Group { children IS c } ] } }\n";
  text += repeated("P { c ", 30) + "Shape { } " + std::string(30, '}');
  const auto world = parse(text);
  EXPECT_TRUE(says(*world, "limit expandedNodes")) << messages(*world);
  EXPECT_TRUE(world->scope.roots.empty());
}

TEST(ParserLimits, ExpandedNodesOfAFlatFile) {
  LoadOptions options;
  options.limits.expandedNodes = 10;
  const auto world = parse(repeated("Shape { }\n", 20), options);
  EXPECT_TRUE(says(*world, "limit expandedNodes=10"));
  EXPECT_EQ(world->scope.roots.size(), 10u);
}

TEST(ParserLimits, ProtoDepth) {
  const auto chain = [](int depth) {
    std::string text = "PROTO P0 [ ] { Group { } }\n";
    for (int i = 1; i < depth; ++i)
      text += fmt::format("PROTO P{} [ ] {{ P{} {{ }} }}\n", i, i - 1);
    return text + fmt::format("P{} {{ }}", depth - 1);
  };
  EXPECT_EQ(messages(*parse(chain(64))), "");
  EXPECT_TRUE(says(*parse(chain(65)), "limit protoDepth=64"));
  LoadOptions options;
  options.limits.protoDepth = 1000;
  EXPECT_EQ(messages(*parse(chain(500), options)), "");
}

// Nested prototypes must not add up to a depth that code walking the graph cannot handle.
TEST(ParserLimits, DepthThroughPrototypes) {
  std::string text = "PROTO P0 [ ] { Group { } }\n";
  for (int i = 1; i < 10; ++i) {
    text += fmt::format("PROTO P{} [ ] {{ {}P{} {{ }}{} }}\n", i,
                        repeated("Group { children ", 500), i - 1, std::string(500, '}'));
  }
  const auto world = parse(text + "P9 { } Shape { }");
  EXPECT_TRUE(says(*world, "nested")) << messages(*world);
  EXPECT_EQ(world->scope.roots.size(), 1u);
}

TEST(ParserLimits, PrototypesThatContainThemselvesThroughFiles) {
  const Folder folder;
  folder.write(
      "a.wrl",
      header + "PROTO A [ ] { EXTERNPROTO B [ ] \"b.wrl#B\" Group { children B { } } }\nA { }\n");
  folder.write("b.wrl",
               header + "PROTO B [ ] { EXTERNPROTO A [ ] \"a.wrl#A\" Group { children A { } } }\n");
  const auto world = loadWorld(folder.path("a.wrl"));
  EXPECT_TRUE(says(*world, "contains an instance of itself")) << messages(*world);
  folder.write("c.wrl", header + "EXTERNPROTO C [ ] \"d.wrl#C\"\nC { }\n");
  folder.write("d.wrl", header + "EXTERNPROTO C [ ] \"c.wrl#C\"\n");
  EXPECT_TRUE(says(*loadWorld(folder.path("c.wrl")), "is not loaded"));
}

TEST(ParserLimits, InlineOfItself) {
  const Folder folder;
  folder.write("a.wrl", header + "Inline { url \"a.wrl\" } Shape { }\n");
  const auto self = loadWorld(folder.path("a.wrl"));
  EXPECT_TRUE(says(*self, "contains this Inline itself")) << messages(*self);
  EXPECT_EQ(self->scope.roots.size(), 2u);
  folder.write("b.wrl", header + "Inline { url \"sub/../c.wrl\" }\n");
  folder.write("c.wrl", header + "Inline { url \"./b.wrl\" }\n");
  folder.write("sub/x", "");
  EXPECT_TRUE(says(*loadWorld(folder.path("b.wrl")), "contains this Inline itself"));
}

TEST(ParserLimits, InlineDepth) {
  const Folder folder;
  for (int i = 0; i < 40; ++i)
    folder.write(fmt::format("{}.wrl", i),
                 header + fmt::format("Inline {{ url \"{}.wrl\" }}\n", i + 1));
  folder.write("40.wrl", header + "Shape { }\n");
  EXPECT_TRUE(says(*loadWorld(folder.path("0.wrl")), "limit inlineDepth=32"));
  LoadOptions options;
  options.limits.inlineDepth = 100;
  EXPECT_EQ(messages(*loadWorld(folder.path("0.wrl"), options)), "");
}

TEST(ParserLimits, InlineDoubling) {
  const Folder folder;
  for (int i = 0; i < 30; ++i) {
    folder.write(fmt::format("{}.wrl", i),
                 header + fmt::format("Inline {{ url \"{}.wrl\" }} Inline {{ url \"{}.wrl\" }}\n",
                                      i + 1, i + 1));
  }
  folder.write(
      "30.wrl",
      header +
          "DEF T Transform { } ROUTE T.translation TO T.scale\n"); // each Inline needs its own copy
  const auto world = loadWorld(folder.path("0.wrl"));
  EXPECT_TRUE(says(*world, "limit expandedNodes")) << messages(*world);
}

TEST(ParserLimits, ArrayElements) {
  LoadOptions options;
  options.limits.arrayElements = 9;
  EXPECT_EQ(messages(*parse(
                "Shape { geometry PointSet { coord Coordinate { point [ 1 2 3 4 5 6 7 8 9 ] } } }",
                options)),
            "");
  EXPECT_TRUE(says(
      *parse(
          "Shape { geometry PointSet { coord Coordinate { point [ 1 2 3 4 5 6 7 8 9 1 2 3 ] } } }",
          options),
      "limit arrayElements=9"));
  EXPECT_TRUE(says(*parse("WorldInfo { info [" + repeated("\"\"", 10) + "] }", options),
                   "limit arrayElements=9"));
}

TEST(ParserLimits, InterfaceFields) {
  std::string fields;
  for (int i = 0; i < 20; ++i) fields += fmt::format("field SFFloat f{} 1 ", i);
  LoadOptions options;
  options.limits.interfaceFields = 10;
  EXPECT_TRUE(says(*parse("Script { " + fields + "}", options), "limit interfaceFields=10"));
  EXPECT_TRUE(
      says(*parse("PROTO P [ " + fields + "] { Group { } }", options), "limit interfaceFields=10"));
}

std::string refusal(const std::string& path, const LoadOptions& options) {
  try {
    loadWorld(path, options);
  } catch (const LoadError& error) { return error.diagnostic.message; }
  return "";
}

TEST(ParserLimits, Inflation) {
  const std::string path = "tests/conformance/hostile/spaces.wrl.gz"; // 3 MiB of blanks in 3 kB
  EXPECT_NE(refusal(path, {}).find("inflateRatio=200"), std::string::npos) << refusal(path, {});
  LoadOptions options;
  options.limits.inflateRatio = 2000;
  EXPECT_EQ(loadWorld(path, options)->scope.roots.size(), 1u);
  options.limits.inflateBytes = 1 << 20;
  EXPECT_NE(refusal(path, options).find("inflateBytes=1048576"), std::string::npos);
}

TEST(ParserLimits, FileBytes) {
  const Folder folder;
  const std::string path = folder.write("big.wrl", header + std::string(1000, ' '));
  LoadOptions options;
  options.limits.fileBytes = 500;
  EXPECT_NE(refusal(path, options).find("fileBytes=500"), std::string::npos);
  EXPECT_THROW(loadWorldFromMemory(header + std::string(1000, ' '), "x", options), LoadError);
}

// Quadratic traps: long lists of things that are looked up by name.
TEST(ParserLimits, ManyOfEverything) {
  std::string text;
  for (int i = 0; i < 20'000; ++i)
    text +=
        fmt::format("DEF N{} Transform {{ }} PROTO Q{} [ ] {{ Group {{ }} }} Q{} {{ }}\n", i, i, i);
  for (int i = 0; i < 20'000; ++i)
    text += fmt::format("ROUTE N{}.translation TO N{}.scale\n", i, 19'999 - i);
  text += "Transform { " + repeated("translation 0 0 0 ", 20'000) + "}";
  const auto world = parse(text);
  EXPECT_EQ(world->diagnostics.errors(), 0u);
  EXPECT_EQ(world->scope.routes.size(), 20'000u);
  const auto again = loadWorldFromMemory(writeWorld(*world), "again.wrl");
  EXPECT_TRUE(equalScopes(world->scope, again->scope));
}

} // namespace
