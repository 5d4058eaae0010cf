// minor_test.cpp: plug-ins from before the word `urls` (minor 0) keep their URLs: there a field's
// name decides. In later plug-ins it does not.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "xvrml/node_plugin.h"

namespace {

using namespace xvrml;

TEST(NodePluginMinors, BeforeTheWordUrlsTheNameDecides) {
  ASSERT_EQ(loadNodePlugins(MINOR_PLUGINS), std::vector<std::string>());
  for (const char* name : {"Pictures0", "Pictures1"}) {
    const NodeType* type = findNodeType(name);
    ASSERT_TRUE(type) << name;
    const bool older = type->name == "Pictures0";
    EXPECT_EQ(type->find("url")->holdsUrls, older) << name;
    EXPECT_EQ(type->find("frontUrl")->holdsUrls, older) << name;
    EXPECT_FALSE(type->find("words")->holdsUrls) << name;
  }
}

} // namespace
