// parameters.h: Defines Python functions with many parameters from a struct. Each parameter is a
// member, and its default is the member's value in a new struct. [GIL held]
#pragma once

#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include <pybind11/pybind11.h>

namespace py = pybind11;

namespace detail {

template <class T> inline constexpr bool isWhole =
    std::is_integral_v<T> && !std::is_same_v<T, bool>;
template <class T> inline constexpr bool isWhole<std::optional<T>> = isWhole<T>;
template <class A, class B> inline constexpr bool isWhole<std::pair<A, B>> =
    isWhole<A>&& isWhole<B>;

} // namespace detail

// Returns the annotation of a parameter. Whole numbers take only values that Python accepts as an
// index: pybind11 would truncate the fractions of NumPy.
template <class Type> py::arg namedArgument(const char* name) {
  py::arg made(name);
  if constexpr (detail::isWhole<Type>) made.noconvert();
  return made;
}

template <class Struct, class Type, bool isRequired> struct Parameter {
  using Value = Type;
  const char* name;
  Type Struct::*member;

  auto annotation(const Struct& defaults) const {
    if constexpr (isRequired)
      return namedArgument<Type>(name);
    else
      return namedArgument<Type>(name) = defaults.*member;
  }
  void store(Struct& given, Type&& value) const { given.*member = std::move(value); }
};

template <class Struct, class Type>
Parameter<Struct, Type, false> parameter(const char* name, Type Struct::*member) {
  return {name, member};
}

template <class Struct, class Type>
Parameter<Struct, Type, true> requiredParameter(const char* name, Type Struct::*member) {
  return {name, member};
}

// Lists parameters in the order of the signature. A row has a type Value and the functions
// annotation and store, as Parameter does; quality_parameters.h has another kind of row.
template <class... Rows> std::tuple<Rows...> parameterList(Rows... rows) { return {rows...}; }

namespace detail {

template <class Struct, class... Rows>
void assign(Struct& given, const std::tuple<Rows...>& rows, typename Rows::Value&... values) {
  std::apply([&](const Rows&... row) { (row.store(given, std::move(values)), ...); }, rows);
}

// Calls use(annotations...).
template <class Struct, class... Positional, class... Named, class Use>
void annotate(const std::tuple<Positional...>& positional, const std::tuple<Named...>& named,
              const Use& use) {
  const Struct defaults;
  std::apply(
      [&](const Positional&... p) {
        std::apply(
            [&](const Named&... n) {
              if constexpr (sizeof...(Named) > 0)
                use(p.annotation(defaults)..., py::kw_only(), n.annotation(defaults)...);
              else
                use(p.annotation(defaults)...);
            },
            named);
      },
      positional);
}

} // namespace detail

// Defines the method `name` of a class: work(self, the arguments). named: parameters that are given
// by name only.
template <class Class, class Result, class Self, class Struct, class... Positional, class... Named>
void defineMethod(Class& owner, const char* name, Result (*work)(const Self&, const Struct&),
                  const std::tuple<Positional...>& positional, const std::tuple<Named...>& named,
                  const char* text) {
  const auto function = [=](const Self& self, typename Positional::Value... p,
                            typename Named::Value... n) -> Result {
    Struct given;
    detail::assign(given, positional, p...);
    detail::assign(given, named, n...);
    return work(self, given);
  };
  detail::annotate<Struct>(positional, named, [&](const auto&... annotations) {
    owner.def(name, function, annotations..., text);
  });
}

// Defines the constructor of a class: work(the arguments).
template <class Class, class Result, class Struct, class... Positional, class... Named>
void defineConstructor(Class& owner, Result (*work)(const Struct&),
                       const std::tuple<Positional...>& positional,
                       const std::tuple<Named...>& named, const char* text) {
  const auto function = [=](typename Positional::Value... p, typename Named::Value... n) -> Result {
    Struct given;
    detail::assign(given, positional, p...);
    detail::assign(given, named, n...);
    return work(given);
  };
  detail::annotate<Struct>(positional, named, [&](const auto&... annotations) {
    owner.def(py::init(function), annotations..., text);
  });
}
