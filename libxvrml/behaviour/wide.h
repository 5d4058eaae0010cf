// wide.h: the numbers of a field's value as a vector in double, for splines and filters. [any
// thread]
#pragma once

#include <cmath>

#include "xvrml/numbers.h"

namespace xvrml {

// A vector of the dimension of T, in double.
template <class T> struct Wide {
  double n[size_t(numberCount<T>)] = {};
  Wide() = default;
  explicit Wide(const T& value) {
    for (int i = 0; i < numberCount<T>; ++i) n[i] = double(numbersOf(value)[i]);
  }
  Wide& add(const Wide& other, double factor) {
    for (int i = 0; i < numberCount<T>; ++i) n[i] += other.n[i] * factor;
    return *this;
  }
  double length() const {
    double sum = 0;
    for (const double x : n) sum += x * x;
    return std::sqrt(sum);
  }
  T narrow() const {
    T value{};
    for (int i = 0; i < numberCount<T>; ++i) numbersOf(value)[i] = ScalarOf<T>(n[i]);
    return value;
  }
};

} // namespace xvrml
