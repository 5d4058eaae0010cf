// write_docs.cpp: the node reference page (Markdown) and the Python stub of the node classes.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "nodegen/writers.h"

namespace xvrml::nodegen {
namespace {

// Escapes text for a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '*' || c == '_' || c == '<') result += '\\';
    result += c;
  }
  return result;
}

std::string code(std::string_view text) {
  return text.empty() ? std::string() : fmt::format("`{}`", text);
}

std::string referenceRow(const FieldSpec& field) {
  return fmt::format("| {} {} **{}** | {} | {} | {} | {} | {} |\n", accessName(field.access),
                     fieldTypeName(field.type), cell(field.name), code(field.valueText),
                     code(field.rangeText), field.urls ? "URLs" : cell(joinNames(field.accepts)),
                     changeName(*field.change), cell(field.text));
}

std::string referenceOf(const TypeSpec& type) {
  std::string clause = clauseText(type);
  if (!clause.empty()) clause = ' ' + clause + '.';
  std::string text = fmt::format("### {}\n\n{}{} Roles: {}.\n\n", type.name, type.text, clause,
                                 fmt::join(type.roles, ", "));
  if (type.fields.empty()) return text;
  text += "| interface | default | range | accepts | changes | meaning |\n| --- | --- | --- | --- "
          "| --- | --- |\n";
  for (const FieldSpec& field : type.fields) text += referenceRow(field);
  return text + '\n';
}

// The beginning of the Python stub. Each field has the type that the binding returns and the type
// that it accepts (any array of the shape, a list of rows and so on).
constexpr std::string_view stubPrologue =
    R"("""Node classes of xvrml. Written by nodegen from the .node files.

A node of a world is of the class of its type: isinstance(node, xvrml.Shape) tells a type checker which fields it has.
"""
from typing import Any, Generic, Optional, Sequence, Tuple, TypeVar

import numpy as np
import numpy.typing as npt

from xvrml import Node

_Read = TypeVar("_Read", covariant=True)
_Write = TypeVar("_Write", contravariant=True)

class Field(Generic[_Read, _Write]):
    def __get__(self, node: Any, owner: Any = ...) -> _Read: ...
    def __set__(self, node: Any, value: _Write) -> None: ...

SFBool = Field[bool, bool]
SFColor = Field[Tuple[float, float, float], npt.ArrayLike]
SFFloat = Field[float, float]
SFImage = Field[npt.NDArray[np.uint8], npt.ArrayLike]
SFInt32 = Field[int, int]
SFNode = Field[Optional[Node], Optional[Node]]
SFRotation = Field[Tuple[float, float, float, float], npt.ArrayLike]
SFString = Field[str, str]
SFTime = Field[float, float]
SFVec2f = Field[Tuple[float, float], npt.ArrayLike]
SFVec3f = Field[Tuple[float, float, float], npt.ArrayLike]
MFColor = Field[npt.NDArray[np.float32], npt.ArrayLike]
MFFloat = Field[npt.NDArray[np.float32], npt.ArrayLike]
MFInt32 = Field[npt.NDArray[np.int32], npt.ArrayLike]
MFNode = Field[Tuple[Node, ...], Sequence[Node]]
MFRotation = Field[npt.NDArray[np.float32], npt.ArrayLike]
MFString = Field[Tuple[str, ...], Sequence[str]]
MFTime = Field[npt.NDArray[np.float64], npt.ArrayLike]
MFVec2f = Field[npt.NDArray[np.float32], npt.ArrayLike]
MFVec3f = Field[npt.NDArray[np.float32], npt.ArrayLike]
)";

// Returns whether Python reserves the name. Such a field has no attribute; the stub names it in a
// comment.
bool isPythonKeyword(std::string_view name) {
  constexpr auto keywords = std::to_array<std::string_view>(
      {"False", "None",     "True",  "and",    "as",   "assert", "async",  "await",    "break",
       "class", "continue", "def",   "del",    "elif", "else",   "except", "finally",  "for",
       "from",  "global",   "if",    "import", "in",   "is",     "lambda", "nonlocal", "not",
       "or",    "pass",     "raise", "return", "try",  "while",  "with",   "yield"});
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

// Returns the type of a constructor's keyword argument.
std::string_view written(FieldType type) {
  switch (type) {
  case FieldType::SFBool: return "bool";
  case FieldType::SFFloat:
  case FieldType::SFTime: return "float";
  case FieldType::SFInt32: return "int";
  case FieldType::SFNode: return "Optional[Node]";
  case FieldType::SFString: return "str";
  case FieldType::MFNode: return "Sequence[Node]";
  case FieldType::MFString: return "Sequence[str]";
  default: return "npt.ArrayLike";
  }
}

// Returns the stub of one class: first the fields, then the events, which have values in a running
// world.
std::string stubOf(const TypeSpec& type) {
  std::string text = fmt::format("\nclass {}(Node):\n    \"\"\"{}\"\"\"\n", type.name,
                                 docString(type.text)),
              keywords;
  for (const bool events : {false, true})
    for (const FieldSpec& field : type.fields) {
      if (field.hasStorage() == events) continue;
      const bool keyword = isPythonKeyword(field.name);
      text += fmt::format("    {}{}: {}  # {}{}\n", keyword ? "# " : "", field.name,
                          fieldTypeName(field.type),
                          events ? fmt::format("{}: ", accessName(field.access)) : "", field.text);
      if (!events && !keyword)
        keywords += fmt::format(", {}: {} = ...", field.name, written(field.type));
    }
  if (type.name != "Script") // Scripts come only from files
    text += fmt::format("    def __init__(self{}{}) -> None: ...\n", keywords.empty() ? "" : ", *",
                        keywords);
  return text;
}

} // namespace

std::string writeReference(const Model& model) {
  std::string text = "# Node reference\n\nWritten by nodegen from the `.node` files. *Changes* "
                     "says what a write makes the renderer do.\n\n";
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
  text += "\n__all__ = [\n";
  for (const Component& component : model.components)
    for (const TypeSpec& type : component.types)
      if (!component.imported && !type.isAbstract) text += fmt::format("    \"{}\",\n", type.name);
  text += "]\n";
  for (const Component& component : model.components) {
    if (component.imported) continue;
    for (const TypeSpec& type : component.types)
      if (!type.isAbstract) text += stubOf(type);
  }
  return text;
}

} // namespace xvrml::nodegen
