// Tests of files that are written atomically (libpicture/files/atomic_file.h): by several threads
// at once, and which files may not be replaced.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <latch>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "libpicture/files/atomic_file.h"

namespace picture {

namespace {

namespace fs = std::filesystem;

class AtomicFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "openrt-atomic-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string pathOf(const std::string& name) const { return (folder_ / name).string(); }
  std::string contentOf(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  size_t files() const {
    return size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

// Returns a content that tells who has written it, and is longer than one block of a file system.
std::string contentBy(int writer, int number) {
  std::string text;
  while (text.size() < 20'000) text += std::to_string(writer) + "/" + std::to_string(number) + " ";
  return text;
}

// Calls `work` with a number on each of several threads, which begin together.
template <class Work> void onThreads(int count, const Work& work) {
  std::latch begin(count);
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i)
    threads.emplace_back([&, i] {
      begin.arrive_and_wait();
      work(i);
    });
  for (std::thread& thread : threads) thread.join();
}

constexpr int writers = 8, each = 25;

} // namespace

TEST_F(AtomicFile, EachOfSeveralWritersGetsItsOwnFile) {
  onThreads(writers, [&](int writer) {
    for (int i = 0; i < each; ++i)
      writeFile(pathOf(std::to_string(writer) + "-" + std::to_string(i)), contentBy(writer, i));
  });
  for (int writer = 0; writer < writers; ++writer)
    for (int i = 0; i < each; ++i)
      EXPECT_EQ(contentOf(std::to_string(writer) + "-" + std::to_string(i)), contentBy(writer, i));
  EXPECT_EQ(files(), size_t(writers * each)); // no temporary file is left
}

TEST_F(AtomicFile, WritersOfTheSameFileLeaveOneWholeContent) {
  onThreads(writers, [&](int writer) {
    for (int i = 0; i < each; ++i) writeFile(pathOf("same"), contentBy(writer, i));
  });
  bool whole = false;
  for (int writer = 0; writer < writers; ++writer)
    whole |= contentOf("same") == contentBy(writer, each - 1);
  EXPECT_TRUE(whole);
  EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFile, AFileIsProtectedWhileOthersAreWritten) {
  writeFile(pathOf("world"), "a world");
  // It stays open until the process ends: no other test gets a file with its number, which is
  // protected from now on.
  ASSERT_NE(std::fopen(pathOf("world").c_str(), "r"), nullptr);
  onThreads(writers, [&](int writer) {
    const std::string own = std::to_string(writer);
    for (int i = 0; i < each; ++i) {
      writeFile(pathOf(own), contentBy(writer, i));
      protectFile(pathOf("world"), "the world that is read");
      EXPECT_THROW(writeFile(pathOf("world"), "a picture"), std::runtime_error);
    }
  });
  EXPECT_EQ(contentOf("world"), "a world");
}

TEST_F(AtomicFile, AnEditedFileIsReplacedAndStaysProtected) {
  writeFile(pathOf("edited"), "a world");
  ASSERT_NE(std::fopen(pathOf("edited").c_str(), "r"), nullptr); // as above
  protectFile(pathOf("edited"), "the world that is read");
  for (const char* const text : {"one edit", "another edit"}) {
    writeEditedFile(pathOf("edited"), text);
    EXPECT_EQ(contentOf("edited"), text);
    EXPECT_THROW(writeRegularFile(pathOf("edited"), "a picture"), std::runtime_error);
  }
  EXPECT_THROW(writeEditedFile("/dev/null", "a world"), std::runtime_error);
}

TEST_F(AtomicFile, AFailedWriteLeavesNothingBehind) {
  fs::create_directory(folder_ / "folder");
  EXPECT_THROW(writeFile(pathOf("folder"), "text"), std::runtime_error);
  EXPECT_THROW(writeFile(pathOf("missing/file"), "text"), std::runtime_error);
  EXPECT_EQ(files(), 1u);
}

} // namespace picture
