#include "script/values.h"

#include <cstring>

#include <fmt/format.h>

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

// Reads one element of the ABI's array; the type of `out` selects the array.
bool element(const XsValue& v, size_t i, bool& out) {
  out = v.of.ints[i] != 0;
  return true;
}
bool element(const XsValue& v, size_t i, int32_t& out) {
  out = v.of.ints[i];
  return true;
}
bool element(const XsValue& v, size_t i, float& out) {
  out = v.of.floats[i];
  return true;
}
bool element(const XsValue& v, size_t i, double& out) {
  out = v.of.doubles[i];
  return true;
}
template <class T>
requires(sizeof(T) % sizeof(float) == 0 && std::is_trivially_copyable_v<T>) bool element(
    const XsValue& v, size_t i,
    T& out) { // Vec2f, Vec3f, Color, Rotation: tuples of floats
  std::memcpy(static_cast<void*>(&out), v.of.floats + i * (sizeof(T) / sizeof(float)), sizeof(T));
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
  template <class T> bool one(size_t i, T& out) { return element(value, i, out); }
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
    out.resize(value.count);
    for (size_t i = 0; i < value.count; ++i)
      if (!one(i, out[i])) return false;
    return true;
  }
};

} // namespace

// The types of the SDK have the order of FieldType.
constexpr XsType xsTypeOf(FieldType type) { return XsType(int(type) + XS_SFBOOL); }
static_assert(
    xsTypeOf(FieldType::SFBool) == XS_SFBOOL && xsTypeOf(FieldType::SFColor) == XS_SFCOLOR &&
    xsTypeOf(FieldType::SFFloat) == XS_SFFLOAT && xsTypeOf(FieldType::SFImage) == XS_SFIMAGE &&
    xsTypeOf(FieldType::SFInt32) == XS_SFINT32 && xsTypeOf(FieldType::SFNode) == XS_SFNODE &&
    xsTypeOf(FieldType::SFRotation) == XS_SFROTATION &&
    xsTypeOf(FieldType::SFString) == XS_SFSTRING && xsTypeOf(FieldType::SFTime) == XS_SFTIME &&
    xsTypeOf(FieldType::SFVec2f) == XS_SFVEC2F && xsTypeOf(FieldType::SFVec3f) == XS_SFVEC3F &&
    xsTypeOf(FieldType::MFColor) == XS_MFCOLOR && xsTypeOf(FieldType::MFNode) == XS_MFNODE &&
    xsTypeOf(FieldType::MFVec3f) == XS_MFVEC3F);

const XsValue& LentValue::lend(Value value, Handles& handles) {
  value_ = std::move(value);
  strings_.clear();
  nodes_.clear();
  view_ = {xsTypeOf(FieldType(value_.index())), 1, {nullptr}};
  std::visit(
      [&](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, bool>) {
          boolean_ = v;
          view_.of.ints = &boolean_;
        } else if constexpr (std::is_same_v<T, std::string>) {
          strings_.push_back(view(v));
          view_.of.strings = strings_.data();
        } else if constexpr (std::is_same_v<T, NodeRef>) {
          nodes_.push_back(handles.handleOf(v.get()));
          view_.of.nodes = nodes_.data();
        } else if constexpr (std::is_same_v<T, Image>) {
          image_ = {v.width, v.height, v.components, 0, v.pixels.data()};
          view_.of.images = &image_;
        } else if constexpr (std::is_same_v<T, MFString>) {
          for (const std::string& text : v) strings_.push_back(view(text));
          view_.count = uint32_t(v.size());
          view_.of.strings = strings_.data();
        } else if constexpr (std::is_same_v<T, MFNode>) {
          for (const NodeRef& node : v) nodes_.push_back(handles.handleOf(node.get()));
          view_.count = uint32_t(v.size());
          view_.of.nodes = nodes_.data();
        } else if constexpr (requires { v.size(); }) {
          view_.count = uint32_t(v.size());
          view_.of.data = v.data();
        } else {
          view_.of.data = &v;
        }
      },
      value_);
  return view_;
}

void LentValue::clear() {
  value_ = false;
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
    const bool known = value->type >= XS_SFBOOL && value->type <= XS_MFVEC3F;
    why =
        fmt::format("expected {}, got {}", fieldTypeName(wanted),
                    known ? fieldTypeName(FieldType(value->type - XS_SFBOOL)) : "an unknown type");
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
