// xvrml_x3d_json.cpp: what is special to X3D in JSON: the order of members, places in messages,
// strings, and hostile files.
#include <gtest/gtest.h>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> load(const std::string& text, const LoadOptions& options = {}) {
  return loadWorldFromMemory(text, "test.x3dj", options);
}

std::string scene(const std::string& children) {
  return R"({"X3D":{"@version":"3.3","@profile":"Full","Scene":{"-children":[)" + children + "]}}}";
}

std::string messages(const World& world) {
  std::string all;
  for (const Diagnostic& one : world.diagnostics.list())
    all += one.text().substr(0, one.text().find('\n')) + '\n';
  return all;
}

template <class T> T& first(const World& world) { return *nodeCast<T>(world.scope.roots.at(0)); }

TEST(X3dJson, ContentDecidesBeforeTheSuffix) {
  for (const char* name : {"a.wrl", "a.json", "a.x3dj", "a.x3d"})
    EXPECT_EQ(loadWorldFromMemory(scene("{\"Group\":{}}"), name)->head.version,
              (FileVersion{Encoding::x3dJson, 3, 3}))
        << name;
  EXPECT_THROW(loadWorldFromMemory("{}", "a.json"), LoadError);
  EXPECT_EQ(messages(*load("{}")), "test.x3dj: error: this file has no Scene: it is empty\n");
  EXPECT_EQ(load("{\"X3D\":{\"@version\":\"4.0\"}}")->head.version.major, 4);
}

TEST(X3dJson, MembersMayHaveAnyOrder) {
  const auto world = load(
      scene(R"({"Transform":{"-children":[{"Transform":{"@USE":"A"}},{"Group":{}}],"@DEF":"B"}})"));
  EXPECT_EQ(messages(*world), "test.x3dj:1:114: error: no node is named 'A' by a DEF above\n");
  EXPECT_EQ(world->scope.roots.at(0)->defName, "B");
  EXPECT_EQ(first<nodes::Transform>(*world).children.size(), 1u);
  // The head and the version count wherever they stand.
  const auto turned = load(R"({"X3D":{"Scene":{"-children":[{"Group":{}}]},"head":{"meta":)"
                           R"({"@name":"a","@content":"b"}},"@version":"3.1"}})");
  EXPECT_EQ(turned->head.version.minor, 1);
  EXPECT_EQ(turned->head.meta.size(), 1u);
  EXPECT_EQ(turned->scope.roots.size(), 1u);
}

TEST(X3dJson, NumbersComeFromTheBytesOfTheFile) {
  const auto world = load(scene(R"({"Transform":{"@translation":[0.1,-2E-3,33554433]}})"));
  EXPECT_EQ(first<nodes::Transform>(*world).translation, (Vec3f{0.1f, -2e-3f, 33554433.0f}));
}

TEST(X3dJson, NumbersThatAreTooLargeLoseTheirValueAlone) {
  for (const std::string& number :
       {std::string("1e999"), std::string("-2.5E+400"), std::string(400, '9')}) {
    const auto world = load(scene(R"({"Transform":{"@class":"e9 \\\"","@translation":[1,)" +
                                  number + R"(,3],"@scale":[1.5e1,2,3]}},{"Group":{"@DEF":"B"}})"));
    const std::string said = messages(*world);
    EXPECT_EQ(said.find("test.x3dj:1:"), 0u) << said;
    EXPECT_EQ(said.find("well-formed"), said.npos) << said;
    EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
    ASSERT_EQ(world->scope.roots.size(), 2u) << said;
    EXPECT_EQ(first<nodes::Transform>(*world).translation, Vec3f{});
    EXPECT_EQ(first<nodes::Transform>(*world).scale, (Vec3f{15, 2, 3}));
  }
  const auto wrong = load(scene(R"({"Transform":{"@translation":[1,2e,3]}})"));
  EXPECT_NE(messages(*wrong).find("not well-formed JSON"), std::string::npos);
}

