// values.cpp: Implements values.h: types, object data, and conversions of the program's values
// (C.6.2).
#include "values.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace ecma {
namespace {

bool equalsWord(const char* text, const char* lower) {
  for (; *lower; ++text, ++lower)
    if ((*text | 0x20) != *lower) return false;
  return *text == 0;
}

// Pushes the primitive of a boxed value or a Date; the value itself stays in place.
void pushPrimitive(duk_context* ctx, duk_idx_t index) {
  duk_dup(ctx, index);
  if (duk_is_object(ctx, -1)) duk_to_primitive(ctx, -1, DUK_HINT_NUMBER);
}

bool tupleOfText(const char* text, double* out, int count) {
  for (int i = 0; i < count; ++i) {
    char* end = nullptr;
    out[i] = std::strtod(text, &end);
    if (end == text) return false;
    for (text = end; *text == ' ' || *text == ',' || *text == '\t' || *text == '\n'; ++text) {}
  }
  return *text == 0;
}

} // namespace

XsType elementType(XsType type) { return xsTypeInfo(type)->element; }
int components(XsType type) { return xsTypeInfo(type)->components; }

int numbersIn(XsType type) { return type == XS_SFIMAGE ? 3 : components(type); }

void defaultNumbers(XsType type, double* out) {
  const int count = numbersIn(type), side = count == 9 ? 3 : 4;
  for (int i = 0; i < count; ++i) out[i] = count >= 9 && i % (side + 1) == 0 ? 1 : 0;
  if (type == XS_SFROTATION) out[2] = 1;
  if (type == XS_SFVEC4F || type == XS_SFVEC4D) out[3] = 1;
}

double numberAt(XsType type, const void* array, size_t at) {
  const XsType element = elementType(type);
  if (element == XS_SFBOOL || element == XS_SFINT32) return static_cast<const int32_t*>(array)[at];
  return xsHasDoubles(element) ? static_cast<const double*>(array)[at]
                               : widen(static_cast<const float*>(array)[at]);
}

void setNumberAt(XsType type, void* array, size_t at, double value) {
  const XsType element = elementType(type);
  if (element == XS_SFBOOL || element == XS_SFINT32)
    static_cast<int32_t*>(array)[at] = int32_t(value);
  else if (xsHasDoubles(element))
    static_cast<double*>(array)[at] = value;
  else
    static_cast<float*>(array)[at] = float(value);
}

double rounded(XsType type, double value) {
  return xsHasDoubles(type) ? value : widen(float(value));
}

size_t elementBytes(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  return info->components > 0 ? info->bytes : 0;
}

const char* typeName(XsType type) {
  const XsTypeInfo* info = xsTypeInfo(type);
  return info ? info->name : "?";
}

double widen(float value) {
  // floats with few bits have a short decimal form as doubles too
  const float scaled = value * 4096;
  if (scaled == std::trunc(scaled) || !std::isfinite(value)) return double(value);
  char text[32];
  double out = double(value);
  const char* end = std::to_chars(text, text + sizeof text, value).ptr;
  std::from_chars(text, end, out);
  return out;
}

SfData* sfData(duk_context* ctx, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return nullptr;
  duk_get_prop_heapptr(ctx, index, Interpreter::of(ctx).keySf);
  auto* data = static_cast<SfData*>(duk_get_buffer(ctx, -1, nullptr));
  duk_pop(ctx); // the object keeps it alive
  return data;
}

MfData* mfData(duk_context* ctx, duk_idx_t index) {
  if (!duk_is_object(ctx, index)) return nullptr;
  duk_get_prop_heapptr(ctx, index, Interpreter::of(ctx).keyMf);
  auto* data = static_cast<MfData*>(duk_get_buffer(ctx, -1, nullptr));
  duk_pop(ctx);
  return data;
}

const char* describe(duk_context* ctx, duk_idx_t index) {
  if (const SfData* sf = sfData(ctx, index)) return typeName(sf->type);
  if (const MfData* mf = mfData(ctx, index)) return typeName(mf->type);
  if (isNode(ctx, Interpreter::of(ctx), index)) return "SFNode";
  if (duk_is_string(ctx, index))
    return duk_push_sprintf(ctx, "text '%.40s'", duk_get_string(ctx, index));
  if (duk_is_number(ctx, index))
    return duk_push_sprintf(ctx, "number %g", duk_get_number(ctx, index));
  if (duk_is_null(ctx, index)) return "null";
  if (duk_is_undefined(ctx, index)) return "undefined";
  if (duk_is_boolean(ctx, index)) return "a boolean";
  if (duk_is_function(ctx, index)) return "a function";
  return duk_is_array(ctx, index) ? "an Array" : "an object";
}

double toNumber(duk_context* ctx, duk_idx_t index, XsType type, const char* what) {
  if (duk_is_number(ctx, index)) return duk_get_number(ctx, index);
  if (duk_is_boolean(ctx, index)) return duk_get_boolean(ctx, index) ? 1 : 0;
  const bool number =
      !duk_is_null_or_undefined(ctx, index) && !sfData(ctx, index) && !mfData(ctx, index);
  if (number) {
    pushPrimitive(ctx, index);
    const bool wasNumber = duk_is_number(ctx, -1);
    const double value = duk_to_number(ctx, -1);
    duk_pop(ctx);
    if (wasNumber || !std::isnan(value)) return value;
  }
  throwType(ctx, "%s: expected %s, got %s", what, typeName(type), describe(ctx, index));
}

