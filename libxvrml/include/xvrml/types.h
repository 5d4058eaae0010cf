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

using SFBool = bool;
using SFColor = Color;
using SFFloat = float;
using SFImage = Image;
using SFInt32 = int32_t;
using SFNode = NodeRef;
using SFRotation = Rotation;
using SFString = std::string;
using SFTime = double;
using SFVec2f = Vec2f;
using SFVec3f = Vec3f;
using MFColor = std::vector<Color>;
using MFFloat = std::vector<float>;
using MFInt32 = std::vector<int32_t>;
using MFNode = std::vector<NodeRef>;
using MFRotation = std::vector<Rotation>;
using MFString = std::vector<std::string>;
using MFTime = std::vector<double>;
using MFVec2f = std::vector<Vec2f>;
using MFVec3f = std::vector<Vec3f>;

// Each value is the index of the alternative in Value.
enum class FieldType : uint8_t {
  SFBool,
  SFColor,
  SFFloat,
  SFImage,
  SFInt32,
  SFNode,
  SFRotation,
  SFString,
  SFTime,
  SFVec2f,
  SFVec3f,
  MFColor,
  MFFloat,
  MFInt32,
  MFNode,
  MFRotation,
  MFString,
  MFTime,
  MFVec2f,
  MFVec3f
};
inline constexpr int fieldTypeCount = 20;

using Value = std::variant<SFBool, SFColor, SFFloat, SFImage, SFInt32, SFNode, SFRotation, SFString,
                           SFTime, SFVec2f, SFVec3f, MFColor, MFFloat, MFInt32, MFNode, MFRotation,
                           MFString, MFTime, MFVec2f, MFVec3f>;

std::string_view fieldTypeName(FieldType type); // "SFBool" ...
bool fieldTypeFromName(std::string_view name, FieldType& type);
inline bool isMultiple(FieldType type) { return type >= FieldType::MFColor; }
Value defaultValue(FieldType type); // FALSE, zeros, empty; SFRotation 0 0 1 0 (clause 5)

} // namespace xvrml
