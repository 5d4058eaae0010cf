// mf_objects.cpp: Implements VRML's arrays (C.6.10 to C.6.18): storage, elements, constructors.
// Indexing is in mf_traps.cpp.
#include <algorithm>
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

bool isZeroByDefault(XsType type) {
  double v[XS_MOST_COMPONENTS];
  defaultNumbers(elementType(type), v);
  return std::all_of(v, v + components(type), [](double number) { return number == 0; });
}

// Sets the elements [from, to) to their defaults.
void clearElements(duk_context* ctx, Interpreter& self, duk_idx_t index, MfData* mf, uint32_t from,
                   uint32_t to) {
  if (const size_t bytes = elementBytes(mf->type)) {
    double v[XS_MOST_COMPONENTS];
    const XsType element = elementType(mf->type);
    const auto n = size_t(components(element));
    defaultNumbers(element, v);
    std::memset(reinterpret_cast<char*>(mf + 1) + bytes * from, 0, bytes * (to - from));
    for (size_t k = 0; k < n; ++k)
      for (size_t i = from; v[k] != 0 && i < to; ++i) setNumberAt(element, mf + 1, i * n + k, v[k]);
    return;
  }
  const XsType type = mf->type;
  const double noImage[3] = {};
  duk_get_prop_heapptr(ctx, index, self.keyList);
  for (uint32_t i = from; i < to; ++i) {
    if (type == XS_MFSTRING) {
      duk_push_string(ctx, "");
    } else if (type == XS_MFIMAGE) {
      pushMf(ctx, self, XS_MFINT32, 0);
      pushImage(ctx, self, noImage, {});
    } else
      duk_push_null(ctx);
    duk_put_prop_index(ctx, -2, i);
  }
  duk_pop(ctx);
}

duk_ret_t construct(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  const auto type = XsType(duk_get_current_magic(ctx));
  const duk_idx_t given = duk_get_top(ctx);
  if (given == 1 && (duk_is_array(ctx, 0) || mfData(ctx, 0) || duk_is_buffer_data(ctx, 0))) {
    pushMfFrom(ctx, self, 0, type, typeName(type));
    return 1;
  }
  pushMf(ctx, self, type, uint32_t(given));
  for (duk_idx_t i = 0; i < given; ++i)
    setElement(ctx, self, given, uint32_t(i), i, typeName(type));
  return 1;
}

} // namespace

MfData* pushMf(duk_context* ctx, Interpreter& self, XsType type, uint32_t count, Place place) {
  if (count > maxElements)
    throwRange(ctx, "%s: more than %u elements", typeName(type), unsigned(maxElements));
  const size_t bytes = elementBytes(type);
  duk_push_bare_object(ctx); // the target of the proxy
  duk_push_heapptr(ctx, self.prototypes[type]);
  duk_set_prototype(ctx, -2);
  auto* mf = static_cast<MfData*>(duk_push_dynamic_buffer(ctx, sizeof(MfData) + bytes * count));
  *mf = {type, place, count};
  duk_put_prop_heapptr(ctx, -2, self.keyMf);
  if (bytes == 0) {
    duk_push_array(ctx);
    duk_put_prop_heapptr(ctx, -2, self.keyList);
  }
  if (bytes == 0 || !isZeroByDefault(type)) clearElements(ctx, self, -1, mf, 0, count);
  duk_push_heapptr(ctx, self.mfHandler);
  duk_push_proxy(ctx, 0);
  return mf;
}

MfData* resizeMf(duk_context* ctx, Interpreter& self, duk_idx_t index, uint32_t count) {
  index = duk_normalize_index(ctx, index);
  MfData* mf = mfData(ctx, index);
  if (count > maxElements)
    throwRange(ctx, "%s: more than %u elements", typeName(mf->type), unsigned(maxElements));
  const uint32_t before = mf->count;
  if (const size_t bytes = elementBytes(mf->type)) {
    duk_get_prop_heapptr(ctx, index, self.keyMf);
    duk_size_t size = 0;
    duk_get_buffer(ctx, -1, &size);
    const size_t wanted = sizeof(MfData) + bytes * count;
    if (wanted > size)
      mf = static_cast<MfData*>(
          duk_resize_buffer(ctx, -1, count > before + 1 ? wanted : wanted + wanted / 2));
    duk_pop(ctx);
  } else if (count < before) {
    duk_get_prop_heapptr(ctx, index, self.keyList);
    duk_set_length(ctx, -1, count);
    duk_pop(ctx);
  }
  if (count > before) clearElements(ctx, self, index, mf, before, count);
  mf->count = count;
  return mf;
}

