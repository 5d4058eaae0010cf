#include "control/world_commands.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "as_json/fields.h"
#include "nearest.h"
#include "xvrml/versions.h"
#include "xvrml/walk.h"

namespace vv::control {

using namespace xvrml;

namespace {

// A value that has been checked and is to be set.
struct Checked {
  NodeRef node;
  const FieldInfo* field;
  Value value;
};

// Tells whether the nodes that are sent to it become part of the node. Scripts only know theirs.
bool holdsWhatItGets(const Node& node, const FieldInfo& field) {
  return !nodeCast<ScriptNode>(&node) && field.name != "removeChildren";
}

void appendNodes(const Value& value, std::vector<Node*>& out) {
  if (const auto* one = std::get_if<NodeRef>(&value)) out.push_back(one->get());
  if (const auto* many = std::get_if<MFNode>(&value))
    for (const NodeRef& one : *many) out.push_back(one.get());
}

// Refuses values by which a node would hold itself, also by way of the other values. The engine
// would drop them and only warn.
void refuseLoops(const std::vector<Checked>& all) {
  std::multimap<const Node*, const Checked*> fresh;
  for (const Checked& one : all)
    if (holdsWhatItGets(*one.node, *one.field)) fresh.emplace(one.node.get(), &one);
  for (const Checked& one : all) {
    std::vector<Node*> open;
    if (holdsWhatItGets(*one.node, *one.field)) appendNodes(one.value, open);
    if (open.empty()) continue;
    const bool free = walk(std::move(open), [&](Node& node, std::vector<Node*>& next) {
      if (!nodeCast<ScriptNode>(&node)) appendChildren(node, next);
      const auto [begin, end] = fresh.equal_range(&node);
      for (auto at = begin; at != end; ++at) appendNodes(at->second->value, next);
      return &node != one.node.get();
    });
    if (!free)
      throw CommandError("value", fmt::format("{}.{}: the node would hold itself",
                                              one.node->type().name, one.field->name));
  }
}

std::string keyOf(const FieldName& name) { return shownNode(name.node) + "." + name.field; }

std::string nodeText(const NodeName& name) {
  if (const auto* number = std::get_if<uint64_t>(&name)) return std::to_string(*number);
  return jsonText(std::get<std::string>(name));
}

// Sends the events of one subscription to its client.
struct Sender {
  Mailbox& mailbox;
  Client& client; // lives longer than the subscription
  Browser& browser;
  std::string head; // the line up to the value

