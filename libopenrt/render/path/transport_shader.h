// transport_shader.h: frames whose light transport is a plug-in (rts::Transport). [render]
#pragma once

#include "render/wave/batch.h"
#include "render/wave/pixel_samples.h"

namespace openrt {

// Lets the transport shader of the scene compute the radiance of camera rays. context: with the
// tracer, from which the shader requests rays.
void runTransportShader(const StageContext& context, const Rays& rays, PixelSamples& found);

} // namespace openrt
