// value_words.cpp: chooses the words for a value by the C++ type of its elements. [any thread]
#include "xvrml/value_words.h"

#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "xvrml/node.h"
#include "xvrml/numbers.h"

namespace xvrml {
namespace {

template <class T> std::string wordsOf(const ValueWords& words) {
  using Element = ElementOf<T>;
  const auto chosen = [](const ValueWords::Words& pair) {
    return std::string(isList<T> ? pair.many : pair.one);
  };
  if constexpr (std::is_same_v<T, Color>)
    return std::string(words.colour);
  else if constexpr (std::is_same_v<T, Rotation>)
    return std::string(words.rotation);
  else if constexpr (std::is_same_v<Element, bool>)
    return chosen(words.truth);
  else if constexpr (std::is_same_v<Element, Image>)
    return chosen(words.image);
  else if constexpr (std::is_same_v<Element, NodeRef>)
    return chosen(words.node);
  else if constexpr (std::is_same_v<Element, std::string>)
    return chosen(words.text);
  else if constexpr (std::is_same_v<Element, int32_t>)
    return chosen(words.whole);
  else if constexpr (numberCount<Element> == 1)
    return chosen(words.number);
  else
    return fmt::format(fmt::runtime(chosen(words.numbers)), numberCount<Element>);
}

} // namespace

std::string wordsFor(FieldType type, const ValueWords& words) {
  return std::visit(
      [&words](const auto& value) { return wordsOf<std::decay_t<decltype(value)>>(words); },
      defaultValue(type));
}

bool hasWideNumbers(FieldType type) {
  return std::visit(
      [](const auto& value) {
        return !std::is_same_v<ScalarOf<ElementOf<std::decay_t<decltype(value)>>>, float>;
      },
      defaultValue(type));
}

} // namespace xvrml