void toPlain(duk_context* ctx, duk_idx_t index, XsType type, double* out, const char* what) {
  index = duk_normalize_index(ctx, index);
  switch (type) {
  case XS_SFBOOL:
    if (duk_is_string(ctx, index)) { // scripts of 1997 use strings as booleans
      const char* text = duk_get_string(ctx, index);
      out[0] = *text && !equalsWord(text, "false") && !equalsWord(text, "0");
    } else {
      const double value = toNumber(ctx, index, type, what);
      out[0] = value != 0 && !std::isnan(value);
    }
    return;
  case XS_SFINT32:
    duk_push_number(ctx, toNumber(ctx, index, type, what));
    out[0] = duk_to_int32(ctx, -1);
    duk_pop(ctx);
    return;
  case XS_SFFLOAT: out[0] = widen(float(toNumber(ctx, index, type, what))); return;
  case XS_SFDOUBLE: out[0] = toNumber(ctx, index, type, what); return;
  case XS_SFTIME: // a Date counts milliseconds
    out[0] = toNumber(ctx, index, type, what);
    if (!duk_is_object(ctx, index)) return;
    duk_get_global_string(ctx, "Date");
    if (duk_instanceof(ctx, index, -1)) out[0] *= 0.001;
    return duk_pop(ctx);
  default: break;
  }
  const int count = components(type);
  if (const SfData* sf = sfData(ctx, index); sf && components(sf->type) == count) {
    std::memcpy(out, sf->v, size_t(count) * sizeof *out);
    return;
  }
  if (duk_is_array(ctx, index) && duk_get_length(ctx, index) == size_t(count)) {
    for (int i = 0; i < count; ++i) {
      duk_get_prop_index(ctx, index, duk_uarridx_t(i));
      out[i] = toNumber(ctx, -1, XS_SFFLOAT, what);
      duk_pop(ctx);
    }
    return;
  }
  if (MfData* mf = mfData(ctx, index);
      mf && (mf->type == XS_MFFLOAT || mf->type == XS_MFDOUBLE) && mf->count == uint32_t(count)) {
    for (int i = 0; i < count; ++i) out[i] = numberAt(mf->type, mf + 1, size_t(i));
    return;
  }
  if (duk_is_string(ctx, index) && tupleOfText(duk_get_string(ctx, index), out, count)) return;
  throwType(ctx, "%s: expected %s, got %s", what, typeName(type), describe(ctx, index));
}

void pushText(duk_context* ctx, duk_idx_t index, const char* what) {
  if (duk_is_null_or_undefined(ctx, index))
    throwType(ctx, "%s: expected SFString, got %s", what, describe(ctx, index));
  duk_dup(ctx, index);
  duk_to_string(ctx, -1);
}

void putMethods(duk_context* ctx, const Method* methods, size_t count, int magic) {
  for (size_t i = 0; i < count; ++i) {
    const Method& m = methods[i];
    // not a light function: its toString would show an address
    duk_push_c_function(ctx, m.function, m.arguments);
    duk_set_magic(ctx, -1, magic);
    duk_put_prop_string(ctx, -2, m.name);
  }
}

void putConstructor(duk_context* ctx, const char* name, duk_c_function function, int magic,
                    const char* alias) {
  duk_push_c_function(ctx, function, DUK_VARARGS);
  duk_set_magic(ctx, -1, magic);
  duk_push_string(ctx, "name");
  duk_push_string(ctx, name);
  duk_def_prop(ctx, -3, DUK_DEFPROP_HAVE_VALUE | DUK_DEFPROP_FORCE);
  duk_dup(ctx, -2);
  duk_put_prop_string(ctx, -2, "prototype");
  duk_push_string(ctx, "constructor");
  duk_dup(ctx, -2);
  duk_def_prop(ctx, -4,
               DUK_DEFPROP_HAVE_VALUE | DUK_DEFPROP_SET_WRITABLE | DUK_DEFPROP_SET_CONFIGURABLE);
  if (alias) {
    duk_dup(ctx, -1);
    duk_put_global_string(ctx, alias);
  }
  duk_put_global_string(ctx, name);
  duk_pop(ctx);
}

void putAccessor(duk_context* ctx, const char* name, duk_c_function get, duk_c_function set,
                 int magic) {
  duk_push_string(ctx, name);
  duk_push_c_function(ctx, get, 0);
  duk_set_magic(ctx, -1, magic);
  duk_push_c_function(ctx, set, 1);
  duk_set_magic(ctx, -1, magic);
  duk_def_prop(ctx, -4,
               DUK_DEFPROP_HAVE_GETTER | DUK_DEFPROP_HAVE_SETTER | DUK_DEFPROP_SET_CONFIGURABLE |
                   DUK_DEFPROP_SET_ENUMERABLE);
}

} // namespace ecma