TEST(X3dJson, NumbersInStringsAreRead) {
  const auto world = load(scene(R"({"Transform":{"@translation":"1 2 3","@DEF":"A"}})"));
  EXPECT_EQ(messages(*world), "");
  EXPECT_EQ(first<nodes::Transform>(*world).translation, (Vec3f{1, 2, 3}));
}

TEST(X3dJson, StringsKeepTheirCharacters) {
  const auto world = load(scene(R"({"WorldInfo":{"@title":"a\nb\t\"\\é",)"
                                R"("@info":["x\ny","\"q\"","a\\b","\ud83d\ude00"]}})"));
  EXPECT_EQ(messages(*world), "");
  const auto& info = first<nodes::WorldInfo>(*world);
  EXPECT_EQ(info.title, "a\nb\t\"\\é");
  EXPECT_EQ(info.info, (MFString{"x\ny", "\"q\"", "a\\b", "😀"}));
}

TEST(X3dJson, PlacesAreThoseOfTheFile) {
  const auto world = load("{ \"X3D\" : { \"@version\":\"3.3\",\n \"Scene\" : { \"-children\" : [\n"
                          "  { \"Shape\" : { \"-geometry\" : { \"Box\" :\n"
                          "    { \"@size\" : [ 1,\n2.5, true ] } } } } ] } } }");
  EXPECT_EQ(messages(*world), "test.x3dj:5:6: error: expected a component of SFVec3f, found "
                              "'true'\n");
  EXPECT_EQ(world->scope.roots.at(0)->source.line, 3u);
  EXPECT_EQ(world->scope.roots.at(0)->source.column, 6u);
}

TEST(X3dJson, DeepFilesAreBounded) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "{\"Group\":{\"-children\":[";
  EXPECT_EQ(load(scene(deep))->diagnostics.errors(), 2u);
  std::string nodes;
  for (int i = 0; i < 1500; ++i) nodes += "{\"Group\":{\"-children\":[";
  for (int i = 0; i < 1500; ++i) nodes += "]}}";
  EXPECT_NE(messages(*load(scene(nodes))).find("nodes nested deeper than limit nesting=1000"),
            std::string::npos);
}

TEST(X3dJson, TheBudgetBoundsTheIndex) {
  LoadOptions options;
  options.limits.worldBytes = 10000;
  std::string many;
  for (int i = 0; i < 2000; ++i) many += "{},";
  EXPECT_NE(messages(*load(scene(many + "{}"), options)).find("limit worldBytes=10000"),
            std::string::npos);
}

TEST(X3dJson, AFileThatEndsEarlyKeepsWhatItHas) {
  const std::string whole = scene(
      R"({"Group":{"@DEF":"A","-children":[{"Shape":{"-geometry":{"Box":{"@size":[1,2,3]}}}}]}},)"
      R"({"Script":{"#sourceCode":["ecmascript:","x"],"field":[{"@name":"a","@type":"SFBool",)"
      R"("@accessType":"initializeOnly","@value":true}]}},{"Transform":{"@DEF":"B"}})");
  for (size_t size = 1; size < whole.size(); ++size) {
    const auto world = load(whole.substr(0, size));
    EXPECT_GE(world->diagnostics.errors(), 1u) << size;
    const auto again = loadWorldFromMemory(writeWorld(*world), "a.wrl");
    EXPECT_TRUE(equalScopes(world->scope, again->scope)) << size;
  }
  EXPECT_EQ(load(whole.substr(0, whole.find("{\"Transform")))->scope.roots.size(), 2u);
}

TEST(X3dJson, DamagedBytesNeverStopTheReader) {
  const std::string whole = scene(
      R"({"Group":{"@DEF":"A","-children":[{"Shape":{"-geometry":{"Box":{"@size":[1,2,3]}}}}]}})");
  for (size_t at = 1; at < whole.size(); ++at) {
    for (const char c : {'{', '}', '[', ']', '"', '\\', ',', ':', '\0', '\xff', '1', '-', '@'}) {
      std::string text = whole;
      text[at] = c;
      EXPECT_NO_THROW(writeWorld(*load(text))) << text;
    }
  }
}

} // namespace
