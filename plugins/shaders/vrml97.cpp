// vrml97.cpp: the stock plug-in: the surface of ISO/IEC 14772-1 clause 4.14, its three lights,
// background with fog, and the cameras. It sees openrt/openrts.h only; the classes are in the
// folder vrml97. Loaded by the shader registry.
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
