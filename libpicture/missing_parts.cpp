#include "libpicture/missing_parts.h"

#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <utility>

#include "xvrml/build.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace picture {

namespace {

using namespace xvrml;

constexpr float millimetre = 1 / 2.54f;         // in units of KiCad's models
constexpr float smallest = 0.1f, largest = 300; // sides of parts, in millimetres
constexpr size_t longestPath = 12;              // names
constexpr uint64_t longestWay = 1000;           // nodes above a part that are asked for names

bool isMissing(const Node& node) {
  const auto* part = nodeCast<nodes::Inline>(&node);
  return part && part->load && !part->url.empty() && !inlineScope(node);
}

// Reads a number of the form 12 or 3.9 at `at`, and moves `at` behind it.
std::optional<float> numberAt(std::string_view text, size_t& at) {
  float value = 0;
  const auto read =
      std::from_chars(text.data() + at, text.data() + text.size(), value, std::chars_format::fixed);
  if (read.ec != std::errc() || !(value >= smallest && value <= largest)) return {};
  at = size_t(read.ptr - text.data());
  return value;
}

// Reads "3.9x4.9mm" or "3.9x4.9x1.2mm" at `at`; "5.0mm" is a diameter.
std::optional<Vec3f> sizeAt(std::string_view text, size_t at, bool isDiameter) {
  std::vector<float> sides;
  while (sides.size() < 3) {
    const std::optional<float> side = numberAt(text, at);
    if (!side) return {};
    sides.push_back(*side);
    if (at >= text.size() || text[at] != 'x') break;
    ++at;
  }
  if (!text.substr(at).starts_with("mm")) return {};
  if (isDiameter && sides.size() == 1) sides.push_back(sides[0]);
  if (sides.size() < 2) return {};
  if (sides.size() < 3) sides.push_back(std::min(sides[0], sides[1]) / 2);
  return Vec3f{sides[0], sides[1], sides[2]};
}

// Reads the metric code of a chip: "2012Metric" is 2 by 1.2 mm.
std::optional<Vec3f> chipSize(std::string_view text) {
  const size_t end = text.find("Metric");
  if (end == text.npos || end < 4) return {};
  int sides[2] = {0, 0};
  for (size_t i = 0; i < 4; ++i) {
    const char digit = text[end - 4 + i];
    if (digit < '0' || digit > '9') return {};
    sides[i / 2] = sides[i / 2] * 10 + (digit - '0');
  }
  if (sides[0] == 0 || sides[1] == 0) return {};
  const float length = float(sides[0]) / 10, width = float(sides[1]) / 10;
  return Vec3f{length, width, std::min(length, width) / 2};
}

void findSize(const nodes::Inline& part, MissingPart& out) {
  const Vec3f& box = part.bboxSize;
  if (box.x >= 0 && box.y >= 0 && box.z >= 0) {
    out.size = box;
    out.center = part.bboxCenter;
  } else if (const auto size = sizeInName(out.url)) {
    out.size = Vec3f{size->x * millimetre, size->y * millimetre, size->z * millimetre};
    out.center = Vec3f{0, 0, out.size->z / 2}; // it stands on the board
  }
}

// Walks over all nodes, and tells for each which node it was reached from; null for a root.
template <class Visit> void walkWithParents(const World& world, const Visit& visit) {
  std::unordered_map<const Node*, const Node*> above;
  std::vector<const Node*> roots;
  appendRoots(world.scope, roots);
  std::reverse(roots.begin(), roots.end()); // the walk takes the last one first
  walk(std::move(roots), [&](const Node& node, std::vector<const Node*>& open) {
    visit(node, above);
    const size_t before = open.size();
    appendChildren(node, open);
    if (const auto* instance = nodeCast<ProtoInstance>(&node)) appendRoots(instance->body, open);
    if (const Scope* content = inlineScope(node)) appendRoots(*content, open);
    std::reverse(open.begin() + long(before), open.end());
    for (size_t i = before; i < open.size(); ++i)
      if (open[i]) above.emplace(open[i], &node);
  });
}

NodeRef made(const char* typeName) { return xvrml::makeNode(*findNodeType(typeName)); }

NodeRef placeholderFor(const MissingPart& part) {
  NodeRef transform = made("Transform"), shape = made("Shape"), appearance = made("Appearance"),
          material = made("Material"), box = made("Box");
  auto& place = static_cast<nodes::Transform&>(*transform);
  place.translation = *part.center;
  static_cast<nodes::Box&>(*box).size = *part.size;
  auto& look = static_cast<nodes::Material&>(*material);
  look.diffuseColor = {.6f, .6f, .65f};
  look.transparency = .5f;
  static_cast<nodes::Appearance&>(*appearance).material = material;
  static_cast<nodes::Shape&>(*shape).appearance = appearance;
  static_cast<nodes::Shape&>(*shape).geometry = box;
  place.children = {shape};
  for (const NodeRef& node : {transform, shape, appearance, material, box})
    node->source = part.where;
  return transform;
}

} // namespace

std::optional<Vec3f> sizeInName(std::string_view file) {
  if (const size_t slash = file.find_last_of("/\\"); slash != file.npos)
    file.remove_prefix(slash + 1);
  if (const auto chip = chipSize(file)) return chip;
  for (size_t at = 0; at < file.size(); ++at) {
    const bool begins = at == 0 || file[at - 1] == '_' || file[at - 1] == '-';
    if (begins && file[at] == 'D')
      if (const auto size = sizeAt(file, at + 1, true)) return size;
    if (begins)
      if (const auto size = sizeAt(file, at, false)) return size;
  }
  return {};
}

std::vector<MissingPart> missingParts(const World& world) {
  std::vector<MissingPart> parts;
  walkWithParents(world, [&](const Node& node, const auto& above) {
    if (!isMissing(node)) return;
    const auto& part = static_cast<const nodes::Inline&>(node);
    MissingPart out{{}, part.url.front(), node.source, {}, {}};
    size_t names = 0;
    const Node* at = &node;
    for (uint64_t steps = 0; at && names < longestPath && steps < longestWay; ++steps) {
      if (!at->defName.empty()) { out.path = at->defName + (names++ > 0 ? "/" : "") + out.path; }
      const auto up = above.find(at);
      at = up == above.end() ? nullptr : up->second;
    }
    findSize(part, out);
    parts.push_back(std::move(out));
  });
  return parts;
}

size_t addPlaceholders(World& world) {
  size_t boxes = 0;
  std::unordered_map<const Node*, NodeRef> standIns;
  const auto replace = [&](NodeRef& child) {
    if (!child || !isMissing(*child)) return;
    NodeRef& box = standIns[child.get()];
    if (!box) {
      const auto& part = static_cast<const nodes::Inline&>(*child);
      MissingPart missing{{}, part.url.front(), part.source, {}, {}};
      findSize(part, missing);
      if (!missing.size || missing.size->x <= 0 || missing.size->y <= 0 || missing.size->z <= 0)
        return;
      box = placeholderFor(missing);
      ++boxes;
    }
    child = box;
  };
  for (NodeRef& root : world.scope.roots) replace(root);
  walkWithParents(world, [&](const Node& node, const auto&) {
    for (const FieldInfo& field : node.type().fields)
      if (holdsValue(field) && field.type == FieldType::MFNode)
        for (NodeRef& child : *static_cast<MFNode*>(const_cast<Node&>(node).storage(field)))
          replace(child);
  });
  return boxes;
}

} // namespace picture
