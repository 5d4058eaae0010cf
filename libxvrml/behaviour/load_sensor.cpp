// load_sensor.cpp: LoadSensor (ISO/IEC 19775-1 9.4.3): tells when the files that nodes name have
// been loaded. Sounds and films are known by their length, Inlines by their content. Pictures are
// read when they are drawn: of them it is asked whether a file is there.
#include <algorithm>
#include <fstream>

#include "behaviour/media.h"
#include "behaviour/named_fields.h"
#include "graph/field_access.h"
#include "graph/inline_node.h"

namespace xvrml {
namespace {

enum class Loaded : uint8_t { no, waits, yes };

struct State : NodeState {
  bool senses = false; // isActive TRUE was sent
  double begun = 0;
  float progress = -1; // the last one sent; below 0: none
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

std::unique_ptr<NodeState> begin(Events& events, Node& node) {
  events.wantTicks(node, true);
  return std::make_unique<State>();
}

// A new list is watched from the beginning.
void receive(Events& events, Node& node, const FieldInfo& in, const Value&) {
  const bool isList = isField<"watchList">(node, in);
  if (!isList && !isField<"enabled">(node, in)) return;
  State& state = stateOf(events, node);
  const bool enabled = static_cast<nodes::LoadSensor&>(node).enabled;
  if (!enabled && state.senses) return end(events, node);
  if (isList && state.senses) {
    state.begun = events.now();
    state.progress = -1;
  }
  events.wantTicks(node, true);
}

} // namespace

void addLoadSensorBehaviours(const AddBehaviour& add) {
  add(nodes::LoadSensor::nodeType(), {.begin = begin, .receive = receive, .tick = tick});
}

} // namespace xvrml
