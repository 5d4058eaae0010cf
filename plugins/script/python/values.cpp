#include "values.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <pybind11/numpy.h>
#include <xvrml/xscript_types.h>

namespace python {
namespace {

std::string expected(XsType type) {
  const XsTypeInfo& info = *xsTypeInfo(type);
  const bool many = xsIsMany(type);
  const std::string width = std::to_string(info.components);
  switch (info.element) {
  case XS_SFBOOL: return many ? "a sequence of True and False" : "True or False";
  case XS_SFIMAGE:
    return std::string(many ? "a sequence of arrays" : "an array") +
           " of bytes of shape (height, width, components)";
  case XS_SFINT32:
    return many ? "whole numbers of 32 bits of shape (n,)" : "a whole number of 32 bits";
  case XS_SFNODE: return many ? "a sequence of Nodes" : "a Node or None";
  case XS_SFSTRING: return many ? "a sequence of str" : "a str";
  default: break;
  }
  if (info.components == 1) return many ? "numbers of shape (n,)" : "a number";
  return many ? "numbers of shape (n, " + width + ")" : width + " numbers";
}

// The field that is being assigned, for messages.
struct Target {
  XsType type;
  const std::string& name;

  std::string text() const {
    return name + " (" + typeName(type) + "): " + expected(type) + " expected";
  }
  [[noreturn]] void wrongType(const py::handle& got) const {
    throw py::type_error(text() + ", not " +
                         std::string(py::str(py::type::handle_of(got).attr("__name__"))));
  }
  [[noreturn]] void wrongValue(const std::string& why) const {
    throw py::value_error(text() + ", " + why);
  }
};

bool hasNumpy() {
  static const bool has = [] {
    try {
      py::module_::import("numpy");
      return true;
    } catch (py::error_already_set&) { return false; }
  }();
  return has;
}

// --- To Python ---

template <class T> py::object arrayOf(const T* data, size_t count, size_t width) {
  if (!hasNumpy()) {
    py::tuple all(count);
    for (size_t i = 0; i < count; ++i) {
      py::tuple row(width);
      for (size_t c = 0; c < width; ++c) row[c] = py::cast(data[width * i + c]);
      all[i] = width == 1 ? py::object(row[0]) : py::object(row);
    }
    return all;
  }
  std::vector<py::ssize_t> shape{py::ssize_t(count)};
  if (width > 1) shape.push_back(py::ssize_t(width));
  py::array_t<T> array(shape);
  if (count > 0) std::memcpy(array.mutable_data(), data, count * width * sizeof(T));
  array.attr("setflags")(py::arg("write") = false); // writes to this copy would be lost
  return array;
}

template <class T> py::object vectorOf(const T* numbers, size_t width) {
  if (width == 1) return py::float_(double(numbers[0]));
  py::tuple all(width);
  for (size_t i = 0; i < width; ++i) all[i] = double(numbers[i]);
  return all;
}

py::object imageOf(const XsImage& image) {
  const size_t row = size_t(image.width) * size_t(image.components), height = size_t(image.height);
  std::string turned;
  for (size_t y = height; y-- > 0 && row > 0;)
    turned.append(reinterpret_cast<const char*>(image.pixels) + y * row, row);
  const py::tuple shape = py::make_tuple(image.height, image.width, image.components);
  if (!hasNumpy()) return py::make_tuple(py::bytes(turned), shape);
  return py::module_::import("numpy")
      .attr("frombuffer")(py::bytes(turned), "uint8")
      .attr("reshape")(shape);
}

// --- From Python ---

double numberOf(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr()) || !PyNumber_Check(object.ptr()) || PyComplex_Check(object.ptr()))
    target.wrongType(object);
  const double v = PyFloat_AsDouble(object.ptr());
  if (v == -1 && PyErr_Occurred()) {
    PyErr_Clear();
    target.wrongType(object);
  }
  if (!std::isfinite(v)) target.wrongValue("not infinity or NaN");
  return v;
}

int32_t wholeOf(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr()) || !PyIndex_Check(object.ptr())) target.wrongType(object);
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
  if (!number) {
    PyErr_Clear();
    target.wrongType(object);
  }
  int overflow = 0;
  const long long v = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  if (overflow || v < std::numeric_limits<int32_t>::min() ||
      v > std::numeric_limits<int32_t>::max())
    target.wrongValue("not " + std::string(py::str(number)));
  return int32_t(v);
}

float singleOf(double v, const Target& target) {
  if (!std::isfinite(float(v))) target.wrongValue("within the range of 32 bit floats");
  return float(v);
}

py::object sequenceOf(const py::handle& object, const Target& target) {
  if (py::isinstance<py::str>(object) || py::isinstance<py::bytes>(object) ||
      !PySequence_Check(object.ptr()))
    target.wrongType(object);
  auto fast = py::reinterpret_steal<py::object>(PySequence_Fast(object.ptr(), ""));
  if (!fast) {
    PyErr_Clear();
    target.wrongType(object);
  }
  return fast;
}
size_t sizeOf(const py::object& fast) { return size_t(PySequence_Fast_GET_SIZE(fast.ptr())); }
py::handle itemOf(const py::object& fast, size_t i) {
  return PySequence_Fast_GET_ITEM(fast.ptr(), py::ssize_t(i));
}

