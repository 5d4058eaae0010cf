// from_host.cpp: Converts the host's values to the program's.
#include <cstring>

#include "slots.h"

namespace ecma {

void pushString(duk_context* ctx, const XsString& text) {
  // Converts the host's UTF-8. ECMAScript's strings are UTF-16, so characters beyond U+FFFF become
  // two (CESU-8 inside Duktape).
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data);
  uint64_t beyond = 0;
  for (uint64_t i = 0; i < text.bytes; ++i) beyond += bytes[i] >= 0xf0;
  if (beyond == 0) {
    duk_push_lstring(ctx, text.data, text.bytes);
    return;
  }
  auto* out = static_cast<unsigned char*>(duk_push_fixed_buffer(ctx, text.bytes + 2 * beyond));
  uint64_t length = 0;
  const auto put = [&](unsigned unit) {
    out[length++] = static_cast<unsigned char>(0xe0 | (unit >> 12));
    out[length++] = static_cast<unsigned char>(0x80 | ((unit >> 6) & 0x3f));
    out[length++] = static_cast<unsigned char>(0x80 | (unit & 0x3f));
  };
  for (uint64_t i = 0; i < text.bytes; ++i) {
    if (bytes[i] < 0xf0 || i + 3 >= text.bytes) {
      out[length++] = bytes[i];
      continue;
    }
    const unsigned code = ((bytes[i] & 7u) << 18 | (bytes[i + 1] & 0x3fu) << 12 |
                           (bytes[i + 2] & 0x3fu) << 6 | (bytes[i + 3] & 0x3fu)) -
                          0x10000;
    put(0xd800 + (code >> 10));
    put(0xdc00 + (code & 0x3ff));
    i += 3;
  }
  duk_push_lstring(ctx, reinterpret_cast<const char*>(out), length);
  duk_remove(ctx, -2);
}

namespace {

void pushTuple(duk_context* ctx, Interpreter& self, const XsValue& value) {
  double v[XS_MOST_COMPONENTS];
  for (int i = 0; i < components(value.type); ++i)
    v[i] = numberAt(value.type, value.of.data, size_t(i));
  pushSf(ctx, self, value.type, v);
}

// Converts pixels of 0 to 4 bytes to numbers 0xRRGGBBAA, as VRML writes them (5.5).
void pushPixels(duk_context* ctx, Interpreter& self, const XsImage& image, Place place) {
  const uint64_t count = image.components > 0 ? uint64_t(image.width) * uint64_t(image.height) : 0;
  if (count > maxElements)
    throwRange(ctx, "an image of %d x %d", int(image.width), int(image.height));
  MfData* mf = pushMf(ctx, self, XS_MFINT32, uint32_t(count), place);
  for (uint64_t i = 0; i < count; ++i) {
    uint32_t pixel = 0;
    for (int k = 0; k < image.components; ++k)
      pixel = pixel << 8 | image.pixels[i * uint64_t(image.components) + uint64_t(k)];
    intsOf(mf)[i] = int32_t(pixel);
  }
}

void pushHostImage(duk_context* ctx, Interpreter& self, const XsImage& image, Place place) {
  const double v[] = {double(image.width), double(image.height), double(image.components)};
  pushPixels(ctx, self, image, place);
  pushImage(ctx, self, v, place);
}

void pushNodes(duk_context* ctx, Interpreter& self, const XsValue& value, Place place) {
  // Copied, because the host's list is valid only until its next call.
  const uint32_t count = value.count;
  auto* nodes = static_cast<XsNode*>(duk_push_fixed_buffer(ctx, (count + 1) * sizeof(XsNode)));
  if (count > 0) std::memcpy(nodes, value.of.nodes, count * sizeof *nodes);
  pushMf(ctx, self, XS_MFNODE, 0, place)->count = count;
  duk_get_prop_heapptr(ctx, -1, self.keyList);
  for (uint32_t i = 0; i < count; ++i) {
    pushNode(ctx, self, nodes[i]);
    duk_put_prop_index(ctx, -2, i);
  }
  duk_pop(ctx);
  duk_remove(ctx, -2);
}

} // namespace

void pushValue(duk_context* ctx, Interpreter& self, const XsValue& value, Place place) {
  switch (value.type) {
  case XS_SFBOOL: return duk_push_boolean(ctx, value.of.ints[0] != 0);
  case XS_SFINT32: return duk_push_int(ctx, value.of.ints[0]);
  case XS_SFFLOAT: return duk_push_number(ctx, widen(value.of.floats[0]));
  case XS_SFTIME: return duk_push_number(ctx, value.of.doubles[0]);
  case XS_SFSTRING: return pushString(ctx, value.of.strings[0]);
  case XS_SFNODE: return pushNode(ctx, self, value.of.nodes[0]);
  case XS_SFDOUBLE: return duk_push_number(ctx, value.of.doubles[0]);
  case XS_SFIMAGE: return pushHostImage(ctx, self, value.of.images[0], place);
  case XS_MFNODE: return pushNodes(ctx, self, value, place);
  case XS_MFSTRING:
    if (value.count > maxElements) throwRange(ctx, "more than %u elements", maxElements);
    pushMf(ctx, self, XS_MFSTRING, 0, place)->count = value.count;
    duk_get_prop_heapptr(ctx, -1, self.keyList);
    for (uint32_t i = 0; i < value.count; ++i) {
      pushString(ctx, value.of.strings[i]);
      duk_put_prop_index(ctx, -2, i);
    }
    return duk_pop(ctx);
  case XS_MFIMAGE:
    if (value.count > maxElements) throwRange(ctx, "more than %u elements", maxElements);
    pushMf(ctx, self, XS_MFIMAGE, 0, place)->count = value.count;
    duk_get_prop_heapptr(ctx, -1, self.keyList);
    for (uint32_t i = 0; i < value.count; ++i) {
      pushHostImage(ctx, self, value.of.images[i], {});
      duk_put_prop_index(ctx, -2, i);
    }
    return duk_pop(ctx);
  default: break;
  }
  if (!isMf(value.type)) return pushTuple(ctx, self, value);
  if (value.count > maxElements) throwRange(ctx, "more than %u elements", maxElements);
  MfData* mf = pushMf(ctx, self, value.type, value.count, place);
  if (value.count > 0)
    std::memcpy(static_cast<void*>(mf + 1), value.of.data, elementBytes(value.type) * value.count);
}

} // namespace ecma
