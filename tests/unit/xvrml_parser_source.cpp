// xvrml_parser_source.cpp: bytes and URLs: what is accepted as a world, what is refused and how
// clearly, and how URLs are resolved.
#include "unit/xvrml_parser_support.h"

namespace {

using namespace parser_test;

std::string refusal(const std::string& bytes) {
  try {
    loadWorldFromMemory(bytes, "f.wrl");
  } catch (const LoadError& error) { return error.diagnostic.text(); }
  return "";
}

TEST(ParserSource, HeadersThatAreExact) {
  for (const char* text :
       {"#VRML V2.0 utf8", "#VRML V2.0 utf8\n", "#VRML V2.0 utf8 a comment\nGroup { }",
        "#VRML V2.0 utf8\r\nGroup { }", "#VRML V2.0 utf8\tx\n"}) {
    EXPECT_EQ(messages(*loadWorldFromMemory(text, "f.wrl")), "") << text;
  }
}

TEST(ParserSource, HeadersThatAreNearlyRight) {
  for (const char* text :
       {"#VRML    V2.0 utf8\nGroup { }", "# VRML V2.0 utf8\nGroup { }",
        "\n\n#VRML V2.0 utf8\nGroup { }", "#VRML V2.0\nGroup { }", "#VRMLV2.0utf8\nGroup { }",
        "#VRML V2.0 utf8x\nGroup { }", "\xef\xbb\xbf#VRML V2.0 utf8\nGroup { }", "Group { }",
        "DEF G Group { }"}) {
    const auto world = loadWorldFromMemory(text, "f.wrl");
    EXPECT_EQ(world->scope.roots.size(), 1u) << text;
    ASSERT_EQ(world->diagnostics.warnings(), 1u) << text;
    EXPECT_EQ(world->diagnostics.list()[0].line, 1u);
  }
}

// Texts that were saved in UTF-16, in both orders, are read with a warning. Half of a surrogate
// pair is the replacement character.
TEST(ParserSource, TextsInUtf16) {
  const std::u16string text =
      u"#VRML V2.0 utf8\nWorldInfo { title \"\u00e9\u6f22\U0001f600\xd800!\" }";
  for (const bool big : {false, true}) {
    std::string bytes = big ? "\xfe\xff" : "\xff\xfe";
    for (const char16_t unit : text)
      for (const int shift : {big ? 8 : 0, big ? 0 : 8}) bytes += char(unit >> shift & 0xff);
    const auto world = loadWorldFromMemory(bytes, "f.wrl");
    EXPECT_EQ(messages(*world),
              "f.wrl:1:1: warning: this file is in UTF-16; it was read, but its standard asks for "
              "UTF-8\n");
    ASSERT_EQ(world->scope.roots.size(), 1u);
    EXPECT_EQ(nodeCast<nodes::WorldInfo>(world->scope.roots[0])->title,
              "\u00e9\u6f22\U0001f600\ufffd!");
    EXPECT_EQ(messages(*loadWorldFromMemory(bytes + "x", "f.wrl")), messages(*world));
  }
}

// Files of a known other format are named in the message. For all others the message says what was
// expected.
TEST(ParserSource, WhatIsNoWorldIsRefused) {
  const std::pair<std::string, const char*> cases[] = {
      {"<?xml version='1.0'?><svg/>", "#VRML V2.0 utf8"},
      {"#Inventor V2.1 binary\n", "binary Open Inventor"},
      {"<html></html>", "web page"},
      {"\x89PNG\r\n\x1a\n", "picture"},
      {"%PDF-1.4", "PDF"},
      {"PK\x03\x04", "ZIP"},
      {"", "#VRML V2.0 utf8"},
      {"hello", "#VRML V2.0 utf8"},
      {std::string("\xff\xfe#\0V\0", 6), "#VRML V2.0 utf8"},
  };
  for (const auto& [bytes, said] : cases)
    EXPECT_NE(refusal(bytes).find(said), std::string::npos) << refusal(bytes);
}

TEST(ParserSource, FilesThatCannotBeRead) {
  const Folder folder;
  const auto refused = [](const std::string& path) {
    try {
      loadWorld(path);
    } catch (const LoadError& error) { return error.diagnostic.text(); }
    return std::string();
  };
  EXPECT_NE(refused(folder.path("none.wrl")).find("cannot be opened"), std::string::npos);
  EXPECT_NE(refused(folder.path("")).find("is a folder"), std::string::npos);
  EXPECT_NE(refused("/dev/zero").find("not a regular file"), std::string::npos);
  EXPECT_NE(refused(folder.write("empty.wrl", "")).find("is empty"), std::string::npos);
}

TEST(ParserSource, DamagedGzipDataShowsWhatItHas) {
  std::ifstream file("tests/conformance/good/gzipped-under-a-plain-name.wrl", std::ios::binary);
  const std::string packed((std::istreambuf_iterator<char>(file)), {});
  ASSERT_GT(packed.size(), 30u);
  EXPECT_EQ(messages(*loadWorldFromMemory(packed, "f.wrl")), "");
  std::string wrongSum = packed;
  wrongSum[packed.size() - 6] ^= 1;
  const auto world = loadWorldFromMemory(wrongSum, "f.wrl");
  EXPECT_TRUE(says(*world, "damaged gzip data")) << messages(*world);
  EXPECT_EQ(world->scope.roots.size(), 1u);
  EXPECT_TRUE(
      says(*loadWorldFromMemory(packed.substr(0, packed.size() - 5), "f.wrl"), "ends early"));
  EXPECT_NE(refusal(packed.substr(0, 12)), "");
  EXPECT_NE(refusal("\x1f\x8b garbage that is no deflate stream"), "");
}

TEST(ParserSource, NodesKnowWhereTheyStand) {
  const auto world = parse("Group {\n  children [\n    DEF S Shape { }\n  ]\n}\n");
  const Node& shape = *world->scope.names.at("S");
  EXPECT_EQ(*shape.source.file, "test.wrl");
  EXPECT_EQ(shape.source.line, 4u);
  EXPECT_EQ(shape.source.column, 11u);
}

// The comments at the top can decide which axis is up.
TEST(ParserSource, CommentsAtTheTopAreWrittenAgain) {
  const std::string top = "#VRML V2.0 utf8 KiCad\n# second line\n";
  const auto world = loadWorldFromMemory(top + "Group { } # not this one\n", "test.wrl");
  const std::string text = writeWorld(*world);
  EXPECT_TRUE(text.starts_with(top)) << text;
  EXPECT_EQ(text.find("not this one"), text.npos);
  EXPECT_EQ(writeWorld(*loadWorldFromMemory(text, "again.wrl")), text);
}

TEST(ParserUrl, RelativeToTheFileThatHoldsThem) {
  const Folder folder;
  folder.write("a/b/c d.png", "x");
  folder.write("a/x.wrl", "x");
  const std::string base = folder.path("a/b/w.wrl");
  const auto path = [&](const std::string& url) { return resolveUrl(url, base, {}).path; };
  EXPECT_EQ(path("c%20d.png"), folder.path("a/b/c d.png"));
  EXPECT_EQ(path("  c d.png\n"), folder.path("a/b/c d.png"));
  EXPECT_EQ(path("../x.wrl#Name"), folder.path("a/b/../x.wrl"));
  EXPECT_EQ(path("..\\x.wrl"), folder.path("a/b/../x.wrl"));
  EXPECT_EQ(path("../x.wrl?query=1"), folder.path("a/b/../x.wrl"));
  EXPECT_EQ(path("./none.wrl"), folder.path("a/b/./none.wrl"));
  EXPECT_EQ(resolveUrl("x.wrl#View%201", base, {}).fragment, "View 1");
  EXPECT_EQ(resolveUrl("#P", base, {}).path, base);
  EXPECT_EQ(resolveUrl("x.wrl", "w.wrl", {}).path, "x.wrl");
}

TEST(ParserUrl, WhatIsNotFollowed) {
  LoadOptions absolute;
  absolute.allowAbsolute = true;
  for (const char* url :
       {"http://example.org/x.wrl", "https://example.org/x.wrl", "ftp://example.org/x",
        "urn:inet:example.org:x", "data:image/png;base64,AAAA", "javascript: f()",
        "//server/share/x.wrl", "\\\\server\\share\\x.wrl", "c:\\x.wrl", "C:/x.wrl", "", "  ",
        "x%00.wrl"}) {
    EXPECT_NE(resolveUrl(url, "a/w.wrl", absolute).error, "") << url;
    EXPECT_EQ(resolveUrl(url, "a/w.wrl", absolute).path, "") << url;
  }
  for (const char* url : {"/etc/passwd", "file:///etc/passwd", "FILE:/etc/passwd",
                          "file://localhost/etc/passwd", "%2Fetc/passwd"}) {
    EXPECT_NE(resolveUrl(url, "a/w.wrl", {}).error, "") << url;
    EXPECT_EQ(resolveUrl(url, "a/w.wrl", absolute).path, "/etc/passwd") << url;
  }
  // "-" in a URL is a file name and never standard input.
  EXPECT_EQ(resolveUrl("-", "-", {}).path, "./-");
  EXPECT_NE(resolveUrl("#P", "-", {}).error, "");
}

TEST(ParserSource, MeshesHaveSuffixesAndWorldsHaveNone) {
  EXPECT_EQ(meshSuffixes(Encoding::gltf), ".gltf .glb");
  for (int i = 0; i < encodingCount(); ++i) {
    const auto encoding = static_cast<Encoding>(i);
    EXPECT_EQ(isMesh(encoding), !meshSuffixes(encoding).empty()) << encodingName(encoding);
  }
}

} // namespace
