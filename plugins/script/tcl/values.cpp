#include "values.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <xvrml/xscript_types.h>

#include "interpreter.h"
#include "nodes.h"

namespace tclscript {
namespace {

// Writes the shortest decimal number for this float, so that 0.1 is written 0.1.
Tcl_Obj* number(float f) {
  char text[40];
  const auto [end, error] = std::to_chars(text, text + sizeof text, f);
  double d = double(f);
  if (error == std::errc() && std::isfinite(f)) {
    double shortest = d;
    std::from_chars(text, end, shortest);
    if (float(shortest) == f) d = shortest;
  }
  return Tcl_NewDoubleObj(d);
}

Tcl_Obj* element(Interpreter& interpreter, const XsTypeInfo& kind, const XsValue& value, size_t i) {
  switch (kind.element) {
  case XS_SFBOOL: return Tcl_NewBooleanObj(value.of.ints[i]);
  case XS_SFINT32: return Tcl_NewIntObj(value.of.ints[i]);
  case XS_SFSTRING: {
    const XsString& s = value.of.strings[i];
    const Object text = tclText({s.data ? s.data : "", size_t(s.bytes)});
    return Tcl_DuplicateObj(text.get());
  }
  case XS_SFNODE: {
    const Object name = interpreter.nodeName(value.of.nodes[i]);
    return Tcl_DuplicateObj(name.get());
  }
  case XS_SFIMAGE: {
    const XsImage& image = value.of.images[i];
    Tcl_Obj* bytes = Tcl_NewListObj(0, nullptr);
    const size_t count =
        image.pixels ? size_t(image.width) * size_t(image.height) * size_t(image.components) : 0;
    for (size_t k = 0; k < count; ++k)
      Tcl_ListObjAppendElement(nullptr, bytes, Tcl_NewIntObj(image.pixels[k]));
    Tcl_Obj* parts[] = {Tcl_NewIntObj(image.width), Tcl_NewIntObj(image.height),
                        Tcl_NewIntObj(image.components), bytes};
    return Tcl_NewListObj(4, parts);
  }
  default: {
    Tcl_Obj* parts[XS_MOST_COMPONENTS];
    for (int k = 0; k < kind.components; ++k) {
      const size_t at = i * size_t(kind.components) + size_t(k);
      parts[k] = xsHasDoubles(kind.element) ? Tcl_NewDoubleObj(value.of.doubles[at])
                                            : number(value.of.floats[at]);
    }
    return kind.components == 1 ? parts[0] : Tcl_NewListObj(kind.components, parts);
  }
  }
}

// Reads objects of one type; messages go into the interpreter's result.
struct Reader {
  Interpreter& interpreter;
  const char* type; // name of the type, for messages
  const XsTypeInfo& kind;
  Converted& out;

  Tcl_Interp* tcl() const { return interpreter.tcl(); }
  int wrong(const char* expected, Tcl_Obj* got) const {
    std::string text = hostText(got);
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    const std::string message =
        std::string("expected ") + type + ", " + expected + ", but got \"" + text + "\"";
    Tcl_SetObjResult(tcl(), tclText(message).get());
    Tcl_SetErrorCode(tcl(), "XVRML", "TYPE", type, nullptr);
    return TCL_ERROR;
  }
  int one(Tcl_Obj* object, double& d) const {
    if (Tcl_GetDoubleFromObj(nullptr, object, &d) != TCL_OK || !std::isfinite(d))
      return wrong("a number", object);
    return TCL_OK;
  }
  int one(Tcl_Obj* object, float& f) const {
    double d = 0;
    if (one(object, d) != TCL_OK) return TCL_ERROR;
    if (std::fabs(d) > double(std::numeric_limits<float>::max()))
      return wrong("a number of single precision", object);
    f = float(d);
    return TCL_OK;
  }
  int integer(Tcl_Obj* object, int32_t& i) const {
    Tcl_WideInt wide;
    if (Tcl_GetWideIntFromObj(nullptr, object, &wide) != TCL_OK || wide < INT32_MIN ||
        wide > INT32_MAX)
      return wrong("an integer of 32 bits", object);
    i = int32_t(wide);
    return TCL_OK;
  }

