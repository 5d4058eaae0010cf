// to_host.cpp: Converts the program's values for the host. The data lie in the Duktape heap or in
// the interpreter's arrays.
#include <cstring>
#include <new>

#include "slots.h"

namespace ecma {
namespace {

// Runs C++ code that may allocate; std::bad_alloc becomes a Duktape error, because exceptions must
// not cross Duktape.
template <class Work> void guardMemory(duk_context* ctx, Work&& work) {
  bool full = false;
  try {
    work();
  } catch (const std::bad_alloc&) { full = true; }
  if (full) throwRange(ctx, "out of memory");
}

bool isSurrogate(const unsigned char* at, const unsigned char* end) {
  return end - at >= 3 && at[0] == 0xed && at[1] >= 0xa0;
}

// Converts surrogate pairs to one character each, and lone surrogates, which UTF-8 cannot encode,
// to U+FFFD.
void convertText(const unsigned char* at, const unsigned char* end, std::string& out) {
  while (at < end) {
    if (!isSurrogate(at, end)) {
      out += char(*at++);
      continue;
    }
    const unsigned high = unsigned(at[1] & 0x3f) << 6 | unsigned(at[2] & 0x3f); // the low 12 bits
    at += 3;
    if (high < 0xc00 && isSurrogate(at, end) && at[1] >= 0xb0) {
      const unsigned low = unsigned(at[1] & 0x3f) << 6 | unsigned(at[2] & 0x3f);
      const unsigned code = 0x10000 + ((high & 0x3ff) << 10 | (low & 0x3ff));
      at += 3;
      for (const unsigned byte : {0xf0 | code >> 18, 0x80 | ((code >> 12) & 0x3f),
                                  0x80 | ((code >> 6) & 0x3f), 0x80 | (code & 0x3f)})
        out += char(byte);
    } else {
      out += "\xef\xbf\xbd";
    }
  }
}

bool needsConversion(const char* text, size_t bytes) {
  for (const char* at = text;
       (at = static_cast<const char*>(std::memchr(at, 0xed, bytes - size_t(at - text)))); ++at)
    if (isSurrogate(reinterpret_cast<const unsigned char*>(at),
                    reinterpret_cast<const unsigned char*>(text + bytes)))
      return true;
  return false;
}

void addString(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  const XsString text = textForHost(ctx, self, index);
  guardMemory(ctx, [&] { self.strings.push_back(text); });
}

// Adds the SFImage on top to the images for the host.
void addImage(duk_context* ctx, Interpreter& self, const char* name) {
  const SfData* sf = sfData(ctx, -1);
  duk_get_prop_heapptr(ctx, -1, self.keyList);
  MfData* mf = mfData(ctx, -1);
  duk_pop(ctx);
  const double w = sf->v[0], h = sf->v[1], n = sf->v[2];
  if (!mf || !(w >= 0 && h >= 0 && n >= 0 && n <= 4) || w * h > maxElements)
    throwType(ctx, "%s: not an image: %g x %g x %g", name, w, h, n);
  XsImage image = {int32_t(w), int32_t(h), int32_t(n), 0, nullptr};
  const size_t count = size_t(image.width) * size_t(image.height), bytes = size_t(image.components);
  guardMemory(ctx, [&] { self.pixels.emplace_back(count * bytes + 1, 0); });
  std::vector<uint8_t>& pixels = self.pixels.back();
  for (size_t i = 0; i < count && i < mf->count; ++i) // missing pixels are 0
    for (size_t k = 0; k < bytes; ++k)
      pixels[i * bytes + k] = uint8_t(uint32_t(intsOf(mf)[i]) >> (8 * (bytes - 1 - k)));
  image.pixels = pixels.data();
  guardMemory(ctx, [&] { self.images.push_back(image); });
}

void pushListOf(duk_context* ctx, Interpreter& self, duk_idx_t index, XsType type,
                const char* what) {
  const MfData* mf = mfData(ctx, index);
  if (mf && mf->type == type)
    duk_dup(ctx, index);
  else
    pushMfFrom(ctx, self, index, type, what);
}

void listValue(duk_context* ctx, Interpreter& self, XsValue& out) {
  MfData* mf = mfData(ctx, -1);
  out.count = mf->count;
  if (elementBytes(mf->type) > 0) {
    out.of.data = mf + 1;
    return;
  }
  const duk_idx_t index = duk_get_top_index(ctx);
  if (mf->type == XS_MFNODE) {
    nodesForHost(ctx, self, index, "");
    out.of.nodes = self.handles.data();
  } else if (mf->type == XS_MFIMAGE) {
    duk_get_prop_heapptr(ctx, index, self.keyList);
    for (uint32_t i = 0; i < out.count; ++i) {
      duk_get_prop_index(ctx, -1, i);
      addImage(ctx, self, "MFImage");
      duk_pop(ctx); // the list keeps it alive
    }
    duk_pop(ctx);
    out.of.images = self.images.data();
  } else {
    textsForHost(ctx, self, index, "");
    out.of.strings = self.strings.data();
  }
}

} // namespace

XsString textForHost(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  duk_size_t bytes = 0;
  const char* text = duk_get_lstring(ctx, index, &bytes);
  if (!needsConversion(text, bytes)) return {text, bytes};
  guardMemory(ctx, [&] {
    self.texts.emplace_back();
    convertText(reinterpret_cast<const unsigned char*>(text),
                reinterpret_cast<const unsigned char*>(text + bytes), self.texts.back());
  });
  return {self.texts.back().data(), self.texts.back().size()};
}

void textsForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what) {
  index = duk_normalize_index(ctx, index);
  pushListOf(ctx, self, index, XS_MFSTRING, what);
  const uint32_t count = mfData(ctx, -1)->count;
  guardMemory(ctx, [&] {
    self.strings.clear();
    self.strings.reserve(count + 1);
  });
  duk_get_prop_heapptr(ctx, -1, self.keyList);
  for (uint32_t i = 0; i < count; ++i) {
    duk_get_prop_index(ctx, -1, i);
    addString(ctx, self, -1);
    duk_pop(ctx); // the list keeps it alive
  }
  duk_pop(ctx);
  duk_replace(ctx, index); // the list stays on the stack
}

