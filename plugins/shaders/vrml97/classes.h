// classes.h: the classes of the VRML97 plug-in, collected by vrml97.cpp.
#pragma once

#include <cfloat>
#include <cstddef>

#include "openrt/openrts.h"

namespace vrml97 {

extern const RtsClass surfaceClass, globalIlluminationClass, x3dMaterialClass;
extern const RtsClass directionalLightClass, pointLightClass, spotLightClass;
extern const RtsClass environmentClass;
extern const RtsClass perspectiveCameraClass, orthographicCameraClass, thinLensClass, panoramaClass;

// The maximum of parameters that have a minimum but no upper limit.
inline constexpr float noLimit = FLT_MAX;

} // namespace vrml97
