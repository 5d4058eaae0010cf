#include "render/walk.h"

#include <stdexcept>

#include <fmt/format.h>

#include "event/hierarchy.h"
#include "geometry/clip_planes.h"
#include "geometry/descend.h"
#include "geometry/edited.h"
#include "geometry/figure.h"
#include "nodes/registry.h"
#include "nodes/visible.h"
#include "render/call.h"

namespace xvrml {
namespace {

const Matrix identity;

// Counts the Shapes of each geometry node.
struct UseCounter : Renderer {
  std::unordered_map<const Node*, uint64_t> uses;
  Visit renderShape(nodes::Shape& /*node*/, const RenderState& /*state*/) override {
    return Visit::draw;
  }
  void draw(const DrawnShape& shape) override { ++uses[&shape.geometry]; }
};

Visit call(Renderer& renderer, Node& node, const RenderState& state) {
  Visit visit = Visit::children;
  const RenderCall own = renderCallOf(node.type());
  return own && own(renderer, node, state, visit) ? visit : callFor(renderer, node, state);
}

} // namespace

RenderWalk::RenderWalk(const World& world, Renderer& renderer, const RenderOptions& options)
    : world_(world), renderer_(renderer), options_(options),
      view_(options.view ? fromArray(options.view) : Matrix()) {}

void RenderWalk::run() {
  for (const NodeRef& root : world_.scope.roots) parts_.push_back(root.get());
  addPlanes(identity);
  const size_t planesOfRoots = planes_.size();
  for (size_t i = parts_.size(); i-- > 0;)
    if (parts_[i]) open_.push_back({NodeRef(parts_[i]), 0});
  for (uint64_t visits = 0; !open_.empty(); ++visits) {
    if (visits == options_.maximumVisits)
      throw std::length_error(
          fmt::format("the world has more than {} nodes where they are drawn", visits));
    const Open next = std::move(open_.back());
    open_.pop_back();
    leaveDownTo(next.depth);
    planes_.resize(levels_.empty() ? planesOfRoots : levels_.back().planesBelow);
    visit(next.node);
  }
  leaveDownTo(0);
}

void RenderWalk::visit(const NodeRef& node) {
  // A program may have made a node that contains itself; it is skipped.
  if (!isVisible(*node) || above_.contains(node.get())) return;
  if (!node->live && deforms(node->type())) deform(*node, nullptr);
  Level level;
  level.node = node;
  level.planesAt = level.planesBelow = planes_.size();
  level.isSingular =
      !innerMatrix(*node, outside(levels_.size()), view_, level.inner, &level.local) ||
      !finite(level.inner);
  path_.push_back(node.get());
  const RenderState state = stateOf(level);
  const Visit answer = call(renderer_, *node, state);
  if (answer != Visit::skip)
    if (auto* shape = nodeCast<nodes::Shape>(node))
      if (const NodeRef geometry(renderedNode(shape->geometry.get())); geometry)
        renderer_.draw(DrawnShape(*shape, *geometry, state, *this));
  if (answer == Visit::children)
    enter(std::move(level));
  else
    path_.pop_back();
}

// Goes into the children of the visited node.
void RenderWalk::enter(Level&& entered) {
  Level& level = levels_.emplace_back(std::move(entered));
  above_.insert(level.node.get(), {});
  if (level.isSingular) return;
  parts_.clear();
  appendParts(*level.node, outside(levels_.size() - 1));
  addPlanes(level.inner);
  level.planesBelow = planes_.size();
  for (size_t i = parts_.size(); i-- > 0;)
    if (parts_[i]) open_.push_back({NodeRef(parts_[i]), levels_.size()});
}

void RenderWalk::leaveDownTo(size_t depth) {
  while (levels_.size() > depth) {
    const Level level = std::move(levels_.back());
    levels_.pop_back();
    renderer_.leave(*level.node, stateOf(level));
    above_.erase(level.node.get());
    path_.pop_back();
  }
}

// Returns the state of the last node of path_, which is below all of `levels_`.
RenderState RenderWalk::stateOf(const Level& level) const {
  return {world_,
          path_,
          data(outside(levels_.size())),
          data(level.local),
          level.isSingular ? nullptr : data(level.inner),
          std::span(planes_).first(level.planesAt)};
}

// Returns the matrix from a node below so many levels to the world.
const Matrix& RenderWalk::outside(size_t depth) const {
  return depth == 0 ? identity : levels_[depth - 1].inner;
}

// Appends the children that are visited.
void RenderWalk::appendParts(Node& node, const Matrix& toWorld) {
  const auto* lod = nodeCast<nodes::LOD>(&node);
  const auto* choice = nodeCast<nodes::Switch>(&node);
  if (lod && !options_.allChoices) {
    const size_t level = options_.finestLevels ? 0 : levelFor(*lod, toWorld, view_);
    if (level < lod->level.size()) parts_.push_back(lod->level[level].get());
  } else if (choice && !options_.allChoices) {
    parts_.push_back(chosenChild(*choice));
  } else if (const auto* collision = nodeCast<nodes::Collision>(&node)) {
    for (const NodeRef& child : collision->children) parts_.push_back(child.get());
  } else if (const auto* layer = nodeCast<nodes::CADLayer>(&node)) {
    appendShownChildren(*layer, parts_);
  } else {
    childrenInScene(node, parts_);
  }
}

// Appends what the ClipPlanes among parts_ leave. toWorld: the matrix of these nodes.
void RenderWalk::addPlanes(const Matrix& toWorld) {
  size_t planes = planes_.size();
  HalfSpaces left;
  forEachHalfSpace(parts_, planes, [&](const HalfSpace& one) { left.push_back(one); });
  Matrix toLocal;
  if (left.empty() || !invert(toWorld, toLocal)) return;
  for (const HalfSpace& one : left) {
    const HalfSpace kept = inside(one, toLocal);
    planes_.push_back({kept.normal.x, kept.normal.y, kept.normal.z, kept.offset});
  }
}

uint64_t RenderWalk::usesOf(const Node& geometry) {
  if (!uses_) {
    UseCounter counter;
    RenderWalk(world_, counter, options_).run(); // the world stays as it was when this walk began
    uses_ = std::move(counter.uses);
  }
  return (*uses_)[&geometry];
}

void render(const World& world, Renderer& renderer, const RenderOptions& options) {
  followEdits(world);
  RenderWalk(world, renderer, options).run();
}

} // namespace xvrml
