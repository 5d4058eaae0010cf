// value_words.h: the elements of a field's value, and the words that a file has for them. Internal.
// [any thread]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// How a file writes values.
struct ValueSyntax {
  char quote = 0; // around attributes of XML; 0: VRML97 or JSON
  bool isJson = false;
  bool isXml() const { return quote != 0; }
};

// The lines of a file, for values that take several.
struct ValueLines {
  size_t indent = 0; // blanks before the line in which the value begins
  std::string_view feed = "\n";
};

// The elements of a list, or the only one of a single value. The three numbers before the pixels of
// an image, and each pixel, count as elements. Nodes have none. Refers to the value.
class ValueWords {
 public:
  ValueWords(FieldType type, const Value& value);

  size_t size() const { return size_; }
  size_t wordsOfElement() const { return wordsOfElement_; }
  bool hasStrings() const {
    return std::holds_alternative<std::span<const std::string>>(elements_);
  }
  // Returns whether the elements are rotations: a file may give their axes another length.
  bool hasAxes() const { return hasAxes_; }
  // Returns bytes that are equal for elements that have the same words.
  std::string_view bytes(size_t element) const;
  // Returns the words of an element.
  std::vector<std::string> words(size_t element, const ValueSyntax& syntax) const;
  // Returns a word as the token in its place is spelled: X3D in XML may also have TRUE and FALSE,
  // and pixels are hexadecimal or decimal.
  std::string spelledLike(std::string_view token, const std::string& word) const;

 private:
  struct ImagePlace {
    const Image* image;
    size_t element; // counted in this image
  };
  ImagePlace imageAt(size_t element) const;

  size_t size_ = 0, wordsOfElement_ = 1;
  bool hasAxes_ = false;
  std::vector<uint8_t> booleans_; // a copy: lists of them have no bytes
  std::variant<std::span<const float>, std::span<const double>, std::span<const int32_t>,
               std::span<const uint8_t>, std::span<const std::string>, std::span<const Image>>
      elements_;
  std::vector<size_t> beginOfImages_; // the first element of each image
};

} // namespace xvrml
