// writer.cpp: the walk through a world that is written; see writer.h.
#include "write/writer.h"

#include <stdexcept>

#include <fmt/format.h>

#include "base/rotation.h"
#include "base/x3d.h"
#include "enough_stack.h"
#include "graph/exchange.h"
#include "graph/expander.h"
#include "graph/field_access.h"
#include "xvrml/comments.h"
#include "xvrml/versions.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Nodes nested deeper are refused: the writer is recursive, and no parser reads such a file (its
// own limit is Parser::maximumNesting).
constexpr size_t deepestNode = 2500;

// Returns how many prototypes must be written before a root. They keep their order, because a
// name may be declared again later.
size_t lastPrototypeOf(Node* root,
                       const std::unordered_map<const ProtoDeclaration*, size_t>& prototypes) {
  size_t last = 0;
  if (prototypes.empty()) return last;
  std::vector<Node*> nodes;
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes({root}, nodes, index);
  for (Node* node : nodes) {
    const auto* instance = nodeCast<ProtoInstance>(node);
    const auto found = instance ? prototypes.find(instance->declaration.get()) : prototypes.end();
    if (found != prototypes.end()) last = std::max(last, found->second);
  }
  return last;
}

// version: that of the file that is written.
bool hasOwnValue(const Node& node, const FieldInfo& field, const FileVersion& version) {
  const Value* standard = &defaultIn(node.type(), field, version);
  if (const auto* instance = nodeCast<ProtoInstance>(&node)) {
    // A default of the prototype's file that a program has assigned again stays a default.
    if (instance->isGiven(field) && instance->hasOwnUrlBase(field)) return true;
    if (holdsNodes(field)) return false;
    if (const ProtoPtr& resolved = instance->declaration->resolved) {
      const FieldInfo* declared = resolved->type->find(field.name);
      if (declared && declared->type == field.type) standard = &declared->defaultValue;
    }
  }
  return visitStorage(field.type, node.storage(field), [&](const auto& value) {
    const auto* other = std::get_if<std::remove_cvref_t<decltype(value)>>(standard);
    return !other || !(value == *other);
  });
}

void* storageOf(Value& value) {
  return std::visit([](auto& stored) -> void* { return &stored; }, value);
}

} // namespace

Writer::Writer(const World& world, std::string target, const FileVersion& version)
    : world_(world), version_(version), target_(std::move(target)) {}

std::string Writer::write() {
  writeHead();
  scope(world_.scope);
  writeEnd();
  return std::move(text_);
}

std::string Writer::writeAlone(Node& root) {
  Names names({&root}, {});
  names_ = &names;
  node(&root, "");
  names_ = nullptr;
  text_.erase(0, text_.find_first_not_of(" \n"));
  return std::move(text_);
}

void Writer::line() {
  text_ += '\n';
  text_.append(indent_, ' ');
}

std::string_view Writer::spelled(const NodeType& type, std::string_view field) const {
  return isX3d() && type.index >= 0 ? x3dName(type.name, field, version_.major) : field;
}

void Writer::scope(const Scope& scope) {
  const std::vector<Node*> roots = rootsOf(scope);
  Names names(roots, scope.routes);
  Names* const outer = std::exchange(names_, &names);
  // Routes are written at the end. A route with a repeated name is written as soon as both nodes
  // exist, while the name still refers to them.
  std::vector<const Route*> early, late;
  for (const Route& route : scope.routes) {
    const bool repeated = names.isRepeated(route.from.get()) || names.isRepeated(route.to.get());
    (repeated ? early : late).push_back(&route);
  }
  std::unordered_map<const ProtoDeclaration*, size_t> prototypes;
  for (size_t i = 0; i < scope.prototypes.size(); ++i)
    prototypes.emplace(scope.prototypes[i].get(), i + 1);
  size_t declared = 0;
  for (Node* root : roots) {
    const size_t needed = lastPrototypeOf(root, prototypes);
    for (; declared < needed; ++declared) prototype(*scope.prototypes[declared]);
    line();
    node(root, "");
    std::erase_if(early, [&](const Route* written) { return route(*written); });
  }
  for (; declared < scope.prototypes.size(); ++declared) prototype(*scope.prototypes[declared]);
  for (const Route* written : late) route(*written);
  if (&scope == &world_.scope && isX3d()) exchange();
  names_ = outer;
}

