// accel.cpp: construction of an Accel.
#include "backend/local/accel.h"

#include "backend/local/accel_build.h"

namespace openrt {

Accel::Accel(std::shared_ptr<EmbreeDevice> device, const Scene& scene, const Flattened& flat, const ShaderTable& shaders,
             const Vec3d& origin, const PixelFootprint& footprint)
    : device_(std::move(device)) {
  AccelBuilder(*this, scene, flat, shaders, origin, footprint).build();
}

} // namespace openrt
