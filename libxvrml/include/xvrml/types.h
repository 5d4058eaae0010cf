// types.h: the 42 field types of X3D (ISO/IEC 19775-1 clause 5) as plain C++ values. The first 20
// are those of VRML97 (ISO/IEC 14772-1 clause 5).
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

// An element of several numbers. `Scalar` is the type of its numbers, which are its only members,
// so that numbers.h can treat all such types alike.
#define XVRML_TUPLE(Name, Number, ...)                                                             \
  struct Name {                                                                                    \
    using Scalar = Number;                                                                         \
    Number __VA_ARGS__;                                                                            \
    bool operator==(const Name&) const = default;                                                  \
  }
XVRML_TUPLE(Vec2f, float, x = 0, y = 0);
XVRML_TUPLE(Vec3f, float, x = 0, y = 0, z = 0);
XVRML_TUPLE(Vec4f, float, x = 0, y = 0, z = 0, w = 1);
XVRML_TUPLE(Vec2d, double, x = 0, y = 0);
XVRML_TUPLE(Vec3d, double, x = 0, y = 0, z = 0);
XVRML_TUPLE(Vec4d, double, x = 0, y = 0, z = 0, w = 1);
XVRML_TUPLE(Color, float, r = 0, g = 0, b = 0);
XVRML_TUPLE(ColorRGBA, float, r = 0, g = 0, b = 0, a = 0);
XVRML_TUPLE(Rotation, float, x = 0, y = 0, z = 1, angle = 0); // radians
// Row by row. The default is the identity matrix.
XVRML_TUPLE(Matrix3f, float, m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1});
XVRML_TUPLE(Matrix3d, double, m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1});
XVRML_TUPLE(Matrix4f, float, m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
XVRML_TUPLE(Matrix4d, double, m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
#undef XVRML_TUPLE
// The number of an SFDouble. It is a type of its own because Value has one alternative for each
// field type, and SFTime is double.
struct Double {
  using Scalar = double;
  double value = 0;
  operator double() const { return value; }
  bool operator==(const Double&) const = default;
};
// A value on the heap. Large types are boxed where a field has one, so that a Value, of which each
// field of a prototype's instance has one, stays small.
template <class T> class Boxed {
 public:
  using Content = T;
  using Scalar = typename T::Scalar;
  Boxed(const T& value = T()) : value_(std::make_unique<T>(value)) {}
  Boxed(const Boxed& other) : Boxed(*other) {}
  Boxed& operator=(Boxed other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  bool operator==(const Boxed& other) const { return **this == *other; }

 private:
  std::unique_ptr<T> value_; // never null
};
// Pixels row by row from the bottom left, `components` bytes each (0: no image).
struct Image {
  int32_t width = 0, height = 0, components = 0;
  std::vector<uint8_t> pixels;
  bool operator==(const Image&) const = default;
};

// The field types and their C++ types. This order is that of FieldType, of the alternatives of
// Value and of XsType. A new type goes to the end.
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
  X(MFVec3f, std::vector<Vec3f>)                                                                   \
  X(MFBool, std::vector<bool>)                                                                     \
  X(SFColorRGBA, ColorRGBA)                                                                        \
  X(MFColorRGBA, std::vector<ColorRGBA>)                                                           \
  X(SFDouble, Double)                                                                              \
  X(MFDouble, std::vector<Double>)                                                                 \
  X(MFImage, std::vector<Image>)                                                                   \
  X(SFMatrix3d, Boxed<Matrix3d>)                                                                   \
  X(MFMatrix3d, std::vector<Matrix3d>)                                                             \
  X(SFMatrix3f, Matrix3f)                                                                          \
  X(MFMatrix3f, std::vector<Matrix3f>)                                                             \
  X(SFMatrix4d, Boxed<Matrix4d>)                                                                   \
  X(MFMatrix4d, std::vector<Matrix4d>)                                                             \
  X(SFMatrix4f, Boxed<Matrix4f>)                                                                   \
  X(MFMatrix4f, std::vector<Matrix4f>)                                                             \
  X(SFVec2d, Vec2d)                                                                                \
  X(MFVec2d, std::vector<Vec2d>)                                                                   \
  X(SFVec3d, Vec3d)                                                                                \
  X(MFVec3d, std::vector<Vec3d>)                                                                   \
  X(SFVec4d, Vec4d)                                                                                \
  X(MFVec4d, std::vector<Vec4d>)                                                                   \
  X(SFVec4f, Vec4f)                                                                                \
  X(MFVec4f, std::vector<Vec4f>)

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
static_assert(sizeof(Value) <= 48); // see Boxed
inline constexpr int fieldTypeCount = std::variant_size_v<Value>;

std::string_view fieldTypeName(FieldType type); // "SFBool" ...
bool fieldTypeFromName(std::string_view name, FieldType& type);
// Whether VRML97 has the type, too (ISO/IEC 14772-1 clause 5).
constexpr bool isVrml97Type(FieldType type) { return type <= FieldType::MFVec3f; }
bool isMultiple(FieldType type);       // an MF type
FieldType elementType(FieldType type); // the SF type of an MF type; an SF type itself
// FALSE, zeros, empty; SFRotation 0 0 1 0, SFVec4f 0 0 0 1, the identity matrix (clause 5).
Value defaultValue(FieldType type);

} // namespace xvrml
