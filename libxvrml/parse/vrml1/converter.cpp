// converter.cpp: the traversal of groups, properties and shapes ("Nodes" of the specification).
#include "parse/vrml1/converter.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "graph/inline_node.h"

namespace xvrml::vrml1 {
namespace {

// Returns whether a node is of no effect on the state and can be shared: it stands for itself.
bool standsAlone(Kind kind) {
  switch (kind) {
  case Kind::asciiText:
  case Kind::cone:
  case Kind::cube:
  case Kind::cylinder:
  case Kind::indexedFaceSet:
  case Kind::indexedLineSet:
  case Kind::lod:
  case Kind::orthographicCamera:
  case Kind::perspectiveCamera:
  case Kind::pointSet:
  case Kind::separator:
  case Kind::sphere:
  case Kind::wwwAnchor:
  case Kind::wwwInline: return true;
  default: return false;
  }
}

} // namespace

size_t Converter::KeyHash::operator()(const Key& key) const {
  size_t hash = std::hash<const void*>()(key.node) ^ key.mask;
  for (const void* value : key.values)
    hash = hash * 1099511628211u + std::hash<const void*>()(value);
  return hash;
}

MFNode Converter::convert(const Tree& tree) {
  Group top(graph_);
  for (const TreeNode* root : tree.roots) traverse(*root, top);
  return top.finish();
}

void Converter::traverseChildren(const TreeNode& node, Group& group) {
  for (const TreeNode* child : node.children) traverse(*child, group);
}

void Converter::traverse(const TreeNode& node, Group& group) {
  if (graph_.isStopped()) return;
  graph_.visit(node);
  if (depth_ >= nesting_)
    return graph_.stop(node, fmt::format("nodes nested deeper than limit nesting={}, shared ones "
                                         "counted at each USE",
                                         nesting_));
  ++depth_;
  sharing_ += node.shared;
  if (standsAlone(node.kind)) {
    group.add(converted(node), node);
  } else {
    switch (node.kind) {
    case Kind::group: traverseChildren(node, group); break;
    case Kind::switchNode: traverseSwitch(node, group); break;
    case Kind::transformSeparator: traverseTransformSeparator(node, group); break;
    case Kind::directionalLight:
    case Kind::pointLight:
    case Kind::spotLight: group.addLight(convertLight(graph_, node, group.placement), node); break;
    case Kind::info: info(node, group); break;
    case Kind::vrml97:
      graph_.name(node.vrml97, node);
      group.add(graph_.finish(node.vrml97), node);
      break;
    case Kind::unknown: break;
    default: setProperty(node, group);
    }
  }
  sharing_ -= node.shared;
  --depth_;
}

// Properties replace the state. Transformations add to the placement.
void Converter::setProperty(const TreeNode& node, Group& group) {
  switch (node.kind) {
  case Kind::coordinate3: return state_.set(Slot::coordinate, &node);
  case Kind::fontStyle: return state_.set(Slot::fontStyle, &node);
  case Kind::material: return state_.set(Slot::material, &node);
  case Kind::materialBinding: return state_.set(Slot::materialBinding, &node);
  case Kind::normal: return state_.set(Slot::normal, &node);
  case Kind::normalBinding: return state_.set(Slot::normalBinding, &node);
  case Kind::shapeHints: return state_.set(Slot::shapeHints, &node);
  case Kind::texture2: return state_.set(Slot::texture, &node);
  case Kind::texture2Transform: return looks_.addTransform(state_, node);
  case Kind::textureCoordinate2: return state_.set(Slot::textureCoordinate, &node);
  default: break;
  }
  if (group.placement.add(node)) return;
  graph_.warnOnce(node, "matrix",
                  node.kind == Kind::matrixTransform
                      ? "the perspective part of this matrix is left out: VRML97 cannot say it"
                      : "this transformation leads beyond the range of numbers; it is left out");
}

// A Switch of cameras is the list of views of many files, whatever it chooses: the first child is
// the chosen one. -3 is Open Inventor's number for all children.
void Converter::traverseSwitch(const TreeNode& node, Group& group) {
  const int32_t which = node.get<int32_t>("whichChild");
  const auto count = static_cast<int64_t>(node.children.size());
  const bool chosen = which >= 0 && which < count;
  const bool cameras = count > 0 && std::all_of(node.children.begin(), node.children.end(),
                                                [](const TreeNode* c) { return isCamera(*c); });
  if (chosen) traverse(*node.children[size_t(which)], group);
  if (!cameras && which != -3) return;
  for (int64_t i = 0; i < count; ++i)
    if (!chosen || i != which) traverse(*node.children[size_t(i)], group);
}

void Converter::traverseTransformSeparator(const TreeNode& node, Group& group) {
  const Placement before = group.placement;
  traverseChildren(node, group);
  group.placement = before;
}

// Two names of Infos are conventions of SGI's browsers: BackgroundColor, and Viewer for the way to
// navigate. Others are information for people.
void Converter::info(const TreeNode& node, Group& group) {
  const std::string& text = node.get<SFString>("string");
  const auto has = [&](std::string_view word) { return text.find(word) != text.npos; };
  SFColor colour;
  if (node.name == "BackgroundColor" &&
      std::sscanf(text.c_str(), "%f %f %f", &colour.r, &colour.g, &colour.b) == 3) {
    auto* background = graph_.make<nodes::Background>(node);
    background->skyColor = {colour};
    return group.add(graph_.finish(background), node);
  }
  if (node.name == "Viewer" && (has("walk") || has("xamin") || has("fly"))) {
    auto* navigation = graph_.make<nodes::NavigationInfo>(node);
    navigation->type = {has("walk") ? "WALK" : has("fly") ? "FLY" : "EXAMINE", "ANY"};
    return group.add(graph_.finish(navigation), node);
  }
  auto* information = graph_.make<nodes::WorldInfo>(node);
  if (node.name == "Title" || node.name == "title")
    information->title = text;
  else
    information->info = {text};
  const NodeRef made = graph_.finish(information);
  graph_.name(made, node);
  group.add(made, node);
}

// Returns what a node becomes in the present state. A node that may be met again is converted once
// for each state that it depends on.
NodeRef Converter::converted(const TreeNode& node) {
  if (sharing_ == 0) return convertAlone(node);
  const auto keyFor = [&](uint32_t mask) {
    Key key{&node, mask, {}};
    for (size_t slot = 0; slot < slotCount; ++slot)
      if (mask >> slot & 1) key.values[slot] = state_.values()[slot];
    return key;
  };
  for (const uint32_t mask : masks_[&node]) {
    const auto found = results_.find(keyFor(mask));
    if (found == results_.end()) continue;
    state_.noteRead(mask);
    return found->second;
  }
  const State::Record outer = state_.begin();
  const NodeRef made = convertAlone(node);
  const uint32_t mask = state_.end(outer);
  // These nodes leave the state as it was, so the key is that of the beginning.
  std::vector<uint32_t>& masks = masks_[&node];
  if (std::find(masks.begin(), masks.end(), mask) == masks.end()) masks.push_back(mask);
  results_.emplace(keyFor(mask), made);
  return made;
}

NodeRef Converter::convertAlone(const TreeNode& node) {
  NodeRef made;
  switch (node.kind) {
  case Kind::separator: made = separator(node); break;
  case Kind::wwwAnchor: made = anchor(node); break;
  case Kind::lod: made = lod(node); break;
  case Kind::wwwInline: made = inlined(node); break;
  case Kind::perspectiveCamera:
  case Kind::orthographicCamera: made = convertCamera(graph_, node); break;
  default: made = grouped(node, true, shapes_.make(node, state_, sharing_ == 0));
  }
  if (made) graph_.name(made, node);
  return made;
}

// Returns one node for all children: null, the only child, or a Group. named: it will get the name
// of `node`, so that it must not have one yet.
NodeRef Converter::grouped(const TreeNode& node, bool named, MFNode children) {
  if (children.empty()) return {};
  const bool hasName = named && !node.name.empty();
  if (children.size() == 1 && (!hasName || children[0]->defName.empty())) return children[0];
  auto* group = graph_.make<nodes::Group>(node);
  group->children = std::move(children);
  return graph_.finish(group);
}

NodeRef Converter::separator(const TreeNode& node) {
  const State::Saved before = state_.save();
  Group group(graph_);
  traverseChildren(node, group);
  state_.restore(before);
  return grouped(node, true, group.finish());
}

NodeRef Converter::anchor(const TreeNode& node) {
  const State::Saved before = state_.save();
  Group group(graph_);
  traverseChildren(node, group);
  state_.restore(before);
  auto* made = graph_.make<nodes::Anchor>(node);
  made->children = group.finish();
  if (const std::string& name = node.get<SFString>("name"); !name.empty()) made->url = {name};
  made->description = node.get<SFString>("description");
  if (node.get<SFString>("map") == "POINT")
    graph_.warnOnce(node, "map",
                    "WWWAnchor.map POINT is not supported: the URL gets no coordinates");
  return graph_.finish(made);
}

// Each child begins in the same state, because only one of them is drawn. It is one level.
NodeRef Converter::lod(const TreeNode& node) {
  const State::Saved before = state_.save();
  auto* made = graph_.make<nodes::LOD>(node);
  const NodeRef result(made);
  made->center = node.get<Vec3f>("center");
  made->range = node.get<MFFloat>("range");
  for (const TreeNode* child : node.children) {
    Group group(graph_);
    traverse(*child, group);
    state_.restore(before);
    NodeRef level = grouped(*child, false, group.finish());
    if (!level) level = graph_.finish(graph_.make<nodes::Group>(*child)); // draws nothing here
    made->level.push_back(level);
  }
  return graph_.finish(result);
}

NodeRef Converter::inlined(const TreeNode& node) {
  const std::string& name = node.get<SFString>("name");
  if (name.empty()) return {};
  auto* made = graph_.make<InlineNode>(node);
  made->url = {name};
  const Vec3f size = node.get<Vec3f>("bboxSize");
  if (size != Vec3f()) { // zeros say that the file does not tell
    made->bboxSize = size;
    made->bboxCenter = node.get<Vec3f>("bboxCenter");
  }
  const NodeRef result = graph_.finish(made);
  graph_.addInline(result);
  return result;
}

} // namespace xvrml::vrml1
