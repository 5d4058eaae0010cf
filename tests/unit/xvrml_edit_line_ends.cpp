// xvrml_edit_line_ends.cpp: Tests that lines of an edited file end as they did, and new ones as its
// first line does.
#include "unit/xvrml_edit_support.h"

namespace {

using namespace edit_test;

class EditedLines : public Edited {};
INSTANTIATE_TEST_SUITE_P(World, EditedLines, testing::Bool(),
                         [](const auto& info) { return info.param ? "Running" : "Resting"; });

TEST_P(EditedLines, LineEndsAndTheByteOrderMarkStay) {
  load("DEF G Group {\r\n}\r\n", "#VRML V2.0 utf8\r\n");
  editor->insert({&node("G"), "children", 0}, "Group { }");
  EXPECT_EQ(editor->text(), "#VRML V2.0 utf8\r\nDEF G Group {\r\n  children [\r\n    Group { }\r\n"
                            "  ]\r\n}\r\n");
  EXPECT_EQ(editor->bytes(), editor->text());
}

TEST_P(EditedLines, NewLinesEndAsThoseOfTheFile) {
  load("Shape { geometry PointSet { coord DEF C Coordinate { } } }\r\n"
       "Shape { geometry PointSet { coord DEF D Coordinate { point [ 0 0 0, 1 1 1 ] } } }\r\n",
       "#VRML V2.0 utf8\r\n");
  for (const char* name : {"C", "D"}) editor->set(node(name), "point", MFVec3f(100));
  editor->wrap({nullptr, "", 0});
  const std::string now = editor->text();
  EXPECT_GT(std::count(now.begin(), now.end(), '\n'), 5);
  for (size_t i = now.find('\n'); i != now.npos; i = now.find('\n', i + 1))
    EXPECT_EQ(now[i - 1], '\r') << i;
  undoAll();
}

TEST_P(EditedLines, TextsThatAreInsertedGetTheEndsOfLinesOfTheFile) {
  load("DEF G Group {\r\n}\r\n", "#VRML V2.0 utf8\r\n");
  editor->insert(
      {&node("G"), "children", 0},
      "Shape { # a \"quote\n  geometry DEF T Text {\n    string \"a\nb\\\"\nc\"\n  }\r}");
  EXPECT_EQ(editor->text(), "#VRML V2.0 utf8\r\nDEF G Group {\r\n  children [\r\n"
                            "    Shape { # a \"quote\r\n      geometry DEF T Text {\r\n"
                            "        string \"a\nb\\\"\nc\"\r\n      }\r\n    }\r\n"
                            "  ]\r\n}\r\n")
      << "the string keeps its own";
  EXPECT_EQ((field<MFString>(node("T"), "string")), MFString{"a\nb\"\nc"});
  undoAll();
}

TEST_P(EditedLines, TextsFromFilesWithCarriageReturnsGetLineFeedsInOtherFiles) {
  load("DEF G Group {\n}\n");
  editor->insert({&node("G"), "children", 0}, "Group {\r\n  children [ ]\r\n}");
  EXPECT_EQ(editor->text().find('\r'), std::string::npos);
}

} // namespace
