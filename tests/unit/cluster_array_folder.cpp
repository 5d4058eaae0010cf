// cluster_array_folder.cpp: Tests the folder of arrays: what is kept comes back, damaged and
// hostile files do not, and the size has a limit.
#include "backend/cluster/worker/array_folder.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "backend/cluster/worker/array_cache.h"
#include "unit/cluster_wires.h"

using namespace openrt;
using namespace openrt::cluster;
namespace fs = std::filesystem;

namespace {

constexpr uint64_t megabyte = 1 << 20;

struct Sample { // an array that does not become smaller by packing
  std::vector<std::byte> bytes, packed;
  Hash hash;
  explicit Sample(size_t count, uint32_t seed = 1)
      : bytes(someBytes(count, seed)), packed(packArray(bytes)), hash(hashOf(bytes)) {}
  std::string name() const { return hex(hash) + ".zst"; }
};

void put(ArrayFolder& folder, const Sample& sample) {
  ArrayFolder::Writer writer(folder, sample.hash, sample.packed.size());
  writer.write(std::span(sample.packed).first(sample.packed.size() / 2));
  writer.write(std::span(sample.packed).subspan(sample.packed.size() / 2));
  writer.keep();
}

bool has(ArrayFolder& folder, const Sample& sample) {
  const ArrayPtr array = folder.load(sample.hash, sample.bytes.size());
  return array && std::equal(sample.bytes.begin(), sample.bytes.end(), array->data());
}

size_t filesIn(const std::string& path) {
  return size_t(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
}

void setAge(const std::string& path, time_t seconds) {
  timespec times[2]{};
  times[0].tv_sec = times[1].tv_sec = time(nullptr) - seconds;
  ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, AT_SYMLINK_NOFOLLOW), 0);
}

struct Kept {
  Folder place;
  std::string path = place / "arrays";
  std::vector<std::string> said;
  ArrayFolder folder;
  explicit Kept(uint64_t limit = 100 * megabyte)
      : folder(path, limit, [this](int, const std::string& text) { said.push_back(text); }) {}
};

} // namespace

TEST(ArrayFolder, whatIsKeptComesBack) {
  Kept k;
  const Sample small(100), large(3 * megabyte + 17, 2);
  EXPECT_FALSE(has(k.folder, small));
  put(k.folder, small);
  put(k.folder, large);
  put(k.folder, large); // by another worker
  EXPECT_TRUE(has(k.folder, small));
  EXPECT_TRUE(has(k.folder, large));
  EXPECT_FALSE(k.folder.load(large.hash, large.bytes.size() + 1)) << "another size";
  ArrayFolder later(k.path, 100 * megabyte, {});
  EXPECT_FALSE(has(later, large)) << "a file that is not of the size that is asked for is damaged";
  EXPECT_TRUE(has(later, small));
}