  int image(Tcl_Obj* object) const {
    constexpr const char* expected = "{width height components {bytes}}";
    Tcl_Obj** parts;
    Tcl_Obj** pixels;
    int count, bytes;
    XsImage image{};
    if (Tcl_ListObjGetElements(nullptr, object, &count, &parts) != TCL_OK || count < 3 || count > 4)
      return wrong(expected, object);
    if (integer(parts[0], image.width) != TCL_OK || integer(parts[1], image.height) != TCL_OK ||
        integer(parts[2], image.components) != TCL_OK)
      return TCL_ERROR;
    bytes = 0;
    pixels = nullptr;
    if (count == 4 && Tcl_ListObjGetElements(nullptr, parts[3], &bytes, &pixels) != TCL_OK)
      return wrong(expected, object);
    const bool sane = image.width >= 0 && image.height >= 0 && image.components >= 0 &&
                      image.components <= 4 && image.width <= 1 << 20 && image.height <= 1 << 20;
    if (!sane || int64_t(image.width) * image.height * image.components != bytes)
      return wrong("as many bytes as width * height * components", object);
    for (int k = 0; k < bytes; ++k) {
      int32_t byte = 0;
      if (integer(pixels[k], byte) != TCL_OK) return TCL_ERROR;
      if (byte < 0 || byte > 255) return wrong("bytes from 0 to 255", pixels[k]);
      out.bytes.push_back(uint8_t(byte));
    }
    out.images.push_back(image);
    return TCL_OK;
  }

  int tuple(Tcl_Obj* const* parts) const {
    for (int k = 0; k < kind.components; ++k) {
      float f = 0;
      double d = 0;
      if (xsHasDoubles(kind.element)) {
        if (one(parts[k], d) != TCL_OK) return TCL_ERROR;
        out.doubles.push_back(d);
        continue;
      }
      if (one(parts[k], f) != TCL_OK) return TCL_ERROR;
      out.floats.push_back(f);
    }
    return TCL_OK;
  }

  int element(Tcl_Obj* object) const {
    switch (kind.element) {
    case XS_SFBOOL: {
      int yes;
      if (Tcl_GetBooleanFromObj(nullptr, object, &yes) != TCL_OK) return wrong("a boolean", object);
      out.ints.push_back(yes);
      return TCL_OK;
    }
    case XS_SFINT32: {
      int32_t i = 0;
      return integer(object, i) == TCL_OK ? (out.ints.push_back(i), TCL_OK) : TCL_ERROR;
    }
    case XS_SFSTRING: out.texts.push_back(hostText(object)); return TCL_OK;
    case XS_SFIMAGE: return image(object);
    case XS_SFNODE: {
      XsNode node = 0;
      if (!nodeOf(interpreter, object, node)) return wrong("the name of a node or NULL", object);
      out.nodes.push_back(node);
      return TCL_OK;
    }
    default: {
      if (kind.components == 1) return tuple(&object);
      const std::string expected = std::to_string(kind.components) + " numbers";
      Tcl_Obj** parts;
      int count;
      if (Tcl_ListObjGetElements(nullptr, object, &count, &parts) != TCL_OK ||
          count != kind.components)
        return wrong(expected.c_str(), object);
      return tuple(parts);
    }
    }
  }

