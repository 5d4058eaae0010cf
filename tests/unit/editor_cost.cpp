// editor_cost.cpp: Tests that a world that nobody edits pays nothing for the editor: its session
// has an editor that has read nothing, whose memory does not depend on the world.
#include <malloc.h>

#include <fmt/format.h>

#include "unit/editor_support.h"

namespace {

using namespace editor_test;

size_t heapBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

std::string nodes(int count) {
  std::string text = "#VRML V2.0 utf8\nDEF FIRST Group { }\n";
  for (int i = 0; i < count; ++i)
    text += fmt::format("Transform {{ translation {} 0 0 children Group {{ }} }} # {}\n", i, i);
  return text;
}

// The bytes that an editor takes before anybody edits, and those that it takes then.
struct Cost {
  size_t opened, editing;
};
Cost costOf(int count) {
  const std::string path = testing::TempDir() + "editor_cost.wrl";
  xvrml::Browser browser(EditedWorld::load(path, nodes(count)));
  const size_t before = heapBytes();
  vv::WorldEditor editor(browser);
  const size_t opened = heapBytes();
  editor.editor().set(*browser.node("FIRST"), "visible", false);
  const size_t editing = heapBytes();
  std::filesystem::remove(path);
  return {opened - before, editing - opened};
}

TEST(EditorCost, AWorldThatNobodyEditsHasNoPlacesOfItsText) {
  if (heapBytes() == 0) GTEST_SKIP() << "the sanitizer has its own heap";
  costOf(10); // makes what is made once
  const Cost few = costOf(10), many = costOf(20'000);
  EXPECT_EQ(many.opened, few.opened) << "it does not depend on the world";
  EXPECT_LT(few.opened, 20'000u);
  // The measure sees what the first edit reads.
  EXPECT_GT(many.editing, few.editing + 20'000u * 50);
}

} // namespace
