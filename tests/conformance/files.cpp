// files.cpp: the files of good/ load without messages and survive writing. Those of bad/ give the
// messages stated in their second line: "# expect LINE:COLUMN SEVERITY MESSAGE | ...". The file
// names state the rule that they test.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "conformance/lost_values.h"

namespace {

using namespace xvrml;

std::vector<std::string> filesOf(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto suffix = entry.path().extension();
    if (suffix == ".wrl" || suffix == ".x3dv" || suffix == ".x3d" || suffix == ".x3dj" ||
        suffix == ".stl" || suffix == ".ply" || suffix == ".obj" || suffix == ".gltf" ||
        suffix == ".glb" || suffix == ".off")
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& diagnostic : world.diagnostics.list()) text += diagnostic.text() + '\n';
  return text;
}

class Good : public testing::TestWithParam<std::string> {};
class Bad : public testing::TestWithParam<std::string> {};

// A world that is written and read again is equal, and is written as the same text.
void expectRoundTrip(const World& world, const std::string& name, Encoding encoding) {
  if (test::losesValues(world, encoding)) return;
  const std::string text = writeWorld(world, "", encoding);
  const auto again = loadWorldFromMemory(text, name);
  EXPECT_EQ(again->head.version.encoding, encoding);
  const bool spokenThere = encoding != Encoding::vrml97 || world.head.version == FileVersion();
  EXPECT_EQ(spokenThere ? messages(*again) : "", "") << text;
  // VRML97 limits numbers that X3D 4 does not, such as the intensity of a light; it says so.
  if (!spokenThere && messages(*again).find("is outside of its range") != std::string::npos) return;
  std::string difference;
  // Nodes that a reader of VRML 1.0 shares have no names; those that are read again have.
  const bool named = world.head.version.encoding != Encoding::vrml1;
  EXPECT_TRUE(!named || equalScopes(world.scope, again->scope, &difference)) << difference << '\n'
                                                                             << text;
  EXPECT_EQ(writeWorld(*again, "", encoding), text);
}

TEST_P(Good, LoadsSilentlyAndRoundTrips) {
  const auto world = loadWorld(GetParam());
  EXPECT_EQ(messages(*world), "");
  for (const Encoding encoding :
       {Encoding::vrml97, Encoding::x3dClassic, Encoding::x3dXml, Encoding::x3dJson})
    expectRoundTrip(*world, GetParam(), encoding);
}

struct Expected {
  uint32_t line = 0, column = 0;
  std::string severity, message;
};

std::vector<Expected> expectations(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  // In XML the line is a comment, in JSON a string.
  const std::string mark = "# expect ";
  std::vector<Expected> all;
  const size_t begin = line.find(mark); // meshes may have no comments, but some text
  if (begin == line.npos) return all;
  line.erase(0, begin + mark.size());
  line.erase(std::min({line.size(), line.find(" -->"), line.find("\"")}));
  for (size_t at = 0; at < line.size();) {
    const size_t end = std::min(line.find(" | ", at), line.size());
    std::istringstream item(line.substr(at, end - at));
    Expected expected;
    char colon = 0;
    item >> expected.line >> colon >> expected.column >> expected.severity >> std::ws;
    std::getline(item, expected.message);
    all.push_back(expected);
    at = end + 3;
  }
  return all;
}

TEST_P(Bad, SaysWhatIsWrongAndWhere) {
  const std::vector<Expected> expected = expectations(GetParam());
  ASSERT_FALSE(expected.empty());
  const auto world = loadWorld(GetParam());
  const auto& list = world->diagnostics.list();
  ASSERT_EQ(list.size(), expected.size()) << messages(*world);
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(list[i].line, expected[i].line) << list[i].text();
    EXPECT_EQ(list[i].column, expected[i].column) << list[i].text();
    EXPECT_EQ(list[i].severity == Severity::error ? "error" : "warning", expected[i].severity);
    EXPECT_NE(list[i].message.find(expected[i].message), std::string::npos) << list[i].text();
    EXPECT_EQ(list[i].file, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Conformance, Good, testing::ValuesIn(filesOf("tests/conformance/good")),
                         testName);
INSTANTIATE_TEST_SUITE_P(Conformance, Bad, testing::ValuesIn(filesOf("tests/conformance/bad")),
                         testName);

TEST(ConformanceFiles, ThereAreEnough) {
  EXPECT_GE(filesOf("tests/conformance/good").size(), 60u);
  EXPECT_GE(filesOf("tests/conformance/bad").size(), 60u);
}

} // namespace
