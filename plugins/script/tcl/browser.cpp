// browser.cpp: Implements the Browser object (4.12.10) as the command `Browser`. [the browser's
// thread]
#include "interpreter.h"
#include "nodes.h"

namespace tclscript {
namespace {

using Words = Tcl_Obj* const*;

XsString view(const std::string& text) { return {text.c_str(), text.size()}; }

int giveText(Interpreter& i, XsResult (*get)(const XsHost*, XsNode, XsString*)) {
  XsString text{"", 0};
  const XsResult result = get(i.host(), i.self(), &text);
  if (result != XS_OK) return i.answer(result);
  Tcl_SetObjResult(i.tcl(), tclText({text.data, size_t(text.bytes)}).get());
  return TCL_OK;
}
int giveNumber(Interpreter& i, double number) {
  Tcl_SetObjResult(i.tcl(), Tcl_NewDoubleObj(number));
  return TCL_OK;
}

int getName(Interpreter& i, Words, int) { return giveText(i, i.host()->getName); }
int getVersion(Interpreter& i, Words, int) { return giveText(i, i.host()->getVersion); }
int getWorldURL(Interpreter& i, Words, int) { return giveText(i, i.host()->getWorldUrl); }
int getCurrentSpeed(Interpreter& i, Words, int) {
  return giveNumber(i, i.host()->getCurrentSpeed(i.host(), i.self()));
}
int getCurrentFrameRate(Interpreter& i, Words, int) {
  return giveNumber(i, i.host()->getCurrentFrameRate(i.host(), i.self()));
}
int now(Interpreter& i, Words, int) { return giveNumber(i, i.host()->now(i.host(), i.self())); }

int setDescription(Interpreter& i, Words words, int) {
  const std::string text = hostText(words[0]);
  return i.answer(i.host()->setDescription(i.host(), i.self(), view(text)));
}

int print(Interpreter& i, Words words, int) {
  i.log(0, 0, hostText(words[0]));
  return TCL_OK;
}

int replaceWorld(Interpreter& i, Words words, int) {
  Converted nodes;
  if (fromTcl(i, words[0], XS_MFNODE, nodes) != TCL_OK) return TCL_ERROR;
  return i.answer(
      i.host()->replaceWorld(i.host(), i.self(), nodes.value.count, nodes.value.of.nodes));
}

int loadURL(Interpreter& i, Words words, int count) {
  Converted urls, parameters;
  if (fromTcl(i, words[0], XS_MFSTRING, urls) != TCL_OK) return TCL_ERROR;
  if (count > 1 && fromTcl(i, words[1], XS_MFSTRING, parameters) != TCL_OK) return TCL_ERROR;
  return i.answer(i.host()->loadUrl(i.host(), i.self(), urls.value.count, urls.value.of.strings,
                                    parameters.value.count, parameters.value.of.strings));
}

int node(Interpreter& i, Tcl_Obj* word, XsNode& found) {
  Converted one;
  if (fromTcl(i, word, XS_SFNODE, one) != TCL_OK) return TCL_ERROR;
  found = one.nodes[0];
  return TCL_OK;
}

int createVrmlFromURL(Interpreter& i, Words words, int) {
  Converted urls;
  XsNode to = 0;
  if (fromTcl(i, words[0], XS_MFSTRING, urls) != TCL_OK || node(i, words[1], to) != TCL_OK)
    return TCL_ERROR;
  return i.answer(i.host()->createVrmlFromUrl(i.host(), i.self(), urls.value.count,
                                              urls.value.of.strings, to, Tcl_GetString(words[2])));
}

int createVrmlFromString(Interpreter& i, Words words, int) {
  const std::string text = hostText(words[0]);
  XsValue nodes{};
  const XsResult result = i.host()->createVrmlFromString(i.host(), i.self(), view(text), &nodes);
  if (result != XS_OK) return i.answer(result);
  Tcl_SetObjResult(i.tcl(), toTcl(i, nodes).get());
  return TCL_OK;
}

using ChangeRoute = XsResult (*)(const XsHost*, XsNode, XsNode, const char*, XsNode, const char*);
int changeRoute(Interpreter& i, Words words, ChangeRoute change) {
  XsNode from = 0, to = 0;
  if (node(i, words[0], from) != TCL_OK || node(i, words[2], to) != TCL_OK) return TCL_ERROR;
  return i.answer(
      change(i.host(), i.self(), from, Tcl_GetString(words[1]), to, Tcl_GetString(words[3])));
}
int addRoute(Interpreter& i, Words words, int) { return changeRoute(i, words, i.host()->addRoute); }
int deleteRoute(Interpreter& i, Words words, int) {
  return changeRoute(i, words, i.host()->deleteRoute);
}

struct Function {
  const char* name; // must be the first member, for Tcl_GetIndexFromObjStruct
  int least, most;  // number of arguments
  const char* usage;
  int (*run)(Interpreter&, Words, int);
};
const Function functions[] = {
    {"getName", 0, 0, nullptr, getName},
    {"getVersion", 0, 0, nullptr, getVersion},
    {"getCurrentSpeed", 0, 0, nullptr, getCurrentSpeed},
    {"getCurrentFrameRate", 0, 0, nullptr, getCurrentFrameRate},
    {"getWorldURL", 0, 0, nullptr, getWorldURL},
    {"replaceWorld", 1, 1, "nodes", replaceWorld},
    {"createVrmlFromString", 1, 1, "text", createVrmlFromString},
    {"createVrmlFromURL", 3, 3, "urls node eventIn", createVrmlFromURL},
    {"addRoute", 4, 4, "fromNode eventOut toNode eventIn", addRoute},
    {"deleteRoute", 4, 4, "fromNode eventOut toNode eventIn", deleteRoute},
    {"loadURL", 1, 2, "urls ?parameters?", loadURL},
    {"setDescription", 1, 1, "text", setDescription},
    {"print", 1, 1, "text", print},
    {"now", 0, 0, nullptr, now},
    {nullptr, 0, 0, nullptr, nullptr}};

int browserCommand(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  int index;
  if (count < 2) {
    Tcl_WrongNumArgs(tcl, 1, words, "function ?arg ...?");
    return TCL_ERROR;
  }
  if (Tcl_GetIndexFromObjStruct(tcl, words[1], functions, sizeof(Function), "function", TCL_EXACT,
                                &index) != TCL_OK)
    return TCL_ERROR;
  const Function& function = functions[index];
  const int arguments = count - 2;
  if (arguments < function.least || arguments > function.most) {
    Tcl_WrongNumArgs(tcl, 2, words, function.usage);
    return TCL_ERROR;
  }
  return function.run(*static_cast<Interpreter*>(data), words + 2, arguments);
}

} // namespace

void addBrowser(Interpreter& interpreter) {
  Tcl_CreateObjCommand(interpreter.tcl(), "::Browser", browserCommand, &interpreter, nullptr);
}

} // namespace tclscript
