// value_writer.cpp: writes numbers, tuples, lists and images as text.
#include "write/value_writer.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "graph/field_access.h"

namespace xvrml {
namespace {

constexpr size_t lineWidth = 120;

template <class T> void writeFinite(std::string& out, T number) {
  if (std::isnan(number)) number = 0;
  if (std::isinf(number)) number = std::copysign(std::numeric_limits<T>::max(), number);
  char buffer[64];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
}

void write(std::string& out, bool value) { out += value ? "TRUE" : "FALSE"; }
void write(std::string& out, const std::string& value) { writeString(out, value); }
template <Numeric T> void write(std::string& out, const T& element) {
  for (int i = 0; i < numberCount<T>; ++i) {
    if (i > 0) out += ' ';
    writeNumber(out, numbersOf(element)[i]);
  }
}

void writeImage(std::string& out, const Image& image, size_t indent) {
  out += fmt::format("{} {} {}", image.width, image.height, image.components);
  if (image.components < 1) return;
  size_t lineStart = out.size();
  const uint64_t pixels = uint64_t(std::max(image.width, 0)) * uint64_t(std::max(image.height, 0));
  for (uint64_t i = 0; i < pixels; ++i) {
    uint32_t pixel = 0;
    for (uint64_t c = 0; c < uint64_t(image.components); ++c) {
      const uint64_t at = i * uint64_t(image.components) + c;
      pixel = pixel << 8 | (at < image.pixels.size() ? image.pixels[at] : 0u);
    }
    if (out.size() - lineStart > lineWidth || i % uint64_t(image.width) == 0) {
      out += '\n';
      lineStart = out.size();
      out.append(indent + 2, ' ');
    } else {
      out += ' ';
    }
    fmt::format_to(std::back_inserter(out), "0x{:0{}x}", pixel, 2 * image.components);
  }
}

// Elements of several numbers are separated by commas; single numbers need none.
template <class T> constexpr std::string_view separator() {
  if constexpr (Numeric<T>) return numberCount<T> == 1 ? " " : ", ";
  return std::is_class_v<T> ? ", " : " ";
}

template <class T> void writeList(std::string& out, const std::vector<T>& values, size_t indent) {
  size_t lineStart = out.size();
  out += "[ ";
  for (size_t i = 0; i < values.size(); ++i) {
    if (out.size() - lineStart > lineWidth) {
      while (out.back() == ' ') out.pop_back();
      out += '\n';
      lineStart = out.size();
      out.append(indent + 2, ' ');
    }
    if constexpr (std::is_same_v<T, Image>)
      writeImage(out, values[i], indent + 2);
    else
      write(out, values[i]);
    if (i + 1 < values.size()) out += separator<T>();
  }
  out += " ]";
}

} // namespace

void writeNumber(std::string& out, float number) { writeFinite(out, number); }
void writeNumber(std::string& out, double number) { writeFinite(out, number); }
void writeNumber(std::string& out, int32_t number) {
  char buffer[16];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr);
}

void writeString(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
}

void writeValue(std::string& out, FieldType type, const void* storage, size_t indent) {
  visitStorage(type, storage, [&](const auto& value) {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<T, Image>) {
      writeImage(out, value, indent);
    } else if constexpr (std::is_same_v<T, NodeRef> || std::is_same_v<T, MFNode>) {
      // The world's writer writes nodes.
    } else if constexpr (std::is_same_v<T, std::string>) {
      writeString(out, value);
    } else if constexpr (isList<T>) {
      writeList(out, value, indent);
    } else {
      write(out, value);
    }
  });
}

void writeXmlValue(std::string& out, FieldType type, const void* storage, size_t indent) {
  if (type == FieldType::SFBool) {
    out += *static_cast<const bool*>(storage) ? "true" : "false";
  } else if (type == FieldType::SFString) {
    out += *static_cast<const std::string*>(storage);
  } else {
    const size_t begin = out.size();
    writeValue(out, type, storage, indent);
    if (!isMultiple(type)) return;
    out.erase(begin, 2); // "[ " and " ]"
    out.resize(std::max(begin, out.size() - 2));
    if (type != FieldType::MFBool) return;
    for (size_t i = begin; i < out.size(); ++i)
      if (out[i] >= 'A' && out[i] <= 'Z') out[i] = char(out[i] + 32);
  }
}

} // namespace xvrml
