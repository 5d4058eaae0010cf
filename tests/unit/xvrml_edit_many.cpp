// xvrml_edit_many.cpp: Tests that 100,000 random edits and as many undos give the bytes of the
// file, and those of the edited one when they are done again.
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditedOften : public Edited {};
INSTANTIATE_TEST_SUITE_P(World, EditedOften, testing::Values(true),
                         [](const auto&) { return "Running"; });

TEST_P(EditedOften, AllEditsAreUndoneAndDoneAgain) {
  constexpr int groups = 50, edits = 100'000;
  std::string body;
  for (int i = 0; i < groups; ++i)
    body += "DEF G" + std::to_string(i) +
            " Transform { # a group\n  translation 0.50 0 0 children [\n    DEF S" +
            std::to_string(i) + " Shape { geometry DEF B" + std::to_string(i) +
            " Box { size 1 1 1 } } # a box\n  ]\n}\n";
  load(body);
  editor->setUndoBytes(uint64_t(4) << 30);
  std::mt19937 random(100);
  const auto any = [&](const char* prefix) {
    return NodeRef(&node(prefix + std::to_string(random() % groups)));
  };
  const auto childOf = [&](const NodeRef& group) -> NodeSlot {
    return {group.get(), "children", random() % (field<MFNode>(*group, "children").size() + 1)};
  };
  int done = 0;
  for (int i = 0; done < edits && i < 2 * edits; ++i) {
    const NodeRef from = any("G"), to = any("G");
    try {
      switch (random() % 8) {
      case 0: editor->insert(childOf(to), "Group { }"); break;
      case 1: {
        const NodeSlot slot = childOf(from);
        const MFNode& children = field<MFNode>(*from, "children");
        if (slot.index >= children.size()) continue;
        const bool isNamed = !children[slot.index]->defName.empty();
        if (isNamed)
          editor->move(slot, {to.get(), "children", 0});
        else
          editor->remove(slot);
        break;
      }
      case 2:
      case 3:
      case 4: editor->set(*any("B"), "size", Vec3f{float(random() % 99 + 1) / 8, 1, 1}); break;
      default: editor->set(*from, "translation", Vec3f{float(random() % 999) / 8, 0, 0});
      }
      ++done;
    } catch (const EditError&) {} // it would hold itself
  }
  ASSERT_EQ(done, edits);
  undoAll();
}

} // namespace
