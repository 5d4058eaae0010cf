// measure.h: photometric sensors (RT_MEASURE). A luminance is that of a camera ray. An illuminance
// is found by a path that starts on a white matt surface at the sensor, which nothing else in the
// scene can see: light samples, shadow rays and the rays that follow are those of any matt surface.
// [render]
#pragma once

#include "render/path/path_tracer.h"

namespace openrt {

// Traces the paths of illuminance sensors, which are at the origins of the rays of a wave and face
// along them.
void measureIlluminance(PathTracer& tracer, Wave& wave, PixelSamples& found);

// Returns the reading of a sensor whose path has found this radiance, in cd/m2 or lux (frame.h).
float readingOf(const edit::FrameSettingsT& frame, const Vec3f& radiance);

} // namespace openrt