void pushElement(duk_context* ctx, Interpreter& self, duk_idx_t index, uint32_t i) {
  index = duk_normalize_index(ctx, index);
  MfData* mf = mfData(ctx, index);
  const bool beyond = i >= mf->count;
  if (beyond && (elementBytes(mf->type) == 0 || components(elementType(mf->type)) == 1))
    return duk_push_undefined(ctx);
  switch (mf->type) {
  case XS_MFBOOL: return duk_push_boolean(ctx, intsOf(mf)[i] != 0);
  case XS_MFDOUBLE:
  case XS_MFFLOAT:
  case XS_MFINT32:
  case XS_MFTIME: return duk_push_number(ctx, numberAt(mf->type, mf + 1, i));
  case XS_MFIMAGE:
  case XS_MFSTRING:
  case XS_MFNODE:
    duk_get_prop_heapptr(ctx, index, self.keyList);
    duk_get_prop_index(ctx, -1, i);
    return duk_remove(ctx, -2);
  default: break;
  }
  const XsType element = elementType(mf->type);
  const int n = components(element);
  double v[XS_MOST_COMPONENTS];
  defaultNumbers(element, v);
  for (int k = 0; k < n && !beyond; ++k)
    v[k] = numberAt(element, mf + 1, size_t(i) * size_t(n) + size_t(k));
  // The element is a copy that writes changes back to the array, also beyond its end:
  // mf[mf.length].x = 1 makes the array longer.
  SfData* sf = pushSf(ctx, self, element, v);
  sf->hasParent = 1;
  sf->index = i;
  duk_dup(ctx, index);
  duk_put_prop_heapptr(ctx, -2, self.keyParent);
}

void setElement(duk_context* ctx, Interpreter& self, duk_idx_t index, uint32_t i, duk_idx_t value,
                const char* what) {
  index = duk_normalize_index(ctx, index);
  value = duk_normalize_index(ctx, value);
  const XsType type = mfData(ctx, index)->type, element = elementType(type);
  if (elementBytes(type) > 0) {
    double v[XS_MOST_COMPONENTS];
    toPlain(ctx, value, element, v, what);
    MfData* mf = mfData(ctx, index);
    if (i >= mf->count) mf = resizeMf(ctx, self, index, i + 1);
    const int n = components(element);
    for (int k = 0; k < n; ++k)
      setNumberAt(element, mf + 1, size_t(i) * size_t(n) + size_t(k), v[k]);
    return;
  }
  if (type == XS_MFSTRING)
    pushText(ctx, value, what);
  else if (type == XS_MFIMAGE)
    pushImageFrom(ctx, self, value, {}, what);
  else
    pushNode(ctx, self, nodeOf(ctx, self, value, what));
  if (i >= mfData(ctx, index)->count) resizeMf(ctx, self, index, i + 1);
  duk_get_prop_heapptr(ctx, index, self.keyList);
  duk_dup(ctx, -2);
  duk_put_prop_index(ctx, -2, i);
  duk_pop_2(ctx);
}

void pushMfFrom(duk_context* ctx, Interpreter& self, duk_idx_t index, XsType type,
                const char* what) {
  index = duk_normalize_index(ctx, index);
  if (type == XS_MFNODE && pushSceneNodes(ctx, index)) { // a scene stands for its nodes
    pushMfFrom(ctx, self, -1, type, what);
    return duk_remove(ctx, -2);
  }
  const MfData* from = mfData(ctx, index);
  if (from && from->type == type && elementBytes(type) > 0) {
    const uint32_t count = from->count;
    MfData* mf = pushMf(ctx, self, type, count);
    from = mfData(ctx, index);
    if (count > 0) std::memcpy(static_cast<void*>(mf + 1), from + 1, elementBytes(type) * count);
    return;
  }
  const bool list = from || duk_is_array(ctx, index) || duk_is_buffer_data(ctx, index);
  const size_t count = from                                           ? from->count
                       : list                                         ? duk_get_length(ctx, index)
                       : type == XS_MFNODE && duk_is_null(ctx, index) ? 0
                                                                      : 1;
  if (count > maxElements)
    throwRange(ctx, "%s: more than %u elements", what, unsigned(maxElements));
  pushMf(ctx, self, type, uint32_t(count));
  const duk_idx_t made = duk_get_top_index(ctx);
  for (uint32_t i = 0; i < count; ++i) {
    if (!list) {
      setElement(ctx, self, made, 0, index, what);
      break;
    }
    if (from)
      pushElement(ctx, self, index, i);
    else
      duk_get_prop_index(ctx, index, i);
    setElement(ctx, self, made, i, -1, what);
    duk_pop(ctx);
  }
}

void touchMf(duk_context* ctx, Interpreter& self, duk_idx_t index) {
  const Place place = mfData(ctx, index)->place;
  if (isLive(self, place)) markDirty(ctx, self, place.slot);
}

void registerMf(duk_context* ctx, Interpreter& self) {
  registerMfTraps(ctx, self);
  static constexpr Method methods[] = {{"toString", notationMethod, 0}};
  for (int type = XS_SFBOOL; type <= XS_LAST_TYPE; ++type) {
    if (!isMf(XsType(type))) continue;
    duk_push_object(ctx); // join, push, pop, slice, sort and others are inherited from Array
    duk_get_global_string(ctx, "Array");
    duk_get_prop_string(ctx, -1, "prototype");
    duk_remove(ctx, -2);
    duk_set_prototype(ctx, -2);
    duk_dup(ctx, -1);
    self.prototypes[type] = keep(ctx);
    putMethods(ctx, methods, 1);
    putConstructor(ctx, typeName(XsType(type)), construct, type);
  }
}

} // namespace ecma
