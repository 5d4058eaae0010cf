// convert.cpp: Converts the field types to and from Python. plugins/script/python/values.cpp
// does the same for Scripts; a change of what counts as a number, a truth value or a text is made
// in both (docs/decisions/0045-two-conversions-to-python.md). [GIL held]
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "arrays.h"
#include "expectation.h"
#include "nearest.h"
#include "numbers.h"
#include "objects.h"
#include "xvrml/numbers.h"
#include "xvrml/value_text.h"
#include "xvrml/value_words.h"
#include "xvrml/versions.h"
#include "xvrml/viewed.h"
#include "xvrml/walk.h"

using namespace xvrml;

namespace {

// The field that is being assigned, for messages.
struct Target {
  const FieldInfo& field;
  const NodeObject& owner;
  // If the owner is loose: the world of the first new node that is in a world.
  mutable WorldPtr place = nullptr;

  std::string text() const {
    return fmt::format("{}.{} ({}): {} expected", owner.node->type().name, field.name,
                       fieldTypeName(field.type), expectation(field.type));
  }
  [[noreturn]] void wrongType(const py::handle& got) const {
    throw py::type_error(fmt::format("{}, not {}", text(), typeName(got)));
  }
  [[noreturn]] void wrongValue(const std::string& why) const {
    throw py::value_error(text() + ", " + why);
  }

