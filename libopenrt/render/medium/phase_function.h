// phase_function.h: the phase function of media that scatter: L. Henyey, J. Greenstein, "Diffuse
// Radiation in the Galaxy", ApJ 93, 1941. Pure functions. [any thread]
#pragma once

#include "openrt/openrts.h"
#include "scene/vec3.h"

namespace openrt {

// Returns the phase function (per steradian; its integral over all directions is 1). cosine: of the
// angle between the directions before and after scattering. g: mean cosine, -1 < g < 1.
double phaseFunction(double g, double cosine);

// Returns the cosine that a number in [0, 1) samples with the pdf of the phase function.
double samplePhaseCosine(double g, double u);

// The phase function as a lobe, so that scattering in a medium passes through the same stages as
// scattering at a surface. data[0] is g. The lobe scatters to all directions.
extern const RtsLobeFunctions phaseLobe;

} // namespace openrt
