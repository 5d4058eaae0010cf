// embree_parts.h: Embree geometries made from parts. Each attaches a part under the geometry id that is its index in
// PartScene::parts and keeps it alive there.
#pragma once

#include "backend/local/accel.h"

namespace openrt {

RTCScene newScene(const EmbreeDevice& device); // robust mode
// filtered: hits are validated in double (slivers).
void attachTriangles(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part, uint32_t mask, bool filtered);
// Spheres or round linear curves; part.vertices have stride 4: centre and radius.
void attachRound(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part, uint32_t mask, RTCGeometryType type);
void attachInstance(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part, const PartScene& object,
                    const Matrix4d& matrix);

} // namespace openrt
