// sampled_points.h: the points on emissive shapes that light samples lead to: the end of a shadow
// ray, the radiance if it is known without the shader, and the hit that the shader is called for
// otherwise. [render]
#pragma once

#include "render/lights/emitters.h"
#include "render/render_scene.h"

namespace openrt {

// Returns tfar of the shadow ray of a light sample: just before the sampled point, so that the
// emitter does not block its own sample; infinite for the sky. eye: the point that the sample was
// taken for. origin: origin of the ray, which may lie on the other side of the same surface.
float shadowRayEnd(const RenderScene& scene, const LightSample& sample, const Vec3f& eye,
                   const Vec3f& origin);

// Returns the radiance of the side that a ray along the direction arrives at, if the shape emits
// uniformly; else null.
const Vec3f* uniformRadiance(const EmissiveShapes::Shape& shape, const Vec3f& direction);

// Writes hit `lane` of the rays as if the kernel had found the sampled point.
void writeSampledHit(const RenderScene& scene, const LightSample& sample, const Rays& rays,
                     uint32_t lane, RayHits& hits);

} // namespace openrt
