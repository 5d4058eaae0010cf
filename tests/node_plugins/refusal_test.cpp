// refusal_test.cpp: plug-ins that do not fit are refused with a line that names what they have and what was expected.
#include <gtest/gtest.h>

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
  EXPECT_TRUE(told("MAGIC", "does not begin as one"));
  EXPECT_TRUE(told("MAJOR", "version 2.0") && told("MAJOR", "has 1.0"));
  EXPECT_TRUE(told("MINOR", "version 1.1") && told("MINOR", "has 1.0"));
  EXPECT_TRUE(told("SIZE", "8 bytes"));
  EXPECT_TRUE(told("ABI", "\"another library\"") && told("ABI", XVRML_CXX_ABI));
  EXPECT_TRUE(told("SIZES", "another version"));
  EXPECT_TRUE(told("NAME", "node type Box already"));
  EXPECT_TRUE(told("NONE", "exports no xvrmlNodePlugin"));
  EXPECT_EQ(nodeTypes().size(), before);
}

TEST(NodePluginRefusals, AMissingFolderIsNone) { EXPECT_TRUE(loadNodePlugins("/nonexistent/folder").empty()); }

} // namespace
