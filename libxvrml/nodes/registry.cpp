// registry.cpp: node types by name and by index. The types of the generated tables come first;
// plug-ins add theirs in the same way. Types are added before they are used and never removed, so
// that the result of nodeTypes() stays valid.  [any thread]
#include "nodes/registry.h"

#include <atomic>
#include <cstddef>
#include <deque>
#include <mutex>
#include <unordered_map>

#include "xvrml/node_table.h"
#include "xvrml/nodes.h"

namespace xvrml {
namespace {

// Immutable once published, so that readers need no lock.
struct Snapshot {
  std::vector<const NodeType*> types;
  std::unordered_map<std::string_view, const NodeType*> byName;
};

class Registry {
 public:
  static Registry& instance() {
    // Never destroyed: worlds may outlive static objects.
    static Registry& registry = *new Registry();
    return registry;
  }

  const Snapshot& current() const { return *current_.load(std::memory_order_acquire); }

  bool add(std::span<const NodeType* const> types) {
    const std::scoped_lock lock(mutex_);
    auto next = std::make_unique<Snapshot>(current());
    for (const NodeType* type : types) {
      if (type->index != int(next->types.size()) || !next->byName.emplace(type->name, type).second)
        return false;
      next->types.push_back(type);
    }
    current_.store(next.get(), std::memory_order_release);
    snapshots_.push_back(std::move(next));
    return true;
  }

 private:
  Registry() {
    snapshots_.push_back(std::make_unique<Snapshot>());
    current_ = snapshots_.back().get();
    add(nodes::builtinNodeTypes());
  }

  std::mutex mutex_;
  // Earlier snapshots are kept, because other threads may still read them.
  std::vector<std::unique_ptr<const Snapshot>> snapshots_;
  std::atomic<const Snapshot*> current_;
};

std::vector<std::string> splitWords(std::string_view words) {
  std::vector<std::string> result;
  while (!words.empty()) {
    const size_t end = std::min(words.find(' '), words.size());
    if (end > 0) result.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return result;
}

// Fills in what follows from the names of the fields.
void readFieldNames(NodeType& type) {
  constexpr std::string_view set = "set_";
  for (FieldInfo& field : type.fields) {
    field.isMetadata = field.type == FieldType::SFNode && field.name == "metadata";
    if (field.access != Access::eventIn || !field.name.starts_with(set)) continue;
    const FieldInfo* const target = type.find(std::string_view(field.name).substr(set.size()));
    if (target && target->type == field.type && holdsValue(*target))
      field.sets = int(target - type.fields.data());
  }
}

} // namespace

NodeType makeNodeType(const NodeRow& row, int index) {
  NodeType type{row.name, index,      row.standard, splitWords(row.roles), row.component, row.text,
                {},       row.create, row.clause};
  type.fields.reserve(row.fields.size());
  for (const FieldRow& field : row.fields) {
    type.fields.push_back({field.name,
                           field.type,
                           field.access,
                           field.change,
                           (field.words & fieldHoldsUrls) != 0,
                           (field.words & fieldOfX3d) != 0,
                           field.offset,
                           {},
                           field.range,
                           field.nodeTypes,
                           field.text});
    type.fields.back().rare = field.rare;
    type.fields.back().rareOffset = field.rareOffset;
  }
  readFieldNames(type);
  if (index == nodes::ParticleSystem::typeIndex) type.expand = expandParticleSystem;
  for (const FieldRevision& one : nodes::revisions())
    if (one.type == index && one.access == Access::exposedField)
      for (FieldInfo& field : type.fields)
        if (field.name == one.field && field.access == Access::field) {
          field.access = Access::exposedField;
          field.exposedSince = uint8_t(one.major);
        }
  const std::unique_ptr<Node> fresh(row.create(type));
  for (FieldInfo& field : type.fields) field.defaultValue = fresh->get(field);
  return type;
}

bool addNodeTypes(std::span<const NodeType* const> types) {
  return Registry::instance().add(types);
}

static std::deque<RenderCall>& renderCalls() {
  static std::deque<RenderCall> calls; // by index of the type
  return calls;
}

void setRenderCall(const NodeType& type, RenderCall call) {
  if (size_t(type.index) >= renderCalls().size()) renderCalls().resize(size_t(type.index) + 1);
  renderCalls()[size_t(type.index)] = call;
}

RenderCall renderCallOf(const NodeType& type) {
  const std::deque<RenderCall>& calls = renderCalls();
  return type.index >= 0 && size_t(type.index) < calls.size() ? calls[size_t(type.index)] : nullptr;
}

std::span<const NodeType* const> nodeTypes() { return Registry::instance().current().types; }

const NodeType* findNodeType(std::string_view name) {
  const Snapshot& snapshot = Registry::instance().current();
  const auto found = snapshot.byName.find(name);
  return found == snapshot.byName.end() ? nullptr : found->second;
}

std::string_view lackOf(const NodeType& type) {
  for (const nodes::Lack& one : nodes::lacks())
    if (one.type == type.name) return one.text;
  return {};
}

const nodes::AbsentNode* findAbsentNode(std::string_view type) {
  static const auto& byName = *[] {
    auto* const table = new std::unordered_map<std::string_view, const nodes::AbsentNode*>();
    for (const nodes::AbsentNode& one : nodes::absentNodes()) table->emplace(one.name, &one);
    return table;
  }();
  const auto found = byName.find(type);
  return found == byName.end() ? nullptr : found->second;
}

std::string_view containerOf(const NodeType& type) {
  static const auto& byName = *[] {
    auto* const table = new std::unordered_map<std::string_view, std::string_view>();
    for (const nodes::Container& one : nodes::containers()) table->emplace(one.type, one.field);
    return table;
  }();
  if (const auto own = byName.find(type.name); own != byName.end()) return own->second;
  for (const std::string& role : type.abstract)
    if (const auto found = byName.find(role); found != byName.end()) return found->second;
  return "children";
}

} // namespace xvrml
