// editor_report.cpp: Tests the page and the table of a report: what they say, and that nothing of a
// world is taken for markup or for a formula.
#include "edit/report.h"

#include <algorithm>
#include <regex>

#include <gtest/gtest.h>

namespace {

using namespace vv;

Report example() {
  Report report;
  report.world = "table.wrl";
  report.program = "vv 1.2.3";
  report.pictures.push_back({"The view", "\x89PNG", 320, 200, "vv table.wrl --camera 1,2,3:0,0,0"});
  Probe probe;
  probe.number = 1;
  probe.point = {1, 2.5, -3};
  probe.state = Probe::State::read;
  probe.now.luminance = 80;
  probe.now.luminanceHalfWidth = 1.5f;
  probe.now.trusted = true;
  probe.before.luminance = 100;
  probe.before.luminanceHalfWidth = 2;
  probe.hasBefore = true;
  report.probes.push_back(probe);
  report.changes.push_back(Difference{-20, 2.5, 0, true});
  report.fields.push_back({3, "PointLight", "LAMP", "intensity", "0.8", "0.5"});
  return report;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Returns the fields of each line of a table (RFC 4180).
std::vector<std::vector<std::string>> linesOf(const std::string& table) {
  std::vector<std::vector<std::string>> lines(1, {""});
  bool isQuoted = false;
  for (size_t i = 0; i < table.size(); ++i) {
    const char c = table[i];
    if (c == '"' && isQuoted && i + 1 < table.size() && table[i + 1] == '"') {
      lines.back().back() += table[++i];
    } else if (c == '"') {
      isQuoted = !isQuoted;
    } else if (c == ',' && !isQuoted) {
      lines.back().emplace_back();
    } else if (c == '\n' && !isQuoted) {
      lines.push_back({""});
    } else {
      lines.back().back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

TEST(Reports, ThePageHasThePictureTheProbesTheEditsAndTheCommand) {
  const std::string page = reportPage(example());
  EXPECT_TRUE(has(page, "<h1>table.wrl</h1>"));
  EXPECT_TRUE(has(page, "src=\"data:image/png;base64,iVBORw==\""));
  EXPECT_TRUE(has(page, "320 x 200"));
  EXPECT_TRUE(has(page, "<code>vv table.wrl --camera 1,2,3:0,0,0</code>"));
  EXPECT_TRUE(has(page, "100 \xc2\xb1 2"));
  EXPECT_TRUE(has(page, "80 \xc2\xb1 1.5"));
  EXPECT_TRUE(has(page, "-20 \xc2\xb1 2.5"));
  EXPECT_TRUE(has(page, "significant, trusted"));
  EXPECT_TRUE(has(page, "LAMP  PointLight<td>3<td>intensity<td><code>0.8</code><td><code>0.5"));
  EXPECT_TRUE(has(page, "No problems are known."));
  EXPECT_FALSE(has(page, "have not been saved"));
}

TEST(Reports, ThePageSaysWhatTheCommandDoesNotShow) {
  Report report = example();
  report.isUnsaved = true;
  report.problems = 2;
  const std::string page = reportPage(report);
  EXPECT_TRUE(has(page, "The edits have not been saved."));
  EXPECT_TRUE(has(page, "To make this picture again, save the edits first:"));
  EXPECT_TRUE(has(page, "2 problems are known"));
}

TEST(Reports, NothingOfAWorldIsMarkup) {
  const std::string hostile = "</code><script>alert(1)</script>\"'&\x1b[2J\xff";
  Report report = example();
  report.world = report.program = hostile;
  report.pictures.front().title = report.pictures.front().command = hostile;
  report.fields.front() = {1, hostile, hostile, hostile, hostile, hostile};
  const std::string page = reportPage(report);
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_FALSE(has(page, "\x1b"));
  EXPECT_FALSE(has(page, "\xff"));
  EXPECT_TRUE(has(page, "&lt;/code&gt;&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&amp;"));
  EXPECT_TRUE(has(page, "default-src 'none'"));
  const std::regex attribute("alt=\"[^\"<>]*\" src=\"data:image/png;base64,[A-Za-z0-9+/=]*\">");
  EXPECT_TRUE(std::regex_search(page, attribute));
}

TEST(Reports, TheTableHasALineForEachThing) {
  const auto lines = linesOf(reportTable(example()));
  ASSERT_EQ(lines.size(), 4u);
  for (const auto& line : lines) EXPECT_EQ(line.size(), lines.front().size());
  EXPECT_EQ(lines[1],
            (std::vector<std::string>{"picture", "The view", "", "320", "200", "", "", "", "", "",
                                      "", "", "vv table.wrl --camera 1,2,3:0,0,0"}));
  EXPECT_EQ(lines[2],
            (std::vector<std::string>{"probe", "1", "luminance in cd/m2", "1", "2.5", "-3", "100",
                                      "2", "80", "1.5", "-20", "2.5", "significant, trusted"}));
  EXPECT_EQ(lines[3], (std::vector<std::string>{"field", "LAMP  PointLight", "intensity", "", "",
                                                "", "0.8", "", "0.5", "", "", "", "line 3"}));
}

TEST(Reports, AProbeHasItsName) {
  Report report = example();
  report.probes.front().name = "Desk <left>";
  EXPECT_TRUE(has(reportPage(report), "<tr><td>1 Desk &lt;left&gt;<td>"));
  EXPECT_EQ(linesOf(reportTable(report))[2][1], "1 Desk <left>");
}

TEST(Reports, NothingOfAWorldIsAFormulaOrABreakOfTheTable) {
  Report report = example();
  report.fields.front() = {1, "T", "=1+1", "a,b", "two \"words\"", "-1 0 0"};
  report.fields.push_back({1, "T", "@x", "+f(x)", "one\nline", "-x"});
  const auto lines = linesOf(reportTable(report));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[3][1], "'=1+1  T");
  EXPECT_EQ(lines[3][2], "a,b");
  EXPECT_EQ(lines[3][6], "two \"words\"");
  EXPECT_EQ(lines[3][8], "-1 0 0") << "a number";
  EXPECT_EQ(lines[4][1], "'@x  T");
  EXPECT_EQ(lines[4][2], "'+f(x)");
  EXPECT_EQ(lines[4][8], "'-x");
  for (const auto& line : lines) EXPECT_EQ(line.size(), 13u);
}

TEST(Reports, AreasAndSensorsSayWhatTheyRead) {
  Report report = example();
  Probe& area = report.probes.front();
  area.area.emplace();
  area.area->reading.pixels = {5, 6, 40, 30};
  report.probes.push_back(report.probes.front());
  report.probes.back().area.reset();
  report.probes.back().sensor.emplace();
  report.changes.emplace_back();
  const std::string page = reportPage(report);
  EXPECT_TRUE(has(page, "<td>mean of 40 x 30 pixels at 5, 6<td"));
  EXPECT_TRUE(has(page, "<td>illuminance, lx<td"));
  const auto lines = linesOf(reportTable(report));
  EXPECT_EQ(lines[2][3], "");
  EXPECT_EQ(lines[2].back(), "significant, trusted, mean of 40 x 30 pixels at 5, 6");
  EXPECT_EQ(lines[3][2], "illuminance in lx");
  for (const auto& line : lines) EXPECT_EQ(line.size(), 13u);
}

TEST(Reports, APictureWithoutACommandHasNone) {
  Report report = example();
  report.pictures.insert(report.pictures.begin(), {"Before (A)", "png", 8, 6, ""});
  const std::string page = reportPage(report);
  EXPECT_LT(page.find("Before (A), 8 x 6"), page.find("The view, 320 x 200"));
  EXPECT_EQ(page.find("To make this"), page.rfind("To make this"));
}

TEST(Reports, ProbesThatWereNotReadAreCalledSo) {
  Report report = example();
  report.changes.front().reset();
  report.probes.front().state = Probe::State::hidden;
  EXPECT_TRUE(has(reportPage(report), "<td>not seen</tr>"));
  const auto lines = linesOf(reportTable(report));
  EXPECT_EQ(lines[2][8], "");
  EXPECT_EQ(lines[2].back(), "not seen");
}

TEST(Reports, ThePageStaysShort) {
  Report report = example();
  for (int i = 0; i < 100; ++i) report.fields.push_back(report.fields.front());
  EXPECT_TRUE(has(reportPage(report), "and 61 more"));
  EXPECT_EQ(linesOf(reportTable(report)).size(), 104u);
}

} // namespace
