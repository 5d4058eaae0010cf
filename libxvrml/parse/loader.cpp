// loader.cpp: loads Inlines and EXTERNPROTOs, and limits the size of the whole world.
#include "parse/loader.h"

#include <filesystem>
#include <new>

#include <fmt/format.h>

#include "enough_stack.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "parse/builder.h"
#include "parse/encodings.h"
#include "parse/parser.h"
#include "parse/urn.h"

namespace xvrml {
namespace {

std::string canonical(const std::string& path) {
  std::error_code error;
  const auto result = std::filesystem::weakly_canonical(path, error);
  return error ? path : result.string();
}

void addReason(std::string& reasons, const std::string& reason) {
  if (reasons.size() > 400) return; // a list of URLs can be long
  if (!reasons.empty()) reasons += "; ";
  reasons += reason;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Loader::Loader(World& world, const LoadOptions& options, uint64_t depth)
    : world_(world), depth_(depth),
      budget_(budgetOf(world)), state_{world, options, world.diagnostics, *budget_, {}},
      expander_(state_,
                [this](ProtoDeclaration& declaration) { return resolveExtern(declaration); }) {}

void Loader::load(const Source& source, const std::string& name,
                  const std::optional<Fragment>& fragment, TextLayout* layout) {
  const auto start = std::chrono::steady_clock::now();
  ParsedFile file;
  const auto sharedName = source.nameWithComments(name, depth_);
  if (fragment)
    setFileVersion(sharedName, fragment->version);
  else
    source.identify(sharedName, state_.diagnostics);
  state_.anyRoots = fragment.has_value();
  state_.layout = layout;
  if (fragment) state_.known = fragment->prototypes;
  parse(source, sharedName, file);
  state_.known = {};
  state_.layout = nullptr;
  state_.anyRoots = false;
  world_.times.parse = secondsSince(start);
  const std::string key = canonical(name);
  inlined_[key].reading = true;
  complete(file, depth_);
  world_.scope = std::move(file.scope);
  world_.head = std::move(file.head);
  setExchange(world_, std::move(file.exchange));
  if (composed_) checkSize(world_.scope);
  world_.times.load = secondsSince(start) - world_.times.parse;
}

void Loader::loadDeferredInline(InlineNode& node, const std::vector<std::string>& enclosing) {
  for (const std::string& file : enclosing) inlined_[canonical(file)].reading = true;
  if (const GlobeOriginPtr origin = globeOrigin(node.source.file)) state_.globe = origin;
  loadInline(node, std::max<uint64_t>(enclosing.size(), fileDepth(node.source.file) + 1));
}

void Loader::parse(const Source& source, const std::shared_ptr<const std::string>& name,
                   ParsedFile& file) {
  file.head.version = fileVersion(name);
  setGlobeOrigin(name, state_.globe);
  // Nodes of VRML 1.0 are counted when the world is complete.
  composed_ = composed_ || file.head.version.encoding == Encoding::vrml1;
  readWorldFile({source.text(), name, state_, file, budget_});
}

void Loader::complete(ParsedFile& file, uint64_t depth) {
  composed_ = composed_ || !file.instances.empty() || !file.inlines.empty();
  expander_.expand(file.instances, file.inlines);
  if (!state_.options.loadInlines) return;
  for (const NodeRef& node : file.inlines) loadInline(*nodeCast<InlineNode>(node), depth + 1);
  if (file.exchange) resolveImports(*file.exchange, nullptr, state_.diagnostics); // reports
}

// Gives an Inline the content of a file. Where the file has another unit of lengths than that of
// the Inline, a Transform around the content converts them (ISO/IEC 19775-1 4.3.6).
void Loader::setContent(InlineNode& node, const InlinedFile& file) {
  node.content = file.content;
  node.exchange = file.exchange;
  const auto scale = float(file.length / lengthUnit(node.source.file));
  if (scale == 1 || file.content->roots.empty()) return;
  auto* const transform = new nodes::Transform();
  transform->source = file.content->roots[0] ? file.content->roots[0]->source : node.source;
  transform->scale = {scale, scale, scale};
  transform->children = file.content->roots;
  ++world_.nodeCount;
  auto scaled = std::make_shared<Scope>(*file.content);
  scaled->roots = {NodeRef(transform)};
  node.content = std::move(scaled);
}

void Loader::loadInline(InlineNode& node, uint64_t depth) {
  if (!node.load || node.url.empty() || node.content) return;
  node.tried = true;
  std::string reasons;
  for (const std::string& url : node.url) {
    const ResolvedUrl resolved =
        resolveUrl(url, node.source.file ? *node.source.file : "", state_.options);
    std::string reason = resolved.error;
    if (reason.empty() && loadInlineFrom(node, resolved.path, depth, reason)) return;
    if (!reason.empty()) addReason(reasons, reason);
  }
  if (!reasons.empty())
    state_.diagnostics.warn(node.source, fmt::format("Inline is empty: {}", reasons));
}

// Loads one URL of an Inline. Returns true if no further URL need be tried: it is loaded, or
// refused with a message.
bool Loader::loadInlineFrom(InlineNode& node, const std::string& path, uint64_t depth,
                            std::string& reason) {
  const Limits& limits = state_.options.limits;
  const std::string key = canonical(path);
  InlinedFile& known = inlined_[key];
  if (known.reading) {
    state_.diagnostics.error(
        node.source, fmt::format("Inline of '{}', which contains this Inline itself", path));
    return true;
  }
  if (depth > limits.inlineDepth) {
    state_.diagnostics.error(
        node.source,
        fmt::format("Inlines within Inlines deeper than limit inlineDepth={}", limits.inlineDepth));
    return true;
  }
  if (known.content) {
    const bool copy =
        known.changing && copied_ + known.bytes <= std::min(maxCopiedBytes, budget_->left());
    if (!copy) {
      setContent(node, known);
      return true;
    }
    copied_ += known.bytes;
  }
  try {
    const Source source = Source::open(path, limits, budget_);
    const auto name = fileName(path, depth);
    source.identify(name, state_.diagnostics);
    const uint64_t before = budget_->used(), routes = state_.routes, scripts = state_.scripts;
    known.reading = true;
    ParsedFile file;
    parse(source, name, file);
    complete(file, depth);
    // Looks up the entry again, because the table may have moved.
    InlinedFile& entry = inlined_[key];
    entry.reading = false;
    entry.bytes = budget_->used() - std::min(budget_->used(), before);
    entry.changing = state_.routes > routes || state_.scripts > scripts ||
                     (file.exchange && !file.exchange->exports.empty());
    entry.content = std::make_shared<const Scope>(std::move(file.scope));
    entry.exchange = std::move(file.exchange);
    entry.length = lengthUnit(name);
    setContent(node, entry);
    return true;
  } catch (const LoadError& error) {
    inlined_[key].reading = false;
    reason = error.diagnostic.text();
    return false;
  }
}

// Returns the prototype of the first URL of an EXTERNPROTO that can be read and has it (4.9.3).
// Returns null, with one message, if there is none.
ProtoPtr Loader::resolveExtern(ProtoDeclaration& declaration) {
  if (declaration.resolved || !tried_.insert(&declaration).second) return declaration.resolved;
  const std::string& name = declaration.type->name;
  if (resolving_ >= state_.options.limits.inlineDepth) {
    state_.diagnostics.error(declaration.source,
                             fmt::format("files of prototypes deeper than limit inlineDepth={}",
                                         state_.options.limits.inlineDepth));
    return nullptr;
  }
  std::string reasons;
  for (const std::string& url : declaration.urls) {
    if (ProtoPtr known = builtinPrototype(url, declaration)) {
      checkInterface(declaration, *known);
      return declaration.resolved = known;
    }
    const ResolvedUrl resolved = resolveUrl(url, declaration.baseUrl, state_.options);
    std::string reason = resolved.error;
    if (reason.empty()) {
      ++resolving_;
      ProtoPtr found = findIn(resolved.path, resolved.fragment, reason);
      if (found && found->isExtern) {
        found = resolveExtern(*found);
        if (!found) reason = fmt::format("'{}' leads to an EXTERNPROTO that cannot be loaded", url);
      }
      --resolving_;
      if (found) {
        checkInterface(declaration, *found);
        return declaration.resolved = found;
      }
    }
    addReason(reasons, reason);
  }
  if (declaration.urls.empty()) reasons = "it names no URL";
  state_.diagnostics.warn(declaration.source,
                          fmt::format("EXTERNPROTO '{}' is not loaded: {}", name, reasons));
  return nullptr;
}

ProtoPtr Loader::findIn(const std::string& path, const std::string& name, std::string& reason) {
  auto& library = libraries_[canonical(path)];
  if (!library) {
    try {
      const Source source = Source::open(path, state_.options.limits, budget_);
      const auto sharedName = fileName(path, depth_);
      source.identify(sharedName, state_.diagnostics);
      library = std::make_unique<ParsedFile>();
      parse(source, sharedName, *library);
    } catch (const LoadError& error) {
      reason = error.diagnostic.text();
      library.reset();
      return nullptr;
    }
  }
  // Without a name, the first PROTO of the file is meant; EXTERNPROTOs do not count (4.9.3). A file
  // with nothing else may still pass on a prototype.
  ProtoPtr external;
  for (const ProtoPtr& proto : library->scope.prototypes) {
    if (name.empty() ? !proto->isExtern : proto->type->name == name) return proto;
    if (name.empty() && !external) external = proto;
  }
  if (external) return external;
  reason = name.empty() ? fmt::format("'{}' declares no prototype", path)
                        : fmt::format("'{}' declares no prototype '{}'", path, name);
  return nullptr;
}

// Reports declarations that differ from the PROTO: the interface of an EXTERNPROTO must be a subset
// of it (4.9.2). Such a declaration has no effect; the rest works.
void Loader::checkInterface(const ProtoDeclaration& wanted, const ProtoDeclaration& found) {
  for (const FieldInfo& field : wanted.type->fields) {
    const FieldInfo* declared = found.type->find(field.name);
    if (declared && declared->type == field.type && declared->access == field.access) continue;
    const std::string place =
        found.source.file ? fmt::format("{}:{}", *found.source.file, found.source.line) : "";
    state_.diagnostics.error(
        wanted.source,
        fmt::format("EXTERNPROTO '{}' declares {} {} '{}' {} the prototype in {}",
                    wanted.type->name, accessName(field.access), fieldTypeName(field.type),
                    field.name, declared ? "differently from" : "that is not in", place));
  }
}

// Removes roots that are too large once all prototypes and Inlines are in place. A root may not
// stand for more nodes than the limit, with shared nodes counted at each use. It may not nest
// deeper than recursive functions can follow. The loop has its own stack.
void Loader::checkSize(Scope& scope) {
  struct Size {
    uint64_t nodes = 1, depth = 1;
    bool done = false;
  };
  std::unordered_map<Node*, Size> sizes;
  const auto children = [](Node* node, std::vector<Node*>& out) {
    // Nodes in the fields of Scripts and instances are only drawn where a body holds them.
    if (node->type().index >= 0)
      forEachChild(*node, [&](NodeRef& child, const FieldInfo&) { out.push_back(child.get()); });
    if (const auto* instance = nodeCast<ProtoInstance>(node)) {
      for (const NodeRef& root : instance->body.roots) out.push_back(root.get());
    }
    if (const Scope* content = inlineScope(*node)) {
      for (const NodeRef& root : content->roots) out.push_back(root.get());
    }
  };
  const auto measure = [&](Node* root) {
    std::vector<Node*> stack{root}, below;
    while (!stack.empty()) {
      Node* node = stack.back();
      Size& size = sizes[node];
      below.clear();
      if (!size.done) children(node, below);
      bool ready = true;
      if (!size.done && size.nodes == 1 && !below.empty()) {
        size.nodes = 0; // its children have been pushed
        for (Node* child : below) {
          if (!sizes[child].done && child != node) {
            stack.push_back(child);
            ready = false;
          }
        }
      }
      if (!ready) continue;
      stack.pop_back();
      Size& result = sizes[node];
      if (result.done) continue;
      result = {1, 1, true};
      for (Node* child : below) {
        const Size& inner = sizes[child];
        result.nodes = saturatingAdd(result.nodes, inner.nodes);
        result.depth = std::max(result.depth, inner.depth + 1);
      }
      sizes[node] = result;
    }
    return sizes[root];
  };
  uint64_t sum = 0;
  const uint64_t limit = state_.options.limits.expandedNodes;
  std::erase_if(scope.roots, [&](const NodeRef& root) {
    const Size size = measure(root.get());
    const bool large = saturatingAdd(sum, size.nodes) > limit,
               deep = size.depth > Parser::maximumNesting;
    if (large)
      state_.diagnostics.error(root->source,
                               fmt::format("more nodes with all prototypes and Inlines than limit "
                                           "expandedNodes={}; {} is left out",
                                           limit, root->type().name));
    else if (deep)
      state_.diagnostics.error(root->source,
                               fmt::format("with all prototypes and Inlines, nodes are nested {} "
                                           "deep, but {} is the maximum; {} is left out",
                                           size.depth, Parser::maximumNesting, root->type().name));
    else
      sum += size.nodes;
    return large || deep;
  });
}

namespace {

// Stack size in bytes for the deepest nesting that is allowed, also in a debug build. A release
// build uses 0.6 kB per level.
constexpr size_t deepestStack = size_t(6) << 20;

template <class MakeSource>
std::unique_ptr<World> loadFrom(const std::string& name, const LoadOptions& options,
                                MakeSource makeSource, const std::optional<Fragment>& fragment = {},
                                const BudgetPtr& budget = nullptr, uint64_t depth = 0,
                                TextLayout* layout = nullptr) {
  // One level more than Inlines have: an Inline of the text reports the limit by itself.
  if (depth > 0 && depth - 1 > options.limits.inlineDepth)
    throw LoadError{{Severity::error,
                     name,
                     0,
                     0,
                     fmt::format("Scripts made by Scripts deeper than limit inlineDepth={}",
                                 options.limits.inlineDepth),
                     {},
                     0}};
  try {
    auto world = std::make_unique<World>();
    world->path = name;
    world->options = options;
    if (budget) setBudget(*world, budget);
    const Source source = makeSource(budgetOf(*world));
    return onStackOf(deepestStack, [&] {
      Loader(*world, world->options, depth).load(source, name, fragment, layout);
      return std::move(world);
    });
  } catch (const std::bad_alloc&) {
    throw LoadError{{Severity::error, name, 0, 0, "not enough memory", {}, 0}};
  }
}

} // namespace

std::unique_ptr<World> loadWorld(const std::string& path, const LoadOptions& options) {
  return loadFrom(path, options, [&](const BudgetPtr& budget) {
    return Source::open(path, options.limits, budget);
  });
}

std::unique_ptr<World> loadWorldFromMemory(std::string_view bytes, const std::string& name,
                                           const LoadOptions& options) {
  return loadFrom(name, options, [&](const BudgetPtr& budget) {
    return Source::fromMemory(bytes, name, options.limits, budget);
  });
}

std::unique_ptr<World> loadWithLayout(std::string_view text, const std::string& name,
                                      const LoadOptions& options, TextLayout& layout,
                                      const std::optional<FileVersion>& fragment) {
  return loadFrom(
      name, options,
      [&](const BudgetPtr& its) { return Source::fromMemory(text, name, options.limits, its); },
      fragment ? std::optional(Fragment{*fragment}) : std::nullopt, nullptr, 0, &layout);
}

std::unique_ptr<World> loadWorldInto(const BudgetPtr& budget, const std::string& path,
                                     const LoadOptions& options, uint64_t depth) {
  return loadFrom(
      path, options, [&](const BudgetPtr& its) { return Source::open(path, options.limits, its); },
      {}, budget, depth);
}

std::unique_ptr<World> loadFragment(std::string_view text, const std::string& name,
                                    const LoadOptions& options, const BudgetPtr& budget,
                                    uint64_t depth, const Fragment& fragment) {
  return loadFrom(
      name, options,
      [&](const BudgetPtr& its) { return Source::fromMemory(text, name, options.limits, its); },
      fragment, budget, depth);
}

} // namespace xvrml
