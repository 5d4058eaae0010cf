// values.h: Converts between VRML's values and Tcl's: lists of numbers, booleans, strings, names of
// nodes. See docs/scripts.md "Tcl/Tk". [the browser's thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tcl.h>

#include "xvrml/xscript.h"

namespace tclscript {

class Interpreter;

// Owns a reference to a Tcl object.
class Object {
 public:
  Object() = default;
  Object(Tcl_Obj* object) : object_(object) {
    if (object_) Tcl_IncrRefCount(object_);
  }
  Object(const Object& other) : Object(other.object_) {}
  Object(Object&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Object& operator=(Object other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Object() {
    if (object_) Tcl_DecrRefCount(object_);
  }
  Tcl_Obj* get() const { return object_; }

 private:
  Tcl_Obj* object_ = nullptr;
};

// A value for the host, and the storage it points to.
struct Converted {
  Converted() = default;
  Converted(Converted&&) = default; // moved vectors keep their storage
  Converted& operator=(Converted&&) = default;
  Converted(const Converted&) = delete;
  Converted& operator=(const Converted&) = delete;

  XsValue value{};
  std::vector<int32_t> ints;
  std::vector<float> floats;
  std::vector<double> doubles;
  std::vector<XsNode> nodes;
  std::vector<std::string> texts;
  std::vector<XsString> strings;
  std::vector<uint8_t> bytes; // the pixels of all images, one behind the other
  std::vector<XsImage> images;
};

const char* typeName(XsType type); // "SFVec3f"

// Converts a value of the host to Tcl; creates commands for nodes.
Object toTcl(Interpreter& interpreter, const XsValue& value);
// Returns TCL_ERROR, with a message in the interpreter's result, if the object has no value of this
// type.
int fromTcl(Interpreter& interpreter, Tcl_Obj* object, XsType type, Converted& out);

// Converts Tcl's UTF-8 to the host's. Tcl writes U+0000 in two bytes and sometimes writes
// characters beyond U+FFFF as two surrogates of three bytes each.
std::string hostText(Tcl_Obj* object);
Object tclText(std::string_view text);

} // namespace tclscript
