// accel_surfaces.cpp: lists what ray queries can hit. Called between frames.
#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"

namespace openrt {
namespace {

// Calls use(record, toRender) for the huge spheres and analytic surfaces of an Embree scene, whose
// matrices have all digits of double. A body of several surfaces has no gaps only with these.
// toRender: from the frame of the Embree scene. first: the first record of its contents.
template <class F> void forPlacedInDouble(const PartScene& scene, const Matrix4d& toRender,
                                          uint32_t first, const F& use) {
  for (const PartSlot& slot : scene.parts) {
    if (!slot.part) continue;
    const Part& part = *slot.part;
    for (uint32_t i = 0; i < part.spheres.size(); i++)
      use(first + part.primitives.find(i).record, toRender * part.spheres[i]);
    for (uint32_t i = 0; i < part.surfaces.size(); i++)
      use(first + part.primitives.find(i).record, toRender * part.surfaces[i].toKernel);
  }
}

bool hasPlacedInDouble(const PartScene& scene) {
  for (const PartSlot& slot : scene.parts)
    if (slot.part && !(slot.part->spheres.empty() && slot.part->surfaces.empty())) return true;
  return false;
}

} // namespace

std::vector<Accel::Surface> Accel::surfaces() const {
  std::vector<Surface> out;
  std::vector<uint32_t> placeOf(records.size(), ~0u);
  for (size_t c = 0; c < placed_.size(); c++) {
    if (c > 0 && !placed_[c].shown) continue;
    const size_t end = c + 1 < placed_.size() ? placed_[c + 1].firstRecord : records.size();
    for (size_t i = placed_[c].firstRecord; i < end; i++) {
      const Record& r = records[i];
      const bool triangles = r.primitive == edit::Primitive::Triangles;
      if (!(triangles ? r.vertices != nullptr
                      : r.surface || r.primitive == edit::Primitive::Sphere))
        continue;
      placeOf[i] = uint32_t(out.size());
      out.push_back({uint32_t(i), triangles ? Matrix4d() : matrixOf(r.frames->toRender)});
    }
  }
  const Matrix4d fromKernel = uniformScale(1 / double(scale_));
  const auto put = [&](uint32_t record, const Matrix4d& toRender) {
    if (const uint32_t at = placeOf[record]; at != ~0u) out[at].toRender = toRender;
  };
  for (const PartScene* scene : {static_cast<const PartScene*>(static_.get()), &top_}) {
    if (!scene) continue;
    forPlacedInDouble(*scene, fromKernel, 0, put);
    for (uint32_t slot = 0; slot < scene->parts.size(); slot++)
      if (const PartSlot& placed = scene->parts[slot];
          placed.object && placed.enabled && hasPlacedInDouble(*placed.object))
        forPlacedInDouble(*placed.object, fromKernel * transformOf(*scene, slot), placed.record,
                          put);
  }
  return out;
}

std::vector<std::shared_ptr<const Blas>> Accel::owners() const {
  std::vector<std::shared_ptr<const Blas>> out;
  if (static_) out.push_back(static_);
  for (const PartSlot& slot : top_.parts)
    if (slot.object && (out.empty() || out.back() != slot.object)) out.push_back(slot.object);
  return out;
}

std::vector<uint32_t> Accel::spheres() const {
  std::vector<uint32_t> out;
  for (const Surface& s : surfaces())
    if (records[s.record].primitive == edit::Primitive::Sphere) out.push_back(s.record);
  return out;
}

} // namespace openrt
