// load_sensor.cpp: LoadSensor (ISO/IEC 19775-1 9.4.3): tells when the files that nodes name have
// been loaded. Sounds and films are known by their length, Inlines by their content. Pictures are
// read when they are drawn: of them it is asked whether a file is there. A new url, or a new `load`
// of an Inline, begins again.
#include <algorithm>
#include <fstream>
#include <functional>

#include "behaviour/media.h"
#include "behaviour/named_fields.h"
#include "event/engine.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"

namespace xvrml {
namespace {

enum class Loaded : uint8_t { no, waits, yes };

// Listens to the fields of nodes that say what is loaded.
class Watch {
 public:
  Watch(Engine& engine, std::function<void()> changed)
      : engine_(engine), changed_(std::make_shared<std::function<void()>>(std::move(changed))) {}
  ~Watch() { stop(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  void start(const MFNode& list) {
    stop();
    for (const NodeRef& written : list) {
      Node* const node = renderedNode(written.get());
      if (!node) continue;
      engine_.adopt(*node);
      for (const FieldInfo& field : node->type().fields)
        if (field.access == Access::exposedField &&
            ((field.type == FieldType::MFString && holdsUrls(*node, field)) ||
             isField<"load">(*node, field)))
          listen(*node, field);
    }
  }

 private:
  // A listener may still be called in the cascade in which it was removed.
  void listen(Node& node, const FieldInfo& field) {
    const std::weak_ptr<std::function<void()>> changed = changed_;
    const uint64_t number = engine_.listen(node, field, [changed](auto&&...) {
      if (const auto alive = changed.lock()) (*alive)();
    });
    heard_.emplace_back(NodeRef(&node), number);
  }
  void stop() {
    for (const auto& [node, number] : heard_) engine_.unlisten(*node, number);
    heard_.clear();
  }

  Engine& engine_;
  const std::shared_ptr<std::function<void()>> changed_;
  std::vector<std::pair<NodeRef, uint64_t>> heard_;
};

struct State : NodeState {
  State(Engine& engine, std::function<void()> changed) : watch(engine, std::move(changed)) {}

  bool senses = false; // isActive TRUE was sent
  double begun = 0;
  float progress = -1; // the last one sent; below 0: none
  Watch watch;
};

bool isReadable(const Node& node, const FieldInfo& field, const MFString& urls,
                const LoadOptions& options) {
  const auto& base = urlBase(node, field);
  return urls.empty() || std::any_of(urls.begin(), urls.end(), [&](const std::string& url) {
           const ResolvedUrl resolved = resolveUrl(url, base ? *base : std::string(), options);
           return resolved.error.empty() && std::ifstream(resolved.path, std::ios::binary).good();
         });
}

Loaded loadedOf(Events& events, const Node& written) {
  const Node* node = renderedNode(const_cast<Node*>(&written));
  if (!node) return Loaded::no;
  if (const auto* content = nodeCast<InlineNode>(node)) {
    if (content->content) return Loaded::yes;
    return content->tried && content->load ? Loaded::no : Loaded::waits;
  }
  if (const FieldInfo* duration = fieldNamed<"duration_changed">(*node))
    return std::get<SFTime>(events.lastSent(*node, *duration)) >= 0 ? Loaded::yes : Loaded::no;
  for (const FieldInfo& field : node->type().fields)
    if (field.type == FieldType::MFString && holdsValue(field) && holdsUrls(*node, field) &&
        !isReadable(*node, field, *static_cast<const MFString*>(node->storage(field)),
                    loadOptions(events)))
      return Loaded::no;
  return Loaded::yes;
}

State& stateOf(Events& events, Node& node) { return static_cast<State&>(*events.state(node)); }

void end(Events& events, Node& node) {
  stateOf(events, node).senses = false;
  events.wantTicks(node, false);
  sendFrom<"isActive">(events, node, false);
}

// An eventOut sends once at a time, so that what has been loaded already is told a tick later.
void tick(Events& events, Node& node) {
  auto& sensor = static_cast<nodes::LoadSensor&>(node);
  State& state = stateOf(events, node);
  const auto count = std::count_if(sensor.watchList.begin(), sensor.watchList.end(),
                                   [](const NodeRef& n) { return bool(n); });
  if (!sensor.enabled || count == 0) {
    if (state.senses) return end(events, node);
    return events.wantTicks(node, false);
  }
  if (!std::exchange(state.senses, true)) {
    state.begun = events.now();
    state.progress = 0;
    sendFrom<"isActive">(events, node, true);
    return sendFrom<"progress">(events, node, 0.f);
  }
  size_t loaded = 0;
  bool failed = false;
  for (const NodeRef& watched : sensor.watchList) {
    if (!watched) continue;
    const Loaded one = loadedOf(events, *watched);
    loaded += one == Loaded::yes;
    failed = failed || one == Loaded::no;
  }
  const float progress = float(loaded) / float(count);
  if (std::exchange(state.progress, progress) != progress)
    sendFrom<"progress">(events, node, progress);
  const bool all = loaded == size_t(count);
  const bool late = sensor.timeOut > 0 && events.now() - state.begun >= sensor.timeOut;
  if (!all && !failed && !late) return;
  sendFrom<"isLoaded">(events, node, all);
  if (all) sendFrom<"loadTime">(events, node, events.now());
  end(events, node);
}

// The nodes are watched from the beginning, and timeOut counts from now.
void restart(Events& events, Node& node) {
  State& state = stateOf(events, node);
  state.begun = events.now();
  state.progress = -1;
  events.wantTicks(node, true);
}

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  events.wantTicks(node, true);
  auto state = std::make_unique<State>(Engine::of(events), [&] { restart(events, node); });
  state->watch.start(static_cast<nodes::LoadSensor&>(node).watchList);
  return state;
}

// A new list is watched from the beginning.
void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  const bool isList = isField<"watchList">(node, in);
  if (!isList && !isField<"enabled">(node, in)) return;
  const auto& sensor = static_cast<const nodes::LoadSensor&>(node);
  State& state = stateOf(events, node);
  if (isList) state.watch.start(sensor.watchList);
  if (!sensor.enabled && state.senses) return end(events, node);
  if (isList) return restart(events, node);
  events.wantTicks(node, true);
}

} // namespace

void addLoadSensorBehaviours(const AddBehaviour& add) {
  add(nodes::LoadSensor::nodeType(), {.begin = begin, .receive = receive, .tick = tick});
}

} // namespace xvrml
