#include "edit/live_world.h"

#include <algorithm>

#include "base/budget.h"
#include "parse/loader.h"
#include "xvrml/set_field.h"

namespace xvrml {
namespace {

class RunningWorld : public LiveWorld {
 public:
  explicit RunningWorld(Browser& browser) : browser_(browser) {}
  World& world() override { return browser_.world(); }
  bool set(Node& node, std::string_view field, Value value) override {
    return browser_.set(node, field, std::move(value));
  }
  MFNode read(const std::string& text, const std::string& name) override {
    return browser_.createVrmlFromString(text, name);
  }
  void addRoot(const NodeRef& node, size_t index) override {
    MFNode& roots = world().scope.roots;
    const size_t before = roots.size();
    browser_.addRoot(node);
    if (roots.size() > before && index < before) // the browser appends
      std::rotate(roots.begin() + std::ptrdiff_t(index), roots.end() - 1, roots.end());
  }
  void removeRoot(Node& node) override { browser_.removeRoot(node); }
  bool addRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    return browser_.addRoute(from, out, to, in);
  }
  void removeRoute(Node& from, const std::string& out, Node& to, const std::string& in) override {
    browser_.deleteRoute(from, out, to, in);
  }
  std::string placeName(const std::string& name) const override {
    return name + " (createVrmlFromString)";
  }

 private:
  Browser& browser_;
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
        loadFragment(text, name, world_.options, budgetOf(world_), 0, world_.head.version);
    world_.nodeCount += made->nodeCount;
    world_.cyclic.insert(world_.cyclic.end(), made->cyclic.begin(), made->cyclic.end());
    made->cyclic.clear();
    return made->scope.roots;
  }
  void addRoot(const NodeRef& node, size_t index) override {
    MFNode& roots = world_.scope.roots;
    roots.insert(roots.begin() + std::ptrdiff_t(std::min(index, roots.size())), node);
  }
  void removeRoot(Node& node) override { std::erase(world_.scope.roots, NodeRef(&node)); }
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