TEST(ArrayFolder, onlyItsOwnerMayReadIt) {
  const mode_t before = umask(0);
  {
    Kept k;
    const Sample sample(100);
    put(k.folder, sample);
    struct stat info;
    ASSERT_EQ(stat(k.path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0700u);
    ASSERT_EQ(stat((k.path + "/" + sample.name()).c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0600u);
  }
  umask(before);
}

TEST(ArrayFolder, foldersOfOthersAreRefused) {
  const Folder place;
  const std::string path = place / "arrays";
  const auto open = [&] { ArrayFolder folder(path, megabyte, {}); };
  ASSERT_EQ(mkdir(path.c_str(), 0700), 0);
  EXPECT_EQ(thrown(open), "");
  ASSERT_EQ(chmod(path.c_str(), 0770), 0);
  EXPECT_EQ(thrown(open),
            "the folder of arrays " + path + ": other users may write there: chmod go-w " + path);
  ASSERT_EQ(chmod(path.c_str(), 0700), 0);
  fs::rename(path, place / "elsewhere");
  fs::create_symlink(place / "elsewhere", path);
  EXPECT_EQ(thrown(open), "the folder of arrays " + path + ": it is no folder, or a link");
  fs::remove(path);
  std::ofstream(path) << "file";
  EXPECT_EQ(thrown(open), "the folder of arrays " + path + ": it is no folder, or a link");
  EXPECT_NE(thrown([&] { ArrayFolder folder(place / "no/such", megabyte, {}); }), "");
  if (geteuid() != 0) return;
  fs::remove(path);
  ASSERT_EQ(mkdir(path.c_str(), 0700), 0);
  ASSERT_EQ(chown(path.c_str(), 12345, 12345), 0);
  EXPECT_EQ(thrown(open), "the folder of arrays " + path + ": it belongs to another user");
}

TEST(ArrayFolder, damagedFilesAreNoArraysAndGo) {
  Kept k;
  const Sample sample(50000);
  const std::string file = k.path + "/" + sample.name();
  uint64_t damaged = 0;
  const auto expectDamaged = [&](const char* what) {
    EXPECT_FALSE(has(k.folder, sample)) << what;
    EXPECT_FALSE(fs::exists(fs::symlink_status(file))) << what;
    EXPECT_EQ(k.folder.damaged(), ++damaged) << what;
  };
  for (size_t at = 0; at < sample.packed.size(); at += 997) {
    put(k.folder, sample);
    std::fstream(file, std::ios::in | std::ios::out)
        .seekp(std::streamoff(at))
        .put(char(std::to_integer<int>(sample.packed[at]) ^ 0x40));
    if (has(k.folder, sample)) continue; // bits of zstd that mean nothing
    EXPECT_EQ(k.folder.damaged(), ++damaged) << at;
  }
  EXPECT_GT(damaged, 45u);
  put(k.folder, sample);
  fs::resize_file(file, sample.packed.size() - 1);
  expectDamaged("cut");
  put(k.folder, sample);
  std::ofstream(file, std::ios::app) << "more";
  expectDamaged("longer");
  put(k.folder, sample);
  fs::resize_file(file, 0); // as a machine leaves it that has crashed
  expectDamaged("empty");
  put(k.folder, sample);
  fs::resize_file(file, 0);
  EXPECT_FALSE(k.folder.open(sample.hash, sample.bytes.size())) << "nothing to send";
  EXPECT_EQ(k.folder.damaged(), ++damaged);
  put(k.folder, sample);
  fs::resize_file(file, uint64_t(1) << 30); // sparse; more than the array could ever have
  EXPECT_FALSE(k.folder.open(sample.hash, sample.bytes.size()));
  EXPECT_EQ(k.folder.damaged(), damaged) << "the size may be a stranger's word";
  expectDamaged("far longer");
  fs::create_symlink("/etc/passwd", file);
  EXPECT_FALSE(has(k.folder, sample));
  EXPECT_EQ(k.folder.damaged(), damaged) << "links are not followed, and not read";
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_FALSE(has(k.folder, sample)); // and does not wait
  put(k.folder, sample);               // replaces it
  EXPECT_TRUE(has(k.folder, sample));
  EXPECT_EQ(k.said.size(), 1u) << "a user is told once";
}

TEST(ArrayFolder, oneThatMayOnlyBeReadGivesWhatItHas) {
  Kept k;
  const Sample kept(50000), other(50000, 7), spoiled(50000, 8);
  put(k.folder, kept);
  put(k.folder, spoiled);
  fs::resize_file(k.path + "/" + spoiled.name(), 100);
  constexpr uid_t nobody = 65534;
  const bool root = geteuid() == 0; // may write everywhere
  for (const std::string& path : {std::string(k.place / "."), k.path, k.path + "/" + kept.name(),
                                  k.path + "/" + spoiled.name()})
    ASSERT_TRUE(!root || chown(path.c_str(), nobody, nobody) == 0);
  ASSERT_EQ(chmod(k.path.c_str(), 0500), 0);
  ASSERT_TRUE(!root || seteuid(nobody) == 0);
  std::vector<std::string> said;
  {
    ArrayFolder folder(k.path, megabyte,
                       [&](int, const std::string& text) { said.push_back(text); });
    EXPECT_TRUE(has(folder, kept));
    put(folder, other);
    EXPECT_FALSE(has(folder, other));
    for (uint64_t i = 1; i <= 2; ++i) {
      EXPECT_FALSE(has(folder, spoiled));
      EXPECT_EQ(folder.damaged(), i) << "it is still there";
    }
  }
  ASSERT_TRUE(!root || seteuid(0) == 0);
  ASSERT_EQ(chmod(k.path.c_str(), 0700), 0);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "the folder of arrays " + k.path +
                         ": what it has is used, and nothing is added: Permission denied");
  EXPECT_EQ(filesIn(k.path), 2u);
}

TEST(ArrayFolder, aSmallFileIsNotUnpackedWithoutEnd) {
  Kept k;
  const std::vector<std::byte> zeros(64 * megabyte);
  Sample sample(10);
  sample.packed = packArray(zeros); // a few kilobytes, under the name of ten bytes
  put(k.folder, sample);
  EXPECT_FALSE(has(k.folder, sample));
  put(k.folder, sample);
  EXPECT_FALSE(k.folder.load(sample.hash, uint64_t(1) << 33)) << "8 GB from a few kilobytes";
}

TEST(ArrayFolder, whatWasNotUsedForLongestGoes) {
  Kept k(4 * megabyte);
  std::vector<Sample> samples;
  for (uint32_t i = 0; i < 5; i++) samples.emplace_back(megabyte - 10000, 10 + i);
  for (int i = 0; i < 4; i++) {
    put(k.folder, samples[size_t(i)]);
    setAge(k.path + "/" + samples[size_t(i)].name(), 1000 - 100 * i);
  }
  std::ofstream(k.path + "/notes.txt") << std::string(2 * megabyte, 'x'); // somebody else's
  EXPECT_TRUE(has(k.folder, samples[0]));                                 // used now
  put(k.folder, samples[4]);
  EXPECT_TRUE(has(k.folder, samples[0]));
  EXPECT_FALSE(has(k.folder, samples[1]));
  for (size_t i = 2; i < 5; i++) EXPECT_TRUE(has(k.folder, samples[i])) << i;
  EXPECT_TRUE(fs::exists(k.path + "/notes.txt"));
  const Sample tooLarge(5 * megabyte, 99);
  put(k.folder, tooLarge);
  EXPECT_FALSE(has(k.folder, tooLarge));
  EXPECT_TRUE(has(k.folder, samples[4])) << "nothing had to go for it";
}

TEST(ArrayFolder, unfinishedFilesAreNoArrays) {
  Kept k;
  const Sample sample(50000);
  {
    ArrayFolder::Writer writer(k.folder, sample.hash, sample.packed.size());
    writer.write(sample.packed);
    EXPECT_EQ(filesIn(k.path), 1u);
    EXPECT_FALSE(has(k.folder, sample));
  }
  EXPECT_EQ(filesIn(k.path), 0u);
  const std::string left = k.path + "/" + std::string(32, 'a') + ".part",
                    fresh = k.path + "/" + std::string(32, 'b') + ".part";
  std::ofstream(left) << "of a worker that was killed";
  std::ofstream(fresh) << "of one that still writes";
  setAge(left, 4000);
  const ArrayFolder again(k.path, megabyte, {});
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(fresh));
}

