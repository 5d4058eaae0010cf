// refusal_test.cpp: plug-ins that do not match are refused with a line that names what they have
// and what was expected.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "xvrml/node_plugin.h"

namespace {

using namespace xvrml;

TEST(NodePluginRefusals, EachNamesBothSides) {
  const size_t before = nodeTypes().size();
  const std::vector<std::string> refused = loadNodePlugins(BAD_PLUGINS);
  const auto told = [&](const std::string& file, const std::string& what) {
    for (const std::string& line : refused)
      if (line.find("/" + file + ".so") != line.npos && line.find(what) != line.npos) return true;
    return false;
  };
  EXPECT_EQ(refused.size(), 8u);
  EXPECT_TRUE(told("MAGIC", "has a wrong magic number"));
  const std::string own = fmt::format("has {}.{}", nodePluginMajor, nodePluginMinor);
  EXPECT_TRUE(told("MAJOR", "version 2.") && told("MAJOR", own));
  EXPECT_TRUE(told("MINOR", fmt::format("version {}.{}", nodePluginMajor, nodePluginMinor + 1)));
  EXPECT_TRUE(told("MINOR", own));
  EXPECT_TRUE(told("SIZE", "8 bytes"));
  EXPECT_TRUE(told("ABI", "\"another library\"") && told("ABI", XVRML_CXX_ABI));
  EXPECT_TRUE(told("SIZES", "another version"));
  EXPECT_TRUE(told("NAME", "node type Box already"));
  EXPECT_TRUE(told("NONE", "exports no xvrmlNodePlugin"));
  EXPECT_EQ(nodeTypes().size(), before);
}

TEST(NodePluginRefusals, AMissingFolderIsNone) {
  EXPECT_TRUE(loadNodePlugins("/nonexistent/folder").empty());
}

TEST(NodePluginRefusals, FoldersThatOthersMayWriteTo) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::path(testing::TempDir()) / ("node_plugins_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  fs::permissions(folder, fs::perms::all);
  fs::copy_file(fs::path(BAD_PLUGINS) / "MAGIC.so", folder / "x.so",
                fs::copy_options::overwrite_existing);
  const std::vector<std::string> refused = loadNodePlugins(folder.string());
  fs::remove_all(folder);
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].find("others may write to it"), refused[0].npos) << refused[0];
}

} // namespace
