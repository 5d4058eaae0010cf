// check.cpp: checks the specifications for consistency and copies field attributes from abstract
// types to nodes. Runs once, after all files are read and before anything is written.
#include <algorithm>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "nodegen/model.h"

namespace xvrml::nodegen {
namespace {

std::string place(const SourcePosition& source) {
  return fmt::format("{}:{}", *source.file, source.line);
}

const FieldSpec* findField(const TypeSpec& type, std::string_view name) {
  for (const FieldSpec& field : type.fields)
    if (field.name == name) return &field;
  return nullptr;
}

class Checker {
 public:
  explicit Checker(Model& model) : model_(model) {}

  void run() {
    collectNames();
    eachType([this](TypeSpec& type) { addMetadata(type); });
    eachType([this](TypeSpec& type) { resolveRoles(type); });
    eachType([this](TypeSpec& type) { checkFieldNames(type); });
    eachType([this](TypeSpec& type) { type.isAbstract ? checkAbstract(type) : checkNode(type); });
    for (const Component& component : model_.components) {
      for (const Revision& revision : component.revisions) checkRevision(revision);
      for (const AbsentNode& one : component.absent) checkAbsent(one);
    }
  }

 private:
  template <class Function> void eachType(Function function) {
    for (Component& component : model_.components)
      for (TypeSpec& type : component.types) function(type);
  }

  void collectNames() {
    std::map<std::string, const Component*> components;
    for (const Component& component : model_.components) {
      if (!components.emplace(component.name, &component).second)
        model_.diagnostics.add({Severity::error,
                                {},
                                0,
                                0,
                                fmt::format("two files describe component {}", component.name),
                                {}});
    }
    // Nodes and abstract types share one name space, or `accepts` would be ambiguous.
    eachType([this](TypeSpec& type) {
      const auto [known, isNew] = types_.emplace(type.name, &type);
      if (!isNew)
        model_.error(type.source, fmt::format("{} is defined at {} already", type.name,
                                              place(known->second->source)));
    });
  }

  // Gives a node the field metadata, which every node of X3D has (ISO/IEC 19775-1 7.3.1). Without
  // the abstract type of its values, as in specifications apart from the library's, there is none.
  void addMetadata(TypeSpec& type) {
    constexpr std::string_view values = "metadataObject";
    if (type.isAbstract || !types_.contains(std::string(values)) || findField(type, "metadata"))
      return;
    FieldSpec& field = type.fields.emplace_back();
    field.name = "metadata";
    field.type = FieldType::SFNode;
    field.access = Access::exposedField;
    field.source = field.valueSource = field.changeSource = type.source;
    field.value = NodeRef();
    field.valueText = "NULL";
    field.change = Change::none;
    field.accepts.push_back({std::string(values), type.source});
    field.ofX3d = !type.ofX3d && !type.clause.empty();
    field.text = "Information about the node.";
  }

  const TypeSpec* abstractType(const Reference& reference) {
    const auto found = types_.find(reference.name);
    if (found == types_.end()) {
      model_.error(reference.source, fmt::format("unknown abstract type {}", reference.name));
    } else if (!found->second->isAbstract) {
      model_.error(reference.source,
                   fmt::format("{} is a node, not an abstract type", reference.name));
    } else {
      return found->second;
    }
    return nullptr;
  }

  // Collects all abstract types above a type, nearest first, each once. Breadth-first over the
  // names, because parents are few.
  void resolveRoles(TypeSpec& type) {
    std::vector<const TypeSpec*> ancestors;
    addParents(type, ancestors, true);
    for (size_t i = 0; i < ancestors.size(); ++i) {
      if (ancestors[i] == &type) {
        model_.error(type.source, fmt::format("{} is its own ancestor", type.name));
        type.parents.clear();
        return;
      }
      addParents(*ancestors[i], ancestors, false);
    }
    for (const TypeSpec* ancestor : ancestors) type.roles.push_back(ancestor->name);
  }

  // Appends the parents of a type. Wrong names are reported at the type that uses them, not again
  // for each type derived from it.
  void addParents(const TypeSpec& type, std::vector<const TypeSpec*>& ancestors, bool report) {
    for (const Reference& parent : type.parents) {
      const auto found = types_.find(parent.name);
      const bool usable = found != types_.end() && found->second->isAbstract;
      if (!usable && report) abstractType(parent);
      if (usable && std::find(ancestors.begin(), ancestors.end(), found->second) == ancestors.end())
        ancestors.push_back(found->second);
    }
  }

  void checkFieldNames(const TypeSpec& type) {
    std::map<std::string_view, const FieldSpec*> names;
    for (const FieldSpec& field : type.fields) {
      if (!names.emplace(field.name, &field).second)
        model_.error(field.source, fmt::format("{} has a field {} already", type.name, field.name));
      if (field.name == type.name)
        model_.error(field.source, "a field cannot have the name of its node");
      // An exposedField x is also an eventIn set_x and an eventOut x_changed (clause 4.7).
      if (field.access != Access::exposedField) continue;
      for (const std::string& event : {"set_" + field.name, field.name + "_changed"}) {
        if (const FieldSpec* other = findField(type, event))
          model_.error(other->source,
                       fmt::format("{} is part of the exposedField {} already", event, field.name));
      }
    }
  }

  void checkAbstract(TypeSpec& type) {
    for (FieldSpec& field : type.fields) checkAttributes(type, field);
  }

