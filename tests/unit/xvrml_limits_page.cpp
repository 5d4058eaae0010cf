// xvrml_limits_page.cpp: Tests that docs/limits.md has every row of the table of limits, and the
// limit that RunOptions holds.
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>

#include "xvrml/browser.h"
#include "xvrml/limits.h"

namespace {

std::string rows() {
  std::string text;
  const xvrml::Limits defaults;
  for (const xvrml::LimitInfo& info : xvrml::limitTable())
    text += fmt::format("| `{}` | {} | {} |\n", info.name, defaults.*info.value, info.text);
  return text +
         fmt::format("| `worldScriptSeconds` | {} | ", xvrml::RunOptions().worldScriptSeconds);
}

TEST(LimitsPage, HoldsTheTable) {
  std::ifstream file("docs/limits.md");
  ASSERT_TRUE(file) << "docs/limits.md is missing";
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_NE(page.str().find("| --- | --- | --- |\n" + rows()), std::string::npos)
      << "docs/limits.md must hold these rows:\n"
      << rows();
}

} // namespace
