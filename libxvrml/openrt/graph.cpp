// graph.cpp: builds the render graph: a walk over the scene graph with a stack of its own, one item a node.
#include "openrt/graph.h"

#include "openrt/appearance.h"
#include "xvrml/nodes.h"

namespace xvrml::mapping {
namespace {

class Builder {
 public:
  Builder(Graph& graph, World& world) : graph_(graph), context_{world} {}

  void build() {
    graph_.items.emplace_back();
    graph_.names.emplace_back();
    Frame root;
    root.plan.kind = Kind::group;
    root.plan.add(context_.world.scope.roots);
    stack_.push_back(std::move(root));
    while (!stack_.empty()) step();
    graph_.root = result_;
  }

 private:
  struct Frame {
    Node* node = nullptr;    // rendered
    Node* written = nullptr; // as the file has it: a prototype instance or the node itself
    Plan plan;
    size_t next = 0;
    std::vector<ItemId> done;
  };
  static constexpr ItemId inProgress = ~ItemId(0);

  // Looks at the next child of the topmost node, or closes it.
  void step() {
    Frame& frame = stack_.back();
    if (frame.next == frame.plan.children.size()) return close();
    Node* written = frame.plan.children[frame.next++];
    Node* node = renderedNode(written);
    const PlanFunction plan = node ? planOf(node->type()) : nullptr;
    if (!plan) return deliver(frame, 0);
    const auto [known, fresh] = made_.try_emplace(node, inProgress);
    if (!fresh) {
      if (known->second == inProgress) {
        context_.world.diagnostics.warn(node->source, "a " + node->type().name + " node that contains itself is drawn once");
        return deliver(frame, 0);
      }
      return deliver(frame, known->second);
    }
    Frame child{node, written, {}, 0, {}};
    plan(context_, *node, child.plan);
    stack_.push_back(std::move(child));
  }

  static void deliver(Frame& frame, ItemId item) {
    if (item != 0 || frame.plan.keepEmpty) frame.done.push_back(item);
  }

  void close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    const ItemId id = worthKeeping(frame) ? makeItem(frame) : 0;
    if (frame.node) made_[frame.node] = id;
    if (stack_.empty())
      result_ = id;
    else
      deliver(stack_.back(), id);
  }

  static bool worthKeeping(const Frame& frame) {
    if (frame.plan.kind == Kind::none) return false;
    const bool grouping = frame.plan.kind == Kind::group || frame.plan.kind == Kind::billboard || frame.plan.kind == Kind::lod;
    return !frame.node || !grouping || !frame.done.empty();
  }

  ItemId makeItem(const Frame& frame) {
    Item item;
    item.node = frame.node;
    item.kind = frame.plan.kind;
    item.isInline = frame.plan.isInline;
    if (frame.plan.moves) {
      item.matrix = int32_t(graph_.matrices.size());
      graph_.matrices.push_back(frame.plan.matrix);
    }
    item.firstChild = uint32_t(graph_.children.size());
    item.childCount = uint32_t(frame.done.size());
    graph_.children.insert(graph_.children.end(), frame.done.begin(), frame.done.end());
    if (frame.node) item.name = graph_.nameId(frame.node->defName.empty() ? frame.written->defName : frame.node->defName);
    if (auto* shape = nodeCast<nodes::Shape>(frame.node))
      item.mesh = graph_.meshes.add(*renderedNode(shape->geometry.get()), isTextured(shape->appearance.get()));
    graph_.items.push_back(item);
    return ItemId(graph_.items.size() - 1);
  }

  Graph& graph_;
  PlanContext context_;
  std::vector<Frame> stack_;
  std::unordered_map<const Node*, ItemId> made_;
  ItemId result_ = 0;
};

} // namespace

Graph::Graph(World& world) : meshes(world) { Builder(*this, world).build(); }

uint32_t Graph::nameId(const std::string& name) {
  if (name.empty()) return 0;
  const auto [it, fresh] = nameIds_.try_emplace(name, uint32_t(names.size()));
  if (fresh) names.push_back(name);
  return it->second;
}

} // namespace xvrml::mapping
