#include "expectation.h"

#include <fmt/format.h>

#include "xvrml/numbers.h"

using namespace xvrml;

namespace {

// Says what Python gives for a value, from the C++ type of its elements.
template <class T> std::string expectation() {
  using Element = ElementOf<T>;
  if constexpr (std::is_same_v<T, Color>)
    return "3 numbers (red, green, blue)";
  else if constexpr (std::is_same_v<T, Rotation>)
    return "4 numbers (axis x, y, z and angle in radians)";
  else if constexpr (std::is_same_v<T, bool>)
    return "True or False";
  else if constexpr (std::is_same_v<T, MFBool>)
    return "truth values of shape (n,)";
  else if constexpr (std::is_same_v<Element, Image>)
    return fmt::format("{} of bytes of shape (height, width, components)",
                       isList<T> ? "a sequence of arrays" : "an array");
  else if constexpr (std::is_same_v<Element, NodeRef>)
    return isList<T> ? "a sequence of Nodes" : "a Node or None";
  else if constexpr (std::is_same_v<Element, std::string>)
    return isList<T> ? "a sequence of str" : "a str";
  else if constexpr (std::is_same_v<Element, int32_t>)
    return isList<T> ? "whole numbers of 32 bits of shape (n,)" : "a whole number of 32 bits";
  else if constexpr (numberCount<Element> == 1)
    return isList<T> ? "numbers of shape (n,)" : "a number";
  else
    return fmt::format(isList<T> ? "numbers of shape (n, {})" : "{} numbers", numberCount<Element>);
}

} // namespace

std::string expectation(FieldType type) {
  return std::visit([](const auto& value) { return expectation<std::decay_t<decltype(value)>>(); },
                    defaultValue(type));
}

bool hasWideNumbers(FieldType type) {
  return std::visit(
      [](const auto& value) {
        return !std::is_same_v<ScalarOf<ElementOf<std::decay_t<decltype(value)>>>, float>;
      },
      defaultValue(type));
}