  // Reads a list of elements. Tuples may also be flat lists of numbers, as in VRML.
  int many(Tcl_Obj* object, uint32_t& count) const {
    Tcl_Obj** parts;
    int length, first;
    if (Tcl_ListObjGetElements(nullptr, object, &length, &parts) != TCL_OK)
      return wrong("a list", object);
    const bool flat = kind.components > 1 && length > 0 && length % kind.components == 0 &&
                      Tcl_ListObjLength(nullptr, parts[0], &first) == TCL_OK && first == 1;
    const int step = flat ? kind.components : 1;
    for (int i = 0; i < length; i += step)
      if ((flat ? tuple(parts + i) : element(parts[i])) != TCL_OK) return TCL_ERROR;
    count = uint32_t(length / step);
    return TCL_OK;
  }
};

const void* dataOf(Converted& c, XsType element) {
  switch (element) {
  case XS_SFBOOL:
  case XS_SFINT32: return c.ints.data();
  case XS_SFNODE: return c.nodes.data();
  case XS_SFIMAGE:
    for (size_t i = 0, at = 0; i < c.images.size(); ++i) {
      XsImage& image = c.images[i];
      image.pixels = c.bytes.data() + at;
      at += size_t(image.width) * size_t(image.height) * size_t(image.components);
    }
    return c.images.data();
  case XS_SFSTRING:
    for (const std::string& text : c.texts) c.strings.push_back({text.c_str(), text.size()});
    return c.strings.data();
  default: break;
  }
  return xsHasDoubles(element) ? static_cast<const void*>(c.doubles.data()) : c.floats.data();
}

} // namespace

const char* typeName(XsType type) {
  const XsTypeInfo* kind = xsTypeInfo(type);
  return kind ? kind->name : "?";
}

Object toTcl(Interpreter& interpreter, const XsValue& value) {
  const XsTypeInfo* kind = xsTypeInfo(value.type);
  if (!kind || (value.count > 0 && !value.of.data)) return Tcl_NewObj();
  if (!xsIsMany(value.type))
    return value.count == 1 ? element(interpreter, *kind, value, 0) : Tcl_NewObj();
  const Object all = Tcl_NewListObj(0, nullptr);
  for (size_t i = 0; i < value.count; ++i)
    Tcl_ListObjAppendElement(nullptr, all.get(), element(interpreter, *kind, value, i));
  return all;
}

int fromTcl(Interpreter& interpreter, Tcl_Obj* object, XsType type, Converted& out) {
  const XsTypeInfo* kind = xsTypeInfo(type);
  if (!kind) {
    Tcl_SetObjResult(interpreter.tcl(), Tcl_NewStringObj("a value of an unknown type", -1));
    return TCL_ERROR;
  }
  const Object keep(object); // lists may be converted to other representations meanwhile
  const Reader reader{interpreter, kind->name, *kind, out};
  out.value.type = type;
  out.value.count = 1;
  const int code = xsIsMany(type) ? reader.many(object, out.value.count) : reader.element(object);
  if (code != TCL_OK) return TCL_ERROR;
  out.value.of.data = out.value.count > 0 ? dataOf(out, kind->element) : nullptr;
  return TCL_OK;
}

namespace {

unsigned unit(const char* at) {
  return (unsigned(at[0]) & 0xfu) << 12 | (unsigned(at[1]) & 0x3fu) << 6 |
         (unsigned(at[2]) & 0x3fu);
}
bool isThree(const char* at, size_t left) {
  return left >= 3 && (unsigned(at[0]) & 0xf0u) == 0xe0u && (unsigned(at[1]) & 0xc0u) == 0x80u &&
         (unsigned(at[2]) & 0xc0u) == 0x80u;
}

void append(std::string& out, unsigned point) {
  out += char(0xf0u | point >> 18);
  out += char(0x80u | (point >> 12 & 0x3fu));
  out += char(0x80u | (point >> 6 & 0x3fu));
  out += char(0x80u | (point & 0x3fu));
}

} // namespace

std::string hostText(Tcl_Obj* object) {
  int length;
  const char* from = Tcl_GetStringFromObj(object, &length);
  const std::string_view text(from, size_t(length));
  if (text.find_first_of("\xc0\xed") == text.npos) return std::string(text);
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const char* at = text.data() + i;
    const size_t left = text.size() - i;
    if (left >= 2 && at[0] == '\xc0' && at[1] == '\x80') {
      out += '\0';
      i += 2;
    } else if (isThree(at, left) && unit(at) >= 0xd800 && unit(at) < 0xe000) {
      const bool pair = unit(at) < 0xdc00 && isThree(at + 3, left - 3) && unit(at + 3) >= 0xdc00 &&
                        unit(at + 3) < 0xe000;
      if (pair) append(out, 0x10000 + ((unit(at) - 0xd800) << 10) + (unit(at + 3) - 0xdc00));
      // a lone surrogate
      else
        out += "\xef\xbf\xbd";
      i += pair ? 6 : 3;
    } else {
      out += text[i++];
    }
  }
  return out;
}

Object tclText(std::string_view text) {
  if (text.find('\0') == text.npos) return Tcl_NewStringObj(text.data(), int(text.size()));
  std::string out;
  for (const char c : text) {
    if (c)
      out += c;
    else
      out += "\xc0\x80";
  }
  return Tcl_NewStringObj(out.data(), int(out.size()));
}

} // namespace tclscript
