// editor_outline.cpp: Tests that rows of the outline which are changed in place, when a node is
// opened or closed, are those that reading all of them gives.
#include <random>

#include "edit/outline.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using namespace xvrml;

// Groups in groups; every fifth is a node that stands elsewhere, too.
std::string groups(int count) {
  std::string text = "#VRML V2.0 utf8\n";
  std::mt19937 random(45);
  int open = 0;
  for (int i = 0; i < count; ++i) {
    if (i > 10 && i % 5 == 0)
      text += "USE N" + std::to_string(int(random() % 5) * 2 + 1) + " ";
    else if (open < 6 && random() % 2)
      text += "DEF N" + std::to_string(i) + " Group { children [ ", ++open;
    else
      text += "DEF N" + std::to_string(i) + " Group { } ";
    while (open > 0 && random() % 3 == 0) text += "] }\n", --open;
  }
  while (open-- > 0) text += "] }\n";
  return text;
}

std::string textOf(const std::vector<OutlineRow>& rows) {
  std::string text;
  for (const OutlineRow& row : rows) {
    text += std::string(size_t(row.depth), '.') + row.label() + (row.isUse ? " USE" : "") +
            (row.isOpen    ? " -"
             : row.canOpen ? " +"
                           : "") +
            " " + row.place.field + std::to_string(row.place.index) +
            (row.place.parent ? row.place.parent->defName : "") + "\n";
  }
  return text;
}

TEST(Outline, RowsThatAreChangedAreThoseThatAreRead) {
  EditedWorld edited(groups(400));
  const World& world = edited.browser.world();
  Outline outline;
  std::vector<OutlineRow> rows = outline.rows(world);
  std::mt19937 random(98);
  int changed = 0, reread = 0;
  for (int i = 0; i < 2000; ++i) {
    const OutlineRow row = rows.at(random() % rows.size());
    outline.setOpen(row.node, !row.isOpen);
    const std::vector<OutlineRow> read = outline.rows(world);
    if (outline.changeRowsOf(*row.node, rows)) {
      ++changed;
      ASSERT_EQ(textOf(rows), textOf(read)) << i;
    } else {
      ++reread;
      rows = read;
    }
  }
  EXPECT_GT(changed, 1000);
  EXPECT_GT(reread, 0);
}

// Rows that are read again would show the child that nobody has told the outline of.
TEST(Outline, OpeningAndClosingReadNoOtherRows) {
  std::string others;
  for (int i = 0; i < 10'001; ++i) others += "Group { }\n";
  EditedWorld world("#VRML V2.0 utf8\nDEF A Group { children DEF B Group { children Group { } } }\n"
                    "DEF OLD Group { }\n" +
                    others);
  EditModel model;
  const auto update = [&](const char* name, bool open) {
    model.setOpen(world.node(name), open);
    EXPECT_TRUE(model.update(world.editor, front(), false, 0));
  };
  model.update(world.editor, front(), false, 0);
  const size_t closed = model.rows().size();
  xvrml::nodeCast<xvrml::nodes::Group>(world.node("OLD"))->children = {world.node("B")};
  update("A", true);
  update("B", true);
  EXPECT_EQ(model.rows().size(), closed + 2);
  EXPECT_EQ(model.rows().at(2).depth, 2);
  EXPECT_FALSE(model.rows().at(3).canOpen);
  update("A", false);
  EXPECT_FALSE(model.rows().at(1).canOpen);
  update("A", true); // B is open still
  EXPECT_EQ(model.rows().size(), closed + 2);
  EXPECT_FALSE(model.rows().at(3).canOpen);
}

// A Script that holds itself is opened once.
TEST(Outline, ANodeInItselfIsOpenedOnce) {
  EditedWorld world("#VRML V2.0 utf8\nDEF S Script { field SFNode own USE S }\n");
  Outline outline;
  std::vector<OutlineRow> rows = outline.rows(world.browser.world());
  ASSERT_EQ(rows.size(), 1u);
  outline.setOpen(rows[0].node, true);
  EXPECT_FALSE(outline.changeRowsOf(*rows[0].node, rows));
  rows = outline.rows(world.browser.world());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_TRUE(rows[1].isUse);
}

} // namespace
