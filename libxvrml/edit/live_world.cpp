#include "edit/live_world.h"

#include <algorithm>

#include "base/budget.h"
#include "parse/loader.h"
#include "xvrml/set_field.h"

namespace xvrml {
namespace {

// Takes one of several equal roots out. Returns false if the node is no root, or the only one.
bool removeOneOf(MFNode& roots, const NodeRef& node, size_t index) {
  if (std::count(roots.begin(), roots.end(), node) < 2) return false;
  if (index >= roots.size() || roots[index] != node)
    index = size_t(std::find(roots.begin(), roots.end(), node) - roots.begin());
  roots.erase(roots.begin() + std::ptrdiff_t(index));
  return true;
}

void insertRoot(MFNode& roots, const NodeRef& node, size_t index) {
  roots.insert(roots.begin() + std::ptrdiff_t(std::min(index, roots.size())), node);
}

class RunningWorld : public LiveWorld {
 public:
  explicit RunningWorld(Browser& browser) : browser_(browser) {}
  World& world() override { return browser_.world(); }
  bool set(Node& node, std::string_view field, Value value) override {
    if (isReplaced()) return true;
    // An event that a node ignores counts as sent.
    const FieldInfo& info = *node.type().find(field);
    const Value before = node.get(info);
    const bool changes = before != value;
    return browser_.set(node, field, std::move(value)) && (!changes || node.get(info) != before);
  }
  MFNode read(const std::string& text, const std::string& name) override {
    return browser_.createVrmlFromString(text, name);
  }
  void addRoot(const NodeRef& node, size_t index) override {
    if (isReplaced()) return;
    MFNode& roots = world().scope.roots;
    if (std::find(roots.begin(), roots.end(), node) == roots.end()) {
      browser_.addRoot(node); // appends it
      if (isReplaced()) return;
      std::erase(roots, node);
    }
    insertRoot(roots, node, index);
  }
  void removeRoot(Node& node, size_t index) override {
    if (isReplaced()) return;
    if (!removeOneOf(world().scope.roots, NodeRef(&node), index)) browser_.removeRoot(node);
  }
  bool isReplaced() const override { return browser_.generation() != generation_; }
  bool addRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    return isReplaced() || browser_.addRoute(from, out, to, in);
  }
  void removeRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    if (!isReplaced()) browser_.deleteRoute(from, out, to, in);
  }
  std::string placeName(const std::string& name) const override {
    return name + " (createVrmlFromString)";
  }

 private:
  Browser& browser_;
  const uint64_t generation_ = browser_.generation();
};

class RestingWorld : public LiveWorld {
 public:
  explicit RestingWorld(World& world) : world_(world) {}
  World& world() override { return world_; }
  bool set(Node& node, std::string_view field, Value value) override {
    return setField(world_, node, field, std::move(value));
  }
  MFNode read(const std::string& text, const std::string& name) override {
    std::unique_ptr<World> made =
        loadFragment(text, name, world_.options, budgetOf(world_), 0, {world_.head.version});
    world_.nodeCount += made->nodeCount;
    world_.cyclic.insert(world_.cyclic.end(), made->cyclic.begin(), made->cyclic.end());
    made->cyclic.clear();
    return made->scope.roots;
  }
  void addRoot(const NodeRef& node, size_t index) override {
    insertRoot(world_.scope.roots, node, index);
    world_.edited = true;
  }
  void removeRoot(Node& node, size_t index) override {
    world_.edited = true;
    if (!removeOneOf(world_.scope.roots, NodeRef(&node), index))
      std::erase(world_.scope.roots, NodeRef(&node));
  }
  bool addRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    world_.scope.routes.push_back({NodeRef(&from), out, NodeRef(&to), in, {}});
    return true;
  }
  void removeRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    std::erase_if(world_.scope.routes, [&](const Route& route) {
      return route.from.get() == &from && route.fromField == out && route.to.get() == &to &&
             route.toField == in;
    });
  }
  std::string placeName(const std::string& name) const override { return name; }

 private:
  World& world_;
};

} // namespace

std::unique_ptr<LiveWorld> makeLiveWorld(Browser& browser) {
  return std::make_unique<RunningWorld>(browser);
}
std::unique_ptr<LiveWorld> makeLiveWorld(World& world) {
  return std::make_unique<RestingWorld>(world);
}

} // namespace xvrml
