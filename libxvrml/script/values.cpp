#include "script/values.h"

#include <cstring>

#include <fmt/format.h>

#include "xvrml/numbers.h"
#include "xvrml/xscript_types.h"

namespace xvrml {
namespace {

XsString view(const std::string& text) { return {text.c_str(), text.size()}; }

// Checks UTF-8 by RFC 3629: no overlong forms, no surrogates, at most U+10FFFF.
bool isUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto byte = [&](size_t k) {
      return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u;
    };
    const unsigned first = byte(0);
    const size_t length = first < 0x80                    ? 1
                          : first >= 0xc2 && first < 0xe0 ? 2
                          : first >= 0xe0 && first < 0xf0 ? 3
                          : first >= 0xf0 && first < 0xf5 ? 4
                                                          : 0;
    if (length == 0) return false;
    for (size_t k = 1; k < length; ++k)
      if ((byte(k) & 0xc0) != 0x80) return false;
    const unsigned second = byte(1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f))
      return false;
    i += length;
  }
  return true;
}

struct ValueReader {
  const XsValue& value;
  const Handles& handles;
  const Limits& limits;
  std::string& why;

  bool one(size_t i, std::string& out) { return takeText(value.of.strings[i], limits, out, why); }
  bool one(size_t i, NodeRef& out) {
    const XsNode number = value.of.nodes[i];
    Node* node = number ? handles.find(number) : nullptr;
    if (number && !node) {
      why = fmt::format("the Script does not know a node {}", number);
      return false;
    }
    out = NodeRef(node);
    return true;
  }
  bool one(size_t i, Image& out) {
    const XsImage& image = value.of.images[i];
    if (image.width < 0 || image.height < 0 || image.components < 0 || image.components > 4) {
      why = fmt::format("not an image: {} x {} x {}", image.width, image.height, image.components);
      return false;
    }
    const uint64_t pixels = uint64_t(image.width) * uint64_t(image.height),
                   bytes = pixels * uint64_t(image.components);
    if (pixels > limits.imagePixels) {
      why = fmt::format("more than limit imagePixels={}", limits.imagePixels);
      return false;
    }
    if (bytes > 0 && !image.pixels) {
      why = "an image without pixels";
      return false;
    }
    out.width = image.width;
    out.height = image.height;
    out.components = image.components;
    out.pixels.assign(image.pixels, image.pixels + (image.pixels ? bytes : 0));
    return true;
  }
  bool one(size_t i, bool& out) {
    out = value.of.ints[i] != 0;
    return true;
  }
  template <Numeric T> bool one(size_t i, T& out) {
    const auto* numbers = static_cast<const ScalarOf<T>*>(value.of.data);
    std::memcpy(numbersOf(out), numbers + i * size_t(numberCount<T>),
                size_t(numberCount<T>) * sizeof *numbers);
    return true;
  }
  template <class T> bool all(T& out) {
    if (value.count != 1) {
      why = fmt::format("a single value has {} elements", value.count);
      return false;
    }
    return one(0, out);
  }
  template <class T> bool all(std::vector<T>& out) {
    if (value.count > limits.arrayElements) {
      why = fmt::format("more than limit arrayElements={}", limits.arrayElements);
      return false;
    }
    out.reserve(value.count);
    for (size_t i = 0; i < value.count; ++i) {
      T element{};
      if (!one(i, element)) return false;
      out.push_back(std::move(element));
    }
    return true;
  }
};

} // namespace

// The types of the SDK have the order of FieldType, and arrays hold the same numbers.
static_assert(fieldTypeCount == XS_LAST_TYPE && xsType(FieldType::SFBool) == XS_SFBOOL &&
              xsType(FieldType::MFVec3f) == XS_MFVEC3F && xsType(FieldType::MFVec4f) == XS_MFVEC4F);

const XsValue& LentValue::lend(Value value, Handles& handles) {
  value_ = std::move(value);
  strings_.clear();
  nodes_.clear();
  booleans_.clear();
  images_.clear();
  view_ = {xsType(FieldType(value_.index())), 1, {nullptr}};
  std::visit([&](const auto& v) { lendAll(v, handles); }, value_);
  return view_;
}

template <class T> void LentValue::lendAll(const T& value, Handles& handles) {
  using Element = ElementOf<T>;
  if constexpr (isList<T>) {
    view_.count = uint32_t(value.size());
    if constexpr (Numeric<Element>) {
      view_.of.data = value.data();
    } else {
      for (const auto& element : value) lendOne(element, handles);
    }
  } else if constexpr (Numeric<T>) {
    view_.of.data = numbersOf(value);
  } else {
    lendOne(value, handles);
  }
  if constexpr (std::is_same_v<Element, bool>) view_.of.ints = booleans_.data();
  if constexpr (std::is_same_v<Element, std::string>) view_.of.strings = strings_.data();
  if constexpr (std::is_same_v<Element, NodeRef>) view_.of.nodes = nodes_.data();
  if constexpr (std::is_same_v<Element, Image>) view_.of.images = images_.data();
}

void LentValue::lendOne(bool value, Handles&) { booleans_.push_back(value); }
void LentValue::lendOne(const std::string& text, Handles&) { strings_.push_back(view(text)); }
void LentValue::lendOne(const NodeRef& node, Handles& handles) {
  nodes_.push_back(handles.handleOf(node.get()));
}
void LentValue::lendOne(const Image& image, Handles&) {
  images_.push_back({image.width, image.height, image.components, 0, image.pixels.data()});
}

void LentValue::clear() {
  value_ = false;
  booleans_.clear();
  images_.clear();
  strings_.clear();
  nodes_.clear();
}

bool takeText(const XsString& text, const Limits& limits, std::string& out, std::string& why) {
  if (text.bytes > limits.stringBytes) {
    why = fmt::format("longer than limit stringBytes={}", limits.stringBytes);
    return false;
  }
  if (text.bytes > 0 && !text.data) {
    why = "a text without characters";
    return false;
  }
  const std::string_view characters(text.data ? text.data : "", text.bytes);
  if (!isUtf8(characters)) {
    why = "a text that is not UTF-8";
    return false;
  }
  out = characters;
  return true;
}

bool takeValue(const XsValue* value, FieldType wanted, const Handles& handles, const Limits& limits,
               Value& out, std::string& why) {
  if (!value) {
    why = "no value";
    return false;
  }
  if (value->type != xsType(wanted)) {
    const XsTypeInfo* known = xsTypeInfo(value->type);
    why = fmt::format("expected {}, got {}", fieldTypeName(wanted),
                      known ? known->name : "an unknown type");
    return false;
  }
  if (value->count > 0 && !value->of.data) {
    why = "a value without data";
    return false;
  }
  out = defaultValue(wanted);
  return std::visit([&](auto& v) { return ValueReader{*value, handles, limits, why}.all(v); }, out);
}

} // namespace xvrml