void nodesForHost(duk_context* ctx, Interpreter& self, duk_idx_t index, const char* what) {
  index = duk_normalize_index(ctx, index);
  pushListOf(ctx, self, index, XS_MFNODE, what);
  const uint32_t count = mfData(ctx, -1)->count;
  guardMemory(ctx, [&] { self.handles.assign(count + 1, 0); });
  duk_get_prop_heapptr(ctx, -1, self.keyList);
  for (uint32_t i = 0; i < count; ++i) {
    duk_get_prop_index(ctx, -1, i);
    self.handles[i] = nodeOf(ctx, self, -1, what);
    duk_pop(ctx);
  }
  duk_pop(ctx);
  duk_replace(ctx, index);
}

void slotValue(duk_context* ctx, Interpreter& self, int slot, XsValue& out) {
  const Slot& it = self.slots[size_t(slot)];
  out = {it.type, 1, {nullptr}};
  self.pixels.clear();
  self.images.clear();
  duk_set_top(ctx, 0); // discards what was pushed for the previous slot
  switch (it.type) {
  case XS_SFBOOL:
  case XS_SFINT32:
    self.integer = int32_t(it.plain[0]);
    out.of.ints = &self.integer;
    return;
  default: break;
  }
  if (const int count = components(it.type); count > 0 && !isMf(it.type)) {
    if (!xsHasDoubles(it.type))
      guardMemory(ctx, [&] { self.floats.assign(it.plain, it.plain + count); });
    out.of.data = xsHasDoubles(it.type) ? static_cast<const void*>(it.plain) : self.floats.data();
    return;
  }
  duk_push_heapptr(ctx, self.values);
  duk_get_prop_index(ctx, -1, duk_uarridx_t(slot));
  if (isMf(it.type)) {
    listValue(ctx, self, out);
  } else if (it.type == XS_SFSTRING) {
    guardMemory(ctx, [&] { self.strings.clear(); });
    addString(ctx, self, -1);
    out.of.strings = self.strings.data();
  } else if (it.type == XS_SFNODE) {
    guardMemory(ctx, [&] { self.handles.assign(1, 0); });
    self.handles[0] = nodeOf(ctx, self, -1, it.name.c_str());
    out.of.nodes = self.handles.data();
  } else {
    addImage(ctx, self, it.name.c_str());
    out.of.images = self.images.data();
  }
}

} // namespace ecma
