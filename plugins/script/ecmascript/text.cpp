// text.cpp: Writes values in VRML's notation (toString, C.6), with the shortest numbers that give
// the same float.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

// Builds long strings from pieces on the stack; joins them before there are too many.
struct Pieces {
  duk_context* ctx;
  duk_idx_t count = 0;
  void add(const char* text, size_t bytes) {
    duk_push_lstring(ctx, text, bytes);
    added();
  }
  void add(const char* text) { add(text, std::strlen(text)); }
  void added() {
    constexpr duk_idx_t most = 200;
    if (++count < most) return;
    duk_concat(ctx, count);
    count = 1;
  }
  void finish() {
    if (count == 0) duk_push_string(ctx, "");
    if (count > 1) duk_concat(ctx, count);
  }
};

void addNumbers(Pieces& pieces, XsType type, const double* v, int count) {
  char text[25 * XS_MOST_COMPONENTS]; // a float takes at most 24 characters
  size_t length = 0;
  for (int i = 0; i < count; ++i) {
    if (i > 0) text[length++] = ' ';
    if (xsHasDoubles(type)) { // written as ECMAScript writes numbers
      pieces.add(text, length);
      length = 0;
      duk_push_number(pieces.ctx, v[i]);
      duk_to_string(pieces.ctx, -1);
      pieces.added();
    } else {
      length += printFloat(text + length, sizeof text - length, v[i]);
    }
  }
  pieces.add(text, length);
}

void pushQuoted(duk_context* ctx, duk_idx_t index) {
  duk_size_t bytes = 0;
  const char* text = duk_get_lstring(ctx, index, &bytes);
  Pieces pieces{ctx};
  pieces.add("\"");
  duk_size_t start = 0;
  for (duk_size_t i = 0; i < bytes; ++i)
    if (text[i] == '"' || text[i] == '\\') {
      pieces.add(text + start, i - start);
      pieces.add("\\");
      start = i;
    }
  pieces.add(text + start, bytes - start);
  pieces.add("\"");
  pieces.finish();
}

void pushMfNotation(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  const uint32_t count = mfData(ctx, index)->count;
  const XsType type = mfData(ctx, index)->type, element = elementType(type);
  Pieces pieces{ctx};
  pieces.add("[");
  for (uint32_t i = 0; i < count; ++i) {
    if (i > 0) pieces.add(", ");
    MfData* mf = mfData(ctx, index);
    if (type == XS_MFBOOL) {
      pieces.add(intsOf(mf)[i] ? "TRUE" : "FALSE");
    } else if (type == XS_MFINT32) {
      duk_push_number(ctx, double(intsOf(mf)[i]));
      duk_to_string(ctx, -1);
      pieces.added();
    } else if (elementBytes(type) > 0) {
      double v[XS_MOST_COMPONENTS];
      const int n = components(element);
      for (int k = 0; k < n; ++k)
        v[k] = numberAt(element, mf + 1, size_t(i) * size_t(n) + size_t(k));
      addNumbers(pieces, element, v, n);
    } else {
      pushElement(ctx, self, index, i);
      if (type == XS_MFSTRING)
        pushQuoted(ctx, duk_get_top_index(ctx));
      else
        pushNotation(ctx, self, duk_get_top_index(ctx));
      duk_remove(ctx, -2);
      pieces.added();
    }
  }
  pieces.add("]");
  pieces.finish();
}

} // namespace

size_t printFloat(char* out, size_t size, double value) {
  const auto f = float(value);
  const float magnitude = std::fabs(f);
  if (std::isnan(f)) return size_t(std::snprintf(out, size, "NaN"));
  if (std::isinf(f)) return size_t(std::snprintf(out, size, f < 0 ? "-Infinity" : "Infinity"));
  if (f == 0) return size_t(std::snprintf(out, size, "0"));
  const auto format = magnitude >= 1e-5f && magnitude < 1e15f ? std::chars_format::fixed
                                                              : std::chars_format::scientific;
  return size_t(std::to_chars(out, out + size, f, format).ptr - out);
}

void pushNotation(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  index = duk_normalize_index(ctx, index);
  if (mfData(ctx, index)) return pushMfNotation(ctx, self, index);
  if (const SfData* sf = sfData(ctx, index)) {
    Pieces pieces{ctx};
    addNumbers(pieces, sf->type, sf->v, numbersIn(sf->type));
    if (sf->type == XS_SFIMAGE) {
      duk_get_prop_heapptr(ctx, index, self.keyList);
      const duk_idx_t array = duk_get_top_index(ctx);
      const uint32_t count = mfData(ctx, array) ? mfData(ctx, array)->count : 0;
      Pieces pixels{ctx};
      for (uint32_t i = 0; i < count; ++i) {
        char text[16];
        const int length =
            std::snprintf(text, sizeof text, " 0x%X", unsigned(intsOf(mfData(ctx, array))[i]));
        pixels.add(text, size_t(length));
      }
      pixels.finish();
      duk_remove(ctx, array);
      pieces.added();
    }
    return pieces.finish();
  }
  if (isNode(ctx, self, index)) {
    XsNodeInfo info{sizeof(XsNodeInfo), 0, nullptr, nullptr};
    const XsResult result =
        self.host->describe(self.host, self.self, nodeOf(ctx, self, index, "toString"), &info);
    if (result != XS_OK) throwHost(ctx, self, result, "toString");
    const bool named = info.defName && *info.defName;
    duk_push_sprintf(ctx, "%s%s%s%s", named ? "DEF " : "", named ? info.defName : "",
                     named ? " " : "", info.typeName);
    duk_push_string(ctx, " { }");
    duk_concat(ctx, 2);
    return;
  }
  if (isNull(ctx, self, index)) {
    duk_push_string(ctx, "NULL");
    return;
  }
  duk_dup(ctx, index);
  duk_to_string(ctx, -1);
}

duk_ret_t notationMethod(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  duk_push_this(ctx);
  const duk_idx_t it = duk_get_top_index(ctx);
  if (!sfData(ctx, it) && !mfData(ctx, it) && !isNode(ctx, self, it) && !isNull(ctx, self, it))
    throwType(ctx, "toString: not a value of VRML");
  pushNotation(ctx, self, it);
  return 1;
}

} // namespace ecma
