#include "expectation.h"

#include "xvrml/value_words.h"

std::string expectation(xvrml::FieldType type) {
  static constexpr xvrml::ValueWords words{
      .colour = "3 numbers (red, green, blue)",
      .rotation = "4 numbers (axis x, y, z and angle in radians)",
      .truth = {"True or False", "truth values of shape (n,)"},
      .image = {"an array of bytes of shape (height, width, components)",
                "a sequence of arrays of bytes of shape (height, width, components)"},
      .node = {"a Node or None", "a sequence of Nodes"},
      .text = {"a str", "a sequence of str"},
      .whole = {"a whole number of 32 bits", "whole numbers of 32 bits of shape (n,)"},
      .number = {"a number", "numbers of shape (n,)"},
      .numbers = {"{} numbers", "numbers of shape (n, {})"}};
  return wordsFor(type, words);
}