  void checkFinite(double v) const {
    if (!std::isfinite(v)) wrongValue("not infinity or NaN");
  }
  // Compares with the range limits rounded to float, so that every value read from a node can be
  // written back.
  void checkRange(double v) const {
    const FieldRange& r = rangeIn(*owner.node, field);
    checkFinite(v);
    const bool wide = hasWideNumbers(field.type);
    const auto rounded = [wide](double number) { return wide ? number : double(float(number)); };
    const double number = rounded(v), minimum = rounded(r.minimum), maximum = rounded(r.maximum);
    const bool low = r.minimumOpen ? number <= minimum : number < minimum;
    const bool high = r.maximumOpen ? number >= maximum : number > maximum;
    if ((low || high) && number != r.also) wrongValue(fmt::format("in {}, not {}", describe(r), v));
  }
};

std::string shapeText(const py::array& array) {
  return "not of shape " + std::string(py::str(array.attr("shape")));
}

// Raises the error for an array of Python objects: ValueError if they are numbers that no type of
// numpy can hold, otherwise TypeError.
[[noreturn]] void refuseObjects(const py::array& array, const py::handle& object,
                                const Target& target) {
  bool large = false;
  try {
    array.attr("astype")("float64");
  } catch (const py::error_already_set& error) { large = error.matches(PyExc_OverflowError); }
  if (large) target.wrongValue("not a number beyond 1e308");
  target.wrongType(object);
}

// Converts any array-like of numbers. Text, objects and complex numbers raise TypeError.
py::array arrayOf(const py::handle& object, const Target& target, const char* kinds) {
  if (py::isinstance<py::str>(object) || py::isinstance<py::bytes>(object) || object.is_none())
    target.wrongType(object);
  py::array array;
  try {
    array = py::array(py::module_::import("numpy").attr("asarray")(object));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    target.wrongValue("not rows of different lengths");
  }
  const char kind = std::string(py::str(array.dtype().attr("kind")))[0];
  if (array.size() > 0 && !std::strchr(kinds, kind)) {
    if (kind == 'O') refuseObjects(array, object, target);
    throw py::type_error(
        fmt::format("{}, not an array of {}", target.text(), std::string(py::str(array.dtype()))));
  }
  return array;
}

template <class T> using Dense = py::array_t<T, py::array::c_style | py::array::forcecast>;

// Converts a double to a checked float32. free: any finite number is accepted.
float single(double v, const Target& target, bool free = false) {
  free ? target.checkFinite(v) : target.checkRange(v);
  const float f = float(v);
  if (!std::isfinite(f)) target.wrongValue("within the range of 32 bit floats");
  return f;
}

// Rotations accept any axis, because the node normalises it (docs/decisions/0042). The axis 0 0 0
// stays and has no effect.
template <class T> constexpr bool isFree = std::is_same_v<T, Rotation>;

// Checks numbers of Python and stores them as floats or doubles.
template <class T>
void store(const double* numbers, size_t count, ScalarOf<T>* out, const Target& target) {
  for (size_t i = 0; i < count; ++i) {
    if constexpr (std::is_same_v<ScalarOf<T>, float>)
      out[i] = single(numbers[i], target, isFree<T>);
    else
      target.checkRange(out[i] = numbers[i]);
  }
}

template <Numeric T> T tuple(const py::handle& object, const Target& target) {
  Dense<double> array(arrayOf(object, target, "fiu"));
  if (array.ndim() != 1 || array.size() != numberCount<T>) target.wrongValue(shapeText(array));
  T value;
  store<T>(array.data(), size_t(array.size()), numbersOf(value), target);
  return value;
}

template <Numeric T> std::vector<T> rows(const py::handle& object, const Target& target) {
  Dense<double> array(arrayOf(object, target, "fiu"));
  if (array.size() == 0) return {};
  const bool fits = numberCount<T> == 1 ? array.ndim() == 1
                                        : array.ndim() == 2 && array.shape(1) == numberCount<T>;
  if (!fits) target.wrongValue(shapeText(array));
  std::vector<T> list(size_t(array.shape(0)));
  store<T>(array.data(), size_t(array.size()), numbersOf(list.front()), target);
  return list;
}

int32_t wholeNumber(long long v, const Target& target) {
  if (v < std::numeric_limits<int32_t>::min() || v > std::numeric_limits<int32_t>::max())
    target.wrongValue(fmt::format("not {}", v));
  target.checkRange(double(v));
  return int32_t(v);
}

std::vector<int32_t> integerList(const py::handle& object, const Target& target) {
  py::array any = arrayOf(object, target, "iu");
  if (any.size() == 0) return {};
  if (any.ndim() != 1) target.wrongValue(shapeText(any));
  if (any.dtype().kind() == 'u') { // 64 bits without a sign do not fit into the array below
    const Dense<uint64_t> large(any);
    for (size_t i = 0; i < size_t(large.size()); ++i)
      if (large.data()[i] > uint64_t(std::numeric_limits<int32_t>::max()))
        target.wrongValue(fmt::format("not {}", large.data()[i]));
  }
  Dense<int64_t> array(any);
  std::vector<int32_t> list(size_t(array.size()));
  for (size_t i = 0; i < list.size(); ++i) list[i] = wholeNumber(array.data()[i], target);
  return list;
}

int32_t integer(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr()) || !PyIndex_Check(object.ptr())) target.wrongType(object);
  auto number = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
  if (!number) { // an array whose __index__ method fails
    PyErr_Clear();
    target.wrongType(object);
  }
  int overflow = 0;
  const long long v = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  if (overflow) target.wrongValue("not " + std::string(py::str(number)));
  return wholeNumber(v, target);
}

double number(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr()) || !PyNumber_Check(object.ptr()) || PyComplex_Check(object.ptr()))
    target.wrongType(object);
  const double v = PyFloat_AsDouble(object.ptr());
  if (v == -1 && PyErr_Occurred()) {
    const bool large = PyErr_ExceptionMatches(PyExc_OverflowError);
    PyErr_Clear();
    if (large) target.wrongValue("not a number beyond 1e308");
    target.wrongType(object);
  }
  return v;
}

bool boolean(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr())) return object.ptr() == Py_True;
  const std::string type = typeName(object);
  if (type == "bool_" || type == "bool") // numpy's names before and since version 2
    return py::bool_(py::reinterpret_borrow<py::object>(object));
  target.wrongType(object);
}

