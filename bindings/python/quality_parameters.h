// quality_parameters.h: Defines parameters of Python functions that are quality settings of the
// library (RT_*). Names, defaults and the names of values are those of its table. The values go to
// the member `quality` (picture::QualityValues) of the struct of arguments. [GIL held]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "libpicture/quality.h"
#include "parameters.h"

namespace py = pybind11;

// A value for off and on: True, False, 0 or 1. pybind11's bool also takes None and any object with
// a truth value, such as nan.
struct Switch {
  bool on = false;
  explicit Switch(double value = 0) : on(value != 0) {}
  explicit operator double() const { return on ? 1 : 0; }
};

template <> struct pybind11::detail::type_caster<Switch> {
  PYBIND11_TYPE_CASTER(Switch, const_name("bool"));

  bool load(handle given, bool) {
    const std::string_view type = Py_TYPE(given.ptr())->tp_name; // NumPy 2 has "numpy.bool"
    make_caster<bool> truth;
    make_caster<long long> number;
    if (truth.load(given, type == "numpy.bool" || type == "numpy.bool_"))
      value.on = cast_op<bool>(truth);
    else if (number.load(given, false) && (cast_op<long long>(number) | 1) == 1)
      value.on = cast_op<long long>(number) == 1;
    else
      return false;
    return true;
  }
  static handle cast(Switch from, return_value_policy, handle) { return bool_(from.on).release(); }
};

// Raises ValueError if a setting does not have the value. name: the name of the parameter. Seeds
// begin at 0 in Python and vv; the C API also has negative ones.
inline void checkQuality(RTenum quality, const char* name, double value) {
  RTqualityInfo info = picture::qualityInfo(quality);
  if (quality == RT_SEED) info.minimum = 0;
  if (!rtIsQualityAllowed(quality, value) || (quality == RT_SEED && value < 0))
    throw py::value_error(picture::qualityFault(info, name, value));
}

// A row of parameterList() (parameters.h). pybind11 needs Type at compile time: Switch for off and
// on, std::string for other settings whose values have names, else a number. Numbers are not
// checked here (checkQuality).
template <class Type> struct QualityParameter {
  using Value = Type;
  RTenum quality;

  template <class Struct> py::arg_v annotation(const Struct&) const {
    const RTqualityInfo info = picture::qualityInfo(quality);
    if constexpr (std::is_same_v<Type, std::string>)
      return py::arg(info.name) =
                 picture::qualityChoices(quality)[size_t(info.defaultValue) - size_t(info.minimum)];
    else
      return namedArgument<Type>(info.name) = static_cast<Type>(info.defaultValue);
  }

  // Raises ValueError for a name that no value has.
  template <class Struct> void store(Struct& given, const Type& value) const {
    if constexpr (std::is_same_v<Type, std::string>) {
      const std::optional<int> named = picture::qualityNamed(quality, value);
      if (!named)
        throw py::value_error(fmt::format("{}: {} expected, not '{}'",
                                          picture::qualityInfo(quality).name,
                                          picture::qualityChoiceList(quality), value));
      given.quality.set(quality, *named);
    } else {
      given.quality.set(quality, static_cast<double>(value));
    }
  }
};

template <class Type> QualityParameter<Type> qualityParameter(RTenum quality) { return {quality}; }
