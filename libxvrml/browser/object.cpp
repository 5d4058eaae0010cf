// object.cpp: the Browser object of Scripts and programs (ISO/IEC 14772-1 4.12.10): its properties,
// loading, and the replacement of one world by another. [the browser's thread]
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "behaviour/viewer/interaction.h"
#include "browser/state.h"
#include "graph/field_access.h"
#include "parse/loader.h"
#include "xvrml/versions.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

std::vector<NodeRef> breakCycles(const std::vector<NodeRef>& cyclic) {
  std::vector<NodeRef> kept;
  for (const NodeRef& node : cyclic) {
    if (node->live) {
      kept.push_back(node);
      continue;
    }
    for (const FieldInfo& field : node->type().fields)
      if (holdsNodes(field))
        visitStorage(field.type, node->storage(field), [](auto& value) { value = {}; });
  }
  return kept;
}

// Returns the version that a header of ClassicVRML or VRML97 states; none: there is no header.
std::optional<FileVersion> versionOfHeader(std::string_view text) {
  constexpr std::string_view x3d = "#X3D V", vrml = "#VRML V2.0";
  if (text.starts_with(vrml)) return FileVersion();
  if (!text.starts_with(x3d) || text.size() < x3d.size() + 3) return {};
  const char major = text[x3d.size()], minor = text[x3d.size() + 2];
  if ((major != '3' && major != '4') || text[x3d.size() + 1] != '.' || minor < '0' || minor > '9')
    return {};
  FileVersion version{Encoding::x3dClassic, 3, 3};
  version.major = decltype(version.major)(major - '0');
  version.minor = decltype(version.minor)(minor - '0');
  return version;
}

// Returns the version that a text follows: that of its header, if it has one. caller: that of the
// file that gives it. An element of XML and an object of JSON stand for themselves; files in XML
// and JSON may also give ClassicVRML.
FileVersion versionOfText(std::string_view text, const FileVersion& caller,
                          const FileVersion& world) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  const char begin = first == text.npos ? ' ' : text[first];
  if (const auto stated = versionOfHeader(text.substr(std::min(first, text.size()))))
    return *stated;
  const FileVersion& known = caller.isX3d() ? caller : world;
  for (const auto& [mark, encoding] :
       {std::pair('<', Encoding::x3dXml), std::pair('{', Encoding::x3dJson)})
    if (begin == mark)
      return known.isX3d() ? FileVersion{encoding, known.major, known.minor}
                           : FileVersion{encoding, 3, 3};
  if (caller.encoding == Encoding::x3dXml || caller.encoding == Encoding::x3dJson)
    return {Encoding::x3dClassic, caller.major, caller.minor};
  return caller;
}

void append(Diagnostics& to, const Diagnostics& from) {
  for (const Diagnostic& d : from.list()) to.add(d);
}

// A call of the Browser object that loads the first of some URLs that is a world.
struct LoadCall {
  std::string_view function; // as ISO/IEC 14772-1 spells it
  std::vector<std::string> urls;
  std::string base;     // the URLs are relative to it
  SourcePosition where; // the calling Script; of other programs the running world
  uint64_t depth;       // depthOfMade()
};

struct LoadedUrl {
  std::unique_ptr<World> world; // null: no URL is a world
  std::string fragment;
};

// Loads the world that a program in the world `caller` asks for. The caller gets a warning if no
// URL is a world. budget: of the world that the result joins; null: the result has its own budget.
LoadedUrl loadFirst(const LoadCall& call, World& caller, const BudgetPtr& budget) {
  std::string reasons;
  for (const std::string& url : call.urls) {
    const ResolvedUrl resolved = resolveUrl(url, call.base, caller.options);
    std::string reason = resolved.error;
    if (reason.empty()) {
      try {
        return {budget ? loadWorldInto(budget, resolved.path, caller.options, call.depth)
                       : loadWorld(resolved.path, caller.options),
                resolved.fragment};
      } catch (const LoadError& error) { reason = error.diagnostic.text(); }
    }
    if (reasons.size() < 400) reasons += (reasons.empty() ? "" : "; ") + reason;
  }
  caller.diagnostics.warn(call.where, fmt::format("{}: {}", call.function,
                                                  reasons.empty() ? "it names no URL" : reasons));
  return {};
}