// Writes what the world's file imports, the routes to it, and what it exports.
void Writer::exchange() {
  const std::shared_ptr<Exchange> all = exchangeOf(world_);
  if (!all) return;
  const auto nameOf = [&](const Node* node) {
    return node && names_->isWritten(node) ? names_->find(node) : nullptr;
  };
  for (const Exchange::Import& one : all->imports) {
    const std::string* const name = nameOf(one.inlineNode.get());
    if (!name) continue;
    line();
    writeImport(*name, nameText(one.exported), nameText(one.local));
  }
  const auto end = [&](const Exchange::End& one, std::string& name, std::string& field) {
    field = one.node && one.node->type().index >= 0
                ? x3dName(one.node->type().name, ownName(one.node->type().name, one.field),
                          version_.major)
                : one.field;
    const Node* const node = one.node ? one.node.get() : all->imports[one.import].inlineNode.get();
    const std::string* const own = nameOf(node);
    if (own) name = one.node ? *own : nameText(all->imports[one.import].local);
    return own != nullptr;
  };
  for (const Exchange::ImportedRoute& one : all->routes) {
    RouteText route;
    if (!end(one.from, route.from, route.fromField) || !end(one.to, route.to, route.toField))
      continue;
    line();
    writeRoute(route);
  }
  for (const Exchange::Export& one : all->exports) {
    const std::string* const name = nameOf(one.node.get());
    if (!name) continue;
    line();
    writeExport(*name, nameText(one.exported));
  }
}

// Writes a route. Returns false if one of its nodes has not been written yet.
bool Writer::route(const Route& route) {
  const Node *from = route.from.get(), *to = route.to.get();
  if (!names_->isWritten(from) || !names_->isWritten(to)) return false;
  line();
  writeRoute({*names_->find(from), std::string(spelled(from->type(), route.fromField)),
              *names_->find(to), std::string(spelled(to->type(), route.toField))});
  return true;
}

void Writer::node(Node* node, std::string_view place) {
  if (!node) {
    writeNull();
    return;
  }
  const std::string* name = names_->find(node);
  if (!names_->begin(node)) {
    writeUse(*node, *name, place);
    return;
  }
  if (++depth_ > deepestNode)
    throw std::length_error(fmt::format("the world cannot be written: nodes are nested more than "
                                        "{} deep, and no program could read the file",
                                        deepestNode));
  Content content = contentOf(*node, name);
  for (const IsConnection* connection : connectionsOf(*node))
    if (!node->type().find(connection->field))
      content.events.emplace_back(spelled(node->type(), connection->field),
                                  connection->interfaceName);
  writeNode(content, place);
  --depth_;
}

Writer::Content Writer::contentOf(Node& node, const std::string* name) const {
  Content content{&node, name, {}, {}};
  for (const FieldInfo& info : node.type().fields) {
    Field field = fieldOf(node, info);
    if (field.value || field.declared || !field.interfaces.empty())
      content.fields.push_back(std::move(field));
  }
  return content;
}

Writer::Field Writer::fieldOf(Node& node, const FieldInfo& info) const {
  Field field{&info, info.declared, nullptr, nullptr, {}};
  for (const IsConnection* connection : connectionsOf(node))
    if (connection->field == info.name) field.interfaces.push_back(connection->interfaceName);
  const bool value = holdsValue(info) && (field.declared ? field.interfaces.empty()
                                                         : hasOwnValue(node, info, version_));
  if (!value) return field;
  field.value = std::as_const(node).storage(info);
  if (hasNormalizedAxes(info)) { // a program may have written to the struct
    field.changed = std::make_shared<Value>(visitStorage(
        info.type, node.storage(info), [](const auto& stored) -> Value { return stored; }));
    field.value = storageOf(*field.changed);
    normalizeAxes(info.type, storageOf(*field.changed));
  } else if (const auto& base = urlBase(node, info);
             base && !target_.empty() && holdsUrls(node, info)) {
    setUrls(field, *static_cast<const MFString*>(node.storage(info)), *base);
  }
  return field;
}

void Writer::setUrls(Field& field, MFString urls, const std::string& base) const {
  rebaseUrls(urls, base, target_);
  field.changed = std::make_shared<Value>(std::move(urls));
  field.value = storageOf(*field.changed);
}

std::span<const IsConnection* const> Writer::connectionsOf(const Node& node) const {
  if (!connections_) return {};
  const auto found = connections_->find(&node);
  return found == connections_->end() ? std::span<const IsConnection* const>() : found->second;
}

