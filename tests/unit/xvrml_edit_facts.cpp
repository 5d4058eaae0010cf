// xvrml_edit_facts.cpp: Tests what an editor tells of its file: the nodes at places of the text,
// and the fields that edits have changed.
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditFacts : public Edited {
 protected:
  // Returns the DEF name of the node at a place; its type if it has none.
  std::string at(uint32_t line, uint32_t column) {
    const SourcePosition place{std::make_shared<const std::string>(path), line, column};
    const NodeRef found = editor->nodesAt({&place, 1}).front();
    if (!found) return "";
    return found->defName.empty() ? found->type().name : found->defName;
  }
  // Returns "NAME.field: before -> now" for each change.
  std::vector<std::string> changes() {
    std::vector<std::string> all;
    for (const ChangedField& one : editor->changedFields())
      all.push_back(one.name + "." + one.field + ": " + one.before + " -> " + one.now);
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Worlds, EditFacts, testing::Bool());

TEST_P(EditFacts, TheInnermostNodeOfAPlaceIsFound) {
  load("DEF A Group {\n"           // line 2
       "  children [\n"            //
       "    DEF B Transform { }\n" //
       "    # \xc3\xa4\xc3\xb6 is two characters\n"
       "    DEF C Shape { geometry Box { } }\n"
       "  ]\n"
       "  bboxSize 1 1 1\n"
       "}\r\n"
       "\r\n"
       "DEF D PointLight { }\r"
       "DEF E Group { children USE B }\n");
  EXPECT_EQ(at(2, 1), "A");
  EXPECT_EQ(at(4, 5), "B");
  EXPECT_EQ(at(4, 23), "B") << "its closing brace";
  EXPECT_EQ(at(4, 24), "A") << "behind it";
  EXPECT_EQ(at(5, 8), "A");
  EXPECT_EQ(at(6, 20), "C");
  EXPECT_EQ(at(6, 31), "Box");
  EXPECT_EQ(at(8, 3), "A") << "a field behind the children";
  EXPECT_EQ(at(10, 1), "");
  EXPECT_EQ(at(11, 5), "D");
  EXPECT_EQ(at(12, 28), "E") << "a USE is no node of its own";
  EXPECT_EQ(at(99, 1), "");
  EXPECT_EQ(at(0, 0), "");
  const SourcePosition elsewhere{std::make_shared<const std::string>("other.wrl"), 4, 5};
  EXPECT_FALSE(editor->nodesAt({&elsewhere, 1}).front());
}

TEST_P(EditFacts, PlacesAreThoseOfTheFileAsItWasRead) {
  load("DEF A Transform {\n}\nDEF B PointLight { }\n");
  editor->insert({nullptr, "", 0}, "DEF NEW Group {\n\n\n}");
  editor->remove({nullptr, "", 1});
  EXPECT_EQ(at(2, 5), "") << "it is not in the world any more";
  EXPECT_EQ(at(4, 5), "B");
  editor->undo();
  EXPECT_EQ(at(2, 5), "A");
}

TEST_P(EditFacts, ChangedFieldsAreThoseThatDiffer) {
  load("DEF A Transform { translation 1 2 3 children DEF S Shape { } }\n"
       "DEF B PointLight { intensity .5 }\n");
  EXPECT_EQ(changes(), std::vector<std::string>());
  editor->set(node("B"), "intensity", SFFloat(.25f));
  editor->set(node("B"), "on", SFBool(false));
  editor->set(node("A"), "translation", SFVec3f{1, 2, 4});
  EXPECT_EQ(changes(),
            (std::vector<std::string>{"A.translation: 1 2 3 -> 1 2 4", "B.intensity: 0.5 -> 0.25",
                                      "B.on: TRUE -> FALSE"}));
  EXPECT_EQ(editor->changedFields().front().line, 2u);
  editor->undo();
  editor->set(node("B"), "on", SFBool(true));
  EXPECT_EQ(changes(), (std::vector<std::string>{"B.intensity: 0.5 -> 0.25"}));
}

TEST_P(EditFacts, NodesAreCountedAndNamesAreCompared) {
  load("DEF A Group { children DEF S Shape { } }\nDEF B PointLight { }\n");
  editor->insert({&node("A"), "children", 1}, "DEF L SpotLight { }");
  editor->set(node("L"), "intensity", SFFloat(.5f)); // part of what has been inserted
  EXPECT_EQ(changes(), (std::vector<std::string>{"A.children: 1 node -> 2 nodes"}));
  editor->rename(node("B"), "LAMP");
  editor->remove({nullptr, "", 0});
  EXPECT_EQ(changes(), (std::vector<std::string>{".: 2 nodes -> 1 node", "LAMP.DEF: B -> LAMP"}));
}

} // namespace