// Reads numbers of an array with any strides: rows of `width`, or for an SF type a single row.
template <class T> bool fromArray(const py::handle& object, size_t width, bool many,
                                  const Target& target, std::vector<T>& out) {
  if (!PyObject_CheckBuffer(object.ptr()) || py::isinstance<py::bytes>(object) || !hasNumpy())
    return false;
  const py::array any = py::array(py::module_::import("numpy").attr("asarray")(object));
  const char kind = any.dtype().kind();
  if (any.size() > 0 && !std::strchr(std::is_integral_v<T> ? "iu" : "fiu", kind))
    throw py::type_error(target.text() + ", not an array of " + std::string(py::str(any.dtype())));
  const bool fits =
      many ? any.size() == 0 ||
                 (width == 1 ? any.ndim() == 1 : any.ndim() == 2 && size_t(any.shape(1)) == width)
           : any.ndim() == 1 && size_t(any.size()) == width;
  if (!fits) target.wrongValue("not of shape " + std::string(py::str(any.attr("shape"))));
  const py::array_t<T, py::array::c_style | py::array::forcecast> dense(any);
  out.assign(dense.data(), dense.data() + dense.size());
  return true;
}

template <class T, class Read> void flatten(const py::handle& object, size_t width, bool many,
                                            const Target& target, std::vector<T>& out,
                                            Read&& read) {
  const auto row = [&](const py::handle& one) {
    if (width == 1) return out.push_back(read(one));
    const py::object fast = sequenceOf(one, target);
    if (sizeOf(fast) != width) target.wrongValue("not " + std::to_string(sizeOf(fast)));
    for (size_t i = 0; i < width; ++i) out.push_back(read(itemOf(fast, i)));
  };
  if (!many) return row(object);
  const py::object fast = sequenceOf(object, target);
  for (size_t i = 0; i < sizeOf(fast); ++i) {
    const py::object one = py::reinterpret_borrow<py::object>(itemOf(fast, i));
    row(one);
  }
}

std::vector<double> numbersOf(const py::handle& object, size_t width, bool many,
                              const Target& target) {
  std::vector<double> numbers;
  if ((many || width > 1) && fromArray(object, width, many, target, numbers)) {
    for (const double v : numbers)
      if (!std::isfinite(v)) target.wrongValue("not infinity or NaN");
    return numbers;
  }
  flatten(object, width, many, target, numbers,
          [&](const py::handle& one) { return numberOf(one, target); });
  return numbers;
}

std::vector<int32_t> wholesOf(const py::handle& object, bool many, const Target& target) {
  std::vector<int64_t> wide;
  std::vector<int32_t> numbers;
  if (many && fromArray(object, 1, true, target, wide)) {
    for (const int64_t v : wide) {
      if (v != int32_t(v)) target.wrongValue("not " + std::to_string(v));
      numbers.push_back(int32_t(v));
    }
    return numbers;
  }
  flatten(object, 1, many, target, numbers,
          [&](const py::handle& one) { return wholeOf(one, target); });
  return numbers;
}

int32_t boolOf(const py::handle& object, const Target& target) {
  if (PyBool_Check(object.ptr())) return object.ptr() == Py_True;
  const py::handle type = py::type::handle_of(object);
  const auto named = [&](const char* attribute) {
    return std::string(py::str(type.attr(attribute)));
  };
  // numpy's truth value is called bool_ before version 2 and bool since then.
  if ((named("__name__") == "bool_" || named("__name__") == "bool") &&
      named("__module__") == "numpy")
    return PyObject_IsTrue(object.ptr()) == 1;
  target.wrongType(object);
}

std::string textOf(const py::handle& object, const Target& target) {
  if (!py::isinstance<py::str>(object)) target.wrongType(object);
  return fromText(object);
}

XsImage imageFrom(const py::handle& object, const Target& target, std::vector<uint8_t>& pixels) {
  if (!hasNumpy()) throw py::type_error(target.text() + ", which needs numpy");
  const py::array any = py::array(py::module_::import("numpy").attr("asarray")(object));
  const py::ssize_t components = any.ndim() == 3 ? any.shape(2) : 1;
  if (any.size() > 0 && any.dtype().kind() != 'i' && any.dtype().kind() != 'u')
    target.wrongType(object);
  if (any.size() > 0 && ((any.ndim() != 2 && any.ndim() != 3) || components < 1 || components > 4 ||
                         any.shape(0) > 65536 || any.shape(1) > 65536))
    target.wrongValue("not of shape " + std::string(py::str(any.attr("shape"))));
  XsImage image{};
  if (any.size() > 0)
    image = {int32_t(any.shape(1)), int32_t(any.shape(0)), int32_t(components), 0, nullptr};
  const py::array_t<int64_t, py::array::c_style | py::array::forcecast> dense(any);
  const size_t row = size_t(image.width) * size_t(image.components);
  for (size_t y = size_t(image.height); y-- > 0;) // VRML stores rows from the bottom
    for (size_t x = 0; x < row; ++x) {
      const int64_t v = dense.data()[y * row + x];
      if (v < 0 || v > 255) target.wrongValue("from 0 to 255, not " + std::to_string(v));
      pixels.push_back(uint8_t(v));
    }
  return image;
}

} // namespace

