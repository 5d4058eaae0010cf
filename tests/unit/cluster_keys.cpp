// cluster_keys.cpp: Tests key files: who may read them, which are refused, and that no key is ever
// lost.
#include <fstream>

#include <sys/stat.h>

#include "unit/cluster_wires.h"

using namespace openrt::cluster;

namespace {

void write(const std::string& path, const std::string& text, mode_t mode = 0600) {
  std::ofstream(path) << text;
  chmod(path.c_str(), mode);
}
std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

TEST(Keys, aNewOneIsForItsOwnerAlone) {
  const Folder folder;
  const mode_t before = umask(0);
  const std::string key = makeKeyFile(folder / "key");
  umask(before);
  struct stat info {};
  ASSERT_EQ(stat((folder / "key").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0600u);
  const KeyRing ring = readKeys(folder / "key");
  EXPECT_EQ(ring.publicKey, key);
  EXPECT_EQ(ring.publicKey.size(), 40u);
  EXPECT_EQ(ring.secretKey.size(), 40u);
  EXPECT_NE(ring.publicKey, ring.secretKey);
  EXPECT_NE(makeKeyFile(folder / "other"), key);
}

TEST(Keys, neverOverAFile) {
  const Folder folder;
  makeKeyFile(folder / "key");
  const std::string before = contents(folder / "key");
  EXPECT_NE(thrown([&] { makeKeyFile(folder / "key"); }).find("exists already"), std::string::npos);
  EXPECT_EQ(contents(folder / "key"), before);
  EXPECT_NE(thrown([&] { makeKeyFile(folder / "no/such/folder"); }), "");
}

TEST(Keys, filesThatOthersMayUseAreRefused) {
  const Folder folder;
  makeKeyFile(folder / "key");
  for (const mode_t mode : {0640, 0604, 0620, 0610}) {
    chmod((folder / "key").c_str(), mode);
    EXPECT_NE(thrown([&] { readKeys(folder / "key"); }).find("chmod 600"), std::string::npos)
        << mode;
  }
  chmod((folder / "key").c_str(), 0400);
  EXPECT_EQ(thrown([&] { readKeys(folder / "key"); }), "");
}

TEST(Keys, whatIsNoKeyFileIsRefusedWithItsName) {
  const Folder folder;
  const KeyRing a = freshKeys(folder, "a"), b = freshKeys(folder, "b");
  const std::string path = folder / "key";
  const auto refused = [&](const std::string& text) {
    write(path, text);
    return thrown([&] { readKeys(path); });
  };
  EXPECT_NE(refused("").find(path), std::string::npos);
  EXPECT_NE(refused("public " + a.publicKey + "\n").find("not a key file"), std::string::npos);
  EXPECT_NE(refused("public " + a.publicKey + "\nsecret short\n").find("line 2"),
            std::string::npos);
  EXPECT_NE(
      refused("public " + a.publicKey + "\nsecret " + b.secretKey + "\n").find("does not belong"),
      std::string::npos);
  EXPECT_NE(refused("public " + a.publicKey + "\npublic " + a.publicKey + "\n").find("line 2"),
            std::string::npos);
  EXPECT_NE(refused(std::string("\0\1\2", 3)), "");
  EXPECT_EQ(refused("\r\n public  " + a.publicKey + "\r\nsecret\t" + a.secretKey), "");
  EXPECT_NE(thrown([&] { readKeys(folder.path); }).find("not a file"), std::string::npos);
  EXPECT_NE(thrown([&] { readKeys("/dev/zero"); }), "");
  EXPECT_NE(thrown([&] { readKeys(folder / "absent"); }).find("No such file"), std::string::npos);
}

TEST(Keys, listsOfThoseThatAreLetIn) {
  const Folder folder;
  const KeyRing a = freshKeys(folder, "a"), b = freshKeys(folder, "b");
  write(folder / "allow",
        "# the farm\n\n" + a.publicKey + " node 1\n  public " + b.publicKey + "\n#x\n", 0644);
  EXPECT_EQ(readKeys(folder / "a", folder / "allow").allowed,
            (std::vector{a.publicKey, b.publicKey}));
  write(folder / "allow", a.publicKey + "\nnode2\n", 0644);
  EXPECT_NE(thrown([&] { readKeys(folder / "a", folder / "allow"); }).find("line 2"),
            std::string::npos);
}
