// write_docs.cpp: the node reference page (Markdown) and the Python stub of the node classes.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "nodegen/writers.h"
#include "xvrml/numbers.h"

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

// The beginning of the Python stub. A field has the type that the binding returns and the type that
// it accepts (any array of the shape, a list of rows and so on).
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

// The types that Python returns for an element, and that it takes.
template <class T> std::string readOne() {
  if constexpr (std::is_same_v<T, bool>)
    return "bool";
  else if constexpr (std::is_same_v<T, std::string>)
    return "str";
  else if constexpr (std::is_same_v<T, NodeRef>)
    return "Optional[Node]";
  else if constexpr (std::is_same_v<T, Image>)
    return "npt.NDArray[np.uint8]";
  else if constexpr (std::is_same_v<T, int32_t>)
    return "int";
  else if constexpr (numberCount<T> == 1)
    return "float";
  else {
    std::string text = "Tuple[float";
    for (int i = 1; i < numberCount<T>; ++i) text += ", float";
    return text + "]";
  }
}
template <class T> std::string readType() {
  using Element = ElementOf<T>;
  if constexpr (!isList<T>)
    return readOne<T>();
  else if constexpr (std::is_same_v<Element, bool>)
    return "npt.NDArray[np.bool_]";
  else if constexpr (std::is_same_v<ScalarOf<Element>, float>)
    return "npt.NDArray[np.float32]";
  else if constexpr (std::is_same_v<ScalarOf<Element>, double>)
    return "npt.NDArray[np.float64]";
  else if constexpr (std::is_same_v<ScalarOf<Element>, int32_t>)
    return "npt.NDArray[np.int32]";
  else if constexpr (std::is_same_v<Element, NodeRef>)
    return "Tuple[Node, ...]";
  else
    return fmt::format("Tuple[{}, ...]", readOne<Element>());
}
template <class T> std::string writtenType() {
  if constexpr (std::is_same_v<T, MFNode>)
    return "Sequence[Node]";
  else if constexpr (std::is_same_v<T, MFString>)
    return "Sequence[str]";
  else if constexpr (std::is_same_v<T, MFImage>)
    return "Sequence[npt.ArrayLike]";
  else if constexpr (isList<T> || std::is_same_v<T, Image>)
    return "npt.ArrayLike";
  else
    return readOne<T>().starts_with("Tuple") ? "npt.ArrayLike" : readOne<T>();
}

// Returns the type of a constructor's keyword argument.
std::string written(FieldType type) {
  return std::visit([](const auto& value) { return writtenType<std::decay_t<decltype(value)>>(); },
                    defaultValue(type));
}

// Each field type of the stub: what the binding returns, and what it takes.
std::string stubTypes() {
  std::string text;
  for (int i = 0; i < fieldTypeCount; ++i) {
    const auto type = FieldType(i);
    text += std::visit(
        [&](const auto& value) {
          return fmt::format("{} = Field[{}, {}]\n", fieldTypeName(type),
                             readType<std::decay_t<decltype(value)>>(), written(type));
        },
        defaultValue(type));
  }
  return text;
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
  std::string text = std::string(stubPrologue) + stubTypes();
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