const char* typeName(XsType type) { return xsTypeInfo(type)->name; }

py::str toText(const XsString& bytes) {
  PyObject* text = PyUnicode_DecodeUTF8(bytes.data, py::ssize_t(bytes.bytes), "surrogateescape");
  if (!text) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

std::string fromText(const py::handle& text) {
  const auto bytes = py::reinterpret_steal<py::bytes>(
      PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape"));
  if (!bytes) throw py::error_already_set();
  return std::string(bytes);
}

std::vector<std::string> textsOf(const py::handle& object, const char* what) {
  if (py::isinstance<py::str>(object)) return {fromText(object)};
  const std::string name = what;
  const Target target{XS_MFSTRING, name};
  std::vector<std::string> texts;
  const py::object fast = sequenceOf(object, target);
  for (size_t i = 0; i < sizeOf(fast); ++i) texts.push_back(textOf(itemOf(fast, i), target));
  return texts;
}

py::object toPython(const XsValue& value, const Nodes& nodes) {
  const XsTypeInfo& info = *xsTypeInfo(value.type);
  const size_t width = size_t(info.components);
  const bool many = xsIsMany(value.type);
  // Converts an SF value, or a list of values that are no numbers.
  const auto each = [&](const auto& convert) -> py::object {
    if (!many) return convert(size_t(0));
    py::tuple all(value.count);
    for (size_t i = 0; i < value.count; ++i) all[i] = convert(i);
    return all;
  };
  switch (info.element) {
  case XS_SFBOOL: return each([&](size_t i) { return py::bool_(value.of.ints[i] != 0); });
  case XS_SFIMAGE: return each([&](size_t i) { return imageOf(value.of.images[i]); });
  case XS_SFSTRING: return each([&](size_t i) { return toText(value.of.strings[i]); });
  case XS_SFNODE: { // copied, because the host's list is valid only until its next call
    const std::vector<XsNode> numbers(value.of.nodes, value.of.nodes + value.count);
    return each([&](size_t i) { return nodes.toPython(numbers[i]); });
  }
  case XS_SFINT32:
    return many ? arrayOf(value.of.ints, value.count, 1) : py::int_(value.of.ints[0]);
  default: break;
  }
  if (xsHasDoubles(value.type))
    return many ? arrayOf(value.of.doubles, value.count, width) : vectorOf(value.of.doubles, width);
  return many ? arrayOf(value.of.floats, value.count, width) : vectorOf(value.of.floats, width);
}

Owned::Owned(const py::handle& object, XsType type, const std::string& name, const Nodes& nodes) {
  value_.type = type;
  read(object, name, nodes);
  if (!xsIsMany(type)) value_.count = 1;
}

void Owned::read(const py::handle& object, const std::string& name, const Nodes& nodes) {
  const XsType type = value_.type;
  const Target target{type, name};
  const XsTypeInfo& info = *xsTypeInfo(type);
  const bool many = xsIsMany(type);
  switch (info.element) {
  case XS_SFBOOL:
    if (!many)
      ints_.push_back(boolOf(object, target));
    else
      for (const py::handle one : sequenceOf(object, target)) ints_.push_back(boolOf(one, target));
    return hold(ints_);
  case XS_SFINT32: ints_ = wholesOf(object, many, target); return hold(ints_);
  case XS_SFSTRING:
    if (!many) texts_.push_back(textOf(object, target));
    // its characters would be taken as elements
    else if (py::isinstance<py::str>(object))
      target.wrongType(object);
    else
      texts_ = textsOf(object, name.c_str());
    for (const std::string& text : texts_) strings_.push_back({text.c_str(), text.size()});
    return hold(strings_);
  case XS_SFNODE:
    if (!many)
      nodes_.push_back(nodes.toHost(object));
    else
      for (const py::handle one : sequenceOf(object, target)) nodes_.push_back(nodes.toHost(one));
    return hold(nodes_);
  case XS_SFIMAGE:
    if (!many)
      images_.push_back(imageFrom(object, target, pixels_.emplace_back()));
    else
      for (const py::handle one : sequenceOf(object, target))
        images_.push_back(imageFrom(one, target, pixels_.emplace_back()));
    for (size_t i = 0; i < images_.size(); ++i) images_[i].pixels = pixels_[i].data();
    return hold(images_);
  default: break;
  }
  const std::vector<double> numbers = numbersOf(object, size_t(info.components), many, target);
  if (xsHasDoubles(type)) {
    doubles_ = numbers;
    hold(doubles_);
  } else {
    for (const double v : numbers) floats_.push_back(singleOf(v, target));
    hold(floats_);
  }
  value_.count = uint32_t(numbers.size() / size_t(info.components));
}

} // namespace python
