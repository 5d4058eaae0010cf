// x3d_elements.cpp: the structure of a file: its head, statements and prototypes. Nodes are in
// x3d_element_nodes.cpp.
#include "parse/x3d_elements.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "base/x3d.h"
#include "lower_case.h"
#include "parse/parser.h"

namespace xvrml {
namespace {

constexpr std::string_view statements[] = {
    "X3D",       "head",         "meta",       "component",     "unit",
    "Scene",     "ProtoDeclare", "IS",         "ProtoInstance", "ExternProtoDeclare",
    "ProtoBody", "ROUTE",        "fieldValue", "field",         "ProtoInterface",
    "connect",   "IMPORT",       "EXPORT"};

} // namespace

X3dElements::X3dElements(Locator& locator, const Limits& limits, ParseSink& sink, Budget* budget,
                         bool isFragment)
    : locator_(locator), limits_(limits), sink_(sink), values_(locator, limits, budget),
      nesting_(std::min(limits.nesting, Parser::maximumNesting)), isFragment_(isFragment) {
  push(Kind::file, {});
  for (const std::string_view name : statements) lowerCase_.emplace(lowerCase(name), name);
  for (const NodeType* type : nodeTypes()) lowerCase_.emplace(lowerCase(type->name), type->name);
}

// Returns a text that lives as long as the sink: the file's own bytes or a copy.
std::string_view X3dElements::keep(std::string_view text) {
  constexpr std::less<const char*> before;
  const std::string_view file = locator_.text();
  if (!before(text.data(), file.data()) && !before(file.data() + file.size(), text.data()))
    return text;
  return *kept_.emplace(text).first;
}

// Returns the name of an element without its prefix. Pages of HTML have names in lower case.
Name X3dElements::canonical(const Name& element) {
  const std::string_view name = element.text.substr(element.text.rfind(':') + 1);
  const bool known =
      std::find(std::begin(statements), std::end(statements), name) != std::end(statements) ||
      sink_.typeNamed(name);
  if (!known)
    if (const auto found = lowerCase_.find(lowerCase(name)); found != lowerCase_.end())
      return {found->second, element.at};
  return {keep(name), element.at};
}

void X3dElements::open(const Name& written, Attributes attributes) {
  locator_.setAnchor(written.at);
  if (skipped_ > 0) return skip(attributes);
  const Name element = canonical(written);
  switch (top().kind) {
  case Kind::file: return openRoot(element, attributes);
  case Kind::x3d: return openInX3d(element, attributes);
  case Kind::head: return openInHead(element, attributes);
  case Kind::proto: return openInProto(element, attributes);
  case Kind::interface:
  case Kind::externProto: return openInInterface(element, attributes);
  case Kind::connections:
    if (element.text == "connect") return connect(element, attributes);
    return refuse(element, "connect", attributes);
  case Kind::text:
  case Kind::leaf: return refuse(element, "no element", attributes);
  case Kind::statements:
  case Kind::node:
  case Kind::declaration:
  case Kind::value: return openStatement(element, attributes);
  }
}

void X3dElements::characters(std::string_view text, const char* at) {
  if (skipped_ > 0) return;
  Frame& frame = top();
  const bool isValue = frame.kind == Kind::text;
  if (frame.hasProgram || isValue) {
    const std::string_view rest = trimmed(text);
    if (frame.sourceAt == nullptr && rest.empty()) return;
    if (frame.sourceAt == nullptr) {
      const size_t blanks = static_cast<size_t>(rest.data() - text.data());
      frame.sourceAt = at + blanks;
      text.remove_prefix(blanks);
    }
    if (frame.good && (isValue || frame.source.size() + text.size() <= limits_.stringBytes)) {
      frame.good = values_.reserve(at, text.size());
      if (frame.good) frame.source += text;
    } else if (frame.good) {
      locator_.error(at, fmt::format("the text of a Script has more bytes than limit "
                                     "stringBytes={}; it is left out",
                                     limits_.stringBytes));
      frame.good = false;
    }
    return;
  }
  if (saidText_ || frame.kind == Kind::head || frame.kind == Kind::leaf || trimmed(text).empty())
    return;
  saidText_ = true;
  locator_.warn(at, fmt::format("text in {} is left out here and below: only a Script has text",
                                frame.kind == Kind::file ? "the file" : frame.element.text));
}

// Leaves out an element and all that it holds. Uses of the names in it are not reported again.
void X3dElements::skip(Attributes attributes) {
  ++skipped_;
  if (const Attribute* def = findAttribute(attributes, "DEF"); def && !trimmed(def->value).empty())
    sink_.lostName({keep(trimmed(def->value)), def->at});
}

void X3dElements::refuse(const Name& element, std::string_view expected, Attributes attributes) {
  const std::string place =
      top().kind == Kind::file ? "" : fmt::format(" in {}", top().element.text);
  locator_.error(element.at, fmt::format("expected {}{}, found the element {}: it is left out",
                                         expected, place, describe(element)));
  skip(attributes);
}

bool X3dElements::tooDeep(const Name& element, std::string_view what) {
  if (depth_ < nesting_) return false;
  locator_.error(element.at,
                 fmt::format("{} nested deeper than limit nesting={}{}; {} is left out", what,
                             nesting_,
                             nesting_ == Parser::maximumNesting ? " (the most there can be)" : "",
                             describe(element)));
  return true;
}

// Returns whether a name can be written in every encoding.
bool X3dElements::checkName(const Name& name) {
  const bool good =
      !name.text.empty() && std::none_of(name.text.begin(), name.text.end(), [](unsigned char c) {
        return c < 0x20 || c == 0x7f || isVrmlSeparator(static_cast<char>(c));
      });
  if (!good)
    locator_.error(name.at, name.text.empty()
                                ? "expected a name, found an empty text"
                                : fmt::format("{} is not a name: it has white space, a bracket, a "
                                              "quote or #",
                                              describe(name)));
  return good;
}

// Checks a name that may begin a line of ClassicVRML: that of a prototype or of a field that a file
// declares. Words of the grammar cannot be names there.
bool X3dElements::checkDeclaredName(const Name& name) {
  constexpr std::string_view words[] = {
      "DEF",          "EXTERNPROTO", "FALSE",          "IS",        "NULL",        "PROTO",
      "ROUTE",        "TO",          "TRUE",           "USE",       "eventIn",     "eventOut",
      "exposedField", "field",       "initializeOnly", "inputOnly", "inputOutput", "outputOnly",
      "PROFILE",      "COMPONENT",   "META",           "UNIT",      "IMPORT",      "EXPORT"};
  const bool good = std::find(std::begin(words), std::end(words), name.text) == std::end(words);
  if (!good)
    locator_.error(name.at,
                   fmt::format("{} is a word of the ClassicVRML encoding: it cannot be the "
                               "name of a field or prototype",
                               describe(name)));
  return good;
}

// Reads the name in an attribute that an element must have. Returns false after a message.
bool X3dElements::nameOf(Name& out, const Name& element, Attributes attributes,
                         std::string_view attribute) {
  const Attribute* const found = findAttribute(attributes, attribute);
  if (!found) {
    locator_.error(element.at, fmt::format("{} has no {}", element.text, attribute));
    return false;
  }
  out = {keep(trimmed(found->value)), found->at};
  return checkName(out);
}

void X3dElements::openRoot(const Name& element, Attributes attributes) {
  if (element.text == "X3D") return openX3d(element, attributes);
  if (isFragment_ && element.text != "Scene") {
    top().kind = Kind::statements;
    sawScene_ = true;
    return openStatement(element, attributes);
  }
  if (element.text != "Scene") return refuse(element, "X3D", attributes);
  locator_.warn(element.at, "there is no X3D around this Scene");
  sawScene_ = true;
  push(Kind::statements, element);
}

void X3dElements::openX3d(const Name& element, Attributes attributes) {
  if (const Attribute* version = findAttribute(attributes, "version")) {
    const std::string_view text = trimmed(version->value);
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const bool good = text.size() == 3 && digit(text[0]) && text[1] == '.' && digit(text[2]);
    int major = good ? text[0] - '0' : 3, minor = good ? text[2] - '0' : 0;
    if (!good || major < 3 || major > 4) {
      major = major > 4 ? 4 : 3;
      minor = 0;
      locator_.warn(version->at,
                    fmt::format("X3D '{}' is not known; read as X3D {}.0", shortened(text), major));
    }
    sink_.version(major, minor);
  } else {
    locator_.warn(element.at, "X3D has no version; read as X3D 3.3");
  }
  Name profile;
  if (findAttribute(attributes, "profile") && nameOf(profile, element, attributes, "profile"))
    sink_.profile(profile);
  push(Kind::x3d, element);
}

void X3dElements::openInX3d(const Name& element, Attributes attributes) {
  if (element.text == "Header") // its name in drafts of the standard
    locator_.warn(element.at, "X3D has no Header: read as head");
  if (element.text == "head" || element.text == "Header") return push(Kind::head, element);
  if (element.text != "Scene") return refuse(element, "head or Scene", attributes);
  sawScene_ = true;
  push(Kind::statements, element);
}

void X3dElements::openInHead(const Name& element, Attributes attributes) {
  if (element.text == "meta") {
    const Attribute* const name = findAttribute(attributes, "name");
    const Attribute* const content = findAttribute(attributes, "content");
    // Pages have others, like http-equiv, which say nothing about the world.
    if (name)
      sink_.meta(element, withBlanks(name->value), content ? withBlanks(content->value) : "");
  } else if (element.text == "component") {
    readComponent(element, attributes);
  } else if (element.text == "unit") {
    readUnit(element, attributes);
  } else {
    return refuse(element, "meta, component or unit", attributes);
  }
  push(Kind::leaf, element);
}

void X3dElements::readComponent(const Name& element, Attributes attributes) {
  Name name;
  if (!nameOf(name, element, attributes, "name")) return;
  int32_t level = 1;
  const Attribute* const written = findAttribute(attributes, "level");
  const FieldTarget target{true, FieldType::SFInt32, &level};
  if (!written || values_.read(target, *written)) sink_.component(name, level);
}

void X3dElements::readUnit(const Name& element, Attributes attributes) {
  Name category, name;
  if (!nameOf(category, element, attributes, "category") ||
      !nameOf(name, element, attributes, "name"))
    return;
  double factor = 1;
  const Attribute* const written = findAttribute(attributes, "conversionFactor");
  const FieldTarget target{true, FieldType::SFTime, &factor};
  if (!written || values_.read(target, *written)) sink_.unit(category, name, factor);
}

// A statement or a node. Only nodes may stand in the value of a field.
void X3dElements::openStatement(const Name& element, Attributes attributes) {
  struct Row {
    std::string_view name;
    bool inNodesOnly;
    Handler handler;
  };
  static constexpr Row rows[] = {{"ROUTE", false, &X3dElements::route},
                                 {"ProtoDeclare", false, &X3dElements::openProto},
                                 {"ExternProtoDeclare", false, &X3dElements::openExternProto},
                                 {"IMPORT", false, &X3dElements::import},
                                 {"EXPORT", false, &X3dElements::exportNode},
                                 {"fieldValue", true, &X3dElements::openFieldValue},
                                 {"field", true, &X3dElements::openDeclaration},
                                 {"IS", true, nullptr}};
  const Kind kind = top().kind;
  const auto row = std::find_if(std::begin(rows), std::end(rows),
                                [&](const Row& one) { return one.name == element.text; });
  if (row == std::end(rows)) {
    const bool other = element.text != "ProtoInstance" &&
                       std::find(std::begin(statements), std::end(statements), element.text) !=
                           std::end(statements);
    if (other || (kind == Kind::declaration && !top().holdsNodes))
      return refuse(element, other ? "a node" : "no element", attributes);
    return openNode(element, attributes);
  }
  if (kind == Kind::declaration || kind == Kind::value || (row->inNodesOnly && kind != Kind::node))
    return refuse(element, "a node", attributes);
  if (row->inNodesOnly) leaveField();
  if (row->handler) return (this->*row->handler)(element, attributes);
  push(element.text == "IS" ? Kind::connections : Kind::leaf, element);
}

void X3dElements::route(const Name& element, Attributes attributes) {
  ParseSink::RouteNames names;
  if (nameOf(names.from, element, attributes, "fromNode") &&
      nameOf(names.fromField, element, attributes, "fromField") &&
      nameOf(names.to, element, attributes, "toNode") &&
      nameOf(names.toField, element, attributes, "toField"))
    sink_.route(element, names);
  push(Kind::leaf, element);
}

// IMPORT inlineDEF importedDEF AS. X3D 3.0 said exportedDEF.
void X3dElements::import(const Name& element, Attributes attributes) {
  const bool old = !findAttribute(attributes, "importedDEF");
  ParseSink::ImportNames names;
  const bool good =
      nameOf(names.inlineName, element, attributes, "inlineDEF") &&
      nameOf(names.exported, element, attributes,
             old && findAttribute(attributes, "exportedDEF") ? "exportedDEF" : "importedDEF");
  names.local = names.exported;
  if (good && (!findAttribute(attributes, "AS") || nameOf(names.local, element, attributes, "AS")))
    sink_.importNode(element, names);
  push(Kind::leaf, element);
}

// EXPORT localDEF AS
void X3dElements::exportNode(const Name& element, Attributes attributes) {
  Name node, exported;
  if (nameOf(node, element, attributes, "localDEF")) {
    exported = node;
    if (!findAttribute(attributes, "AS") || nameOf(exported, element, attributes, "AS"))
      sink_.exportNode(node, exported);
  }
  push(Kind::leaf, element);
}

void X3dElements::openProto(const Name& element, Attributes attributes) {
  Name name;
  if (tooDeep(element, "prototypes") || !nameOf(name, element, attributes, "name") ||
      !checkDeclaredName(name))
    return skip(attributes);
  ++depth_;
  sink_.openProto(name);
  push(Kind::proto, element);
}

void X3dElements::openExternProto(const Name& element, Attributes attributes) {
  Name name;
  if (tooDeep(element, "prototypes") || !nameOf(name, element, attributes, "name") ||
      !checkDeclaredName(name))
    return skip(attributes);
  ++depth_;
  sink_.openExternProto(name);
  push(Kind::externProto, element);
  const FieldTarget target{true, FieldType::MFString, &sink_.externUrls()};
  if (const Attribute* url = findAttribute(attributes, "url"))
    top().good = values_.read(target, *url);
  if (!top().good) sink_.lostName(name);
}

void X3dElements::openInProto(const Name& element, Attributes attributes) {
  if (element.text == "ProtoInterface") return push(Kind::interface, element);
  if (element.text != "ProtoBody")
    return refuse(element, "ProtoInterface or ProtoBody", attributes);
  sink_.openProtoBody();
  push(Kind::statements, element);
}

void X3dElements::openInInterface(const Name& element, Attributes attributes) {
  if (element.text != "field") return refuse(element, "field", attributes);
  openDeclaration(element, attributes);
}

// Reads what a word says about an access. Returns false, after a message, for other words.
bool X3dElements::readAccess(const Attribute& attribute, Access& access) {
  const Name word{trimmed(attribute.value), attribute.at};
  for (const Access one :
       {Access::field, Access::exposedField, Access::eventIn, Access::eventOut}) {
    if (word.text != x3dAccessName(one) && word.text != accessName(one)) continue;
    access = one;
    if (word.text == accessName(one))
      locator_.warn(word.at, fmt::format("{} is VRML97's word: X3D writes {}", describe(word),
                                         x3dAccessName(one)));
    return true;
  }
  locator_.error(word.at,
                 fmt::format("expected inputOnly, outputOnly, initializeOnly or inputOutput, found "
                             "{}",
                             describe(word)));
  return false;
}

void X3dElements::openDeclaration(const Name& element, Attributes attributes) {
  const bool inNode = top().kind == Kind::node;
  const bool isExtern = top().kind == Kind::externProto;
  if (inNode && !sink_.declaresFields()) return refuse(element, "a node", attributes);
  const Attribute* const word = findAttribute(attributes, "accessType");
  const Attribute* const typeName = findAttribute(attributes, "type");
  Name name;
  if (!nameOf(name, element, attributes, "name") || !checkDeclaredName(name))
    return skip(attributes);
  if (!word || !typeName) {
    locator_.error(element.at, fmt::format("the field {} has no {}", describe(name),
                                           word ? "type" : "accessType"));
    return skip(attributes);
  }
  Access access{};
  if (!readAccess(*word, access)) return skip(attributes);
  FieldType type{};
  const Name named{trimmed(typeName->value), typeName->at};
  if (!fieldTypeFromName(named.text, type)) {
    locator_.error(named.at, fmt::format("expected a field type, found {}", describe(named)));
    return skip(attributes);
  }
  const bool hasValue = !isExtern && (access == Access::field || access == Access::exposedField);
  const FieldTarget target = sink_.openDeclaration(access, type, name, hasValue);
  push(Kind::declaration, element);
  top().holdsNodes = hasValue && (type == FieldType::SFNode || type == FieldType::MFNode);
  top().isList = type == FieldType::MFNode;
  const Attribute* const value = findAttribute(attributes, "value");
  if (!value || !hasValue) return;
  if (!top().holdsNodes)
    values_.read(target, *value); // after a message the field has the default of its type
  else if (const auto text = trimmed(value->value); !text.empty() && text != "NULL")
    locator_.error(value->at, fmt::format("the nodes of the field {} stand between its tags, not "
                                          "in its value",
                                          describe(name)));
}

void X3dElements::openFieldValue(const Name& element, Attributes attributes) {
  Name name;
  if (!nameOf(name, element, attributes, "name")) return skip(attributes);
  const FieldTarget target = sink_.openField(name);
  if (!target.known) return skip(attributes);
  const bool nodes = target.type == FieldType::SFNode || target.type == FieldType::MFNode;
  const Attribute* const value = findAttribute(attributes, "value");
  if (nodes) {
    push(Kind::value, element);
    top().isList = target.type == FieldType::MFNode;
    return;
  }
  push(value ? Kind::leaf : Kind::text, element);
  if (value) return sink_.closeField(values_.read(target, *value));
  top().field = name;
  top().target = target;
}

// Some files have the value as text between the tags, which ISO/IEC 19776-1 does not know.
void X3dElements::closeText(Frame& frame) {
  const std::string_view text = trimmed(frame.source);
  if (!frame.sourceAt)
    locator_.error(frame.element.at,
                   fmt::format("fieldValue {} has no value", describe(frame.field)));
  else if (!std::exchange(saidValueText_, true))
    locator_.warn(frame.sourceAt,
                  "the value of a fieldValue stands in its attribute 'value'; this text is read as "
                  "the value");
  const bool good = frame.sourceAt && frame.good;
  sink_.closeField(good && values_.read(frame.target, {frame.field, text, frame.sourceAt, false}));
}

void X3dElements::connect(const Name& element, Attributes attributes) {
  Connection connection;
  if (nameOf(connection.field, element, attributes, "nodeField") &&
      nameOf(connection.interfaceName, element, attributes, "protoField"))
    frames_[frames_.size() - 2].connections.push_back(connection);
  push(Kind::leaf, element);
}

void X3dElements::close() {
  if (skipped_ > 0) {
    --skipped_;
    return;
  }
  Frame& frame = frames_.back();
  switch (frame.kind) {
  case Kind::node: closeNode(frame); break;
  case Kind::declaration: sink_.closeDeclaration(true); break;
  case Kind::value: sink_.closeField(true); break;
  case Kind::text: closeText(frame); break;
  case Kind::proto:
    sink_.closeProto(true);
    --depth_;
    break;
  case Kind::externProto:
    sink_.closeExternProto(frame.good);
    --depth_;
    break;
  default: break;
  }
  frames_.pop_back();
}

void X3dElements::finish() {
  skipped_ = 0;
  while (frames_.size() > 1) close();
  if (!sawScene_) locator_.error(nullptr, "this file has no Scene: it is empty");
}

} // namespace xvrml
