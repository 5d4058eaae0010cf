// numbers.h: the numbers that a field's value consists of, for code that treats all types of
// numbers alike: parser, writer, ranges, Scripts and bindings. [any thread]
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// The type of the numbers of an element: float of Vec3f, Color and float; void of what has none.
template <class T> struct ScalarType { using type = void; };
template <> struct ScalarType<float> { using type = float; };
template <> struct ScalarType<double> { using type = double; };
template <> struct ScalarType<int32_t> { using type = int32_t; };
template <class T>
requires requires { typename T::Scalar; }
struct ScalarType<T> {
  using type = typename T::Scalar;
};
template <class T> using ScalarOf = typename ScalarType<T>::type;

// An element that consists of numbers. Booleans, texts, images and nodes are none.
template <class T>
concept Numeric = !std::is_void_v<ScalarOf<T>>;

// The type that holds an element's numbers one behind the other: the element, or what its box
// holds.
template <class T> struct UnboxedType { using type = T; };
template <class T> struct UnboxedType<Boxed<T>> { using type = T; };
template <class T> using Unboxed = typename UnboxedType<T>::type;

// How many numbers an element has.
template <Numeric T>
inline constexpr int numberCount = int(sizeof(Unboxed<T>) / sizeof(ScalarOf<T>));

// The numbers of an element, or of the elements of an array, one behind the other.
template <Numeric T> ScalarOf<T>* numbersOf(T& element) {
  return reinterpret_cast<ScalarOf<T>*>(&element);
}
template <Numeric T> const ScalarOf<T>* numbersOf(const T& element) {
  return reinterpret_cast<const ScalarOf<T>*>(&element);
}
template <class T> ScalarOf<T>* numbersOf(Boxed<T>& element) { return numbersOf(*element); }
template <class T> const ScalarOf<T>* numbersOf(const Boxed<T>& element) {
  return numbersOf(*element);
}

// Whether a value is that of an MF type, and the type of its elements; of an SF type its own.
template <class T> inline constexpr bool isList = false;
template <class T> inline constexpr bool isList<std::vector<T>> = true;
template <class T> struct ElementType { using type = T; };
template <class T> struct ElementType<std::vector<T>> { using type = T; };
template <class T> using ElementOf = typename ElementType<T>::type;
// Whether a value is a list whose numbers lie one behind the other.
template <class T> inline constexpr bool isNumberList = isList<T>&& Numeric<ElementOf<T>>;

namespace detail {
template <class T, class... All> constexpr size_t placeIn(const std::variant<All...>*) {
  size_t place = 0;
  (void)((std::is_same_v<T, Unboxed<All>> || (++place, false)) || ...);
  return place;
}
} // namespace detail
// The field type whose C++ type is T, or whose box holds T.
template <class T> inline constexpr auto
    fieldTypeOf = FieldType(detail::placeIn<T>(static_cast<const Value*>(nullptr)));

} // namespace xvrml
