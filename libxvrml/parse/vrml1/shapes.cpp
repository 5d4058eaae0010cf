// shapes.cpp: geometry other than faces, and the properties that shapes share.
#include "parse/vrml1/shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace xvrml::vrml1 {
namespace {

// Sets a field that not all versions of a node have.
void setIfThere(Node& node, std::string_view name, Value value) {
  const FieldInfo* field = node.type().find(name);
  if (field && holdsValue(*field)) node.set(*field, std::move(value));
}

// Returns a size as VRML97 allows it: positive. A negative one has meant the same shape, and a flat
// shape keeps a trace of its thickness. 0 only if all are 0.
float positive(float size, float largest) { return std::max(std::abs(size), largest * 1e-6f); }

} // namespace

MFNode Shapes::make(const TreeNode& node, State& state, bool last) {
  const auto array = [&](const char* name) {
    return last ? node.take<MFInt32>(name) : node.get<MFInt32>(name);
  };
  switch (node.kind) {
  case Kind::indexedFaceSet: {
    Faces set{node,
              coordinates(node, state),
              array("coordIndex"),
              array("materialIndex"),
              array("normalIndex"),
              array("textureCoordIndex"),
              {},
              true};
    return faces(set, state);
  }
  case Kind::indexedLineSet: return lines(node, state, last);
  case Kind::pointSet: return points(node, state);
  case Kind::asciiText: return text(node, state);
  case Kind::cube: return cube(node, state);
  case Kind::sphere: {
    if (node.get<float>("radius") == 0) return {};
    auto* sphere = graph_.make<nodes::Sphere>(node);
    sphere->radius = std::abs(node.get<float>("radius"));
    return {shape(node, looks_.appearance(node, state, 0, Use::surface), graph_.finish(sphere))};
  }
  default: return parts(node, state);
  }
}

NodeRef Shapes::shape(const TreeNode& from, NodeRef appearance, NodeRef geometry) {
  auto* made = graph_.make<nodes::Shape>(from);
  made->appearance = std::move(appearance);
  made->geometry = std::move(geometry);
  return graph_.finish(made);
}

// Cone and Cylinder. With materials for the parts, each part that is there becomes a Shape. The
// parts keep their numbers where others are left out.
MFNode Shapes::parts(const TreeNode& node, State& state) {
  const bool cone = node.kind == Kind::cone;
  bool side = false, top = false, bottom = false;
  for (const std::string& part : node.get<MFString>("parts")) {
    const bool all = part == "ALL";
    side = side || all || part == "SIDES";
    top = top || (!cone && (all || part == "TOP"));
    bottom = bottom || all || part == "BOTTOM";
    if (!all && part != "SIDES" && part != "BOTTOM" && part != "NONE" && (part != "TOP" || cone))
      graph_.warnOnce(node, "part " + part,
                      fmt::format("{} has no part '{}'", node.type->name, part));
  }
  const float radius = std::abs(node.get<float>(cone ? "bottomRadius" : "radius"));
  const float height = positive(node.get<float>("height"), radius);
  if (radius == 0) return {};
  const auto make = [&](bool withSide, bool withTop, bool withBottom, size_t material) {
    NodeRef geometry;
    if (cone) {
      auto* made = graph_.make<nodes::Cone>(node);
      made->bottomRadius = radius;
      made->height = height;
      made->side = withSide;
      made->bottom = withBottom;
      geometry = NodeRef(made);
    } else {
      auto* made = graph_.make<nodes::Cylinder>(node);
      made->radius = radius;
      made->height = height;
      made->side = withSide;
      made->top = withTop;
      made->bottom = withBottom;
      geometry = NodeRef(made);
    }
    // Nothing closes a shape that lacks a part, also in other Shapes: its inside is seen, too.
    if (!side || !bottom || !(top || cone)) setIfThere(*geometry, "solid", false);
    return shape(node, looks_.appearance(node, state, material, Use::surface),
                 graph_.finish(geometry));
  };
  if (!side && !top && !bottom) return {};
  const Binding bound = binding(state, Slot::materialBinding, Binding::overall);
  if ((bound != Binding::perPart && bound != Binding::perPartIndexed) ||
      looks_.list(state).count == 1)
    return {make(side, top, bottom, 0)};
  MFNode shapes;
  if (side) shapes.push_back(make(true, false, false, 0));
  if (top) shapes.push_back(make(false, true, false, 1));
  if (bottom) shapes.push_back(make(false, false, true, cone ? 1 : 2));
  return shapes;
}

// PER_PART materials are those of segments, PER_FACE materials those of polylines.
MFNode Shapes::lines(const TreeNode& node, State& state, bool last) {
  MFInt32 coordIndex = last ? node.take<MFInt32>("coordIndex") : node.get<MFInt32>("coordIndex");
  if (faceCount(coordIndex) == 0) return {};
  const Binding bound = binding(state, Slot::materialBinding, Binding::overall);
  auto* set = graph_.make<nodes::IndexedLineSet>(node);
  const NodeRef geometry(set);
  set->coord = coordinates(node, state);
  if (bound != Binding::overall && looks_.list(state).count > 1) {
    if (bound == Binding::perPart || bound == Binding::perPartIndexed) {
      MFInt32 segments; // each segment becomes a polyline
      for (size_t i = 1; i < coordIndex.size(); ++i)
        if (coordIndex[i - 1] >= 0 && coordIndex[i] >= 0)
          segments.insert(segments.end(), {coordIndex[i - 1], coordIndex[i], -1});
      coordIndex = std::move(segments);
    }
    Indices indices = materials(state, coordIndex, node.get<MFInt32>("materialIndex"), bound);
    set->color = looks_.colours(node, state, Use::lines);
    set->colorPerVertex = indices.perCorner;
    set->colorIndex = std::move(indices.values);
  }
  set->coordIndex = std::move(coordIndex);
  return {shape(node, looks_.appearance(node, state, 0, Use::lines), graph_.finish(geometry))};
}

