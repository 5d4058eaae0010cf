// accel_clusters.cpp: the top level: the slots (Embree geometry ids) of each cluster and their
// contents. Slots depend only on the scene, never on the order of edits. A cluster that was never
// visible has no acceleration structure.
#include <algorithm>

#include "backend/local/accel/accel_build.h"
#include "backend/local/line_stippler.h"

namespace openrt {
namespace {

// The slots of a cluster, in this order: the baked scenes, shared items, ellipsoids, lines, points.
// For the root part the first three are in the static scene and have no slots.
struct Slots {
  uint32_t shared, ellipsoids, lines, points, end; // first slot of each kind
  Slots(const PartInfo& part, bool root) {
    shared = root ? 0 : part.baked;
    ellipsoids = shared + (root ? 0 : uint32_t(part.sharedItems.size()));
    lines = ellipsoids + (root ? 0 : uint32_t(part.ellipsoids.size()));
    points = lines + part.lines;
    end = points + part.points;
  }
};

} // namespace

void AccelBuilder::begin(Accel& accel, const BuildInput& input) {
  accel_ = &accel;
  input_ = &input;
  worldToRender_ = {};
  worldToRender_.translate(input.origin * -1.0);
  changed_ = false;
  buildNumber_++;
  device_->forgetErrors();
}

bool AccelBuilder::hasFrame(const Accel& accel, const BuildInput& input) {
  return accel.origin_.x == input.origin.x && accel.origin_.y == input.origin.y &&
         accel.origin_.z == input.origin.z && accel.scale_ == float(input.scale) &&
         accel.reach_ == input.reach;
}

std::shared_ptr<Accel> AccelBuilder::build(const BuildInput& input) {
  const auto accel = std::make_shared<Accel>();
  begin(*accel, input);
  accel->device_ = device_;
  accel->origin_ = input.origin;
  accel->scale_ = float(input.scale);
  accel->reach_ = input.reach;
  buckets_.clear();
  layOut();
  accel->static_ = staticBlas();
  accel->staticLevel_ = {accel->static_.get(),
                         accel->static_->parts.empty() ? 0u : maskOpaque | maskTransparent,
                         accel->static_->instances, largestCoordinate(accel->static_->enlargement)};
  for (uint32_t c = 0; c < input.flat.clusters.size(); c++) place(c);
  if (accel->buckets.empty()) accel->buckets.push_back({input.shaders[0].shaderClass, 0});
  if (!changed_) topLevelBuilds++; // there is only the static scene
  finish();
  evictUnused();
  return accel;
}

void AccelBuilder::update(Accel& accel, const BuildInput& input,
                          const std::vector<uint32_t>& clusters,
                          const std::vector<uint32_t>& objects, bool thin) {
  begin(accel, input);
  std::vector<uint32_t> all = clusters;
  for (uint32_t object : objects) {
    const std::vector<uint32_t>& its = survey.parts()[survey.partOf(object)].clusters;
    all.insert(all.end(), its.begin(), its.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (uint32_t c : all) place(c);
  if (thin)
    for (const PartInfo& part : survey.parts())
      if (part.lines || part.points)
        for (uint32_t c : part.clusters)
          if (input.flat.clusters[c].visible) placeThin(c);
  finish();
}

void AccelBuilder::layOut() {
  const auto& clusters = input_->flat.clusters;
  uint64_t records = 0, slots = 0, items = 0, frames = 0;
  accel_->placed_.resize(clusters.size());
  for (uint32_t c = 0; c < clusters.size(); c++) {
    const PartInfo& part = survey.parts()[clusters[c].part];
    Accel::PlacedCluster& placed = accel_->placed_[c];
    placed.firstRecord = uint32_t(records);
    placed.firstSlot = uint32_t(slots);
    placed.firstItem = uint32_t(items);
    placed.firstFrames = uint32_t(frames);
    records += part.entries();
    slots += Slots(part, clusters[c].part == 0).end;
    items += part.firstEntry.size();
    frames += part.framed;
  }
  if (records > 0xfffffff0u || slots > 0xfffffff0u) throw std::bad_alloc();
  accel_->records.resize(records);
  accel_->toObject_.resize(items); // no more than records, as the frames
  accel_->frames_.resize(frames);
  accel_->top_.parts.resize(slots);
  if (slots) accel_->top_.scene = newScene(*device_);
}

// Writes a cluster's records and instances for its current place, or hides it.
void AccelBuilder::place(uint32_t c) {
  if (!input_->flat.clusters[c].visible) {
    hide(c);
    return;
  }
  writeRecords(c);
  accel_->placed_[c].shown = true;
  if (input_->flat.clusters[c].part != 0) placeInstances(c);
  placeThin(c);
}

void AccelBuilder::hide(uint32_t c) {
  Accel::PlacedCluster& placed = accel_->placed_[c];
  if (!placed.shown) return;
  const PartInfo& part = survey.parts()[input_->flat.clusters[c].part];
  const Slots slots(part, input_->flat.clusters[c].part == 0);
  for (uint32_t s = 0; s < slots.lines; s++)
    if (accel_->top_.parts[placed.firstSlot + s].used())
      setEnabled(accel_->top_, placed.firstSlot + s, false);
  for (uint32_t s = slots.lines; s < slots.end; s++) detach(accel_->top_, placed.firstSlot + s);
  placed.shown = placed.instances = placed.transparent = false;
  placed.rejected = 0;
  changed_ = true;
}

void AccelBuilder::placeInstances(uint32_t c) {
  const Cluster& cluster = input_->flat.clusters[c];
  const ScenePart& part = input_->flat.parts[cluster.part];
  const PartInfo& info = survey.parts()[cluster.part];
  Accel::PlacedCluster& placed = accel_->placed_[c];
  const Slots slots(info, false);
  const Matrix4d partToRender = worldToRender_ * cluster.world;
  const uint32_t override = overrideMask(cluster.path.shader);
  uint32_t slot = placed.firstSlot;
  bool any = false;
  for (uint32_t group = 0; group < info.baked; group++) {
    const auto blas = partBlas(cluster.part, group, override);
    any |= placeInstance(slot++, blas, placed.firstRecord, partToRender * blas->fromKernel);
  }
  for (uint32_t i : info.sharedItems) {
    const Item& item = part.items[i];
    const auto blas = objectBlas(item.object, override ? override : overrideMask(item.path.shader));
    any |= placeInstance(slot++, blas, placed.firstRecord + info.firstEntry[i],
                         partToRender * item.matrix * blas->fromKernel);
  }
  for (const auto& [i, k] : info.ellipsoids) {
    const Item& item = part.items[i];
    const Geometry& g = input_->scene.objects.at(item.object).geometries[k];
    any |= placeInstance(slot++, consistent(g) ? spheres_.get(maskOf(item, g, override)) : nullptr,
                         placed.firstRecord + info.firstEntry[i] + k,
                         partToRender * item.matrix * g.matrix * uniformScale(g.width));
  }
  placed.instances = any;
}

// Returns whether the instance is visible.
bool AccelBuilder::placeInstance(uint32_t slot, std::shared_ptr<const Blas> blas, uint32_t record,
                                 const Matrix4d& toRender) {
  PartScene& top = accel_->top_;
  const Matrix4d toRoot = uniformScale(input_->scale) * toRender;
  changed_ = true;
  if (!blas || blas->parts.empty() || !isTraceable(toRoot, input_->reach)) {
    if (top.parts[slot].used()) setEnabled(top, slot, false);
    return false;
  }
  if (top.parts[slot].object == blas) {
    setTransform(top, slot, toRoot);
    setEnabled(top, slot, true);
    return true;
  }
  attachInstance(top, *device_, std::move(blas), record, toRoot, slot);
  return true;
}

void AccelBuilder::placeThin(uint32_t c) {
  const Cluster& cluster = input_->flat.clusters[c];
  const PartInfo& info = survey.parts()[cluster.part];
  if (!info.lines && !info.points) return;
  const ScenePart& part = input_->flat.parts[cluster.part];
  const Accel::PlacedCluster& placed = accel_->placed_[c];
  const Slots slots(info, cluster.part == 0);
  const Matrix4d toKernel = uniformScale(input_->scale) * worldToRender_ * cluster.world;
  auto lines = std::make_unique<Part>(), points = std::make_unique<Part>();
  for (uint32_t i = 0; i < part.items.size(); i++) {
    const auto& geometries = input_->scene.objects.at(part.items[i].object).geometries;
    for (uint32_t k = 0; k < geometries.size(); k++) {
      if (info.drawn[info.firstEntry[i] + k] != DrawnAs::thin) continue;
      const Geometry& g = geometries[k];
      const uint32_t record = placed.firstRecord + info.firstEntry[i] + k;
      const ThinGeometry thin{g, toKernel * part.items[i].matrix * g.matrix, record,
                              accel_->records[record].cull};
      addThin(g.primitive == edit::Primitive::Lines ? *lines : *points, thin, input_->footprint,
              accel_->scale_);
      if (!isStippled(g)) continue;
      lines->stippled.push_back(stippledLines(thin, input_->footprint, accel_->scale_));
      accel_->records[record].stippled = lines->stippled.back().data();
    }
  }
  const auto put = [&](std::unique_ptr<Part> made, uint32_t slot, RTCGeometryType type) {
    if (made->vertices.empty())
      detach(accel_->top_, slot);
    else
      attachRound(accel_->top_, *device_, std::move(made), maskThin, type, slot);
  };
  if (info.lines)
    put(std::move(lines), placed.firstSlot + slots.lines, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  if (info.points)
    put(std::move(points), placed.firstSlot + slots.points, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  changed_ = true;
}

// Rebuilds the top level if it changed, and updates the masks of its contents.
void AccelBuilder::finish() {
  Accel& a = *accel_;
  a.hasTransparent = a.culls = false;
  uint32_t masks = 0;
  bool instances = false;
  for (uint32_t c = 0; c < a.placed_.size(); c++) {
    const Accel::PlacedCluster& placed = a.placed_[c];
    if (!placed.shown) continue;
    const PartInfo& part = survey.parts()[input_->flat.clusters[c].part];
    a.hasTransparent |= placed.transparent;
    a.culls |= placed.culls;
    if (placed.instances) {
      instances = true;
      masks |= maskOpaque | maskTransparent;
    }
    if (part.lines || part.points) masks |= maskThin;
  }
  int8_t enlargement = 0;
  for (const PartSlot& slot : a.top_.parts)
    if (slot.object && slot.enabled) enlargement = std::max(enlargement, slot.enlargement);
  a.topLevel_ = {&a.top_, masks, instances, largestCoordinate(enlargement)};
  if (changed_ && a.top_.scene) {
    device_->commit(a.top_.scene);
    topLevelBuilds++;
  }
  a.measure();
  changed_ = false;
  input_ = nullptr;
  accel_ = nullptr;
}

AccelBuilder::Counts AccelBuilder::count(const Accel& accel, const Flattened& flat) const {
  Counts counts;
  counts.uniqueTriangles = survey.uniqueTriangles();
  for (uint32_t c = 0; c < accel.placed_.size(); c++) {
    if (!accel.placed_[c].shown) continue;
    counts.triangles += survey.parts()[flat.clusters[c].part].triangles;
    counts.rejectedInstances += accel.placed_[c].rejected;
  }
  counts.degenerate = static_.blas ? static_.blas->degenerate : 0;
  for (const auto& [key, entry] : blases_)
    counts.degenerate += entry.blas ? entry.blas->degenerate : 0;
  return counts;
}

} // namespace openrt
