// xvrml_limits_page.cpp: docs/limits.md agrees with the table of limits, row by row.
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>

#include "xvrml/limits.h"

namespace {

std::string rows() {
  std::string text;
  const xvrml::Limits defaults;
  for (const xvrml::LimitInfo& info : xvrml::limitTable())
    text += fmt::format("| `{}` | {} | {} |\n", info.name, defaults.*info.value, info.text);
  return text;
}

TEST(LimitsPage, HoldsTheTable) {
  std::ifstream file("docs/limits.md");
  ASSERT_TRUE(file) << "docs/limits.md is missing";
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_NE(page.str().find("| --- | --- | --- |\n" + rows() + "\n"), std::string::npos)
      << "docs/limits.md must hold exactly these rows:\n"
      << rows();
}

} // namespace
