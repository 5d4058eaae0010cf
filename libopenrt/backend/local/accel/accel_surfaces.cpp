// accel_surfaces.cpp: lists what ray queries can hit. Called between frames.
#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"

namespace openrt {

std::vector<Accel::Surface> Accel::surfaces() const {
  std::vector<Surface> out;
  std::vector<uint32_t> placeOf(records.size(), ~0u);
  for (size_t c = 0; c < placed_.size(); c++) {
    if (c > 0 && !placed_[c].shown) continue;
    const size_t end = c + 1 < placed_.size() ? placed_[c + 1].firstRecord : records.size();
    for (size_t i = placed_[c].firstRecord; i < end; i++) {
      const Record& r = records[i];
      const bool sphere = r.primitive == edit::Primitive::Sphere;
      if (!sphere && (r.primitive != edit::Primitive::Triangles || !r.vertices)) continue;
      placeOf[i] = uint32_t(out.size());
      out.push_back({uint32_t(i), sphere ? matrixOf(r.toRender) : Matrix4d()});
    }
  }
  // The matrices of huge spheres need all digits of double.
  if (static_)
    for (const PartSlot& slot : static_->parts)
      for (uint32_t i = 0; slot.part && i < slot.part->spheres.size(); i++)
        if (const uint32_t at = placeOf[slot.part->primitives.find(i).record]; at != ~0u)
          out[at].unitSphere = uniformScale(1 / double(scale_)) * slot.part->spheres[i];
  return out;
}

std::vector<uint32_t> Accel::spheres() const {
  std::vector<uint32_t> out;
  for (const Surface& s : surfaces())
    if (records[s.record].primitive == edit::Primitive::Sphere) out.push_back(s.record);
  return out;
}

} // namespace openrt
