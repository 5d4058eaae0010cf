// nodes.cpp: Implements the commands of nodes. A command keeps its node number valid until it is
// deleted.
#include "nodes.h"

#include <cstring>

namespace tclscript {
namespace {

struct NodeCommand {
  Interpreter* interpreter;
  XsNode node;
};

int get(Interpreter& interpreter, XsNode node, Tcl_Obj* const* words) {
  XsValue value{};
  const char* field = Tcl_GetString(words[2]);
  const XsResult result =
      interpreter.host()->read(interpreter.host(), interpreter.self(), node, field, &value);
  if (result != XS_OK) return interpreter.answer(result);
  Tcl_SetObjResult(interpreter.tcl(), toTcl(interpreter, value).get());
  return TCL_OK;
}

int set(Interpreter& interpreter, XsNode node, Tcl_Obj* const* words) {
  if (interpreter.isRunning())
    return setField(interpreter, node, Tcl_GetString(words[2]), words[3]);
  interpreter.postponeSet(node, Tcl_GetString(words[2]), words[3]);
  return TCL_OK;
}

bool describe(Interpreter& interpreter, XsNode node, XsNodeInfo& info, int& code) {
  info = {sizeof(XsNodeInfo), 0, nullptr, nullptr};
  code = interpreter.answer(
      interpreter.host()->describe(interpreter.host(), interpreter.self(), node, &info));
  return code == TCL_OK;
}

int fields(Interpreter& interpreter, XsNode node, Tcl_Obj* const*) {
  static constexpr const char* access[] = {"", "field", "exposedField", "eventIn", "eventOut"};
  XsNodeInfo info;
  int code;
  if (!describe(interpreter, node, info, code)) return code;
  const Object all = Tcl_NewListObj(0, nullptr);
  for (uint32_t i = 0; i < info.fieldCount; ++i) {
    XsField field{};
    const XsResult result =
        interpreter.host()->field(interpreter.host(), interpreter.self(), node, i, &field);
    if (result != XS_OK) return interpreter.answer(result);
    const bool known = field.access >= XS_FIELD && field.access <= XS_EVENT_OUT;
    Tcl_Obj* parts[] = {Tcl_NewStringObj(known ? access[field.access] : "", -1),
                        Tcl_NewStringObj(typeName(field.type), -1),
                        Tcl_NewStringObj(field.name, -1)};
    Tcl_ListObjAppendElement(nullptr, all.get(), Tcl_NewListObj(3, parts));
  }
  Tcl_SetObjResult(interpreter.tcl(), all.get());
  return TCL_OK;
}

int type(Interpreter& interpreter, XsNode node, Tcl_Obj* const*) {
  XsNodeInfo info;
  int code;
  if (describe(interpreter, node, info, code))
    Tcl_SetObjResult(interpreter.tcl(), Tcl_NewStringObj(info.typeName, -1));
  return code;
}

int name(Interpreter& interpreter, XsNode node, Tcl_Obj* const*) {
  XsNodeInfo info;
  int code;
  if (describe(interpreter, node, info, code))
    Tcl_SetObjResult(interpreter.tcl(), Tcl_NewStringObj(info.defName, -1));
  return code;
}

int release(Interpreter& interpreter, XsNode node, Tcl_Obj* const*) {
  const auto known = interpreter.nodes.find(node);
  if (known != interpreter.nodes.end())
    Tcl_DeleteCommandFromToken(interpreter.tcl(), known->second);
  return TCL_OK;
}

struct Subcommand {
  const char* name; // must be the first member, for Tcl_GetIndexFromObjStruct
  int arguments;
  const char* usage;
  int (*run)(Interpreter&, XsNode, Tcl_Obj* const*);
};
const Subcommand subcommands[] = {{"get", 1, "field", get},       {"set", 2, "field value", set},
                                  {"fields", 0, nullptr, fields}, {"type", 0, nullptr, type},
                                  {"name", 0, nullptr, name},     {"release", 0, nullptr, release},
                                  {nullptr, 0, nullptr, nullptr}};

int nodeCommand(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  // a copy, because `release` deletes the command
  const NodeCommand command = *static_cast<NodeCommand*>(data);
  int index;
  if (count < 2) {
    Tcl_WrongNumArgs(tcl, 1, words, "option ?arg ...?");
    return TCL_ERROR;
  }
  if (Tcl_GetIndexFromObjStruct(tcl, words[1], subcommands, sizeof(Subcommand), "option", TCL_EXACT,
                                &index) != TCL_OK)
    return TCL_ERROR;
  const Subcommand& sub = subcommands[index];
  if (count != 2 + sub.arguments) {
    Tcl_WrongNumArgs(tcl, 2, words, sub.usage);
    return TCL_ERROR;
  }
  return sub.run(*command.interpreter, command.node, words);
}

void nodeGone(ClientData data) {
  const std::unique_ptr<NodeCommand> command(static_cast<NodeCommand*>(data));
  Interpreter& interpreter = *command->interpreter;
  interpreter.nodes.erase(command->node);
  interpreter.host()->release(interpreter.host(), interpreter.self(), command->node);
}

} // namespace

Object Interpreter::nodeName(XsNode node) {
  if (node == 0) return Tcl_NewStringObj("NULL", 4);
  const auto known = nodes.find(node);
  if (known != nodes.end()) { // the command may have been renamed
    const Object name = Tcl_NewObj();
    Tcl_GetCommandFullName(tcl_, known->second, name.get());
    const char* full = Tcl_GetString(name.get());
    const bool global = std::strncmp(full, "::", 2) == 0 && !std::strstr(full + 2, "::");
    return global ? Object(Tcl_NewStringObj(full + 2, -1)) : name;
  }
  const std::string name = "node" + std::to_string(node);
  host_->retain(host_, self(), node);
  const Tcl_Command token = Tcl_CreateObjCommand(tcl_, ("::" + name).c_str(), nodeCommand,
                                                 new NodeCommand{this, node}, nodeGone);
  nodes[node] = token;
  return tclText(name);
}

int setField(Interpreter& interpreter, XsNode node, const std::string& name, Tcl_Obj* object) {
  XsField field{};
  const XsResult found = interpreter.host()->findField(interpreter.host(), interpreter.self(), node,
                                                       name.c_str(), &field);
  if (found != XS_OK) return interpreter.answer(found);
  const XsType type = field.type; // the name is valid only until the next call
  const XsAccess access = field.access;
  Converted value;
  if (fromTcl(interpreter, object, type, value) != TCL_OK) return TCL_ERROR;
  using Output = Interpreter::Output;
  const bool own = node == interpreter.self();
  const Output kind = !own || access == XS_EVENT_IN ? Output::post
                      : access == XS_FIELD          ? Output::write
                                                    : Output::send;
  return interpreter.answer(interpreter.give(kind, node, name.c_str(), std::move(value)));
}

bool nodeOf(Interpreter& interpreter, Tcl_Obj* object, XsNode& node) {
  const char* name = Tcl_GetString(object);
  node = 0;
  if (*name == 0 || std::strcmp(name, "NULL") == 0) return true;
  Tcl_CmdInfo info;
  if (!Tcl_GetCommandInfo(interpreter.tcl(), name, &info) || info.objProc != nodeCommand)
    return false;
  node = static_cast<NodeCommand*>(info.objClientData)->node;
  return true;
}

} // namespace tclscript
