// values.h: Represents values of VRML's types in the heap, and converts the program's
// values to them. SF tuples are objects over a fixed buffer of doubles. MF types are proxies over
// one dynamic buffer (numbers) or an array (strings, nodes). [the browser's thread]
#pragma once

#include <xvrml/xscript_types.h>

#include "interpreter.h"

namespace ecma {

// The field whose value an object is, if any; changes of the object change the field.
struct Place {
  int32_t slot = -1;
  uint32_t serial = 0;
};

// Data of tuples of numbers (SFVec3f, SFColor, SFMatrix4d and so on) and of SFImage (x, y, comp).
// An element of an MF object refers to it by the property `parent`. The buffer ends behind the
// numbers that the type has.
struct SfData {
  XsType type;
  uint32_t index; // index in the parent
  Place place;
  uint32_t hasParent, unused;
  double v[XS_MOST_COMPONENTS];
};

// Header of an MF object; `count` elements follow in the same buffer.
struct MfData {
  XsType type;
  Place place;
  uint32_t count;
};

inline bool isMf(XsType type) { return xsIsMany(type); }
XsType elementType(XsType type); // type: an MF type
// Returns the numbers in an SF type; 0 for SFString, SFNode and SFImage.
int components(XsType type);
// Returns the numbers in the data of a tuple or an SFImage.
int numbersIn(XsType type);
// Writes the default of an SF type of numbers.
void defaultNumbers(XsType type, double* out);
// Reads and writes number `at` of the array of an SF or MF type of numbers.
double numberAt(XsType type, const void* array, size_t at);
void setNumberAt(XsType type, void* array, size_t at, double value);
// Rounds a number to what a field of the type holds.
double rounded(XsType type, double value);
// Returns the bytes of an MF type's element; 0: the elements are in an array.
size_t elementBytes(XsType type);
const char* typeName(XsType type);
constexpr uint32_t maxElements = 16'000'000; // limit for one MF object

// Returns the data of such an object; NULL for other values.
SfData* sfData(duk_context* ctx, duk_idx_t index);
MfData* mfData(duk_context* ctx, duk_idx_t index);
inline float* floatsOf(MfData* data) { return reinterpret_cast<float*>(data + 1); }
inline int32_t* intsOf(MfData* data) { return reinterpret_cast<int32_t*>(data + 1); }

// Converts a float to the double with the same shortest decimal form, so that the program reads 0.1
// as 0.1 instead of 0.10000000149011612.
double widen(float value);

// Describes a value for messages: "SFVec3f", "number 5", "undefined".
const char* describe(duk_context* ctx, duk_idx_t index);

// Converts a program's value to a number, a boolean or a tuple of this type; `what` names the
// target in error messages.
void toPlain(duk_context* ctx, duk_idx_t index, XsType type, double* out, const char* what);
double toNumber(duk_context* ctx, duk_idx_t index, XsType type, const char* what);
// Pushes the value as an SFString: the text of a primitive or object.
void pushText(duk_context* ctx, duk_idx_t index, const char* what);

// --- sf_objects.cpp ---
SfData* pushSf(duk_context* ctx, Interpreter& self, XsType type, const double* v);
// Creates an SFImage with a copy of the pixels on top, which it replaces on the stack.
void pushImage(duk_context* ctx, Interpreter& self, const double* v, Place place);
// Pushes a copy of the SFImage at `index`; throws if it is none.
void pushImageFrom(duk_context* ctx, Interpreter& self, duk_idx_t index, Place place,
                   const char* what);
void registerSf(duk_context* ctx, Interpreter& self);
void registerSfMethods(duk_context* ctx, Interpreter& self);
// Writes a change of the object at `index` to the field or MF object that contains it.
void writeBack(duk_context* ctx, Interpreter& self, duk_idx_t index, SfData* data, int first,
               int count);

// --- mf_objects.cpp ---
//
// Creates an MF object of `count` default elements. Returns its data, which moves when the object
// grows.
MfData* pushMf(duk_context* ctx, Interpreter& self, XsType type, uint32_t count, Place place = {});
// Creates an MF object of this type from the value at `index`: another MF object, an array, or one
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

// text.cpp: Pushes the value at `index` in VRML's notation.
void pushNotation(duk_context* ctx, Interpreter& self, duk_idx_t index);
duk_ret_t notationMethod(duk_context* ctx); // toString of all objects
size_t printFloat(char* out, size_t size, double value);

// --- matrix.cpp ---
void registerMatrix(duk_context* ctx, Interpreter& self);
// --- nodes.cpp ---
void pushNode(duk_context* ctx, Interpreter& self, XsNode node); // 0: pushes null
XsNode nodeOf(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what);
bool isNull(duk_context* ctx, Interpreter& self, duk_idx_t index);
bool isNode(duk_context* ctx, Interpreter& self, duk_idx_t index);
void registerNodes(duk_context* ctx, Interpreter& self);
// --- browser.cpp ---
void registerBrowser(duk_context* ctx, Interpreter& self);

// Methods are light functions, which take no memory in each heap.
struct Method {
  const char* name;
  duk_c_function function;
  int arguments; // number of arguments and value of `length`; DUK_VARARGS: any number
};
// Adds the methods to the object on top.
void putMethods(duk_context* ctx, const Method* methods, size_t count, int magic = 0);
// Pops the prototype on top and defines the global constructor of this name.
void putConstructor(duk_context* ctx, const char* name, duk_c_function function, int magic,
                    const char* alias = nullptr);
// Adds an accessor property to the object on top.
void putAccessor(duk_context* ctx, const char* name, duk_c_function get, duk_c_function set,
                 int magic);

} // namespace ecma
