#include "write/json_value.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "printable.h"
#include "write/value_writer.h"

namespace xvrml {
namespace {

// An array of numbers, truth values or strings.
class Array {
 public:
  Array(std::string& out, size_t indent) : out_(out), indent_(indent), lineStart_(out.size()) {
    out_ += '[';
  }
  void end() { out_ += ']'; }

  void add(bool value) { next() += value ? "true" : "false"; }
  void add(const std::string& value) { writeJsonString(next(), value); }
  void add(const Image& image) {
    for (const int32_t number : {image.width, image.height, image.components})
      writeNumber(next(), number);
    const auto components = uint64_t(std::max(image.components, 0));
    const uint64_t pixels =
        components == 0 ? 0
                        : uint64_t(std::max(image.width, 0)) * uint64_t(std::max(image.height, 0));
    for (uint64_t i = 0; i < pixels; ++i) {
      uint32_t pixel = 0;
      for (uint64_t at = i * components; at < (i + 1) * components; ++at)
        pixel = pixel << 8 | (at < image.pixels.size() ? image.pixels[at] : 0u);
      fmt::format_to(std::back_inserter(next()), "{}", pixel);
    }
  }
  template <Numeric T> void add(const T& value) {
    for (int i = 0; i < numberCount<T>; ++i) writeNumber(next(), numbersOf(value)[i]);
  }

 private:
  // Returns the text after what separates an item from the one before.
  std::string& next() {
    constexpr size_t lineWidth = 120;
    if (out_.back() != '[') out_ += out_.size() - lineStart_ > lineWidth ? "," : ", ";
    if (out_.size() - lineStart_ > lineWidth) {
      out_ += '\n';
      lineStart_ = out_.size();
      out_.append(indent_ + 2, ' ');
    }
    return out_;
  }

  std::string& out_;
  const size_t indent_;
  size_t lineStart_;
};

} // namespace

void writeJsonString(std::string& out, std::string_view text) {
  out += '"';
  while (!text.empty()) {
    const size_t length = printable_text::utf8Length(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (length == 0) {
      out += char(0xc0 | byte >> 6);
      out += char(0x80 | (byte & 0x3f));
    } else if (byte < 0x20) {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", byte);
    } else {
      if (byte == '"' || byte == '\\') out += '\\';
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<size_t>(length, 1));
  }
  out += '"';
}

void writeJsonValue(std::string& out, FieldType type, const void* storage, size_t indent) {
  visitStorage(type, const_cast<void*>(storage), [&](auto& value) {
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_same_v<T, NodeRef> || std::is_same_v<T, MFNode>) {
      // The world's writer writes nodes.
    } else if constexpr (std::is_same_v<T, bool>) {
      out += value ? "true" : "false";
    } else if constexpr (std::is_same_v<T, std::string>) {
      writeJsonString(out, value);
    } else {
      if constexpr (Numeric<T>)
        if (numberCount<T> == 1) return writeNumber(out, *numbersOf(value));
      Array array(out, indent);
      if constexpr (isList<T>)
        for (const auto& element : value) array.add(element);
      else
        array.add(value);
      array.end();
    }
  });
}

} // namespace xvrml
