// arrays.h: Makes arrays of numpy, whose strides follow from the type in C++. [GIL held]
//
// pybind11 before 2.12 does not know numpy 2. It reads the size of an element where numpy 2 keeps
// flags, and gets 0. So these bindings call neither itemsize() nor nbytes() of an array, and make
// none with a constructor that asks the descriptor: those of py::array, and that of py::array_t
// from a count. test_numpy2 checks both.
#pragma once

#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace py = pybind11;

using ArrayShape = std::vector<py::ssize_t>;

// Returns an array of these sides, with undefined numbers.
template <class T> py::array_t<T> newArray(ArrayShape shape) {
  return py::array_t<T>(std::move(shape));
}

// Returns a 4x4 matrix for column vectors, of 16 numbers column by column.
inline py::array_t<double> matrixArray(const double* columns) {
  py::array_t<double> matrix({4, 4});
  for (size_t i = 0; i < 16; ++i)
    matrix.mutable_at(py::ssize_t(i % 4), py::ssize_t(i / 4)) = columns[i];
  return matrix;
}

// Returns an array of one dimension with a copy of the numbers.
template <class T> py::array_t<T> copiedArray(const std::vector<T>& numbers) {
  return py::array_t<T>(ArrayShape{py::ssize_t(numbers.size())}, numbers.data());
}
