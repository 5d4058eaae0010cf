// value_words.h: says what the value of a field looks like in a language that programs write values
// in, for messages. [any thread]
#pragma once

#include <string>
#include <string_view>

#include "xvrml/types.h"

namespace xvrml {

// The words of a language. one, many: for a type and for a list of its values.
struct ValueWords {
  struct Words {
    std::string_view one, many;
  };
  std::string_view colour, rotation;
  Words truth, image, node, text, whole, number;
  Words numbers; // several; {} stands for how many
};

// Returns the words for a value of this type: "3 numbers (red, green, blue)".
std::string wordsFor(FieldType type, const ValueWords& words);

// Tells whether the numbers of a type are more exact than float, or it has none.
bool hasWideNumbers(FieldType type);

} // namespace xvrml