// Charges nodes made by programs to the budget only while they are made. Counting them longer would
// stop a world that makes and drops nodes for hours. The number of live nodes limits them (limit
// expandedNodes).
class TemporaryCharge {
 public:
  explicit TemporaryCharge(const World& world)
      : budget_(budgetOf(world)), before_(budget_->used()) {}
  ~TemporaryCharge() {
    if (const uint64_t now = budget_->used(); now > before_) budget_->give(now - before_);
  }
  const BudgetPtr& budget() const { return budget_; }

 private:
  BudgetPtr budget_;
  uint64_t before_;
};

// Tells the Scripts of an instance how many Scripts made one another before them. Their file is
// that of the prototype, and its depth does not grow.
void markMakers(const Scope& made, uint32_t makers) {
  walk<Node>(rootsOf(made), [makers](Node& node, std::vector<Node*>& open) {
    if (auto* script = nodeCast<ScriptNode>(&node)) script->makers = makers;
    if (auto* instance = nodeCast<ProtoInstance>(&node)) {
      appendRoots(instance->body, open);
      for (const Route& route : instance->body.routes)
        open.insert(open.end(), {route.from.get(), route.to.get()});
    }
    appendChildren(node, open);
  });
}

} // namespace

Browser::Impl::Impl(Browser& browser, std::unique_ptr<World> world, const BrowserOptions& options,
                    const RunOptions& run)
    : options(options), run(run), world(std::move(world)),
      engine(std::make_unique<Engine>(this->world->diagnostics, makeInteraction, &browser)) {
  engine->maximumEvents = options.maximumEvents;
  if (!options.runScripts) return;
  scripts = std::make_unique<ScriptHost>(browser, *engine, *this->world, this->options, this->run);
  engine->scripts = scripts.get();
}

void Browser::Impl::addJob(std::function<void()> job) {
  constexpr size_t most = 10'000;
  if (jobs.size() >= most) throw std::runtime_error("too many worlds are waiting to be loaded");
  jobs.push_back(std::move(job));
  runJobs();
}

void Browser::Impl::runJobs() {
  if (working || engine->settling()) return;
  working = true;
  const struct Idle {
    bool& working;
    ~Idle() { working = false; } // also if a job throws
  } idle{working};
  for (int done = 0; done < 100 && !jobs.empty(); ++done) {
    const uint64_t before = generation;
    const std::function<void()> job = std::move(jobs.front());
    jobs.pop_front();
    job();
    if (generation != before) break; // at most one new world per call
  }
}

SourcePosition Browser::Impl::callerPosition() const {
  const Node* script = scripts ? scripts->runningNode() : nullptr;
  return script ? script->source
                : SourcePosition{std::make_shared<const std::string>(world->path), 0, 0};
}

uint64_t Browser::Impl::depthOfMade() const {
  const auto* script = nodeCast<ScriptNode>(scripts ? scripts->runningNode() : nullptr);
  return script ? std::max<uint64_t>(fileDepth(script->source.file), script->makers) + 1 : 1;
}

MFNode Browser::Impl::adopt(World& loaded) {
  append(world->diagnostics, loaded.diagnostics);
  world->cyclic.insert(world->cyclic.end(), loaded.cyclic.begin(), loaded.cyclic.end());
  world->nodeCount += loaded.nodeCount;
  loaded.cyclic.clear();
  MFNode nodes;
  for (const NodeRef& root : loaded.scope.roots)
    if (root) nodes.push_back(root);
  engine->adoptScope(loaded.scope, false);
  return nodes;
}

void Browser::Impl::replaceScene(Scope scope, const std::vector<NodeRef>& kept,
                                 std::vector<NodeRef> cyclic) {
  engine->keepOnly(kept);
  for (NodeRef& node : breakCycles(world->cyclic)) cyclic.push_back(std::move(node));
  world->cyclic = std::move(cyclic);
  world->scope = std::move(scope);
  ++generation;
  engine->beginCascade(engine->now());
  engine->adoptScope(world->scope, true);
  engine->settle();
  engine->takeChanges(); // a renderer starts with the current state of the new world
}

