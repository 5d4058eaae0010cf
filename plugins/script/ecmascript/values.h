// values.h: how values of VRML's types lie in the Duktape heap, and how they are made of the
// program's values. SF tuples are objects over a fixed buffer of doubles; MF types are proxies over
// one dynamic buffer (numbers) or an array (texts, nodes). [the browser's thread]
#pragma once

#include <xvrml/xscript_types.h>

#include "interpreter.h"

namespace ecma {

// Which field's value an object is, if any: changes of it change the field.
struct Place {
  int32_t slot = -1;
  uint32_t serial = 0;
};

// SFColor, SFRotation, SFVec2f, SFVec3f; SFImage (x, y, comp). An element of an MF object has that
// as `parent`.
struct SfData {
  XsType type;
  uint32_t index; // in the parent
  Place place;
  uint32_t hasParent, unused;
  double v[4];
};

// In front of `count` elements, in the same buffer.
struct MfData {
  XsType type;
  Place place;
  uint32_t count;
};

inline bool isMf(XsType type) { return xsIsMany(type); }
XsType elementType(XsType type);  // of an MF type
int components(XsType type);      // numbers of an SF type, 0 for SFString, SFNode, SFImage
size_t elementBytes(XsType type); // of an MF type's numbers; 0: elements are in an array
const char* typeName(XsType type);
constexpr uint32_t mostElements = 16'000'000; // of one MF object

// The data of such an object; NULL if it is something else.
SfData* sfData(duk_context* ctx, duk_idx_t index);
MfData* mfData(duk_context* ctx, duk_idx_t index);
inline float* floatsOf(MfData* data) { return reinterpret_cast<float*>(data + 1); }
inline int32_t* intsOf(MfData* data) { return reinterpret_cast<int32_t*>(data + 1); }
inline double* doublesOf(MfData* data) { return reinterpret_cast<double*>(data + 1); }

// A float as the shortest decimal number that means it: the program reads 0.1 as 0.1, not as
// 0.10000000149011612.
double widen(float value);

// What a value is, for messages: "SFVec3f", "number 5", "undefined".
const char* describe(duk_context* ctx, duk_idx_t index);

// A number, a boolean or a tuple of this type from a program's value; `what` names the target in
// the error.
void toPlain(duk_context* ctx, duk_idx_t index, XsType type, double* out, const char* what);
double toNumber(duk_context* ctx, duk_idx_t index, XsType type, const char* what);
// Pushes what stands for an SFString: the text of a primitive or object.
void pushText(duk_context* ctx, duk_idx_t index, const char* what);

// sf_objects.cpp
SfData* pushSf(duk_context* ctx, Interpreter& self, XsType type, const double* v);
// A new SFImage, with a copy of the pixels on top, which it replaces.
void pushImage(duk_context* ctx, Interpreter& self, const double* v, Place place);
void registerSf(duk_context* ctx, Interpreter& self);
void registerSfMethods(duk_context* ctx, Interpreter& self);
// The object at `index` has changed: so has what it is part of.
void writeBack(duk_context* ctx, Interpreter& self, duk_idx_t index, SfData* data, int first,
               int count);

// mf_objects.cpp
// A new MF object of `count` default elements; its data, which lies elsewhere once it grows.
MfData* pushMf(duk_context* ctx, Interpreter& self, XsType type, uint32_t count, Place place = {});
// A new MF object of this type made of the value at `index`: another MF object, an array, one
// element.
void pushMfFrom(duk_context* ctx, Interpreter& self, duk_idx_t index, XsType type,
                const char* what);
MfData* resizeMf(duk_context* ctx, Interpreter& self, duk_idx_t index, uint32_t count);
void pushElement(duk_context* ctx, Interpreter& self, duk_idx_t mf, uint32_t index);
void setElement(duk_context* ctx, Interpreter& self, duk_idx_t mf, uint32_t index, duk_idx_t value,
                const char* what);
void touchMf(duk_context* ctx, Interpreter& self, duk_idx_t mf);
void registerMf(duk_context* ctx, Interpreter& self);
void registerMfTraps(duk_context* ctx, Interpreter& self);

// text.cpp: VRML's notation of the value at `index`, pushed.
void pushNotation(duk_context* ctx, Interpreter& self, duk_idx_t index);
duk_ret_t notationMethod(duk_context* ctx); // toString of all of them
size_t printFloat(char* out, size_t size, double value);

// matrix.cpp
void registerMatrix(duk_context* ctx, Interpreter& self);
// nodes.cpp
void pushNode(duk_context* ctx, Interpreter& self, XsNode node); // 0: null
XsNode nodeOf(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);
bool isNull(duk_context* ctx, Interpreter& self, duk_idx_t index);
bool isNode(duk_context* ctx, Interpreter& self, duk_idx_t index);
void registerNodes(duk_context* ctx, Interpreter& self);
// browser.cpp
void registerBrowser(duk_context* ctx, Interpreter& self);

// Methods are light functions: they cost no memory in each heap.
struct Method {
  const char* name;
  duk_c_function function;
  int arguments; // as `length` says, and as many are taken; DUK_VARARGS: any number
};
void putMethods(duk_context* ctx, const Method* methods, size_t count,
                int magic = 0); // into the object on top
// Pops the prototype on top; makes the constructor of this name, global.
void putConstructor(duk_context* ctx, const char* name, duk_c_function function, int magic,
                    const char* alias = nullptr);
// An accessor property of the object on top.
void putAccessor(duk_context* ctx, const char* name, duk_c_function get, duk_c_function set,
                 int magic);

} // namespace ecma
