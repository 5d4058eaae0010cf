// numbers.h: arguments out of Python objects where the types of the signature do not say enough,
// with errors that name the argument, what was expected and what came. Called with the GIL held.
#pragma once

#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace py = pybind11;

// Returns a value as messages name it: "the str 'a'".
std::string shown(const py::handle& value);

// Returns the numbers as an array of whatever type. Raises TypeError for text and other objects,
// ValueError for rows of different lengths; whole: ValueError for numbers with a fraction, too.
// expected: "numbers of shape (n, 3)".
py::array numberArray(const py::object& given, const std::string& name, const std::string& expected,
                      bool whole = false);
