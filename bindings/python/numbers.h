// numbers.h: Converts Python arguments where the types of the signature are not specific enough.
// Errors name the argument, the expected value and the given value. [GIL held]
#pragma once

#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace py = pybind11;

// Formats a value for messages: "the str 'a'".
std::string shown(const py::handle& value);

// Returns the name of the value's class.
std::string typeName(const py::handle& value);

// Returns the numbers as an array of any type. Raises TypeError for text and other objects, and
// ValueError for rows of different lengths. whole: fractions also raise ValueError. expected: for
// the message, such as "numbers of shape (n, 3)".
py::array numberArray(const py::object& given, const std::string& name, const std::string& expected,
                      bool whole = false);

// Returns the numbers of an array of shape (height, width, 3), or with alpha (height, width, 4).
// Raises TypeError and ValueError.
py::array_t<float> imageArray(const py::object& given, const std::string& name, bool mayHaveAlpha);
// Returns the numbers of such an array with alpha, which is 1 if it has none.
std::vector<float> rgbaOfImage(const py::array_t<float>& image);