std::string text(const py::handle& object, const Target& target) {
  if (!py::isinstance<py::str>(object)) target.wrongType(object);
  try {
    return fromText(object);
  } catch (py::error_already_set&) { target.wrongValue("not half a surrogate pair"); }
}

// Converts an image. Python stores rows from the top, VRML from the bottom.
Image image(const py::handle& object, const Target& target) {
  py::array any = arrayOf(object, target, "iu");
  if (any.size() == 0) return {};
  if (any.ndim() != 2 && any.ndim() != 3) target.wrongValue(shapeText(any));
  const py::ssize_t components = any.ndim() == 3 ? any.shape(2) : 1;
  const bool fits =
      components >= 1 && components <= 4 && any.shape(0) <= 65536 && any.shape(1) <= 65536;
  if (!fits) target.wrongValue(shapeText(any));
  Dense<int64_t> array(any);
  Image result{int32_t(any.shape(1)), int32_t(any.shape(0)), int32_t(components), {}};
  result.pixels.resize(size_t(array.size()));
  const size_t row = size_t(result.width) * size_t(components);
  for (size_t i = 0; i < result.pixels.size(); ++i) {
    const int64_t v = array.data()[i];
    if (v < 0 || v > 255) target.wrongValue(fmt::format("from 0 to 255, not {}", v));
    result.pixels[(size_t(result.height) - 1 - i / row) * row + i % row] = uint8_t(v);
  }
  return result;
}

// Returns whether a field of these node types accepts the node. nodeTypes: names and abstract
// types, separated by blanks; empty: any.
bool accepts(const std::string& nodeTypes, const Node& node) {
  if (nodeTypes.empty()) return true;
  const std::string padded = " " + nodeTypes + " ";
  auto listed = [&](const std::string& name) {
    return padded.find(" " + name + " ") != padded.npos;
  };
  Node* rendered = renderedNode(const_cast<Node*>(&node));
  for (const Node* one : {&node, static_cast<const Node*>(rendered)}) {
    if (!one) continue;
    if (listed(one->type().name)) return true;
    for (const std::string& kind : one->type().abstract)
      if (listed(kind)) return true;
  }
  return false;
}

NodeRef nodeOf(const py::handle& object, const Target& target) {
  if (!py::isinstance<NodeObject>(object)) target.wrongType(object);
  const auto& given = object.cast<const NodeObject&>();
  const WorldPtr from = given.world(), to = target.owner.world();
  if (!from->loose() && to->loose() && !target.place) target.place = from;
  const WorldPtr& place = target.place ? target.place : to;
  if (!from->loose() && !sameWorld(from, place)) target.wrongValue("of the same world");
  if (!accepts(target.field.nodeTypes, *given.node))
    target.wrongValue(
        fmt::format("one of {}, not {}", target.field.nodeTypes, given.node->type().name));
  given.isUnowned = false;
  return given.node;
}

// Returns whether NULL keeps its place in the lists of the node (docs/decisions/0015).
bool mayHoldNull(const Node& node) { return node.type().index < 0 || node.type().is("selecting"); }

py::sequence sequenceOf(const py::handle& object, const Target& target) {
  if (py::isinstance<py::str>(object) || !PySequence_Check(object.ptr())) target.wrongType(object);
  return py::reinterpret_borrow<py::sequence>(object);
}

