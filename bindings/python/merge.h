// merge.h: Declares what merge.cpp shares with other files of the module.
#pragma once

#include <pybind11/pybind11.h>

#include "libpicture/files/formats.h"

// Returns the format of a file by its suffix. Raises ValueError. (picture.cpp)
const picture::Format& formatFor(const std::string& path);

void defineMerge(pybind11::module_& module); // after definePicture()
