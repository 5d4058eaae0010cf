// quality_parameters.h: Defines parameters of Python functions that are quality settings of the
// library (RT_*). Names, defaults and the names of values are those of its table. The values go to
// the member `quality` (picture::QualityValues) of the struct of arguments. [GIL held]
#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "libpicture/quality.h"

namespace py = pybind11;

// A row of parameterList() (parameters.h). pybind11 needs Type at compile time: bool for off and
// on, std::string for other settings whose values have names, else a number. Numbers are not
// checked here.
template <class Type> struct QualityParameter {
  using Value = Type;
  RTenum quality;

  template <class Struct> py::arg_v annotation(const Struct&) const {
    const RTqualityInfo info = picture::qualityInfo(quality);
    if constexpr (std::is_same_v<Type, std::string>)
      return py::arg(info.name) =
                 picture::qualityChoices(quality)[size_t(info.defaultValue) - size_t(info.minimum)];
    else
      return py::arg(info.name) = static_cast<Type>(info.defaultValue);
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