// Each point may have a material, whatever the binding says but OVERALL.
MFNode Shapes::points(const TreeNode& node, State& state) {
  NodeRef coord = coordinates(node, state);
  const auto& all = nodeCast<nodes::Coordinate>(coord)->point;
  const auto begin = static_cast<size_t>(
      std::clamp<int64_t>(node.get<int32_t>("startIndex"), 0, int64_t(all.size())));
  const int32_t wanted = node.get<int32_t>("numPoints");
  const size_t count =
      wanted < 0 ? all.size() - begin : std::min(size_t(wanted), all.size() - begin);
  if (wanted >= 0 && size_t(wanted) > count)
    graph_.warnOnce(node, "points",
                    fmt::format("PointSet wants {} points from {} on, but there are {} in all",
                                wanted, begin, all.size()));
  if (count == 0) return {};
  if (count < all.size()) {
    auto* some = graph_.make<nodes::Coordinate>(node);
    some->point.assign(all.begin() + std::ptrdiff_t(begin),
                       all.begin() + std::ptrdiff_t(begin + count));
    coord = graph_.finish(some);
  }
  auto* set = graph_.make<nodes::PointSet>(node);
  const NodeRef geometry(set);
  set->coord = coord;
  if (binding(state, Slot::materialBinding, Binding::overall) != Binding::overall &&
      looks_.list(state).count > 1) {
    auto* colours = graph_.make<nodes::Color>(node);
    const size_t materials = looks_.list(state).count;
    for (size_t i = 0; i < count; ++i)
      colours->color.push_back(looks_.colour(state, i % materials, Use::lines));
    set->color = graph_.finish(colours);
  }
  return {shape(node, looks_.appearance(node, state, 0, Use::lines), graph_.finish(geometry))};
}

MFNode Shapes::text(const TreeNode& node, State& state) {
  auto* made = graph_.make<nodes::Text>(node);
  const NodeRef geometry(made);
  made->string = node.get<MFString>("string");
  const MFFloat& width = node.get<MFFloat>("width");
  if (std::any_of(width.begin(), width.end(), [](float w) { return w > 0; })) made->length = width;
  made->fontStyle = fontStyle(node, state);
  return {shape(node, looks_.appearance(node, state, 0, Use::surface), graph_.finish(geometry))};
}

NodeRef Shapes::fontStyle(const TreeNode& from, State& state) {
  const TreeNode* font = state.node(Slot::fontStyle);
  if (!font) font = &defaultNode(Kind::fontStyle);
  auto* made = graph_.make<nodes::FontStyle>(from);
  made->size = font->get<float>("size");
  made->spacing = from.get<float>("spacing");
  made->family = {font->get<SFString>("family")};
  const std::string& justification = from.get<SFString>("justification");
  made->justify = {justification == "CENTER"  ? "MIDDLE"
                   : justification == "RIGHT" ? "END"
                                              : "BEGIN"};
  bool bold = false, italic = false;
  for (const std::string& style : font->get<MFString>("style")) {
    bold = bold || style == "BOLD";
    italic = italic || style == "ITALIC";
  }
  made->style = bold && italic ? "BOLDITALIC" : bold ? "BOLD" : italic ? "ITALIC" : "PLAIN";
  return graph_.finish(made);
}

NodeRef Shapes::coordinates(const TreeNode& from, State& state) {
  const TreeNode* node = state.node(Slot::coordinate);
  NodeRef& made = properties_[node];
  if (made) return made;
  auto* coord = graph_.make<nodes::Coordinate>(node ? *node : from);
  coord->point = node ? node->take<MFVec3f>("point") : MFVec3f{{}};
  made = graph_.finish(coord);
  if (node) graph_.name(made, *node);
  return made;
}

// Returns the normals of the state, or null if there are none.
NodeRef Shapes::normals(State& state) {
  const TreeNode* node = state.node(Slot::normal);
  if (!node) return {};
  const auto [found, fresh] = properties_.try_emplace(node);
  if (!fresh) return found->second;
  if (node->get<MFVec3f>("vector").empty()) return {};
  auto* normal = graph_.make<nodes::Normal>(*node);
  normal->vector = node->take<MFVec3f>("vector");
  found->second = graph_.finish(normal);
  graph_.name(found->second, *node);
  return found->second;
}

NodeRef Shapes::textureCoordinates(State& state) {
  const TreeNode* node = state.node(Slot::textureCoordinate);
  if (!node) return {};
  const auto [found, fresh] = properties_.try_emplace(node);
  if (!fresh) return found->second;
  if (node->get<MFVec2f>("point").empty()) return {};
  auto* coordinates = graph_.make<nodes::TextureCoordinate>(*node);
  coordinates->point = node->take<MFVec2f>("point");
  found->second = graph_.finish(coordinates);
  graph_.name(found->second, *node);
  return found->second;
}

// Returns texture coordinates with the transformation applied.
NodeRef Shapes::changed(const TreeNode& from, const TextureChain& chain,
                        const NodeRef& coordinates) {
  NodeRef& made = changed_[{coordinates.get(), &chain}];
  if (made) return made;
  auto* node = graph_.make<nodes::TextureCoordinate>(from);
  for (const Vec2f& point : nodeCast<nodes::TextureCoordinate>(coordinates)->point)
    node->point.push_back(chain.apply(point));
  return made = graph_.finish(node);
}

} // namespace xvrml::vrml1
