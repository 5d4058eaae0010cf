#include "as_json/perform_step.h"

#include <utility>

#include <fmt/format.h>

#include "as_json/field_json.h"
#include "as_json/fields.h"
#include "xvrml/versions.h"

namespace vv::json::edits {

using namespace xvrml;

namespace {

class StepDoer {
 public:
  StepDoer(WorldEditor& world, const FindNamed& find) : world_(world), find_(find) {}

  // Throws CommandError and EditError.
  void perform(const Edit& edit) {
    made_.push_back(std::visit([this](const auto& one) { return perform(one); }, edit));
  }
  // Returns the node that each edit has made; null if it makes none.
  const MFNode& made() const { return made_; }

 private:
  Editor& editor() { return world_.editor(); }

  NodeRef nodeOf(const EditedNode& name) const {
    if (const auto* made = std::get_if<Made>(&name)) return made_[made->by];
    if (const auto* number = std::get_if<uint64_t>(&name)) return find_(*number);
    return find_(std::get<std::string>(name));
  }
  NodeRef parentOf(const Place& place) const {
    return place.parent ? nodeOf(*place.parent) : NodeRef();
  }

  NodeSlot targetOf(const Place& place) const {
    const NodeRef parent = parentOf(place);
    if (!place.index) return world_.endOf(parent.get(), place.field);
    return {parent.get(), parent ? std::string(ownName(*parent, place.field)) : place.field,
            *place.index};
  }

  NodeSlot placeOf(const Node& node, const std::optional<Place>& at) const {
    if (!at) return world_.placeOf(node);
    const NodeRef parent = parentOf(*at);
    return world_.placeOf(node, [&](const NodeSlot& place) {
      return place.parent == parent.get() &&
             (at->field.empty() ||
              (parent ? ownName(*parent, at->field) : at->field) == place.field) &&
             (!at->index || *at->index == place.index);
    });
  }

  NodeRef perform(const SetField& set) {
    const NodeRef node = nodeOf(set.node);
    const FieldInfo& field = storedField(*node, set.field);
    if (field.type == FieldType::SFNode || field.type == FieldType::MFNode)
      throw EditError(fmt::format("{}.{} holds nodes: insert, move or remove them",
                                  node->type().name, field.name));
    editor().set(*node, field.name, readValue(set.value, *node, field, {}));
    return {};
  }
  NodeRef perform(const Insert& insert) {
    return editor().insert(targetOf(insert.to), insert.vrml);
  }
  NodeRef perform(const Use& use) {
    const NodeRef node = nodeOf(use.node);
    editor().use(targetOf(use.to), *node);
    return {};
  }
  NodeRef perform(const Remove& remove) {
    const NodeRef node = nodeOf(remove.node);
    editor().remove(placeOf(*node, remove.at));
    return {};
  }
  NodeRef perform(const Move& move) {
    const NodeRef node = nodeOf(move.node);
    const NodeSlot from = placeOf(*node, move.at);
    NodeSlot to = targetOf(move.to);
    // The end is counted without the node.
    if (!move.to.index && from.parent == to.parent && from.field == to.field && to.index > 0)
      --to.index;
    editor().move(from, to);
    return {};
  }
  NodeRef perform(const Duplicate& duplicate) {
    const NodeRef node = nodeOf(duplicate.node);
    return editor().duplicate(placeOf(*node, duplicate.at));
  }
  NodeRef perform(const Wrap& wrap) {
    const NodeRef node = nodeOf(wrap.node);
    return editor().wrap(placeOf(*node, wrap.at), wrap.type);
  }
  NodeRef perform(const Rename& rename) {
    const NodeRef node = nodeOf(rename.node);
    editor().rename(*node, rename.name);
    return {};
  }
  NodeRef perform(const Route& route) {
    const NodeRef from = nodeOf(route.from), to = nodeOf(route.to);
    if (route.add)
      editor().addRoute(*from, route.out, *to, route.in);
    else
      editor().removeRoute(*from, route.out, *to, route.in);
    return {};
  }

  WorldEditor& world_;
  const FindNamed& find_;
  MFNode made_;
};

} // namespace

MFNode perform(const Step& step, WorldEditor& world, const FindNamed& find) {
  StepDoer doer(world, find);
  const auto where = [&] { return fmt::format("edit: edits[{}]: ", doer.made().size()); };
  try {
    for (const Edit& one : step.edits) doer.perform(one);
  } catch (const EditError& error) {
    throw EditError(where() + error.what());
  } catch (const CommandError& error) { throw CommandError(error.code, where() + error.what()); }
  return doer.made();
}

} // namespace vv::json::edits
