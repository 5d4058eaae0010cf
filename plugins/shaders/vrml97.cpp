// vrml97.cpp: the stock plug-in: the surface of ISO/IEC 14772-1 clause 4.14, the standard's three
// lights, background and fog, and the cameras. The classes are in the folder vrml97; they use only
// the headers of openrt/openrts.h. Loaded by the shader registry.
#include "vrml97/classes.h"

namespace {

const RtsClass* const classes[] = {
    &vrml97::surfaceClass,
    &vrml97::directionalLightClass,
    &vrml97::pointLightClass,
    &vrml97::spotLightClass,
    &vrml97::environmentClass,
    &vrml97::perspectiveCameraClass,
    &vrml97::orthographicCameraClass,
    &vrml97::thinLensClass,
    &vrml97::panoramaClass,
    &vrml97::globalIlluminationClass,
    &vrml97::x3dMaterialClass,
};

} // namespace

extern "C" {
extern RTS_EXPORT const RtsPlugin rtsPlugin;
const RtsPlugin rtsPlugin = {RTS_MAGIC,
                             RTS_ABI_MAJOR,
                             RTS_ABI_MINOR,
                             sizeof(RtsPlugin),
                             sizeof(classes) / sizeof(classes[0]),
                             classes};
}
