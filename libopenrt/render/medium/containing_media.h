// containing_media.h: the media that a point lies in. [render]
#pragma once

#include "render/wave/batch.h"

namespace openrt {

// Finds the media that contain the origins of the rays: those whose boundaries a probe ray leaves
// more often than it enters them. The bodies must be closed. Camera paths use it only in scenes
// with media that scatter.
void findContainingMedia(const StageContext& context, const Rays& rays, MediaStack* media);
// Returns the media that contain the eye of a scene; none if it has no media.
MediaStack mediaAroundEye(const RenderScene& scene);
// Returns whether a point lies in a body of the medium.
bool isInMedium(const RenderScene& scene, const Vec3f& point, uint16_t medium);

} // namespace openrt