void Writer::declaration(const ProtoDeclaration& declaration, const FieldInfo& info) {
  Field field{&info, true, nullptr, nullptr, {}};
  if (declaration.isExtern || !holdsValue(info)) {
    writeDeclaration(field);
    return;
  }
  if (!target_.empty() && declaration.holdsUrls(info)) {
    setUrls(field, std::get<MFString>(info.defaultValue), declaration.baseUrl);
  } else {
    field.changed = std::make_shared<Value>(info.defaultValue); // nodes are shared, not copied
    field.value = storageOf(*field.changed);
  }
  std::vector<Node*> roots;
  if (auto* single = std::get_if<NodeRef>(field.changed.get())) roots.push_back(single->get());
  if (auto* many = std::get_if<MFNode>(field.changed.get())) {
    for (const NodeRef& node : *many) roots.push_back(node.get());
  }
  Names names(roots, {});
  Names* const outer = std::exchange(names_, &names);
  writeDeclaration(field);
  names_ = outer;
}

void Writer::prototype(const ProtoDeclaration& declared) {
  MFString urls = declared.urls;
  if (declared.isExtern && !target_.empty()) rebaseUrls(urls, declared.baseUrl, target_);
  line();
  openPrototype(nameText(declared.type->name), declared.isExtern ? &urls : nullptr);
  const Connections* const outer = std::exchange(connections_, nullptr);
  for (const FieldInfo& info : declared.type->fields) declaration(declared, info);
  if (!declared.isExtern) {
    Connections connections;
    for (const IsConnection& connection : declared.is)
      connections[connection.node.get()].push_back(&connection);
    connections_ = &connections;
    openBody();
    scope(declared.body);
    connections_ = nullptr;
  }
  connections_ = outer;
  closePrototype(declared.isExtern ? &urls : nullptr);
}

std::vector<std::string> commentsOf(const World& world, std::string& header) {
  constexpr std::string_view vrml = "VRML V2.0 utf8";
  std::string_view rest = openingComments(world);
  std::vector<std::string> lines;
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    lines.emplace_back(one);
    std::erase(lines.back(), '\r');
  }
  header.clear();
  if (lines.empty() || !(lines[0].starts_with("VRML") || lines[0].starts_with("X3D V")))
    return lines;
  if (lines[0].starts_with(vrml)) header = lines[0].substr(vrml.size());
  lines.erase(lines.begin());
  return lines;
}

std::vector<FileHead::Unit> unitsOf(const FileHead& head) {
  std::vector<FileHead::Unit> units = head.units;
  std::erase_if(units, [](const FileHead::Unit& one) { return one.category == "angle"; });
  return units;
}

std::string profileOf(const FileHead& head) {
  return head.profile.empty() ? "Immersive" : nameText(head.profile);
}

Encoding writtenEncoding(std::string_view path) {
  std::string suffix(path.substr(std::min(path.rfind('.'), path.size())));
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c + 32);
  if (suffix == ".x3dv") return Encoding::x3dClassic;
  if (suffix == ".x3dj" || suffix == ".json") return Encoding::x3dJson;
  return suffix == ".x3d" ? Encoding::x3dXml : Encoding::vrml97;
}

std::string writeWorld(const World& world) { return writeWorld(world, ""); }

std::string writeWorld(const World& world, const std::string& path) {
  return writeWorld(world, path, writtenEncoding(path));
}

FileVersion writtenVersion(const World& world, Encoding encoding) {
  const FileVersion& own = world.head.version;
  if (encoding == Encoding::vrml97) return {encoding, 2, 0};
  // version 3.3 is what most programs read
  return {encoding, own.isX3d() ? own.major : 3, own.isX3d() ? own.minor : 3};
}

namespace {

// Calls `write` with the writer for an encoding, on a stack that is deep enough.
template <class Write> std::string writeAs(const World& world, const std::string& path,
                                           Encoding encoding, const Write& write) {
  constexpr size_t deepestStack = size_t(6) << 20; // bytes; a level uses about 1 kB
  const FileVersion version = writtenVersion(world, encoding);
  return onStackOf(deepestStack, [&] {
    if (encoding == Encoding::vrml97 || encoding == Encoding::x3dClassic)
      return write(*makeVrmlWriter(world, path, version));
    if (encoding == Encoding::x3dXml) return write(*makeXmlWriter(world, path, version));
    if (encoding == Encoding::x3dJson) return write(*makeJsonWriter(world, path, version));
    throw std::invalid_argument(
        fmt::format("worlds cannot be written as {}", encodingName(encoding)));
  });
}

} // namespace

std::string writeWorld(const World& world, const std::string& path, Encoding encoding) {
  return writeAs(world, path, encoding, [](Writer& writer) { return writer.write(); });
}

std::string writeNode(const World& world, Node& node, Encoding encoding) {
  return writeAs(world, "", encoding, [&](Writer& writer) { return writer.writeAlone(node); });
}

} // namespace xvrml
