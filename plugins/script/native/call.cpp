#include "call.h"

#include <algorithm>
#include <cstring>

#include <xvrml/xscript_types.h>

namespace native {
namespace {

constexpr uint32_t defaultRoom = 65536; // default room in elements or characters

ffi_type* typeOf(Number number) {
  switch (number) {
  case Number::i8: return &ffi_type_sint8;
  case Number::u8: return &ffi_type_uint8;
  case Number::i16: return &ffi_type_sint16;
  case Number::u16: return &ffi_type_uint16;
  case Number::i32: return &ffi_type_sint32;
  case Number::u32: return &ffi_type_uint32;
  case Number::i64: return &ffi_type_sint64;
  case Number::u64: return &ffi_type_uint64;
  case Number::f32: return &ffi_type_float;
  case Number::f64: return &ffi_type_double;
  case Number::none: break;
  }
  return &ffi_type_void;
}

// Returns the C type of a VRML number; none for types that are passed as pointers.
Number defaultNumber(XsType type) {
  switch (type) {
  case XS_SFBOOL:
  case XS_SFINT32: return Number::i32;
  case XS_SFFLOAT: return Number::f32;
  case XS_SFTIME:
  case XS_SFDOUBLE: return Number::f64;
  case XS_SFNODE: return Number::u64;
  default: return Number::none;
  }
}

bool isUnsigned(Number n) {
  return n == Number::u8 || n == Number::u16 || n == Number::u32 || n == Number::u64;
}

// Clamps a number to the range of its type.
double bounded(double v, double low, double high) {
  return v >= low && v <= high ? v : v > high ? high : v < low ? low : 0;
}

// A cell holds a number of type `number` in its first bytes, like C (little-endian).
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
void put(Cell& cell, Number number, double v) {
  cell.u = 0;
  if (number == Number::f32)
    cell.f = float(v);
  else if (number == Number::f64)
    cell.d = v;
  else if (isUnsigned(number))
    cell.u = uint64_t(bounded(v, 0, 1.8e19));
  else
    cell.i = int64_t(bounded(v, -9.2e18, 9.2e18));
}

double get(const Cell& cell, Number number) {
  switch (number) {
  case Number::f32: return double(cell.f);
  case Number::f64: return cell.d;
  case Number::i8: return int8_t(cell.i);
  case Number::u8: return uint8_t(cell.u);
  case Number::i16: return int16_t(cell.i);
  case Number::u16: return uint16_t(cell.u);
  case Number::i32: return int32_t(cell.i);
  case Number::u32: return uint32_t(cell.u);
  case Number::i64: return double(cell.i);
  default: return double(cell.u);
  }
}

double numberIn(Slot& slot) {
  switch (slot.type()) {
  case XS_SFFLOAT: return double(*static_cast<float*>(slot.data()));
  case XS_SFTIME:
  case XS_SFDOUBLE: return *static_cast<double*>(slot.data());
  default: return *static_cast<int32_t*>(slot.data());
  }
}

void setNumber(Slot& slot, double v) {
  switch (slot.type()) {
  case XS_SFFLOAT: *static_cast<float*>(slot.data()) = float(v); break;
  case XS_SFTIME:
  case XS_SFDOUBLE: *static_cast<double*>(slot.data()) = v; break;
  case XS_SFBOOL: *static_cast<int32_t*>(slot.data()) = v != 0; break;
  default:
    *static_cast<int32_t*>(slot.data()) = int32_t(bounded(v, -2147483648.0, 2147483647.0));
    break;
  }
}

void* pointerTo(Slot& slot) {
  return slot.type() == XS_SFSTRING ? const_cast<char*>(slot.text()) : slot.data();
}

} // namespace

void PreparedCall::push(ffi_type* type, std::function<void(const World&, Cell&)> fill) {
  types_.push_back(type);
  fill_.push_back(std::move(fill));
}

// Returns the place of a field; x.data and x.count share one.
PreparedCall::Place& PreparedCall::place(const Argument& argument) {
  for (Place& known : places_)
    if (known.field == argument.field) return known;
  Place& made = places_.emplace_back();
  made.field = argument.field;
  made.slot = Slot(info_.fields[argument.field].type);
  made.number = argument.number;
  made.room = argument.room ? argument.room : defaultRoom;
  return made;
}

void PreparedCall::add(const Argument& a) {
  if (a.kind == Argument::Kind::integer || a.kind == Argument::Kind::real)
    return push(typeOf(a.number), [a](const World&, Cell& cell) { put(cell, a.number, a.value); });
  if (a.kind == Argument::Kind::host)
    return push(&ffi_type_pointer,
                [](const World& w, Cell& cell) { cell.p = const_cast<XsHost*>(w.host); });
  if (a.kind == Argument::Kind::self)
    return push(&ffi_type_uint64, [](const World& w, Cell& cell) { cell.u = w.self; });
  if (a.kind == Argument::Kind::time) {
    const Number type = a.number != Number::none ? a.number : Number::f64;
    return push(typeOf(type), [type](const World& w, Cell& cell) { put(cell, type, w.time); });
  }
  const XsType type = info_.fields[a.field].type;
  const bool many = xsIsMany(type);
  const bool data = a.part != Argument::Part::count, count = a.part == Argument::Part::count;
  if (a.write) {
    Place& written = place(a);
    if (data)
      push(&ffi_type_pointer, [&written](const World&, Cell& cell) {
        cell.p = written.number != Number::none ? static_cast<void*>(&written.cell)
                                                : written.slot.data();
      });
    if (many && (count || (a.part == Argument::Part::whole && !a.room))) {
      written.fixed = false;
      push(&ffi_type_pointer, [&written](const World&, Cell& cell) { cell.p = &written.count; });
    } else if (type == XS_SFSTRING && (count || (a.part == Argument::Part::whole && !a.room))) {
      push(&ffi_type_uint32, [&written](const World&, Cell& cell) { cell.u = written.room; });
    }
    return;
  }
  if (const Number own = defaultNumber(type); own != Number::none && !count) {
    const Number asked = a.number != Number::none ? a.number : own;
    return push(typeOf(asked), [this, a, asked, type](const World& w, Cell& cell) {
      Slot& slot = w.input(a.field);
      cell.u = 0;
      if (type == XS_SFNODE)
        cell.u = *static_cast<XsNode*>(slot.data());
      else
        put(cell, asked, numberIn(slot));
    });
  }
  if (data)
    push(&ffi_type_pointer,
         [a](const World& w, Cell& cell) { cell.p = pointerTo(w.input(a.field)); });
  if (count || (many && a.part == Argument::Part::whole))
    push(&ffi_type_uint32, [a, type](const World& w, Cell& cell) {
      Slot& slot = w.input(a.field);
      cell.u = type == XS_SFSTRING ? std::strlen(slot.text()) : slot.count();
    });
}

PreparedCall::PreparedCall(const Call& call, void* function, const XsScriptInfo& info)
    : call_(call), function_(reinterpret_cast<void (*)()>(function)), info_(info) {
  for (const Argument& argument : call.arguments) add(argument);
  ffi_type* result = &ffi_type_void;
  if (call.result) {
    const XsType type = info.fields[call.target.field].type;
    if (call_.target.number == Number::none) call_.target.number = defaultNumber(type);
    result = type == XS_SFSTRING ? &ffi_type_pointer : typeOf(call_.target.number);
  } else if (call.sends != Call::Sends::always) {
    result = &ffi_type_sint32;
  }
  cells_.resize(types_.size());
  if (ffi_prep_cif(&frame_, FFI_DEFAULT_ABI, unsigned(types_.size()), result, types_.data()) !=
      FFI_OK)
    throw ProgramError(call.line, "libffi cannot make this call");
}

XsResult PreparedCall::run(const World& world) {
  for (Place& written : places_) {
    const bool state = info_.fields[written.field].access != XS_EVENT_OUT;
    const bool many = xsIsMany(written.slot.type());
    written.slot.makeRoom(many || written.slot.type() == XS_SFSTRING ? written.room : 1);
    written.count = written.room;
    written.cell.u = 0;
    if (!state) continue;
    Slot& now = world.input(written.field); // initialize with the current value of the field
    const size_t bytes =
        written.slot.type() == XS_SFSTRING
            ? std::min<size_t>(std::strlen(now.text()), written.room)
            : elementBytes(now.type()) * std::min(now.count(), written.slot.count());
    if (bytes > 0)
      std::memcpy(written.slot.data(), now.type() == XS_SFSTRING ? now.text() : now.data(), bytes);
    if (written.number != Number::none) put(written.cell, written.number, numberIn(now));
  }
  std::vector<void*> addresses(cells_.size());
  for (size_t i = 0; i < cells_.size(); ++i) {
    fill_[i](world, cells_[i]);
    addresses[i] = &cells_[i];
  }
  Cell result{};
  ffi_call(&frame_, function_, &result, addresses.data());
  const bool yes = int32_t(result.returned) != 0;
  if (call_.sends != Call::Sends::always && !call_.result &&
      yes != (call_.sends == Call::Sends::ifTrue))
    return XS_OK;
  return giveAll(world, result);
}

XsResult PreparedCall::give(const World& world, uint32_t field, const XsValue& value) {
  const XsResult answer = world.give(field, value);
  if (answer == XS_OK || answer == XS_STOPPED) return answer;
  XsString why{"", 0};
  world.host->lastError(world.host, world.self, &why);
  world.log(3, call_.line, call_.function + ": " + std::string(why.data, why.bytes));
  return XS_FAILED;
}

XsResult PreparedCall::giveAll(const World& world, const Cell& result) {
  if (call_.result) {
    Slot slot(info_.fields[call_.target.field].type);
    if (slot.type() == XS_SFSTRING) {
      if (result.p) slot.setText(static_cast<const char*>(result.p));
    } else if (slot.type() == XS_SFNODE) {
      *static_cast<XsNode*>(slot.data()) = result.u;
    } else {
      setNumber(slot, get(result, call_.target.number));
    }
    const bool nothing = slot.type() == XS_SFSTRING && !result.p;
    if (const XsResult answer = nothing ? XS_OK : give(world, call_.target.field, slot.value(1));
        answer != XS_OK)
      return answer;
  }
  for (Place& written : places_) {
    Slot& slot = written.slot;
    const std::string name = info_.fields[written.field].name;
    if (xsIsMany(slot.type()) && written.count > written.room) {
      world.log(3, call_.line,
                call_.function + " says that it wrote " + std::to_string(written.count) +
                    " elements to " + name + ", which has room for " +
                    std::to_string(written.room));
      return XS_FAILED;
    }
    if (written.number != Number::none) setNumber(slot, get(written.cell, written.number));
    if (elementType(slot.type()) == XS_SFBOOL) slot.makeBooleans();
    if (slot.type() == XS_SFSTRING) {
      const std::string text(static_cast<const char*>(slot.data()),
                             strnlen(static_cast<const char*>(slot.data()), written.room));
      slot.setText(text.c_str());
    }
    if (const XsResult answer = give(world, written.field, slot.value(written.count));
        answer != XS_OK)
      return answer;
  }
  return XS_OK;
}

} // namespace native
