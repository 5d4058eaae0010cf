// range.cpp: ranges of field values (the intervals the standard prints beside each field). Used by the builder and the expander.
#include <limits>

#include <fmt/format.h>

#include "parse/builder.h"
#include "parse/field_access.h"

namespace xvrml {
namespace {

template <class T> bool inside(T number, const FieldRange& range) {
  const T minimum = static_cast<T>(range.minimum), maximum = static_cast<T>(range.maximum);
  return (range.minimumOpen ? number > minimum : number >= minimum) && (range.maximumOpen ? number < maximum : number <= maximum);
}

// Integers are compared as doubles: infinity is no integer.
bool inside(int32_t number, const FieldRange& range) { return inside(static_cast<double>(number), range); }

template <class T> void clampToClosed(T& number, const FieldRange& range) {
  const double value = static_cast<double>(number);
  if (!range.minimumOpen && value < range.minimum) number = static_cast<T>(range.minimum);
  if (!range.maximumOpen && value > range.maximum) number = static_cast<T>(range.maximum);
}

template <class T> bool isAlso(T number, const FieldRange& range) { return static_cast<double>(number) == range.also; }

// The numbers of a value that the range speaks of; the angle of a rotation is free.
template <class T> struct Numbers;
template <> struct Numbers<float> { static constexpr int count = 1; };
template <> struct Numbers<double> { static constexpr int count = 1; };
template <> struct Numbers<int32_t> { static constexpr int count = 1; };
template <> struct Numbers<Vec2f> { static constexpr int count = 2; };
template <> struct Numbers<Vec3f> { static constexpr int count = 3; };
template <> struct Numbers<Color> { static constexpr int count = 3; };
template <> struct Numbers<Rotation> { static constexpr int count = 3; };
template <class T>
concept Numeric = requires {
  Numbers<T>::count;
};

template <Numeric T> auto* first(T& value) {
  if constexpr (Numbers<T>::count == 1)
    return &value;
  else
    return &reinterpret_cast<float&>(value);
}

template <Numeric T> bool enforce(T& value, const FieldRange& range) {
  auto* numbers = first(value);
  const auto end = numbers + Numbers<T>::count;
  if (std::all_of(numbers, end, [&](auto number) { return inside(number, range); })) return true;
  if (std::all_of(numbers, end, [&](auto number) { return isAlso(number, range); })) return true;
  std::for_each(numbers, end, [&](auto& number) { clampToClosed(number, range); });
  return false;
}

} // namespace

bool enforceRange(const FieldInfo& field, void* storage) {
  return visitStorage(field.type, storage, [&](auto& value) {
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (Numeric<T>) {
      if (enforce(value, field.range)) return true;
      if constexpr (Numbers<T>::count == 1) {
        if (!inside(value, field.range)) value = std::get<T>(field.defaultValue);
      }
      return false;
    } else if constexpr (requires { requires Numeric<typename T::value_type>; }) {
      bool good = true;
      for (auto& element : value) good = enforce(element, field.range) && good;
      return good;
    } else {
      return true;
    }
  });
}

std::string describe(const FieldRange& range) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string low =
      range.minimum == -infinity ? "(-inf" : fmt::format("{}{}", range.minimumOpen ? '(' : '[', range.minimum);
  const std::string high = range.maximum == infinity ? "inf)" : fmt::format("{}{}", range.maximum, range.maximumOpen ? ')' : ']');
  return low + "," + high + (range.also == range.also ? fmt::format(" or {}", range.also) : "");
}

} // namespace xvrml
