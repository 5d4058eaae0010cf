// range.cpp: rounds and clamps numbers to the range of their field.
#include "graph/range.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "base/rotation.h"
#include "graph/field_access.h"

namespace xvrml {
namespace {

// Returns true if the bound is a multiple of pi/2 other than 0. Files contain such angles rounded
// (1.571, 1.5708, 6.28319).
bool isAngleBound(double bound) {
  const double quarters = bound / (std::numbers::pi / 2);
  return std::abs(quarters) >= 1 && std::abs(quarters) <= 8 &&
         std::abs(quarters - std::round(quarters)) < 1e-6;
}

// Returns how far beyond a bound a number may lie and still mean the bound.
double slackAt(double bound) {
  constexpr double rounded = 5.1e-4; // half of the third decimal, plus the error of a float
  constexpr double single = 1e-6;    // about eight units in the last place of a float
  return isAngleBound(bound) ? rounded : single * std::abs(bound);
}

template <class T> bool inside(T number, const FieldRange& range) {
  const T minimum = static_cast<T>(range.minimum), maximum = static_cast<T>(range.maximum);
  return (range.minimumOpen ? number > minimum : number >= minimum) &&
         (range.maximumOpen ? number < maximum : number <= maximum);
}

// Compares as doubles, because no integer can represent infinity.
bool inside(int32_t number, const FieldRange& range) {
  return inside(static_cast<double>(number), range);
}

// Moves a number that means a bound to that bound, or to the nearest number inside if the range is
// open there. Returns false if the number is outside and means no bound.
template <class T> bool round(T& number, const FieldRange& range) {
  if (inside(number, range)) return true;
  if constexpr (std::is_floating_point_v<T>) {
    const auto means = [number](double bound) {
      return std::abs(static_cast<double>(number) - bound) <= slackAt(bound);
    };
    const T minimum = static_cast<T>(range.minimum), maximum = static_cast<T>(range.maximum);
    if (number > maximum && means(range.maximum) &&
        (!range.maximumOpen || isAngleBound(range.maximum))) {
      number = range.maximumOpen ? std::nextafter(maximum, T(0)) : maximum;
      return true;
    }
    if (number < minimum && means(range.minimum) && !range.minimumOpen) {
      number = minimum;
      return true;
    }
    if (range.maximumOpen && number == maximum && isAngleBound(range.maximum)) {
      number = std::nextafter(maximum, T(0));
      return true;
    }
  }
  return false;
}

template <class T> void clampToClosed(T& number, const FieldRange& range) {
  const double value = static_cast<double>(number);
  if (!range.minimumOpen && value < range.minimum) number = static_cast<T>(range.minimum);
  if (!range.maximumOpen && value > range.maximum) number = static_cast<T>(range.maximum);
}

template <class T> bool isAlso(T number, const FieldRange& range) {
  return static_cast<double>(number) == range.also;
}

// Whether a range applies to an element's numbers. Rotations are normalised instead.
template <class T>
concept Ranged = Numeric<T> && !std::is_same_v<T, Rotation>;

template <Ranged T> bool enforce(T& value, const FieldRange& range) {
  auto* numbers = numbersOf(value);
  const auto end = numbers + numberCount<T>;
  if (std::all_of(numbers, end, [&](auto number) { return inside(number, range); })) return true;
  if (std::all_of(numbers, end, [&](auto number) { return isAlso(number, range); })) return true;
  bool good = true;
  std::for_each(numbers, end, [&](auto& number) { good = round(number, range) && good; });
  if (good) return true;
  std::for_each(numbers, end, [&](auto& number) { clampToClosed(number, range); });
  return false;
}

// Returns whether a list says how many vertices each line, fan or strip has. Another count would
// move the vertices of all that follow, so wrong ones stay, and the geometry leaves out their lines
// with a warning, as it does after events.
bool isCounts(const FieldInfo& field) {
  return field.type == FieldType::MFInt32 && field.range.minimum > 0;
}

// Returns the numbers of a value as a file shows them.
template <Ranged T> std::string textOf(T value) {
  std::string text;
  auto* numbers = numbersOf(value);
  for (int i = 0; i < numberCount<T>; ++i) text += fmt::format("{}{}", i ? " " : "", numbers[i]);
  return text;
}

// Returns a bound as text; "pi/2" instead of 1.5707963267948966.
std::string boundText(double bound) {
  if (!isAngleBound(bound)) return fmt::format("{}", bound);
  const int quarters = int(std::lround(bound / (std::numbers::pi / 2)));
  const std::string sign = quarters < 0 ? "-" : "";
  const int n = std::abs(quarters);
  if (n % 2 != 0) return fmt::format("{}{}pi/2", sign, n == 1 ? "" : std::to_string(n));
  return fmt::format("{}{}pi", sign, n == 2 ? "" : std::to_string(n / 2));
}

} // namespace

bool enforceRange(const FieldInfo& field, const FieldRevision* revision, void* storage,
                  RangeFault* fault) {
  const FieldRange& range = revision ? revision->range : field.range;
  const Value& standard = revision ? revision->defaultValue : field.defaultValue;
  if (hasNormalizedAxes(field)) {
    normalizeAxes(field.type, storage);
    return true;
  }
  const auto tell = [fault, &range](const auto& given, const auto& used, size_t index) {
    if (fault && fault->count++ == 0) {
      fault->given = textOf(given);
      fault->used = textOf(used);
      fault->index = index;
      fault->range = range;
    }
  };
  return visitStorage(field.type, storage, [&](auto& value) {
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (Ranged<T>) {
      const T given = value;
      if (enforce(value, range)) return true;
      if constexpr (numberCount<T> == 1) {
        if (!inside(*numbersOf(value), range)) value = std::get<T>(standard);
      }
      tell(given, value, 0);
      return false;
    } else if constexpr (isList<T> && Ranged<ElementOf<T>>) {
      if (isCounts(field)) return true;
      bool good = true;
      for (size_t i = 0; i < value.size(); ++i) {
        const auto given = value[i];
        if (enforce(value[i], range)) continue;
        good = false;
        tell(given, value[i], i);
      }
      return good;
    } else {
      return true;
    }
  });
}

std::string describe(const FieldRange& range) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::string low = range.minimum == -infinity
                              ? "(-inf"
                              : (range.minimumOpen ? '(' : '[') + boundText(range.minimum);
  const std::string high = range.maximum == infinity
                               ? "inf)"
                               : boundText(range.maximum) + (range.maximumOpen ? ')' : ']');
  return low + "," + high + (range.also == range.also ? fmt::format(" or {}", range.also) : "");
}

std::string describe(const NodeType& type, const FieldInfo& field, const RangeFault& fault) {
  const bool list = isMultiple(field.type);
  const std::string where = list ? fmt::format("{}.{}[{}]", type.name, field.name, fault.index)
                                 : type.name + "." + field.name;
  const std::string done = fault.given != fault.used ? fmt::format("becomes {}", fault.used)
                           : field.change == Change::none
                               ? "is kept; no picture depends on it"
                               : "is kept, and parts that cannot be drawn are skipped";
  return fmt::format(
      "{}: {} is outside of its range {} and {}{}", where, fault.given, describe(fault.range), done,
      fault.count > 1 ? fmt::format(", as do {} further elements", fault.count - 1) : "");
}

} // namespace xvrml
