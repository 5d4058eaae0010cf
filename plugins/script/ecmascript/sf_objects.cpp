// sf_objects.cpp: Implements the constructors and components of tuples of numbers and of SFImage
// (C.6.4 to C.6.9).
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

SfData* thisData(duk_context* ctx) {
  duk_push_this(ctx);
  return sfData(ctx, -1);
}

duk_ret_t getComponent(duk_context* ctx) {
  step(Interpreter::of(ctx));
  const SfData* data = thisData(ctx);
  if (!data) return 0; // the prototype itself
  const int component = duk_get_current_magic(ctx);
  if (component >= numbersIn(data->type)) return 0; // an accessor of another type
  duk_push_number(ctx, data->v[component]);
  return 1;
}

duk_ret_t setComponent(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  SfData* data = thisData(ctx);
  if (!data) throwType(ctx, "not a value of VRML");
  const int component = duk_get_current_magic(ctx);
  const double value = toNumber(ctx, 0, XS_SFFLOAT, typeName(data->type));
  if (component >= numbersIn(data->type))
    throwType(ctx, "%s: no component %d", typeName(data->type), component);
  data->v[component] = data->type == XS_SFIMAGE ? std::trunc(value) : value;
  writeBack(ctx, self, 1, data, component, 1);
  return 0;
}

duk_ret_t getPixels(duk_context* ctx) {
  duk_push_this(ctx);
  duk_get_prop_heapptr(ctx, -1, Interpreter::of(ctx).keyList);
  return 1;
}

duk_ret_t setPixels(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  SfData* data = thisData(ctx);
  if (!data || data->type != XS_SFIMAGE) throwType(ctx, "not an SFImage");
  pushMfFrom(ctx, self, 0, XS_MFINT32, "SFImage.array");
  mfData(ctx, -1)->place = data->place;
  duk_put_prop_heapptr(ctx, 1, self.keyList);
  writeBack(ctx, self, 1, data, 0, 3);
  return 0;
}

// Computes the shortest rotation from one direction to another (C.6.7).
void rotationBetween(const double* a, const double* b, double* out) {
  const double la = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]),
               lb = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
         z = a[0] * b[1] - a[1] * b[0];
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
               sine = std::sqrt(x * x + y * y + z * z);
  if (!(sine > 1e-12 * la * lb)) { // parallel: any perpendicular axis will do
    const bool alongX = std::fabs(a[0]) > 0.9 * la;
    x = alongX ? a[2] : 0;
    y = alongX ? 0 : -a[2];
    z = alongX ? -a[0] : a[1];
    if (dot >= 0 || la * lb == 0) {
      x = y = 0;
      z = 1;
    }
  }
  const double length = std::sqrt(x * x + y * y + z * z);
  out[0] = x / length;
  out[1] = y / length;
  out[2] = z / length;
  out[3] = la * lb > 0 ? std::atan2(sine, dot) : 0;
}

duk_ret_t construct(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  const auto type = XsType(duk_get_current_magic(ctx));
  const duk_idx_t given = duk_get_top(ctx);
  const int count = components(type);
  double v[XS_MOST_COMPONENTS];
  defaultNumbers(type, v);
  const SfData* first = given > 0 ? sfData(ctx, 0) : nullptr;
  if (type == XS_SFROTATION && given >= 2 && first && components(first->type) == 3) {
    const SfData* second = sfData(ctx, 1);
    if (second && components(second->type) == 3) {
      rotationBetween(first->v, second->v, v);
    } else {
      std::memcpy(v, first->v, 3 * sizeof *v);
      v[3] = toNumber(ctx, 1, XS_SFFLOAT, "SFRotation");
    }
  } else if (given == 1 && (duk_is_object(ctx, 0) || duk_is_string(ctx, 0))) {
    toPlain(ctx, 0, type, v, typeName(type));
  } else {
    for (int i = 0; i < count && i < given; ++i)
      if (!duk_is_undefined(ctx, i)) v[i] = toNumber(ctx, i, XS_SFFLOAT, typeName(type));
  }
  pushSf(ctx, self, type, v);
  return 1;
}

duk_ret_t constructImage(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  const duk_idx_t given = duk_get_top(ctx);
  double v[3] = {};
  const SfData* other = given == 1 ? sfData(ctx, 0) : nullptr;
  if (other && other->type == XS_SFIMAGE) {
    std::memcpy(v, other->v, sizeof v);
    duk_get_prop_heapptr(ctx, 0, self.keyList);
  } else {
    for (int i = 0; i < 3 && i < given; ++i)
      v[i] = std::trunc(toNumber(ctx, i, XS_SFFLOAT, "SFImage"));
    if (given > 3)
      pushMfFrom(ctx, self, 3, XS_MFINT32, "SFImage.array");
    else
      pushMf(ctx, self, XS_MFINT32, 0);
  }
  pushImage(ctx, self, v, {});
  return 1;
}

void keepPrototype(duk_context* ctx, Interpreter& self, XsType type) {
  duk_dup(ctx, -1);
  self.prototypes[type] = keep(ctx);
}

