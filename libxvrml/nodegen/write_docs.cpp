// write_docs.cpp: the node reference page (Markdown) and the Python stub of the node classes.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

// Text in a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '*' || c == '_' || c == '<') result += '\\';
    result += c;
  }
  return result;
}

std::string code(std::string_view text) { return text.empty() ? std::string() : fmt::format("`{}`", text); }

std::string referenceRow(const FieldSpec& field) {
  return fmt::format("| {} {} **{}** | {} | {} | {} | {} | {} |\n", accessName(field.access), fieldTypeName(field.type),
                     cell(field.name), code(field.valueText), code(field.rangeText), cell(joinNames(field.accepts)),
                     changeName(*field.change), cell(field.text));
}

std::string referenceOf(const TypeSpec& type) {
  const std::string clause = type.clause.empty() ? "" : fmt::format(" ISO/IEC 14772-1 clause {}.", type.clause);
  std::string text = fmt::format("### {}\n\n{}{} Roles: {}.\n\n", type.name, type.text, clause, fmt::join(type.roles, ", "));
  if (type.fields.empty()) return text;
  text += "| interface | default | range | accepts | changes | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const FieldSpec& field : type.fields) text += referenceRow(field);
  return text + '\n';
}

// What the binding takes and returns for each field type.
constexpr std::string_view stubPrologue =
    R"("""Node classes of xvrml, for type checkers and editors. Written by nodegen from the .node files."""
from typing import List, Optional, Tuple

class Node: ...

SFBool = bool
SFColor = Tuple[float, float, float]
SFFloat = float
SFImage = Tuple[int, int, int, bytes]
SFInt32 = int
SFNode = Optional[Node]
SFRotation = Tuple[float, float, float, float]
SFString = str
SFTime = float
SFVec2f = Tuple[float, float]
SFVec3f = Tuple[float, float, float]
MFColor = List[SFColor]
MFFloat = List[float]
MFInt32 = List[int]
MFNode = List[Node]
MFRotation = List[SFRotation]
MFString = List[str]
MFTime = List[float]
MFVec2f = List[SFVec2f]
MFVec3f = List[SFVec3f]
)";

// A field whose name Python keeps for itself has no attribute: it is named in a comment.
bool isPythonKeyword(std::string_view name) {
  constexpr auto keywords = std::to_array<std::string_view>(
      {"False",  "None",     "True", "and",    "as",      "assert", "async",  "await",  "break", "class",  "continue", "def",
       "del",    "elif",     "else", "except", "finally", "for",    "from",   "global", "if",    "import", "in",       "is",
       "lambda", "nonlocal", "not",  "or",     "pass",    "raise",  "return", "try",    "while", "with",   "yield"});
  return std::find(keywords.begin(), keywords.end(), name) != keywords.end();
}

std::string docString(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string stubOf(const TypeSpec& type) {
  std::string text = fmt::format("\nclass {}(Node):\n    \"\"\"{}\"\"\"\n", type.name, docString(type.text));
  for (const FieldSpec& field : type.fields) {
    if (!field.hasStorage()) continue;
    text += fmt::format("    {}{}: {}  # {}\n", isPythonKeyword(field.name) ? "# " : "", field.name, fieldTypeName(field.type),
                        field.text);
  }
  return text;
}

} // namespace

std::string writeReference(const Model& model) {
  std::string text =
      "# Node reference\n\nWritten by nodegen from the `.node` files. *Changes* says what a write makes the renderer do.\n\n";
  for (const Component& component : model.components) {
    if (component.imported) continue;
    text += fmt::format("## {}\n\n", component.title);
    for (const TypeSpec& type : component.types)
      if (type.isAbstract) text += fmt::format("* *{}*: {}\n", type.name, cell(type.text));
    text += '\n';
    for (const TypeSpec& type : component.types)
      if (!type.isAbstract) text += referenceOf(type);
  }
  return text;
}

std::string writeStub(const Model& model) {
  std::string text(stubPrologue);
  for (const Component& component : model.components) {
    if (component.imported) continue;
    for (const TypeSpec& type : component.types)
      if (!type.isAbstract) text += stubOf(type);
  }
  return text;
}

} // namespace xvrml::nodegen
