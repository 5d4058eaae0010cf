// mf_traps.cpp: Implements mf[i], mf.length and their assignment as traps of the proxies that
// represent MF objects.
//
// An index inside the array returns the element. An index outside returns undefined, or a tuple
// that does not exist yet. Assigning outside the array, or to a component of such a tuple, makes
// the array longer (C.6.10).
#include <cmath>
#include <cstring>

#include "slots.h"

namespace ecma {
namespace {

enum class Key : uint8_t { element, length, none, other };

// Decodes the traps' second argument: a number, or a string such as "12" or "length".
Key keyOf(duk_context* ctx, uint32_t& index) {
  double number = 0;
  if (duk_is_number(ctx, 1)) {
    number = duk_get_number(ctx, 1);
  } else {
    const char* text = duk_get_string(ctx, 1);
    if (!text) return Key::other;
    if (std::strcmp(text, "length") == 0) return Key::length;
    if ((*text < '0' || *text > '9') && *text != '-') return Key::other;
    duk_dup(ctx, 1);
    number = duk_to_number(ctx, -1);
    duk_pop(ctx);
    if (std::isnan(number)) return Key::other;
  }
  if (!(number >= 0 && number < 4294967295.0) || number != std::floor(number)) return Key::none;
  index = uint32_t(number);
  return Key::element;
}

duk_ret_t get(duk_context* ctx) { // arguments: target, key, receiver
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  uint32_t index = 0;
  switch (keyOf(ctx, index)) {
  case Key::element: pushElement(ctx, self, 0, index); return 1;
  case Key::length: duk_push_uint(ctx, mfData(ctx, 0)->count); return 1;
  case Key::none: return 0;
  case Key::other: break;
  }
  duk_dup(ctx, 1);
  duk_get_prop(ctx, 0);
  return 1;
}

// Handles an assignment. Arguments: target, key, value, receiver.
duk_ret_t set(duk_context* ctx) {
  Interpreter& self = Interpreter::of(ctx);
  step(self);
  const char* name = typeName(mfData(ctx, 0)->type);
  uint32_t index = 0;
  switch (keyOf(ctx, index)) {
  case Key::element:
    if (index >= maxElements)
      throwRange(ctx, "%s: more than %u elements", name, unsigned(maxElements));
    setElement(ctx, self, 0, index, 2, name);
    touchMf(ctx, self, 0);
    break;
  case Key::length: {
    const double count = toNumber(ctx, 2, XS_SFINT32, "length");
    if (!(count >= 0 && count <= maxElements)) throwRange(ctx, "%s: length %g", name, count);
    resizeMf(ctx, self, 0, uint32_t(count));
    touchMf(ctx, self, 0);
    break;
  }
  case Key::none: throwRange(ctx, "%s: no element %s", name, duk_safe_to_string(ctx, 1));
  case Key::other:
    duk_dup(ctx, 1);
    duk_dup(ctx, 2);
    duk_put_prop(ctx, 0);
    break;
  }
  duk_push_true(ctx);
  return 1;
}

duk_ret_t has(duk_context* ctx) { // arguments: target, key
  uint32_t index = 0;
  switch (keyOf(ctx, index)) {
  case Key::element: duk_push_boolean(ctx, index < mfData(ctx, 0)->count); return 1;
  case Key::length: duk_push_true(ctx); return 1;
  case Key::none: duk_push_false(ctx); return 1;
  case Key::other: break;
  }
  duk_dup(ctx, 1);
  duk_push_boolean(ctx, duk_has_prop(ctx, 0));
  return 1;
}

// arguments: target, key. Elements cannot be deleted, only the program's own properties.
duk_ret_t remove(duk_context* ctx) {
  uint32_t index = 0;
  if (keyOf(ctx, index) == Key::other) {
    duk_dup(ctx, 1);
    duk_del_prop(ctx, 0);
  }
  duk_push_true(ctx);
  return 1;
}

} // namespace

void registerMfTraps(duk_context* ctx, Interpreter& self) {
  static constexpr Method traps[] = {
      {"get", get, 3}, {"set", set, 4}, {"has", has, 2}, {"deleteProperty", remove, 2}};
  duk_push_bare_object(ctx);
  putMethods(ctx, traps, std::size(traps));
  self.mfHandler = keep(ctx);
}

} // namespace ecma