  // Throws nothing, because the event engine calls it.
  void operator()(const Value& value) const noexcept try {
    std::string line = head;
    try {
      line += "\"value\":";
      appendValue(line, value, [this](const NodeRef& node) { return client.numbers.of(node); });
    } catch (const CommandError& error) {
      line = fmt::format(R"({}"error":{{"code":{},"message":{}}})", head, jsonText(error.code),
                         jsonText(error.what()));
    }
    line += fmt::format(R"(,"time":{}}})", browser.now());
    mailbox.send(client.id, line);
  } catch (const std::bad_alloc&) {
    mailbox.cut(client.id, "limit", "not enough memory for an event: this client is cut off");
  } catch (...) { mailbox.cut(client.id, "failed", "an event was lost: this client is cut off"); }
};

// Returns the node in an SFNode of a node, or of what a prototype instance stands for; null if
// there is none.
NodeRef childOf(Node* node, const char* field) {
  const Node* const real = renderedNode(node);
  const FieldInfo* const info = real ? real->type().find(field) : nullptr;
  if (!info || info->type != FieldType::SFNode || !holdsValue(*info)) return {};
  return *static_cast<const NodeRef*>(real->storage(*info));
}

// Numbers may be none where nodes are scaled beyond all measure.
std::string triple(const std::array<double, 3>& v) {
  const auto text = [](double number) {
    return std::isfinite(number) ? fmt::format("{}", number) : "null";
  };
  return fmt::format("[{},{},{}]", text(v[0]), text(v[1]), text(v[2]));
}

struct Performer {
  template <class... F> struct Of : F... { using F::operator()...; };
};
template <class... F> Performer::Of<F...> choose(F... functions) { return {functions...}; }

} // namespace

std::string WorldCommands::perform(const Command& command) {
  const auto other = [](const auto&) -> std::string { return "null"; };
  return std::visit(
      choose([this](const Get& c) { return get(c); }, [this](const Set& c) { return set(c); },
             [this](const Subscribe& c) { return subscribe(c); },
             [this](const Create& c) { return create(c); },
             [this](const ChangeRoots& c) { return changeRoots(c); },
             [this](const Release& c) { return release(c); },
             [this](const ChangeRoute& c) { return changeRoute(c); },
             [this](const Describe& c) { return describe(c); },
             [this](const ListNames&) { return listNames(); },
             [this](const ListViewpoints&) { return listViewpoints(); },
             [this](const Bind& c) { return bind(c); },
             [this](const Replace& c) { return replace(c); },
             [this](const PressKey& c) { return press(c); },
             [this](const Time& c) { return time(c); },
             [this](const edits::Step& c) { return edit(c); },
             [this](const Undo& c) { return undo(c); }, [this](const Save& c) { return save(c); },
             [this](const ListEdits& c) { return listEdits(c); },
             [this](const ListRoots&) { return listRoots(); },
             [this](const ListParents& c) { return listParents(c); },
             [this](const Select& c) { return select(c); },
             [this](const ListSelection&) { return listSelection(); },
             [this](const ListParameters& c) { return listParameters(c); },
             [this](const Pick& c) { return pick(c); },
             [this](const Recover&) { return throwLeftAway(); }, other),
      command.action);
}

// --- Nodes and values ---

NodeRef WorldCommands::nodeOf(const NodeName& name) const {
  if (const auto* number = std::get_if<uint64_t>(&name)) {
    if (NodeRef node = client_.numbers.find(*number)) return node;
    throw CommandError("node", fmt::format("there is no node {}; this client did not get the "
                                           "number, or has released it",
                                           *number));
  }
  const auto& text = std::get<std::string>(name);
  if (NodeRef node = browser_.node(text)) return node;
  std::vector<std::string> known;
  constexpr size_t most = 1000, longest = 64; // the search takes time
  for (const auto& [def, node] : browser_.world().scope.names)
    if (known.size() < most) known.push_back(def);
  const std::string near = text.size() > longest ? "" : nearest::word(text, known);
  throw CommandError("node",
                     fmt::format("the world has no node {}{}", shownJson(text),
                                 near.empty() ? "" : "; did you mean " + jsonText(near) + "?"));
}

std::string WorldCommands::valueText(const Value& value) {
  std::string text;
  appendValue(text, value, [this](const NodeRef& node) { return client_.numbers.of(node); });
  return text;
}

std::string WorldCommands::factsOf(const NodeRef& node) {
  if (!node) return "null";
  return fmt::format(R"({{"node":{},"type":{},"name":{}}})", client_.numbers.of(node),
                     jsonText(node->type().name), jsonText(node->defName));
}

std::string WorldCommands::factsOf(const MFNode& nodes) {
  std::string list;
  for (const NodeRef& node : nodes) list += (list.empty() ? "" : ",") + factsOf(node);
  return "[" + list + "]";
}

std::string WorldCommands::get(const Get& get) {
  const NodeRef node = nodeOf(get.from.node);
  return valueText(browser_.get(*node, readableField(*node, get.from.field).name));
}

// All values are checked before the first one is set. The events are one cascade: they have one
// time stamp, and what they cause comes after the last of them.
std::string WorldCommands::set(const Set& set) {
  std::vector<Checked> all;
  std::set<std::pair<const Node*, const FieldInfo*>> seen;
  const FindNode find = [this](const Json& name) {
    return name.is_string() ? nodeOf(name.get<std::string>()) : nodeOf(name.get<uint64_t>());
  };
  for (const Assignment& one : set.values) {
    NodeRef node = nodeOf(one.to.node);
    const FieldInfo& field = writableField(*node, one.to.field);
    if (!seen.emplace(node.get(), &field).second)
      throw CommandError("value",
                         fmt::format("{}.{} of {} would be set twice in one step",
                                     node->type().name, field.name, shownNode(one.to.node)));
    Value value = readValue(one.value, *node, field, find);
    all.push_back({std::move(node), &field, std::move(value)});
  }
  refuseLoops(all);
  std::vector<Checked> fields, events;
  for (Checked& one : all)
    (one.field->access == Access::field ? fields : events).push_back(std::move(one));
  for (Checked& one : fields)
    if (!browser_.set(*one.node, one.field->name, std::move(one.value)))
      throw CommandError("value", fmt::format("{}.{}: the world refused the value",
                                              one.node->type().name, one.field->name));
  for (size_t i = 0; i < events.size(); ++i) {
    Checked& one = events[i];
    if (i + 1 < events.size())
      browser_.events().post(*one.node, *one.field, std::move(one.value));
    else // delivers those that wait, and then what they cause
      browser_.set(*one.node, one.field->name, std::move(one.value));
  }
  return "null";
}

// --- Events ---

std::string WorldCommands::subscribe(const Subscribe& subscribe) {
  const std::string key = keyOf(subscribe.to);
  const auto known = client_.subscriptions.find(key);
  if (!subscribe.on) {
    if (known == client_.subscriptions.end())
      throw CommandError("field", fmt::format("there is no subscription to {}", key));
    browser_.unlisten(*known->second.node, known->second.number);
    client_.subscriptions.erase(known);
    return "null";
  }
  const NodeRef node = nodeOf(subscribe.to.node);
  const FieldInfo* field = findEventOut(*node, subscribe.to.field);
  if (!field) refuseField(*node, subscribe.to.field, "subscribed to", fieldNames(*node, sends));
  std::string value = valueText(browser_.get(*node, field->name));
  if (known != client_.subscriptions.end()) return value;
  if (client_.subscriptions.size() >= limits.subscriptions)
    throw CommandError("limit", fmt::format("this client has subscriptions={} subscriptions",
                                            limits.subscriptions));
  const Sender sender{mailbox_, client_, browser_,
                      fmt::format(R"({{"event":"changed","node":{},"field":{},)",
                                  nodeText(subscribe.to.node), jsonText(subscribe.to.field))};
  const uint64_t number =
      browser_.listen(*node, subscribe.to.field,
                      [sender](Node&, const FieldInfo&, const Value& sent) { sender(sent); });
  client_.subscriptions[key] = {node, number};
  return value;
}

void WorldCommands::unsubscribeAll(Browser& browser, Client& client) {
  for (const auto& [key, one] : client.subscriptions) browser.unlisten(*one.node, one.number);
  client.subscriptions.clear();
}

// --- The graph ---

std::string WorldCommands::create(const Create& create) {
  const Diagnostics& diagnostics = browser_.world().diagnostics;
  const size_t before = diagnostics.list().size();
  MFNode made;
  try {
    made = browser_.createVrmlFromString(create.vrml);
  } catch (const LoadError& error) { throw CommandError("vrml", error.diagnostic.text()); }
  if (made.empty() && diagnostics.list().size() > before)
    throw CommandError("vrml", diagnostics.list()[before].text());
  std::string nodes = valueText(made), names, problems;
  std::vector<Node*> open;
  for (const NodeRef& node : made) open.push_back(node.get());
  walk(std::move(open), [&](Node& node, std::vector<Node*>& next) {
    if (!node.defName.empty())
      names += fmt::format("{}{}:{}", names.empty() ? "" : ",", jsonText(node.defName),
                           client_.numbers.of(NodeRef(&node)));
    appendChildren(node, next);
  });
  for (size_t i = before; i < diagnostics.list().size(); ++i)
    problems += (problems.empty() ? "" : ",") + jsonText(diagnostics.list()[i].text());
  return fmt::format(R"({{"nodes":{},"names":{{{}}},"problems":[{}]}})", nodes, names, problems);
}

std::string WorldCommands::changeRoots(const ChangeRoots& change) {
  const NodeRef node = nodeOf(change.node);
  if (change.add) {
    if (!node->type().is("child") && renderedNode(node.get()) == node.get() &&
        node->type().index >= 0)
      throw CommandError("value", fmt::format("a {} cannot be a root of the world: it is not a "
                                              "child node",
                                              node->type().name));
    browser_.addRoot(node);
    return "null";
  }
  const std::vector<NodeRef>& roots = browser_.world().scope.roots;
  if (std::find(roots.begin(), roots.end(), node) == roots.end())
    throw CommandError("node", shownNode(change.node) + " is not a root of the world");
  browser_.removeRoot(*node);
  return "null";
}

std::string WorldCommands::release(const Release& release) {
  for (const uint64_t number : release.nodes)
    if (!client_.numbers.find(number))
      throw CommandError("node", fmt::format("there is no node {}", number));
  for (const uint64_t number : release.nodes) client_.numbers.release(number);
  return "null";
}

std::string WorldCommands::changeRoute(const ChangeRoute& change) {
  const NodeRef from = nodeOf(change.from.node), to = nodeOf(change.to.node);
  const FieldInfo* out = findEventOut(*from, change.from.field);
  const FieldInfo* in = findEventIn(*to, change.to.field);
  if (!out) refuseField(*from, change.from.field, "the start of a route", fieldNames(*from, sends));
  if (!in)
    refuseField(*to, change.to.field, "the end of a route",
                fieldNames(*to, [](const FieldInfo& field) {
                  return field.access == Access::eventIn || field.access == Access::exposedField;
                }));
  if (out->type != in->type)
    throw CommandError("field", fmt::format("a route has one type: {}.{} is {}, {}.{} is {}",
                                            from->type().name, out->name, fieldTypeName(out->type),
                                            to->type().name, in->name, fieldTypeName(in->type)));
  const bool done = change.add
                        ? browser_.addRoute(*from, change.from.field, *to, change.to.field)
                        : browser_.deleteRoute(*from, change.from.field, *to, change.to.field);
  if (!done && !change.add) throw CommandError("field", "there is no such route");
  return "null";
}

std::string WorldCommands::describe(const Describe& describe) {
  const NodeRef node = nodeOf(describe.node);
  std::string fields;
  for (const FieldInfo& field : node->type().fields)
    fields += fmt::format(R"({}{{"name":{},"type":"{}","access":"{}"}})", fields.empty() ? "" : ",",
                          jsonText(std::string(fieldName(*node, field))), fieldTypeName(field.type),
                          accessName(field.access));
  return fmt::format(R"({{"node":{},"type":{},"name":{},"fields":[{}]}})", client_.numbers.of(node),
                     jsonText(node->type().name), jsonText(node->defName), fields);
}

std::string WorldCommands::listRoots() { return factsOf(browser_.world().scope.roots); }

std::string WorldCommands::listNames() const {
  std::string names;
  for (const auto& [name, node] : browser_.world().scope.names)
    if (node)
      names += fmt::format("{}{}:{}", names.empty() ? "" : ",", jsonText(name),
                           jsonText(node->type().name));
  return "{" + names + "}";
}

// --- The viewer, the world and its time ---

std::string WorldCommands::listViewpoints() {
  std::string list;
  const Node* bound = browser_.bound().viewpoint;
  for (const ViewpointName& one : browser_.viewpoints())
    list += fmt::format(R"({}{{"node":{},"name":{},"description":{},"bound":{}}})",
                        list.empty() ? "" : ",", client_.numbers.of(one.node), jsonText(one.name),
                        jsonText(one.description), one.node.get() == bound);
  return "[" + list + "]";
}

std::string WorldCommands::pick(const Pick& pick) {
  PickHit hit;
  if (!session_.pilot().pick(pick.x, pick.y, hit)) return "null";
  MFNode path;
  for (const PickHit::Step& step : hit.path) path.push_back(step.node);
  Node* const shape = path.empty() ? nullptr : path.back().get();
  const NodeRef appearance = childOf(shape, "appearance");
  const CameraRay ray =
      rayThrough(session_.pilot().camera(), session_.pilot().aspect(), pick.x, pick.y);
  const bool isFacing =
      std::inner_product(hit.normal.begin(), hit.normal.end(), ray.direction, 0.0) < 0;
  return fmt::format(
      R"({{"point":{},"normal":{},"facing":{},"distance":{},"path":{},"geometry":{},"appearance":{},"shader":{}}})",
      triple(hit.point), triple(hit.normal), isFacing, hit.distance, factsOf(path),
      factsOf(childOf(shape, "geometry")), factsOf(appearance),
      factsOf(childOf(appearance.get(), "shader")));
}

std::string WorldCommands::press(const PressKey& press) {
  if (press.key.empty()) return browser_.worldText(press.text) ? "true" : "false";
  bool taken = false;
  if (press.pressed.value_or(true)) taken = browser_.worldKey(press.key, true);
  if (!press.pressed.value_or(false)) taken |= browser_.worldKey(press.key, false);
  return taken ? "true" : "false";
}

std::string WorldCommands::bind(const Bind& bind) {
  if (!session_.pilot().jumpToViewpoint(bind.viewpoint))
    throw CommandError("node",
                       fmt::format("the world has no viewpoint {}", shownJson(bind.viewpoint)));
  return "null";
}

std::string WorldCommands::replace(const Replace& replace) {
  MFNode nodes;
  for (const NodeName& name : replace.nodes) nodes.push_back(nodeOf(name));
  browser_.replaceWorld(nodes);
  return "null";
}

std::string WorldCommands::time(const Time& time) {
  if (time.paused) session_.pilot().setPaused(*time.paused);
  if (time.skip) {
    if (!session_.pilot().paused())
      throw CommandError("command", "time: skip: the world must be paused; add \"paused\": true");
    session_.skip(*time.skip);
  }
  return fmt::format(R"({{"now":{},"epoch":{},"paused":{}}})", browser_.now(), browser_.epoch(),
                     session_.pilot().paused());
}

} // namespace vv::control
