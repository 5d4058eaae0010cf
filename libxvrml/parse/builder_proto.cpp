// builder_proto.cpp: PROTO and EXTERNPROTO declarations (ISO/IEC 14772-1 4.8, 4.9), and the fields
// that nodes declare: Scripts (6.40) and shaders.
#include <utility>

#include <fmt/format.h>

#include "graph/field_access.h"
#include "graph/inline_node.h"
#include "parse/builder.h"

namespace xvrml {
namespace {

// Fills in what a field is for the node that declares it. A field of a shader is one of its
// parameters. Whether a field of a Script holds URLs, its name `...Url` says. There is no other way
// to know, if no field beside it IS the same one: the Script's program alone decides what it does
// with the strings.
void describeDeclared(const NodeType& type, FieldInfo& field) {
  const bool isShader = type.is("shader"), strings = field.type == FieldType::MFString;
  field.declared = true;
  field.holdsUrls = strings && holdsValue(field) && (isShader || field.name.ends_with("Url"));
  if (!isShader) return;
  field.change = Change::shader;
  if (field.type == FieldType::SFNode || field.type == FieldType::MFNode)
    field.nodeTypes = "texture";
}

} // namespace

// Returns the prototype with this name. A name is valid from the end of its declaration to the end
// of the enclosing scope, prototypes within it included.
ProtoPtr Builder::findPrototype(std::string_view name) const {
  for (auto frame = scopes_.rbegin(); frame != scopes_.rend(); ++frame) {
    const auto found = frame->types.find(name);
    if (found != frame->types.end()) return found->second;
  }
  return nullptr;
}

bool Builder::isBeingDeclared(std::string_view name) const {
  return std::any_of(scopes_.begin(), scopes_.end(), [&](const ScopeFrame& frame) {
    return frame.protoType && frame.protoType->name == name;
  });
}

// Returns the type that gets interface declarations: that of the innermost open node, if it
// declares fields, or prototype.
NodeType& Builder::declaringType() {
  if (!declaresFields()) return *scope().protoType;
  NodeFrame& frame = nodes_.back();
  if (!frame.ownType) {
    frame.ownType = makeOwnType(frame.node->type());
    static_cast<DeclaringNode&>(*frame.node).setOwnType(frame.ownType);
  }
  return *frame.ownType;
}

// Reports a declaration that a node of the type should not have. Returns false if it is left out.
bool Builder::mayDeclare(const NodeType& type, Access access, const Name& name) {
  const bool hasValue = access == Access::field || access == Access::exposedField;
  if (type.is("shader")) {
    if (!hasValue)
      locator_.error(name.at,
                     fmt::format("{0} declares its parameters as {1} or {2}, not as {3}: {4} is "
                                 "left out ({2} x has the events set_x and x_changed)",
                                 type.name, word(Access::field), word(Access::exposedField),
                                 word(access), describe(name)));
    return hasValue;
  }
  if (access == Access::exposedField && !isX3d())
    locator_.error(name.at, fmt::format("a Script declares field, eventIn and eventOut, not "
                                        "exposedField (6.40): {} works as in X3D, but other "
                                        "browsers refuse it",
                                        describe(name)));
  return true;
}

// Reports a declaration whose name is taken. An exposedField x also occupies set_x and x_changed
// (4.7). Some exporters declare these as well; that is only a warning if the types agree.
bool Builder::declarationConflicts(const NodeType& type, const FieldInfo& field, const Name& name) {
  const auto report = [&] {
    locator_.error(name.at, fmt::format("{} is declared already in the interface of {} (4.7)",
                                        describe(name), type.name));
    return true;
  };
  if (type.find(field.name)) return report();
  const FieldInfo* implied = nullptr;
  const auto imply = [&](const std::string& other, bool wanted) {
    const FieldInfo* found = type.find(other);
    if (found && wanted && !implied) implied = found;
  };
  const auto exposed = [&](const std::string& other) {
    const FieldInfo* found = type.find(other);
    return found && found->access == Access::exposedField;
  };
  const std::string& text = field.name;
  imply("set_" + text, field.access == Access::exposedField);
  imply(text + "_changed", field.access == Access::exposedField);
  if (text.starts_with("set_"))
    imply(text.substr(4), field.access == Access::eventIn && exposed(text.substr(4)));
  if (text.ends_with("_changed")) {
    const std::string stem = text.substr(0, text.size() - 8);
    imply(stem, field.access == Access::eventOut && exposed(stem));
  }
  if (!implied) return false;
  if (implied->type != field.type) return report();
  locator_.warn(name.at, fmt::format("{} and {} of {} declare the same event twice (4.7)",
                                     describe(name), implied->name, type.name));
  return false;
}

FieldTarget Builder::openDeclaration(Access access, FieldType type, const Name& name,
                                     bool hasValue) {
  const bool inNode = declaresFields();
  NodeType& target = declaringType();
  Declaration& declaration = declarations_.emplace_back();
  declaration.at = name.at;
  declaration.hasValue = hasValue;
  declaration.scoped = false;
  FieldInfo& field = declaration.field;
  field.name = name.text;
  field.type = type;
  field.access = access;
  field.change = Change::none;
  if (inNode) describeDeclared(target, field);
  field.offset = 0;
  field.defaultValue = defaultValue(type);
  // A Script of VRML97 may declare a field of that name, which X3D gives to every node.
  if (inNode && isVrml97() && field.name == "metadata")
    std::erase_if(target.fields, [](const FieldInfo& own) { return own.isMetadata; });
  const uint64_t limit = state_.options.limits.interfaceFields;
  declaration.accepted = target.fields.size() < limit;
  if (!declaration.accepted && std::exchange(fullInterface_, &target) != &target)
    locator_.error(
        name.at,
        fmt::format("{} declares more than limit interfaceFields={}; those from {} on are left out",
                    target.name, limit, describe(name)));
  declaration.accepted = declaration.accepted && !declarationConflicts(target, field, name) &&
                         (!inNode || mayDeclare(target, access, name));
  if (declaration.accepted) declaration.accepted = reserveMemory(bytesOfDeclaration, name);
  void* storage = std::visit([](auto& value) -> void* { return &value; }, field.defaultValue);
  const bool nodeValue = type == FieldType::SFNode || type == FieldType::MFNode;
  const auto kind =
      type == FieldType::SFNode ? NodeTarget::Kind::single : NodeTarget::Kind::multiple;
  if (inNode) {
    Node& node = *nodes_.back().node;
    if (declaration.accepted) {
      // A reference to an element of the type's fields.
      const FieldInfo* added = &addField(target, field);
      if (holdsValue(*added)) {
        declaredValues(node).push_back(defaultValue(type));
        storage = node.storage(*added);
        if (node.type().index >= 0)
          static_cast<DeclaringNode&>(node).places.push_back(locator_.place(name.at));
      }
    }
    if (hasValue && nodeValue) nodeTargets_.push_back({kind, storage, &field, &node});
  } else if (hasValue && nodeValue) {
    declaration.scoped = true;
    pushScope(nullptr, nullptr, nullptr);
    nodeTargets_.push_back({kind, storage, nullptr, nullptr});
  }
  return {true, type, storage};
}

void Builder::closeDeclaration(bool good) {
  Declaration declaration = std::move(declarations_.back());
  declarations_.pop_back();
  const bool nodeValue =
      declaration.field.type == FieldType::SFNode || declaration.field.type == FieldType::MFNode;
  if (declaration.hasValue && nodeValue) nodeTargets_.pop_back();
  if (declaration.scoped) {
    // Prototypes declared within a default value live as long as the enclosing declaration. Their
    // names are known only inside the value.
    std::vector<ProtoPtr> local = std::move(scope().scope->prototypes);
    popScope();
    std::vector<ProtoPtr>& outer = scopes_[scopes_.size() - 2].scope->prototypes;
    outer.insert(outer.end(), local.begin(), local.end());
  }
  if (!good && declaration.hasValue && !nodeValue) { // the rest of the interface is as declared
    Node* const node = declaresFields() ? nodes_.back().node.get() : nullptr;
    const FieldInfo* const own =
        node && declaration.accepted ? node->type().find(declaration.field.name) : nullptr;
    if (own) node->set(*own, defaultValue(own->type));
    declaration.field.defaultValue = defaultValue(declaration.field.type);
  }
  const bool rotation = declaration.field.type == FieldType::SFRotation ||
                        declaration.field.type == FieldType::MFRotation;
  if (angle_ != 1 && rotation && declaration.hasValue && good) {
    Node* const node = declaresFields() ? nodes_.back().node.get() : nullptr;
    const FieldInfo* const own = node ? node->type().find(declaration.field.name) : nullptr;
    if (own && own->type == declaration.field.type && declaration.accepted)
      convertAngles(own->type, node->storage(*own));
    else if (!node)
      convertAngles(declaration.field.type, std::visit([](auto& value) -> void* { return &value; },
                                                       declaration.field.defaultValue));
  }
  if ((good || !nodeValue) && declaration.accepted && !declaresFields())
    addField(*scope().protoType, std::move(declaration.field));
}

void Builder::openProto(const Name& name) {
  reserveMemory(bytesOfPrototype, name);
  auto proto = std::make_shared<ProtoDeclaration>();
  auto type = std::make_shared<NodeType>();
  type->name = name.text;
  type->index = ProtoInstance::typeIndex;
  type->create = nullptr;
  proto->type = type;
  proto->source = locator_.place(name.at);
  if (proto->source.file) proto->baseUrl = *proto->source.file;
  Scope* body = &proto->body;
  pushScope(body, std::move(proto), std::move(type));
}

void Builder::openProtoBody() {}

void Builder::closeProto(bool good) {
  const ProtoPtr proto = scope().proto;
  const std::shared_ptr<NodeType> type = scope().protoType;
  popScope();
  if (!good) return;
  if (angle_ != 1 && !proto->isExtern) {
    const NodeRef instance(new ProtoInstance(type, proto));
    for (FieldInfo& field : type->fields)
      if ((field.type == FieldType::SFFloat || field.type == FieldType::MFFloat) &&
          isAngle(*instance, field))
        convertAngles(field.type,
                      std::visit([](auto& value) -> void* { return &value; }, field.defaultValue));
  }
  if (!proto->isExtern && proto->body.roots.empty()) {
    state_.diagnostics.warn(
        proto->source,
        fmt::format("the body of prototype '{}' has no node (4.8.3)", proto->type->name));
  }
  scope().scope->prototypes.push_back(proto);
  // The key is a view of the type's own name, which lives as long as the frame's pointer to the
  // type.
  scope().types.erase(proto->type->name);
  scope().types.emplace(proto->type->name, proto);
}

void Builder::openExternProto(const Name& name) {
  openProto(name);
  scope().proto->isExtern = true;
}

std::vector<std::string>& Builder::externUrls() { return scope().proto->urls; }

void Builder::closeExternProto(bool good) { closeProto(good); }

} // namespace xvrml
