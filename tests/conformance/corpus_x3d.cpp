// corpus_x3d.cpp: real files of X3D by many authors, in ClassicVRML, XML and JSON, and of
// VRML 1.0 (the corpus beside the repository, or $OPENRT_CORPUS_X3D; skipped if there is none).
// None may be refused or silently empty.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "conformance/lost_values.h"

namespace {

using namespace xvrml;

// Returns the paths of the corpus's files with one of these suffixes; empty if there is no corpus.
std::vector<std::string> filesWith(const std::vector<std::string>& suffixes) {
  const char* given = std::getenv("OPENRT_CORPUS_X3D");
  const std::string folder = given ? given : "../shared/corpus-x3d";
  std::vector<std::string> paths;
  std::ifstream table(folder + "/MANIFEST.tsv");
  for (std::string line; std::getline(table, line);) {
    std::istringstream columns(line);
    std::string origin, path;
    std::getline(columns, origin, '\t');
    std::getline(columns, path, '\t');
    if (std::any_of(suffixes.begin(), suffixes.end(),
                    [&](const std::string& suffix) { return path.ends_with(suffix); }))
      paths.push_back(folder + '/' + origin + '/' + path);
  }
  return paths;
}

// Returns whether a file is in UTF-16, which ClassicVRML does not allow.
bool isUtf16(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return file.get() == 0xff && file.get() == 0xfe;
}

bool hasNodes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return text.find('{') != std::string::npos || text.find("<Scene>") != std::string::npos;
}

// wanted: percent of the files that have to load without an error.
void expectToBeRead(const std::vector<std::string>& files, size_t wanted) {
  if (files.empty()) GTEST_SKIP() << "no corpus of X3D files";
  size_t clean = 0, withoutErrors = 0;
  for (const std::string& path : files) {
    if (path.ends_with(".x3dv") && isUtf16(path)) continue;
    LoadOptions options;
    options.loadInlines = false; // they may name files in formats that are not read yet
    std::unique_ptr<World> world;
    ASSERT_NO_THROW(world = loadWorld(path, options)) << path;
    const Diagnostics& said = world->diagnostics;
    clean += said.list().empty();
    withoutErrors += said.errors() == 0;
    EXPECT_FALSE(hasNodes(path) && world->scope.roots.empty() && world->scope.prototypes.empty() &&
                 said.list().empty())
        << path << " is silently empty";
    if (test::losesValues(*world, Encoding::vrml97)) continue;
    const std::string text = writeWorld(*world);
    const auto again = loadWorldFromMemory(text, path, options);
    EXPECT_EQ(writeWorld(*again), text) << path;
  }
  testing::Test::RecordProperty("files", static_cast<int>(files.size()));
  testing::Test::RecordProperty("clean", static_cast<int>(clean));
  testing::Test::RecordProperty("without_errors", static_cast<int>(withoutErrors));
  EXPECT_GE(withoutErrors * 100, files.size() * wanted);
}

// A file says the same in all encodings of X3D: every seventh file, written as ClassicVRML, as XML,
// as JSON and as VRML97, is the same graph again. XML and JSON have no NULL, so a list with NULL
// is compared with what they make of it. OPENRT_CORPUS_STEP=1 takes every file.
TEST(CorpusX3d, FilesAreTheSameGraphInEveryEncoding) {
  const auto files = filesWith({".x3dv", ".x3d", ".x3dj"});
  if (files.empty()) GTEST_SKIP() << "no corpus of X3D files";
  const char* const step = std::getenv("OPENRT_CORPUS_STEP");
  for (size_t i = 0; i < files.size(); i += step ? std::max(1, std::atoi(step)) : 7) {
    const std::string& path = files[i];
    if (path.ends_with(".x3dv") && isUtf16(path)) continue;
    LoadOptions options;
    options.loadInlines = false;
    const auto world = loadWorld(path, options);
    for (const Encoding encoding :
         {Encoding::x3dClassic, Encoding::x3dXml, Encoding::x3dJson, Encoding::vrml97}) {
      if (test::losesValues(*world, encoding)) continue;
      const auto again = loadWorldFromMemory(writeWorld(*world, path, encoding), path, options);
      std::string difference;
      if (equalScopes(world->scope, again->scope, &difference)) continue;
      const std::string text = writeWorld(*world, path, encoding);
      const bool cannotSay = (encoding == Encoding::x3dXml || encoding == Encoding::x3dJson) &&
                             writeWorld(*world).find("NULL") != std::string::npos &&
                             writeWorld(*again, path, encoding) == text;
      EXPECT_TRUE(cannotSay) << path << " as " << encodingName(encoding) << ": " << difference;
    }
  }
}

TEST(CorpusX3d, ClassicFilesAreReadAndSurviveWriting) { expectToBeRead(filesWith({".x3dv"}), 75); }

TEST(CorpusX3d, FilesInXmlAndJsonAreReadAndSurviveWriting) {
  expectToBeRead(filesWith({".x3d", ".x3dz", ".x3dj"}), 90);
}

// Returns the paths of the corpus's files in VRML 1.0; empty if there is no corpus.
std::vector<std::string> vrml1Files() {
  std::vector<std::string> paths;
  for (const std::string& path : filesWith({".wrl"})) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    if (std::getline(file, line) && line.starts_with("#VRML V1.0")) paths.push_back(path);
  }
  return paths;
}

TEST(CorpusX3d, FilesInVrml1AreReadAndSurviveWriting) {
  const auto files = vrml1Files();
  if (files.empty()) GTEST_SKIP() << "no corpus of VRML 1.0 files";
  size_t withoutErrors = 0;
  for (const std::string& path : files) {
    LoadOptions options;
    options.loadInlines = false;
    std::unique_ptr<World> world;
    ASSERT_NO_THROW(world = loadWorld(path, options)) << path;
    const Diagnostics& said = world->diagnostics;
    withoutErrors += said.errors() == 0;
    EXPECT_EQ(world->head.version.encoding, Encoding::vrml1) << path;
    if (test::losesValues(*world, Encoding::vrml97)) continue;
    const std::string text = writeWorld(*world);
    const auto again = loadWorldFromMemory(text, path, options);
    EXPECT_EQ(again->diagnostics.errors(), 0u) << path;
    EXPECT_EQ(writeWorld(*again), text) << path;
  }
  EXPECT_GE(withoutErrors * 100, files.size() * 95);
}

} // namespace
