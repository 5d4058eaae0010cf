#include "numbers.h"

#include <algorithm>
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

py::array_t<float> imageArray(const py::object& given, const std::string& name, bool mayHaveAlpha) {
  const std::string expected = mayHaveAlpha
                                   ? "numbers of shape (height, width, 3) or (height, width, 4)"
                                   : "numbers of shape (height, width, 3)";
  const py::array any = numberArray(given, name, expected);
  const auto image = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(any);
  constexpr py::ssize_t most = 65536;
  if (!image || image.ndim() != 3 || image.shape(0) < 1 || image.shape(1) < 1 ||
      image.shape(0) > most || image.shape(1) > most ||
      (image.shape(2) != 3 && !(mayHaveAlpha && image.shape(2) == 4)))
    throw py::value_error(fmt::format("{}: {} expected, not {}", name, expected,
                                      std::string(py::str(any.attr("shape")))));
  return image;
}

std::vector<float> rgbaOfImage(const py::array_t<float>& image) {
  const auto components = size_t(image.shape(2));
  std::vector<float> rgba(size_t(image.size()) / components * 4, 1);
  const float* from = image.data();
  for (size_t i = 0; i < rgba.size(); i += 4, from += components)
    std::copy_n(from, components, &rgba[i]);
  return rgba;
}
