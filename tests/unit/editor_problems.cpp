// editor_problems.cpp: Tests the list of the messages about a world: its rows, and their nodes.
#include "edit/problems.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using xvrml::Severity;

constexpr const char* text = "#VRML V2.0 utf8\n"
                             "DEF A Transform {\n"
                             "  children DEF B Shape { geometry DEF C Box { size 1 x 1 } }\n"
                             "  bogus 3\n"
                             "}\n"
                             "Nonsense { }\n"
                             "DEF D PointLight { }\n";

struct Problems : testing::Test {
  EditedWorld world{text};
  ProblemList list;
  double now = 0;
  bool update() { return list.update(world.editor, now += 1); }
  xvrml::Diagnostics& messages() {
    return const_cast<xvrml::World&>(world.browser.world()).diagnostics;
  }
  // Returns the first row about a line.
  const ProblemRow* at(const std::string& place) const {
    for (const ProblemRow& row : list.rows())
      if (row.place == place) return &row;
    return nullptr;
  }
};

TEST_F(Problems, AreCountedWhileTheListIsClosed) {
  EXPECT_TRUE(update());
  EXPECT_EQ(list.count(), messages().errors() + messages().warnings());
  EXPECT_GE(list.count(), 3u);
  EXPECT_TRUE(list.rows().empty());
  EXPECT_FALSE(update());
}

TEST_F(Problems, HaveTheirNodes) {
  list.setOpen(true);
  EXPECT_TRUE(update());
  ASSERT_TRUE(at("line 3") && at("line 4") && at("line 6"));
  EXPECT_EQ(at("line 3")->node, world.node("C"));
  EXPECT_EQ(at("line 3")->label, "C  Box");
  EXPECT_EQ(at("line 4")->node, world.node("A")) << "behind its children";
  EXPECT_NE(at("line 4")->message.find("bogus"), std::string::npos);
  EXPECT_FALSE(at("line 6")->node) << "it is not in the world";
  EXPECT_FALSE(update()) << "nothing has changed";
}

TEST_F(Problems, EqualMessagesAreOneRow) {
  list.setOpen(true);
  update();
  const size_t rows = list.rows().size();
  for (int i = 0; i < 3; ++i) messages().warn(world.node("D")->source, "it is dark");
  EXPECT_TRUE(update());
  ASSERT_EQ(list.rows().size(), rows + 1);
  EXPECT_EQ(at("line 7")->times, 3u);
  EXPECT_EQ(at("line 7")->node, world.node("D"));
  EXPECT_EQ(problemText(*at("line 7")), "warning  line 7  it is dark (3 times)");
}

TEST_F(Problems, ErrorsComeFirstAndNotesAreNotCounted) {
  list.setOpen(true);
  messages().add({Severity::note, world.path, 7, 1, "a detail", "", 0});
  messages().warn({}, "about nothing");
  messages().error({std::make_shared<const std::string>("part.wrl"), 5, 1}, "elsewhere");
  update();
  EXPECT_EQ(list.count(), messages().errors() + messages().warnings());
  EXPECT_EQ(list.rows().back().message, "a detail");
  EXPECT_TRUE(std::is_sorted(
      list.rows().begin(), list.rows().end(),
      [](const ProblemRow& a, const ProblemRow& b) { return a.severity > b.severity; }));
  ASSERT_TRUE(at("part.wrl, line 5"));
  EXPECT_FALSE(at("part.wrl, line 5")->node) << "line 5 of another file";
}

TEST_F(Problems, TheRowInFullStaysTheSameMessage) {
  list.setOpen(true);
  update();
  EXPECT_EQ(list.shown(), nullptr);
  list.show(list.rows().size() - 1);
  const std::string message = list.shown()->message;
  messages().error({}, "a new one");
  update();
  ASSERT_NE(list.shown(), nullptr);
  EXPECT_EQ(list.shown()->message, message);
}

TEST_F(Problems, AreReadAFewTimesASecond) {
  list.setOpen(true);
  update();
  const size_t rows = list.rows().size();
  messages().warn({}, "one");
  EXPECT_TRUE(list.update(world.editor, now + .01)) << "the number is another";
  EXPECT_EQ(list.rows().size(), rows);
  EXPECT_TRUE(update());
  EXPECT_EQ(list.rows().size(), rows + 1);
}

TEST(ProblemsOfFiles, ThatAreOnlyReadHaveTheirNodes) {
  EditedWorld world("#VRML V1.0 ascii\nDEF A Separator { Cube { width -1 } }\n");
  ProblemList list;
  list.setOpen(true);
  list.update(world.editor, 1);
  for (const ProblemRow& row : list.rows()) EXPECT_NE(row.message, "");
}

} // namespace