// Adds an accessor; the same two functions serve component `index` of all types.
void putComponent(duk_context* ctx, Interpreter& self, const char* name, int index) {
  duk_push_string(ctx, name);
  duk_push_heapptr(ctx, self.componentGet[index]);
  duk_push_heapptr(ctx, self.componentSet[index]);
  duk_def_prop(ctx, -4,
               DUK_DEFPROP_HAVE_GETTER | DUK_DEFPROP_HAVE_SETTER | DUK_DEFPROP_SET_ENUMERABLE);
}

// Creates the prototype and the constructor of a tuple of numbers. Its numbers are x[0], x[1] and
// so on; those of up to four have names, too.
void registerTuple(duk_context* ctx, Interpreter& self, XsType type) {
  const char* const names = type == XS_SFCOLOR || type == XS_SFCOLORRGBA ? "rgba" : "xyzw";
  duk_push_object(ctx);
  keepPrototype(ctx, self, type);
  for (int i = 0; i < components(type); ++i) {
    char text[16];
    std::snprintf(text, sizeof text, "%d", i);
    putComponent(ctx, self, text, i);
    if (components(type) > 4) continue;
    std::snprintf(text, sizeof text, "%c", names[i]);
    putComponent(ctx, self, type == XS_SFROTATION && i == 3 ? "angle" : text, i);
  }
  putConstructor(ctx, typeName(type), construct, type);
}

} // namespace

SfData* pushSf(duk_context* ctx, Interpreter& self, XsType type, const double* v) {
  duk_push_bare_object(ctx);
  duk_push_heapptr(ctx, self.prototypes[type]);
  duk_set_prototype(ctx, -2);
  const size_t bytes = size_t(numbersIn(type)) * sizeof *v;
  auto* data =
      static_cast<SfData*>(duk_push_fixed_buffer(ctx, offsetof(SfData, v) + bytes)); // all zero
  data->type = type;
  data->place = {};
  std::memcpy(data->v, v, bytes);
  duk_put_prop_heapptr(ctx, -2, self.keySf);
  return data;
}

void pushImage(duk_context* ctx, Interpreter& self, const double* v, Place place) {
  pushSf(ctx, self, XS_SFIMAGE, v)->place = place;
  pushMfFrom(ctx, self, -2, XS_MFINT32, "SFImage.array");
  mfData(ctx, -1)->place = place;
  duk_put_prop_heapptr(ctx, -2, self.keyList);
  duk_remove(ctx, -2);
}

void pushImageFrom(duk_context* ctx, Interpreter& self, duk_idx_t index, Place place,
                   const char* what) {
  const SfData* image = sfData(ctx, index);
  if (!image || image->type != XS_SFIMAGE)
    throwType(ctx, "%s: expected SFImage, got %s", what, describe(ctx, index));
  duk_get_prop_heapptr(ctx, index, self.keyList);
  pushImage(ctx, self, image->v, place);
}

void writeBack(duk_context* ctx, Interpreter& self, duk_idx_t index, SfData* data, int first,
               int count) {
  index = duk_normalize_index(ctx, index);
  if (data->hasParent) {
    duk_get_prop_heapptr(ctx, index, self.keyParent);
    MfData* mf = mfData(ctx, -1);
    if (mf && elementType(mf->type) == data->type) {
      if (data->index >= mf->count) mf = resizeMf(ctx, self, -1, data->index + 1);
      const size_t at = size_t(data->index) * size_t(components(data->type));
      for (int i = first; i < first + count; ++i)
        setNumberAt(data->type, mf + 1, at + size_t(i), data->v[i]);
      touchMf(ctx, self, -1);
    }
    duk_pop(ctx);
  }
  if (!isLive(self, data->place)) return;
  const int slot = data->place.slot;
  if (data->type == XS_SFIMAGE) return markDirty(ctx, self, slot);
  loadSlot(ctx, self, slot);
  for (int i = first; i < first + count; ++i)
    self.slots[size_t(slot)].plain[i] = rounded(data->type, data->v[i]);
  markDirty(ctx, self, slot);
}

void registerSf(duk_context* ctx, Interpreter& self) {
  for (int i = 0; i < XS_MOST_COMPONENTS; ++i) {
    duk_push_c_function(ctx, getComponent, 0);
    duk_set_magic(ctx, -1, i);
    self.componentGet[i] = keep(ctx);
    duk_push_c_function(ctx, setComponent, 1);
    duk_set_magic(ctx, -1, i);
    self.componentSet[i] = keep(ctx);
  }
  for (int i = XS_SFBOOL; i <= XS_LAST_TYPE; ++i) {
    const auto type = XsType(i);
    if (!isMf(type) && components(type) > 1) registerTuple(ctx, self, type);
  }
  duk_push_object(ctx);
  keepPrototype(ctx, self, XS_SFIMAGE);
  static const char* const image[] = {"x", "y", "comp"};
  for (int i = 0; i < 3; ++i) putComponent(ctx, self, image[i], i);
  putAccessor(ctx, "array", getPixels, setPixels, 0);
  putConstructor(ctx, "SFImage", constructImage, 0);
  registerSfMethods(ctx, self);
}

} // namespace ecma
