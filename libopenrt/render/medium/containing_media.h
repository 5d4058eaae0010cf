// containing_media.h: the media that a point lies in. [render]
#pragma once

#include "render/surface/batch.h"

namespace openrt {

// Finds the media that contain the origins of the rays: those whose boundaries a probe ray leaves
// more often than it enters them. The bodies must be closed. Used only in scenes with media that
// scatter.
void findContainingMedia(const StageContext& context, const Rays& rays, MediaStack* media);

} // namespace openrt