  void checkNode(TypeSpec& type) {
    for (const std::string& role : type.roles) inherit(type, *types_.at(role));
    for (FieldSpec& field : type.fields) {
      checkAttributes(type, field);
      checkDefault(field);
    }
    if (type.ofX3d && type.clause.empty())
      model_.error(type.source, fmt::format("{} is a node of X3D: its clause of ISO/IEC 19775-1 is "
                                            "missing",
                                            type.name));
  }

  // Copies attributes from an abstract type. A node's specification lists the whole interface, as
  // the standard does; the abstract type describes its fields once.
  void inherit(TypeSpec& type, const TypeSpec& role) {
    for (const FieldSpec& above : role.fields) {
      const auto field = std::find_if(type.fields.begin(), type.fields.end(),
                                      [&](const FieldSpec& f) { return f.name == above.name; });
      if (field == type.fields.end()) {
        model_.error(type.source,
                     fmt::format("{} lacks the {} {} {} of {}", type.name, accessName(above.access),
                                 fieldTypeName(above.type), above.name, role.name));
        continue;
      }
      if (field->type != above.type || field->access != above.access) {
        model_.error(field->source,
                     fmt::format("{} is declared as {} {} {}", role.name, accessName(above.access),
                                 fieldTypeName(above.type), above.name));
      }
      if (field->text.empty()) field->text = above.text;
      if (!field->change) field->change = above.change;
      if (field->accepts.empty()) field->accepts = above.accepts;
      field->urls = field->urls || above.urls;
    }
  }

  void checkAttributes(const TypeSpec& type, FieldSpec& field) {
    if (field.text.empty())
      model_.error(field.source, fmt::format("{} of {} has no description", field.name, type.name));
    if (field.access == Access::eventOut) {
      if (field.change && field.changeSource.line)
        model_.error(field.changeSource, "an eventOut is not written: it changes nothing");
      field.change = Change::none;
    } else if (!field.change) {
      model_.error(field.source,
                   fmt::format("{} of {} does not say what it changes", field.name, type.name));
    }
    const bool holdsNodes = field.type == FieldType::SFNode || field.type == FieldType::MFNode;
    if (holdsNodes && field.accepts.empty())
      model_.error(field.source, fmt::format("{} of {} does not say which nodes it accepts",
                                             field.name, type.name));
    if (!holdsNodes && !field.accepts.empty()) {
      model_.error(field.accepts.front().source,
                   fmt::format("{} is of type {}: it accepts no nodes", field.name,
                               fieldTypeName(field.type)));
    }
    if (field.urls && field.urlsSource.line) checkUrls(field);
    if (field.rare && (type.isAbstract || !field.hasStorage()))
      model_.error(field.rareSource, "only a field or exposedField of a node can be rare");
    if (field.ofX3d && type.ofX3d)
      model_.error(field.ofX3dSource,
                   fmt::format("{} is a node of X3D: all its fields are X3D's", type.name));
    for (const Reference& name : field.accepts) {
      if (!types_.count(name.name) &&
          reported_.insert({*name.source.file, name.source.line, name.source.column}).second)
        model_.error(name.source, fmt::format("unknown node or abstract type {}", name.name));
    }
  }

  void checkRevision(const Revision& revision) {
    const auto found = types_.find(revision.node.name);
    if (found == types_.end() || found->second->isAbstract) {
      model_.error(revision.node.source, fmt::format("there is no node {}", revision.node.name));
      return;
    }
    for (const FieldSpec& field : revision.fields) {
      const FieldSpec* const own = findField(*found->second, field.name);
      if (!own || own->type != field.type || !own->hasStorage() || !field.hasStorage())
        model_.error(field.source, fmt::format("{} has no field {} of type {}", revision.node.name,
                                               field.name, fieldTypeName(field.type)));
      checkDefault(field);
    }
  }

  void checkAbsent(const AbsentNode& one) {
    if (types_.contains(one.node.name))
      model_.error(one.node.source, fmt::format("{} is there: its stanza is at {}", one.node.name,
                                                place(types_.find(one.node.name)->second->source)));
    if (!absent_.insert(one.node.name).second)
      model_.error(one.node.source, fmt::format("{} is listed twice", one.node.name));
  }

  void checkUrls(const FieldSpec& field) {
    if (field.type != FieldType::MFString)
      model_.error(field.urlsSource, fmt::format("{} is of type {}: only an MFString holds URLs",
                                                 field.name, fieldTypeName(field.type)));
    else if (!field.hasStorage())
      model_.error(field.urlsSource, fmt::format("{} is an {}: it has no value that holds URLs",
                                                 field.name, accessName(field.access)));
  }

  void checkDefault(const FieldSpec& field) {
    if (!field.hasStorage() || !field.range) return;
    FieldInfo info;
    info.type = field.type;
    info.range = *field.range;
    if (!inRange(info, field.value))
      model_.error(field.valueSource, fmt::format("default {} of {} is outside {}", field.valueText,
                                                  field.name, field.rangeText));
  }

  Model& model_;
  std::map<std::string, TypeSpec*, std::less<>> types_;
  std::set<std::string> absent_; // nodes that the library does not have
  // Positions of unknown names that were reported, because many nodes may inherit them.
  std::set<std::tuple<std::string, uint32_t, uint32_t>> reported_;
};

} // namespace

void check(Model& model) { Checker(model).run(); }

} // namespace xvrml::nodegen
