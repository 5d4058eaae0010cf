// types.h: the 20 field types of ISO/IEC 14772-1 clause 5 as plain C++ values.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace xvrml {

class Node;

// A reference-counted pointer to a node; null is VRML's NULL.
class NodeRef {
 public:
  NodeRef() = default;
  NodeRef(std::nullptr_t) {}
  explicit NodeRef(Node* node);
  NodeRef(const NodeRef& other);
  NodeRef(NodeRef&& other) noexcept : node_(other.node_) { other.node_ = nullptr; }
  NodeRef& operator=(NodeRef other) noexcept {
    std::swap(node_, other.node_);
    return *this;
  }
  ~NodeRef();
  Node* get() const { return node_; }
  Node* operator->() const { return node_; }
  Node& operator*() const { return *node_; }
  explicit operator bool() const { return node_ != nullptr; }
  bool operator==(const NodeRef&) const = default;

 private:
  Node* node_ = nullptr;
};

struct Vec2f {
  float x = 0, y = 0;
  bool operator==(const Vec2f&) const = default;
};
struct Vec3f {
  float x = 0, y = 0, z = 0;
  bool operator==(const Vec3f&) const = default;
};
struct Color {
  float r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};
struct Rotation {
  float x = 0, y = 0, z = 1, angle = 0;
  bool operator==(const Rotation&) const = default;
}; // radians
// Pixels row by row from the bottom left, `components` bytes each (0: no image).
struct Image {
  int32_t width = 0, height = 0, components = 0;
  std::vector<uint8_t> pixels;
  bool operator==(const Image&) const = default;
};

// The field types and their C++ types. This order is that of FieldType and of the alternatives of
// Value; MFColor is the first MF type.
#define XVRML_FIELD_TYPES(X)                                                                       \
  X(SFBool, bool)                                                                                  \
  X(SFColor, Color)                                                                                \
  X(SFFloat, float)                                                                                \
  X(SFImage, Image)                                                                                \
  X(SFInt32, int32_t)                                                                              \
  X(SFNode, NodeRef)                                                                               \
  X(SFRotation, Rotation)                                                                          \
  X(SFString, std::string)                                                                         \
  X(SFTime, double)                                                                                \
  X(SFVec2f, Vec2f)                                                                                \
  X(SFVec3f, Vec3f)                                                                                \
  X(MFColor, std::vector<Color>)                                                                   \
  X(MFFloat, std::vector<float>)                                                                   \
  X(MFInt32, std::vector<int32_t>)                                                                 \
  X(MFNode, std::vector<NodeRef>)                                                                  \
  X(MFRotation, std::vector<Rotation>)                                                             \
  X(MFString, std::vector<std::string>)                                                            \
  X(MFTime, std::vector<double>)                                                                   \
  X(MFVec2f, std::vector<Vec2f>)                                                                   \
  X(MFVec3f, std::vector<Vec3f>)

#define XVRML_ALIAS(name, type) using name = type;
XVRML_FIELD_TYPES(XVRML_ALIAS)
#undef XVRML_ALIAS

// Each value is the index of the alternative in Value.
#define XVRML_ENUMERATOR(name, type) name,
enum class FieldType : uint8_t { XVRML_FIELD_TYPES(XVRML_ENUMERATOR) };
#undef XVRML_ENUMERATOR

namespace detail {
template <class First, class... Others> using VariantOfOthers = std::variant<Others...>;
} // namespace detail
#define XVRML_ARGUMENT(name, type) , type
using Value = detail::VariantOfOthers<void XVRML_FIELD_TYPES(XVRML_ARGUMENT)>;
#undef XVRML_ARGUMENT
inline constexpr int fieldTypeCount = std::variant_size_v<Value>;

std::string_view fieldTypeName(FieldType type); // "SFBool" ...
bool fieldTypeFromName(std::string_view name, FieldType& type);
inline bool isMultiple(FieldType type) { return type >= FieldType::MFColor; }
Value defaultValue(FieldType type); // FALSE, zeros, empty; SFRotation 0 0 1 0 (clause 5)

} // namespace xvrml