TEST(ArrayFolder, aStreamKeepsOnlyWhatHasTheRightHash) {
  Kept k;
  const Sample good(3 * megabyte, 5), bad(2 * megabyte, 6);
  const auto send = [&](const Sample& sample, const Hash& hash) {
    ArrayStream stream(hash, sample.bytes.size(), &k.folder);
    for (size_t at = 0; at < sample.packed.size(); at += pieceBytes)
      EXPECT_EQ(stream.put(pieceOf(hash, sample.bytes.size(), sample.packed, at)), "");
    return stream.take() != nullptr;
  };
  EXPECT_TRUE(send(good, good.hash));
  EXPECT_FALSE(send(bad, Hash{1, 2}));
  EXPECT_TRUE(has(k.folder, good));
  EXPECT_EQ(filesIn(k.path), 1u);
}

TEST(ArrayFolder, manyUseItAtOnce) {
  const Folder place;
  const std::string path = place / "arrays";
  std::vector<Sample> samples;
  for (uint32_t i = 0; i < 8; i++) samples.emplace_back(200000, 20 + i);
  std::atomic<uint64_t> hits{0}, damaged{0};
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 4; t++)
    threads.emplace_back([&, t] { // two folder objects, as of two processes
      ArrayFolder folder(path, megabyte, {});
      for (uint32_t i = 0; i < 60; i++) {
        const Sample& sample = samples[(i * 5 + t) % samples.size()];
        if (has(folder, sample))
          hits++;
        else
          put(folder, sample);
      }
      damaged += folder.damaged();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(hits, 0u);
  EXPECT_EQ(damaged, 0u);
  uint64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(path)) bytes += file.file_size();
  EXPECT_LE(bytes, megabyte + 4 * 200200);
}
