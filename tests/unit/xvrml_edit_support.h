// xvrml_edit_support.h: a world of one file that tests edit.
#pragma once

#include <random>

#include "unit/xvrml_parser_support.h"
#include "xvrml/edit.h"
#include "xvrml/walk.h"

namespace edit_test {

using namespace parser_test;

// A world of one file that is edited while it rests or runs.
class Edited : public testing::TestWithParam<bool> {
 protected:
  // head: its first line.
  void load(const std::string& body, const std::string& head = "#VRML V2.0 utf8\n",
            const std::string& name = "w.wrl") {
    original = head + body;
    path = folder.write(name, original);
    resting = loadWorld(path);
    ASSERT_EQ(messages(*resting), "");
    if (GetParam()) {
      browser = std::make_unique<Browser>(std::move(resting));
      editor = std::make_unique<Editor>(*browser);
    } else {
      editor = std::make_unique<Editor>(*resting);
    }
  }
  World& world() { return browser ? browser->world() : *resting; }
  Node& node(const std::string& name) { return *world().scope.names.at(name); }
  // Returns the text without its first line.
  std::string text() {
    const std::string all = editor->text();
    return all.substr(all.find('\n') + 1);
  }
  std::string body() const { return original.substr(original.find('\n') + 1); }
  // Undoes all steps, which gives the file back, and does them again.
  void undoAll() {
    const std::string now = editor->text();
    size_t steps = 0;
    while (editor->undo()) ++steps;
    EXPECT_EQ(editor->text(), original);
    EXPECT_FALSE(editor->isChanged());
    while (editor->redo()) --steps;
    EXPECT_EQ(steps, 0u);
    EXPECT_EQ(editor->text(), now);
  }
  // Does 60 random edits, all of which can be undone. group, transform: texts to insert.
  void editAtRandom(unsigned seed, const std::string& group, const std::string& transform) {
    std::mt19937 random(seed);
    const auto below = [&](size_t n) { return size_t(random() % n); };
    for (int i = 0; i < 60; ++i) {
      // All nodes of the file, as they stand now.
      std::vector<Node*> nodes;
      walk(rootsOf(world().scope), [&](Node& one, std::vector<Node*>& open) {
        nodes.push_back(&one);
        appendChildren(one, open);
      });
      if (nodes.empty()) {
        editor->insert({nullptr, "", 0}, group);
        continue;
      }
      const auto any = [&]() -> Node& { return *nodes[below(nodes.size())]; };
      const auto slot = [&]() -> NodeSlot {
        if (below(4) == 0) return {nullptr, "", below(world().scope.roots.size() + 1)};
        Node& parent = any();
        for (const char* name : {"children", "kids", "geometry"})
          if (const FieldInfo* info = parent.type().find(name))
            return {&parent, name,
                    info->type == FieldType::SFNode
                        ? 0
                        : below(field<MFNode>(parent, name).size() + 1)};
        return {nullptr, "", 0};
      };
      try {
        switch (below(8)) {
        case 0: editor->set(any(), "translation", Vec3f{float(below(9)), .5f, -1}); break;
        case 1: editor->set(any(), "size", Vec3f{1, float(below(9)) + 1, 2}); break;
        case 2: editor->insert(slot(), transform); break;
        case 3: editor->remove(slot()); break;
        case 4: editor->move(slot(), slot()); break;
        case 5: editor->use(slot(), any()); break;
        case 6: editor->wrap(slot()); break;
        default: editor->rename(any(), "R" + std::to_string(below(99)));
        }
      } catch (const EditError&) {}
    }
    undoAll();
    while (editor->undo()) {}
    EXPECT_EQ(editor->text(), original) << seed;
  }
  template <class F> std::string refusal(const F& edit) {
    const std::string before = editor->text();
    try {
      edit();
    } catch (const EditError& error) {
      EXPECT_EQ(editor->text(), before) << "nothing has changed";
      return error.what();
    }
    return "done";
  }

  const Folder folder;
  std::string original, path;
  std::unique_ptr<World> resting;
  std::unique_ptr<Browser> browser;
  std::unique_ptr<Editor> editor;
};

} // namespace edit_test
