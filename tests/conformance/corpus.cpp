// corpus.cpp: real files of many authors (the corpus beside the repository, or $OPENRT_CORPUS;
// skipped if there is none). Each class of files has a promise to keep, and all files must survive
// writing and reading again.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "xvrml/world.h"

namespace {

using namespace xvrml;

std::string corpusFolder() {
  const char* folder = std::getenv("OPENRT_CORPUS");
  return folder ? folder : "../shared/corpus";
}

// Returns the paths of a class (second column: path, third: class of FEATURES.tsv); empty if there
// is no corpus.
std::vector<std::string> filesOfClass(const std::string& wanted) {
  std::vector<std::string> paths;
  std::ifstream table(corpusFolder() + "/FEATURES.tsv");
  for (std::string line; std::getline(table, line);) {
    std::istringstream columns(line);
    std::string folder, path, type;
    std::getline(columns, folder, '\t');
    std::getline(columns, path, '\t');
    std::getline(columns, type, '\t');
    if (type == wanted) paths.push_back(corpusFolder() + '/' + folder + '/' + path);
  }
  return paths;
}

std::string firstMessage(const World& world) {
  return world.diagnostics.list().empty() ? "" : world.diagnostics.list().front().text();
}

bool hasPlace(const World& world, Severity least) {
  for (const Diagnostic& diagnostic : world.diagnostics.list()) {
    if (diagnostic.severity >= least && diagnostic.line > 0 && diagnostic.column > 0) return true;
  }
  return false;
}

void expectRoundTrip(const World& world, const std::string& path) {
  const std::string text = writeWorld(world);
  const auto again = loadWorldFromMemory(text, path);
  std::string difference;
  EXPECT_TRUE(equalScopes(world.scope, again->scope, &difference)) << path << ": " << difference;
  EXPECT_EQ(writeWorld(*again), text) << path;
}

#define REQUIRE_CORPUS(files)                                                                      \
  if (files.empty()) GTEST_SKIP() << "no corpus at " << corpusFolder()

TEST(Corpus, StrictFilesLoadAndRoundTrip) {
  const auto files = filesOfClass("strict");
  REQUIRE_CORPUS(files);
  size_t silent = 0;
  for (const std::string& path : files) {
    try {
      const auto world = loadWorld(path);
      silent += world->diagnostics.errors() == 0;
      for (const Diagnostic& diagnostic : world->diagnostics.list()) {
        EXPECT_TRUE(diagnostic.severity != Severity::error || diagnostic.line > 0)
            << diagnostic.text();
      }
      expectRoundTrip(*world, path);
    } catch (const LoadError& error) { ADD_FAILURE() << error.diagnostic.text(); }
  }
  // Some files use X3D fields or break rules. The share counted when the parser was written must
  // not get worse.
  EXPECT_GE(silent, files.size() * 85 / 100);
}

TEST(Corpus, FilesWithForeignNodesSaySoAndKeepTheRest) {
  const auto files = filesOfClass("ext");
  REQUIRE_CORPUS(files);
  for (const std::string& path : files) {
    const auto world = loadWorld(path);
    EXPECT_TRUE(hasPlace(*world, Severity::warning)) << path;
    expectRoundTrip(*world, path);
  }
}

TEST(Corpus, InexactHeadersGiveAWarning) {
  const auto files = filesOfClass("header");
  REQUIRE_CORPUS(files);
  for (const std::string& path : files) {
    const auto world = loadWorld(path);
    EXPECT_TRUE(hasPlace(*world, Severity::warning)) << path << firstMessage(*world);
    expectRoundTrip(*world, path);
  }
}

TEST(Corpus, BadFilesGiveErrorsWithPlaces) {
  const auto files = filesOfClass("bad");
  REQUIRE_CORPUS(files);
  for (const std::string& path : files) {
    const auto world = loadWorld(path);
    EXPECT_TRUE(hasPlace(*world, Severity::error)) << path;
    expectRoundTrip(*world, path);
  }
}

TEST(Corpus, Vrml1IsRead) {
  const auto files = filesOfClass("v1");
  REQUIRE_CORPUS(files);
  for (const std::string& path : files) {
    const auto world = loadWorld(path);
    EXPECT_EQ(world->head.version.encoding, Encoding::vrml1) << path;
    for (const Diagnostic& said : world->diagnostics.list())
      EXPECT_NE(said.severity, Severity::error) << said.text();
  }
}

} // namespace