std::string Browser::name() const { return "OpenRT XVRML"; }
std::string Browser::version() const { return XVRML_VERSION; }
double Browser::currentSpeed() const { return interactionOf(*impl_->engine).viewer.speed(); }
double Browser::currentFrameRate() const { return impl_->frameRate; }
void Browser::setFrameRate(double framesPerSecond) { impl_->frameRate = framesPerSecond; }
std::string Browser::worldUrl() const { return impl_->world->path; }
void Browser::setDescription(std::string text) { impl_->description = std::move(text); }
std::string Browser::description() const { return impl_->description; }

MFNode Browser::Impl::create(std::string_view text, const std::string& base,
                             std::span<const ProtoPtr> prototypes) {
  constexpr std::string_view suffix = " (createVrmlFromString)";
  std::string name = base.empty() ? world->path : base;
  if (!name.ends_with(suffix)) name += suffix;
  LoadOptions loading = world->options;
  uint64_t& most = loading.limits.expandedNodes;
  most -= std::min<uint64_t>(most, engine->nodes());
  const uint64_t depth = depthOfMade();
  const SourcePosition caller = callerPosition();
  const FileVersion& own = world->head.version;
  const FileVersion version =
      versionOfText(text, caller.file ? fileVersion(caller.file) : own, own);
  const auto loaded = loadFragment(text, name, loading, TemporaryCharge(*world).budget(), depth,
                                   {version, prototypes});
  if (!prototypes.empty()) markMakers(loaded->scope, uint32_t(depth));
  MFNode nodes = adopt(*loaded);
  settle();
  return nodes;
}

MFNode Browser::createVrmlFromString(std::string_view text, const std::string& base) {
  return impl_->create(text, base, {});
}

NodeRef Browser::createInstance(const ProtoPtr& prototype, const std::string& base) {
  const MFNode made = impl_->create(prototype->type->name + " { }", base, {&prototype, 1});
  return made.empty() ? NodeRef() : made[0];
}

void Browser::createVrmlFromUrl(const std::vector<std::string>& urls, Node& node,
                                std::string_view eventIn, const std::string& base) {
  LoadCall call{"createVrmlFromURL", urls, base.empty() ? impl_->world->path : base,
                impl_->callerPosition(), impl_->depthOfMade()};
  impl_->addJob([this, call = std::move(call), to = NodeRef(&node),
                 in = std::string(ownName(node, eventIn))] {
    World& world = *impl_->world;
    const LoadedUrl loaded = loadFirst(call, world, TemporaryCharge(world).budget());
    if (!loaded.world || !to->live) return;
    MFNode nodes = impl_->adopt(*loaded.world);
    impl_->engine->dispatch(*to, in, std::move(nodes));
  });
}

void Browser::loadUrl(const std::vector<std::string>& urls,
                      const std::vector<std::string>& parameters, const std::string& base) {
  LoadCall call{"loadURL", urls, base.empty() ? impl_->world->path : base, impl_->callerPosition(),
                impl_->depthOfMade()};
  impl_->addJob([this, call = std::move(call), parameters] {
    if (impl_->options.loadUrl && impl_->options.loadUrl(call.urls, parameters, call.base)) return;
    const auto bind = [&](const std::string& name) {
      const NodeRef view = node(name);
      if (!view || !impl_->engine->dispatch(*view, "set_bind", true))
        impl_->world->diagnostics.warn(
            call.where, fmt::format("loadURL: there is no viewpoint '{}'", name.substr(0, 100)));
    };
    World& world = *impl_->world;
    if (!call.urls.empty() && call.urls[0].starts_with('#')) return bind(call.urls[0].substr(1));
    const auto [loaded, fragment] = loadFirst(call, world, nullptr);
    if (!loaded) return;
    append(world.diagnostics, loaded->diagnostics);
    setBudget(world, budgetOf(*loaded));
    world.path = loaded->path;
    world.times = loaded->times;
    world.nodeCount = loaded->nodeCount;
    impl_->replaceScene(std::move(loaded->scope), {}, std::exchange(loaded->cyclic, {}));
    if (!fragment.empty()) bind(fragment);
  });
}

void Browser::replaceWorld(const MFNode& nodes) {
  impl_->addJob([this, nodes] {
    Scope scope;
    for (const NodeRef& node : nodes)
      if (node) scope.roots.push_back(node);
    const std::vector<NodeRef> kept = scope.roots;
    setBudget(*impl_->world, std::make_shared<Budget>(impl_->world->options.limits.worldBytes));
    impl_->replaceScene(std::move(scope), kept, {});
  });
}

} // namespace xvrml
