// classes.h: the class tables of the VRML97 plug-in, one object each, gathered by vrml97.cpp.
#pragma once

#include <cfloat>
#include <cstddef>

#include "openrt/openrts.h"

namespace vrml97 {

extern const RtsClass surfaceClass, globalIlluminationClass;
extern const RtsClass directionalLightClass, pointLightClass, spotLightClass;
extern const RtsClass environmentClass;
extern const RtsClass perspectiveCameraClass, orthographicCameraClass, thinLensClass, panoramaClass;

// The range of a number that may not be negative.
inline constexpr float noLimit = FLT_MAX;

} // namespace vrml97
