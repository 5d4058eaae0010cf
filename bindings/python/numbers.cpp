#include "numbers.h"

#include <cstring>

#include <fmt/format.h>

#include "objects.h"

std::string shown(const py::handle& value) {
  return fromText(py::module_::import("xvrml._arguments").attr("_short")(value));
}

std::string typeName(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

py::array numberArray(const py::object& given, const std::string& name, const std::string& expected,
                      bool whole) {
  py::array array;
  try {
    array = py::array(py::module_::import("numpy").attr("asarray")(given));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw py::value_error(
        fmt::format("{}: {} expected, not rows of different lengths", name, expected));
  }
  if (array.size() == 0) return array;
  const char kind = fromText(array.dtype().attr("kind"))[0];
  if (!std::strchr("biuf", kind))
    throw py::type_error(fmt::format("{}: {} expected, not {}", name, expected, shown(given)));
  if (whole && kind == 'f') {
    // also true for NaN
    const py::array odd =
        array[array.attr("__ne__")(py::module_::import("numpy").attr("floor")(array))];
    if (odd.size() > 0) {
      const std::string first = fromText(py::str(odd.attr("flat")[py::int_(0)]));
      throw py::value_error(fmt::format("{}: whole {} expected, not {}", name, expected, first));
    }
  }
  return array;
}
