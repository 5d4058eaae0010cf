// convert.cpp: Converts the 20 field types to and from Python. plugins/script/python/values.cpp
// does the same for Scripts; a change of what counts as a number, a truth value or a text is made
// in both (docs/decisions/0045-two-conversions-to-python.md). [GIL held]
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "nearest.h"
#include "numbers.h"
#include "objects.h"
#include "xvrml/viewed.h"
#include "xvrml/walk.h"

using namespace xvrml;

namespace {

// Number of floats (or doubles) in one value, and the name of such a value in Python.
template <class T> constexpr size_t width = sizeof(T) / sizeof(float);
static_assert(width<Vec2f> == 2 && width<Vec3f> == 3 && width<Color> == 3 && width<Rotation> == 4);

std::string expectation(FieldType type) {
  switch (type) {
  case FieldType::SFBool: return "True or False";
  case FieldType::SFColor: return "3 numbers (red, green, blue)";
  case FieldType::SFFloat:
  case FieldType::SFTime: return "a number";
  case FieldType::SFImage: return "an array of bytes of shape (height, width, components)";
  case FieldType::SFInt32: return "a whole number of 32 bits";
  case FieldType::SFNode: return "a Node or None";
  case FieldType::SFRotation: return "4 numbers (axis x, y, z and angle in radians)";
  case FieldType::SFString: return "a str";
  case FieldType::SFVec2f: return "2 numbers";
  case FieldType::SFVec3f: return "3 numbers";
  case FieldType::MFColor:
  case FieldType::MFVec3f: return "numbers of shape (n, 3)";
  case FieldType::MFFloat:
  case FieldType::MFTime: return "numbers of shape (n,)";
  case FieldType::MFInt32: return "whole numbers of 32 bits of shape (n,)";
  case FieldType::MFNode: return "a sequence of Nodes";
  case FieldType::MFRotation: return "numbers of shape (n, 4)";
  case FieldType::MFString: return "a sequence of str";
  case FieldType::MFVec2f: return "numbers of shape (n, 2)";
  }
  return "";
}

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
    const FieldRange& r = field.range;
    checkFinite(v);
    const bool wide = field.type == FieldType::SFTime || field.type == FieldType::MFTime ||
                      field.type == FieldType::SFInt32 || field.type == FieldType::MFInt32;
    const auto rounded = [wide](double number) { return wide ? number : double(float(number)); };
    const double number = rounded(v), minimum = rounded(r.minimum), maximum = rounded(r.maximum);
    const bool low = r.minimumOpen ? number <= minimum : number < minimum;
    const bool high = r.maximumOpen ? number >= maximum : number > maximum;
    if ((low || high) && number != r.also)
      wrongValue(fmt::format("from {} to {}{}{}, not {}", r.minimum, r.maximum,
                             r.minimumOpen || r.maximumOpen ? " (bounds excluded)" : "",
                             std::isnan(r.also) ? "" : fmt::format(" or {}", r.also), v));
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
py::array numbersOf(const py::handle& object, const Target& target, const char* kinds) {
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

template <class T> T fixed(const py::handle& object, const Target& target) {
  Dense<double> array(numbersOf(object, target, "fiu"));
  if (array.ndim() != 1 || size_t(array.size()) != width<T>) target.wrongValue(shapeText(array));
  float numbers[width<T>];
  for (size_t i = 0; i < width<T>; ++i) numbers[i] = single(array.data()[i], target, isFree<T>);
  T value;
  std::memcpy(static_cast<void*>(&value), numbers, sizeof value);
  return value;
}

template <class T> std::vector<T> rows(const py::handle& object, const Target& target) {
  Dense<double> array(numbersOf(object, target, "fiu"));
  if (array.size() == 0) return {};
  const bool fits = array.ndim() == 2 && size_t(array.shape(1)) == width<T>;
  if (!fits) target.wrongValue(shapeText(array));
  std::vector<T> list(size_t(array.shape(0)));
  float* out = reinterpret_cast<float*>(list.data());
  for (size_t i = 0; i < size_t(array.size()); ++i)
    out[i] = single(array.data()[i], target, isFree<T>);
  return list;
}

template <class T> std::vector<T> numberList(const py::handle& object, const Target& target) {
  Dense<double> array(numbersOf(object, target, "fiu"));
  if (array.size() == 0) return {};
  if (array.ndim() != 1) target.wrongValue(shapeText(array));
  std::vector<T> list(size_t(array.size()));
  for (size_t i = 0; i < list.size(); ++i) {
    if constexpr (std::is_same_v<T, float>)
      list[i] = single(array.data()[i], target);
    else
      target.checkRange(list[i] = array.data()[i]);
  }
  return list;
}

int32_t wholeNumber(long long v, const Target& target) {
  if (v < std::numeric_limits<int32_t>::min() || v > std::numeric_limits<int32_t>::max())
    target.wrongValue(fmt::format("not {}", v));
  target.checkRange(double(v));
  return int32_t(v);
}

std::vector<int32_t> integerList(const py::handle& object, const Target& target) {
  py::array any = numbersOf(object, target, "iu");
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
  py::array any = numbersOf(object, target, "iu");
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
  py::array_t<T> array(std::move(shape));
  if (array.size()) std::memcpy(array.mutable_data(), data, size_t(array.nbytes()));
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <class T> py::object rowsToPython(const std::vector<T>& list) {
  return readOnly(reinterpret_cast<const float*>(list.data()),
                  {py::ssize_t(list.size()), py::ssize_t(width<T>)});
}

struct ToPython {
  const WorldPtr& world;

  py::object operator()(bool v) const { return py::bool_(v); }
  py::object operator()(float v) const { return py::float_(double(v)); }
  py::object operator()(double v) const { return py::float_(v); }
  py::object operator()(int32_t v) const { return py::int_(v); }
  py::object operator()(const std::string& v) const { return toText(v); }
  py::object operator()(const Color& v) const { return py::make_tuple(v.r, v.g, v.b); }
  py::object operator()(const Vec2f& v) const { return py::make_tuple(v.x, v.y); }
  py::object operator()(const Vec3f& v) const { return py::make_tuple(v.x, v.y, v.z); }
  py::object operator()(const Rotation& v) const { return py::make_tuple(v.x, v.y, v.z, v.angle); }
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
  py::object operator()(const MFColor& v) const { return rowsToPython(v); }
  py::object operator()(const MFVec2f& v) const { return rowsToPython(v); }
  py::object operator()(const MFVec3f& v) const { return rowsToPython(v); }
  py::object operator()(const MFRotation& v) const { return rowsToPython(v); }
  py::object operator()(const MFFloat& v) const {
    return readOnly(v.data(), {py::ssize_t(v.size())});
  }
  py::object operator()(const MFTime& v) const {
    return readOnly(v.data(), {py::ssize_t(v.size())});
  }
  py::object operator()(const MFInt32& v) const {
    return readOnly(v.data(), {py::ssize_t(v.size())});
  }
  py::object operator()(const MFString& v) const {
    py::tuple out(v.size());
    for (size_t i = 0; i < v.size(); ++i) out[i] = toText(v[i]);
    return out;
  }
  py::object operator()(const MFNode& v) const {
    py::tuple out(v.size());
    for (size_t i = 0; i < v.size(); ++i) out[i] = (*this)(v[i]);
    return out;
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
  return py::isinstance<py::bytes>(text) ? std::string(py::bytes(text)) : fromText(text);
}

py::object toPython(const Value& value, const WorldPtr& world) {
  return std::visit(ToPython{world}, value);
}

py::object fieldToPython(const NodeObject& object, const FieldInfo& field) {
  std::shared_ptr<const ViewedField> view = viewField(*object.node, field);
  if (!view || view->size() == 0) return toPython(object.node->get(field), object.world());
  const auto n = py::ssize_t(view->size());
  auto* viewing = new Viewing{object, std::move(view)};
  switch (field.type) {
  case FieldType::MFColor: return viewArray<float>(viewing, {n, 3});
  case FieldType::MFRotation: return viewArray<float>(viewing, {n, 4});
  case FieldType::MFVec2f: return viewArray<float>(viewing, {n, 2});
  case FieldType::MFVec3f: return viewArray<float>(viewing, {n, 3});
  case FieldType::MFInt32: return viewArray<int32_t>(viewing, {n});
  case FieldType::MFTime: return viewArray<double>(viewing, {n});
  default: return viewArray<float>(viewing, {n});
  }
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
  switch (field.type) {
  case FieldType::SFBool: return boolean(object, target);
  case FieldType::SFColor: return fixed<Color>(object, target);
  case FieldType::SFFloat: return single(number(object, target), target);
  case FieldType::SFImage: return image(object, target);
  case FieldType::SFInt32: return integer(object, target);
  case FieldType::SFNode: return object.is_none() ? NodeRef() : nodeOf(object, target);
  case FieldType::SFRotation: return fixed<Rotation>(object, target);
  case FieldType::SFString: return text(object, target);
  case FieldType::SFTime: {
    const double v = number(object, target);
    target.checkRange(v);
    return v;
  }
  case FieldType::SFVec2f: return fixed<Vec2f>(object, target);
  case FieldType::SFVec3f: return fixed<Vec3f>(object, target);
  case FieldType::MFColor: return rows<Color>(object, target);
  case FieldType::MFFloat: return numberList<float>(object, target);
  case FieldType::MFInt32: return integerList(object, target);
  case FieldType::MFNode: {
    MFNode list;
    const bool keeps = mayHoldNull(*owner.node);
    for (const py::object one : sequenceOf(object, target)) // may be made anew
      list.push_back(keeps && one.is_none() ? NodeRef() : nodeOf(one, target));
    return list;
  }
  case FieldType::MFRotation: return rows<Rotation>(object, target);
  case FieldType::MFString: {
    MFString list;
    for (const py::object one : sequenceOf(object, target)) list.push_back(text(one, target));
    return list;
  }
  case FieldType::MFTime: return numberList<double>(object, target);
  case FieldType::MFVec2f: return rows<Vec2f>(object, target);
  case FieldType::MFVec3f: return rows<Vec3f>(object, target);
  }
  throw py::type_error("unknown field type");
}
