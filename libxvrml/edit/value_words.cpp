#include "edit/value_words.h"

#include <algorithm>
#include <charconv>
#include <type_traits>

#include <fmt/format.h>

#include "edit/changed_value.h"
#include "write/value_writer.h"
#include "write/xml_escape.h"
#include "xvrml/visit_storage.h"

namespace xvrml {
namespace {

constexpr size_t headOfImage = 3; // width, height, components

size_t bytesOfPixel(const Image& image) { return size_t(std::clamp(image.components, 0, 4)); }
size_t elementsOf(const Image& image) {
  const size_t bytes = bytesOfPixel(image);
  return headOfImage + (bytes > 0 ? image.pixels.size() / bytes : 0);
}
const int32_t& headNumber(const Image& image, size_t element) {
  const int32_t* const numbers[headOfImage] = {&image.width, &image.height, &image.components};
  return *numbers[element];
}
std::span<const uint8_t> pixelOf(const Image& image, size_t element) {
  const size_t bytes = bytesOfPixel(image);
  return {image.pixels.data() + (element - headOfImage) * bytes, bytes};
}

template <class T> std::string_view bytesOf(std::span<const T> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

std::string stringWord(const std::string& text, const ValueSyntax& syntax) {
  if (syntax.isJson) return jsonString(text);
  std::string word;
  writeString(word, text);
  if (!syntax.isXml()) return word;
  std::string escaped;
  escapeXml(escaped, word, {&syntax.quote, 1});
  return escaped;
}

std::string booleanWord(bool value, const ValueSyntax& syntax) {
  if (syntax.isXml() || syntax.isJson) return value ? "true" : "false";
  return value ? "TRUE" : "FALSE";
}

// Returns a number as a hexadecimal token is spelled: with its prefix, its number of digits at
// least, and its case.
std::string hexadecimalLike(std::string_view token, const std::string& word) {
  uint32_t number = 0;
  std::from_chars(word.data(), word.data() + word.size(), number);
  const std::string_view digits = token.substr(2);
  const bool isUpper = digits.find_first_of("ABCDEF") != digits.npos &&
                       digits.find_first_of("abcdef") == digits.npos;
  return std::string(token.substr(0, 2)) + (isUpper
                                                ? fmt::format("{:0{}X}", number, digits.size())
                                                : fmt::format("{:0{}x}", number, digits.size()));
}

} // namespace

ValueWords::ValueWords(FieldType type, const Value& value)
    : hasAxes_(type == FieldType::SFRotation || type == FieldType::MFRotation) {
  const auto setNumbers = [this](const auto* first, size_t count) {
    using E = std::remove_cvref_t<decltype(*first)>;
    size_ = count;
    wordsOfElement_ = size_t(numberCount<E>);
    if (count > 0) elements_ = std::span(numbersOf(*first), count * wordsOfElement_);
  };
  const auto setElements = [&](const auto* first, size_t count) {
    using E = std::remove_cvref_t<decltype(*first)>;
    if constexpr (Numeric<E>) {
      setNumbers(first, count);
    } else if constexpr (std::is_same_v<E, std::string> || std::is_same_v<E, Image>) {
      elements_ = std::span(first, count);
      size_ = count;
    }
  };
  const void* const storage =
      std::visit([](const auto& stored) -> const void* { return &stored; }, value);
  visitStorage(type, storage, [&](const auto& stored) {
    using T = std::remove_cvref_t<decltype(stored)>;
    if constexpr (std::is_same_v<T, bool>)
      booleans_ = {stored};
    else if constexpr (std::is_same_v<T, std::vector<bool>>)
      booleans_.assign(stored.begin(), stored.end());
    else if constexpr (isList<T>)
      setElements(stored.data(), stored.size());
    else
      setElements(&stored, 1);
  });
  if (!booleans_.empty()) {
    elements_ = std::span<const uint8_t>(booleans_);
    size_ = booleans_.size();
  }
  if (const auto* const images = std::get_if<std::span<const Image>>(&elements_)) {
    size_ = 0;
    for (const Image& image : *images) {
      beginOfImages_.push_back(size_);
      size_ += elementsOf(image);
    }
  }
}

ValueWords::ImagePlace ValueWords::imageAt(size_t element) const {
  const auto next = std::upper_bound(beginOfImages_.begin(), beginOfImages_.end(), element);
  const size_t index = size_t(next - beginOfImages_.begin()) - 1;
  return {&std::get<std::span<const Image>>(elements_)[index], element - beginOfImages_[index]};
}

std::string_view ValueWords::bytes(size_t element) const {
  return std::visit(
      [&](const auto& all) -> std::string_view {
        using E = std::remove_cvref_t<decltype(all[0])>;
        if constexpr (std::is_same_v<E, Image>) {
          const auto [image, own] = imageAt(element);
          if (own >= headOfImage) return bytesOf(pixelOf(*image, own));
          return bytesOf(std::span(&headNumber(*image, own), 1));
        } else if constexpr (std::is_same_v<E, std::string>) {
          return all[element];
        } else {
          return bytesOf(all.subspan(element * wordsOfElement_, wordsOfElement_));
        }
      },
      elements_);
}

std::vector<std::string> ValueWords::words(size_t element, const ValueSyntax& syntax) const {
  std::vector<std::string> words;
  std::visit(
      [&](const auto& all) {
        using E = std::remove_cvref_t<decltype(all[0])>;
        if constexpr (std::is_same_v<E, Image>) {
          const auto [image, own] = imageAt(element);
          if (own < headOfImage) return writeNumber(words.emplace_back(), headNumber(*image, own));
          uint32_t pixel = 0;
          for (const uint8_t component : pixelOf(*image, own)) pixel = pixel << 8 | component;
          words.push_back(fmt::format("{}", pixel));
        } else if constexpr (std::is_same_v<E, std::string>) {
          words.push_back(stringWord(all[element], syntax));
        } else if constexpr (std::is_same_v<E, uint8_t>) {
          words.push_back(booleanWord(all[element] != 0, syntax));
        } else {
          for (const auto number : all.subspan(element * wordsOfElement_, wordsOfElement_))
            writeNumber(words.emplace_back(), number);
        }
      },
      elements_);
  return words;
}

std::string ValueWords::spelledLike(std::string_view token, const std::string& word) const {
  if (token == "TRUE" || token == "FALSE") {
    if (word == "true") return "TRUE";
    if (word == "false") return "FALSE";
  }
  const bool isHexadecimal = token.starts_with("0x") || token.starts_with("0X");
  return isHexadecimal && !beginOfImages_.empty() ? hexadecimalLike(token, word) : word;
}

} // namespace xvrml