// Returns a read-only copy, so that `node.point[0] = ...` fails; it could not change the node.
template <class T> py::object readOnly(const T* data, std::vector<py::ssize_t> shape) {
  py::array_t<T> array = newArray<T>(std::move(shape));
  if (array.size()) std::memcpy(array.mutable_data(), data, size_t(array.size()) * sizeof(T));
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

// Each function reads a value of one C++ type.
void read(const py::handle& object, const Target& target, bool& value) {
  value = boolean(object, target);
}
void read(const py::handle& object, const Target& target, std::string& value) {
  value = text(object, target);
}
void read(const py::handle& object, const Target& target, Image& value) {
  value = image(object, target);
}
void read(const py::handle& object, const Target& target, NodeRef& value) {
  if (!object.is_none()) value = nodeOf(object, target);
}
void read(const py::handle& object, const Target& target, int32_t& value) {
  value = integer(object, target);
}
template <Numeric T> void read(const py::handle& object, const Target& target, T& value) {
  if constexpr (numberCount<T> == 1) {
    const double v = number(object, target);
    store<T>(&v, 1, numbersOf(value), target);
  } else {
    value = tuple<T>(object, target);
  }
}
template <class T> void read(const py::handle& object, const Target& target, std::vector<T>& list) {
  if constexpr (std::is_same_v<T, int32_t>) {
    list = integerList(object, target);
  } else if constexpr (Numeric<T>) {
    list = rows<T>(object, target);
  } else {
    const bool keepsNull = mayHoldNull(*target.owner.node);
    for (const py::object one : sequenceOf(object, target)) { // may be made anew
      T element{};
      if constexpr (std::is_same_v<T, NodeRef>)
        element = keepsNull && one.is_none() ? NodeRef() : nodeOf(one, target);
      else
        read(one, target, element);
      list.push_back(std::move(element));
    }
  }
}

struct ToPython {
  const WorldPtr& world;

  py::object operator()(bool v) const { return py::bool_(v); }
  py::object operator()(int32_t v) const { return py::int_(v); }
  template <Numeric T> py::object operator()(const T& v) const {
    if constexpr (numberCount<T> == 1) return py::float_(double(*numbersOf(v)));
    py::tuple out(numberCount<T>);
    for (int i = 0; i < numberCount<T>; ++i) out[size_t(i)] = double(numbersOf(v)[i]);
    return out;
  }
  py::object operator()(const std::string& v) const { return toText(v); }
  py::object operator()(const NodeRef& v) const { return asNode(world, v); }
  py::object operator()(const Image& v) const {
    const size_t row = size_t(v.width) * size_t(v.components);
    std::vector<uint8_t> flipped;
    for (size_t y = size_t(v.height); y-- > 0 && row;)
      flipped.insert(flipped.end(), v.pixels.begin() + std::ptrdiff_t(y * row),
                     v.pixels.begin() + std::ptrdiff_t((y + 1) * row));
    if (flipped.empty()) return readOnly(flipped.data(), {0, 0, 0});
    return readOnly(flipped.data(), {v.height, v.width, v.components});
  }
  py::object operator()(const MFBool& v) const {
    py::array_t<bool> array = newArray<bool>({py::ssize_t(v.size())});
    for (size_t i = 0; i < v.size(); ++i) array.mutable_at(py::ssize_t(i)) = v[i];
    array.attr("setflags")(py::arg("write") = false);
    return array;
  }
  template <class T> py::object operator()(const std::vector<T>& v) const {
    if constexpr (Numeric<T>) {
      std::vector<py::ssize_t> shape{py::ssize_t(v.size())};
      if (numberCount < T >> 1) shape.push_back(numberCount<T>);
      return readOnly(reinterpret_cast<const ScalarOf<T>*>(v.data()), std::move(shape));
    } else {
      py::tuple out(v.size());
      for (size_t i = 0; i < v.size(); ++i) out[i] = (*this)(v[i]);
      return out;
    }
  }
};

// Keeps alive what an array of a field's numbers refers to. The view is released before the node.
struct Viewing {
  NodeObject node;
  std::shared_ptr<const ViewedField> view;
};

template <class T> py::object viewArray(Viewing* viewing, std::vector<py::ssize_t> shape) {
  py::capsule keeper(viewing, [](void* held) { delete static_cast<Viewing*>(held); });
  py::array_t<T> array(std::move(shape), static_cast<const T*>(viewing->view->data()), keeper);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

} // namespace

py::str toText(const std::string& bytes) {
  PyObject* text = PyUnicode_DecodeUTF8(bytes.data(), py::ssize_t(bytes.size()), "surrogateescape");
  if (!text) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

std::string fromText(const py::handle& text) {
  auto bytes = py::reinterpret_steal<py::bytes>(
      PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape"));
  if (!bytes) throw py::error_already_set();
  return std::string(bytes);
}

std::string didYouMean(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = nearest::word(name, known);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

void raiseOsError(const std::string& failure) {
  if (failure.empty()) return;
  PyErr_SetString(PyExc_OSError, failure.c_str());
  throw py::error_already_set();
}

std::string toPath(const py::handle& path) {
  auto text = py::reinterpret_steal<py::object>(PyOS_FSPath(path.ptr()));
  if (!text) throw py::error_already_set();
  std::string name =
      py::isinstance<py::bytes>(text) ? std::string(py::bytes(text)) : fromText(text);
  if (name.find('\0') != name.npos) throw py::value_error("embedded null byte in a file name");
  return name;
}

py::object toPython(const Value& value, const WorldPtr& world) {
  return std::visit(ToPython{world}, value);
}

py::object fieldToPython(const NodeObject& object, const FieldInfo& field) {
  std::shared_ptr<const ViewedField> view = viewField(*object.node, field);
  if (!view || view->size() == 0) return toPython(object.node->get(field), object.world());
  const auto n = py::ssize_t(view->size());
  auto* viewing = new Viewing{object, std::move(view)};
  return std::visit(
      [&](const auto& value) -> py::object {
        using T = std::decay_t<decltype(value)>;
        if constexpr (isNumberList<T>) {
          std::vector<py::ssize_t> shape{n};
          if (numberCount < ElementOf < T >>> 1) shape.push_back(numberCount<ElementOf<T>>);
          return viewArray<ScalarOf<ElementOf<T>>>(viewing, std::move(shape));
        } else {
          return py::none(); // no view is made of other types
        }
      },
      defaultValue(field.type));
}

void joinWorlds(const NodeObject& owner, const py::handle& object) {
  if (py::isinstance<NodeObject>(object)) {
    const WorldPtr to = owner.world(), from = object.cast<const NodeObject&>().world();
    if (from == to) return;
    // The smaller tree joins the larger one, so that the path from any node to its world stays
    // short.
    if (from->loose() && (!to->loose() || from->rank <= to->rank)) {
      to->rank += from->rank == to->rank;
      from->joined = to;
    } else if (to->loose()) {
      to->joined = from;
    }
  } else if (!py::isinstance<py::str>(object) && PySequence_Check(object.ptr())) {
    // The sequence may make each item when it is asked: a py::object keeps the item alive.
    for (const py::object one : py::reinterpret_borrow<py::sequence>(object))
      if (py::isinstance<NodeObject>(one)) joinWorlds(owner, one);
  }
}

void refuseLoops(const NodeObject& owner, const FieldInfo& field, const Value& value) {
  // neither the value nor anything below it can contain the owner
  if (owner.isUnowned && owner.world()->loose()) return;
  std::vector<Node*> open;
  if (const auto* one = std::get_if<NodeRef>(&value)) open.push_back(one->get());
  if (const auto* many = std::get_if<MFNode>(&value))
    for (const NodeRef& one : *many) open.push_back(one.get());
  const bool free = walk(std::move(open), [&](Node& node, std::vector<Node*>& next) {
    appendChildren(node, next);
    return &node != owner.node.get();
  });
  if (!free)
    throw py::value_error(
        fmt::format("{}.{}: the node would hold itself", owner.node->type().name, field.name));
}

Value fromPython(const py::handle& object, const FieldInfo& field, const NodeObject& owner) {
  const Target target{field, owner, nullptr};
  return std::visit(
      [&](auto value) -> Value {
        read(object, target, value);
        return value;
      },
      defaultValue(field.type));
}
