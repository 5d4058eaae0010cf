// accel_blas.cpp: the Embree scenes (Blas) of parts and objects, built once for each signature.
// Small objects, and objects that occur once, are baked into the scene of their part. Large objects
// with several copies have a scene of their own, which the copies instance.
#include <algorithm>

#include <xxhash.h>

#include "backend/local/accel/accel_build.h"

namespace openrt {
namespace {

// XXH3 hash over all input of an Embree scene.
class Hash {
 public:
  Hash() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_);
  }
  ~Hash() { XXH3_freeState(state_); }
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;
  template <class T> Hash& operator<<(const T& value) {
    XXH3_128bits_update(state_, &value, sizeof value);
    return *this;
  }
  Hash& operator<<(const Matrix4d& m) { return *this << m.m; }
  Hash& operator<<(const Vec3d& v) { return *this << v.x << v.y << v.z; }
  template <class Signature> Signature digest() const {
    const XXH128_hash_t digest = XXH3_128bits_digest(state_);
    return {digest.low64, digest.high64};
  }

 private:
  XXH3_state_t* state_;
};

} // namespace

uint32_t AccelBuilder::maskOf(uint32_t shader) const {
  return input_->shaders[input_->shaders.slotOf(shader)].traits & RTS_TRANSPARENT ? maskTransparent
                                                                                  : maskOpaque;
}

uint32_t AccelBuilder::maskOf(const Item& item, const Geometry& g, uint32_t override) const {
  return override ? override : maskOf(item.path.shader ? item.path.shader : g.shader);
}

// Returns the cached Blas of a key, or makes it if its signature changed; `make` gets the former
// one, or null. The signature is computed once per build or update.
template <class Sign, class Make> std::shared_ptr<const Blas>
AccelBuilder::cached(const Key& key, const Sign& sign, const Make& make) {
  Cached& entry = blases_[key];
  if (entry.checked == buildNumber_ && entry.blas) return entry.blas;
  entry.checked = buildNumber_;
  if (const Signature signature = sign(); !entry.blas || entry.signature != signature) {
    entry.blas = make(entry.blas.get());
    entry.signature = signature;
    objectBuilds += !entry.blas->refitted;
  }
  return entry.blas;
}

// Returns whether there is an Embree scene of a part, maybe an outdated one.
bool AccelBuilder::hasBlas(uint32_t part, const BuildInput& input) const {
  const uint32_t object = input.flat.parts[part].object;
  const auto found = blases_.lower_bound({object, true, 0, 0});
  return found != blases_.end() && found->first.object == object && found->first.part;
}

uint64_t AccelBuilder::trianglesToBuild(const BuildInput& input,
                                        const std::vector<uint32_t>& clusters,
                                        const std::vector<uint32_t>& objects) const {
  uint64_t triangles = 0;
  for (const uint32_t id : objects) {
    const Object& object = input.scene.objects.at(id);
    const bool keepsTree = isRefitted(object) && object.geometries[0].rest;
    if (!keepsTree) triangles += survey.parts()[survey.partOf(id)].triangles;
  }
  for (const uint32_t c : clusters) {
    const Cluster& cluster = input.flat.clusters[c];
    if (cluster.visible && !hasBlas(cluster.part, input))
      triangles += survey.parts()[cluster.part].triangles;
  }
  return triangles;
}

// Drops the scenes that this build did not use, except those of parts that still exist, because
// these parts may only be hidden.
void AccelBuilder::evictUnused() {
  std::erase_if(blases_, [&](const auto& entry) {
    const Key& key = entry.first;
    if (entry.second.checked == buildNumber_) return false;
    const uint32_t part = key.part ? survey.partOf(key.object) : ~0u;
    return part == ~0u || key.group >= survey.parts()[part].baked;
  });
}

std::shared_ptr<const Blas> AccelBuilder::objectBlas(uint32_t object, uint32_t override) {
  const Object& source = input_->scene.objects.at(object);
  const Item item;
  if (std::all_of(source.geometries.begin(), source.geometries.end(),
                  [&](const Geometry& g) { return maskOf(item, g, 0) == override; }))
    override = 0; // the override changes no mask
  const auto sign = [&] {
    Hash hash;
    hash << source.version;
    for (const Geometry& g : source.geometries) hash << maskOf(item, g, override);
    return hash.digest<Signature>();
  };
  return cached({object, false, override}, sign, [&](Blas*) {
    const Box& box = survey.object(object).bounds;
    const Matrix4d fromKernel = kernelFrame(box.low, box.high), toKernel = inverse(fromKernel);
    BlasBuilder builder(*device_, spheres_, source.geometries.size());
    for (uint32_t g = 0; g < source.geometries.size(); g++)
      builder.add(source.geometries[g], toKernel * source.geometries[g].matrix, g,
                  maskOf(item, source.geometries[g], override));
    const std::shared_ptr<Blas> blas = builder.finish();
    blas->fromKernel = fromKernel;
    return blas;
  });
}

// Returns the Embree scene of a group of the baked geometry of a part other than the static one.
std::shared_ptr<const Blas> AccelBuilder::partBlas(uint32_t part, uint32_t group,
                                                   uint32_t override) {
  const ScenePart& source = input_->flat.parts[part];
  const PartInfo& info = survey.parts()[part];
  const auto forEachBaked = [&](const auto& f) {
    for (uint32_t i = 0; i < source.items.size(); i++) {
      const Object& object = input_->scene.objects.at(source.items[i].object);
      for (uint32_t g = 0; g < object.geometries.size(); g++)
        if (const uint32_t entry = info.firstEntry[i] + g;
            info.drawn[entry] == DrawnAs::baked && info.groupOf(entry) == group)
          f(source.items[i], object, object.geometries[g], entry);
    }
  };
  if (override) {
    bool differs = false;
    forEachBaked([&](const Item& item, const Object&, const Geometry& g, uint32_t) {
      differs |= maskOf(item, g, 0) != override;
    });
    if (!differs) override = 0;
  }
  const auto sign = [&] {
    Hash hash;
    forEachBaked([&](const Item& item, const Object& object, const Geometry& g, uint32_t entry) {
      hash << object.version << entry << item.matrix << maskOf(item, g, override);
    });
    return hash.digest<Signature>();
  };
  return cached({source.object, true, override, group}, sign, [&](Blas* former) {
    const bool deforms =
        info.entries() == 1 && isRefitted(input_->scene.objects.at(source.items[0].object));
    Box box = deforms ? info.bounds : Box();
    std::optional<Vec3d> detail;
    forEachBaked([&](const Item& item, const Object&, const Geometry& g, uint32_t) {
      if (!deforms) box.add(boundsOf(g), item.matrix);
      if (!detail && hasDetailAtOrigin(g)) detail = (item.matrix * g.matrix).translation();
    });
    const Matrix4d fromKernel = kernelFrame(box.low, box.high, detail),
                   toKernel = inverse(fromKernel);
    BlasBuilder builder(*device_, spheres_, info.entries());
    forEachBaked([&](const Item& item, const Object&, const Geometry& g, uint32_t entry) {
      const Matrix4d matrix = toKernel * item.matrix * g.matrix;
      const uint32_t mask = maskOf(item, g, override);
      if (deforms) // frames may still trace the former tree
        builder.addDeforming(g, matrix, entry, mask, input_->besideFrames ? nullptr : former);
      else
        builder.add(g, matrix, entry, mask);
    });
    const std::shared_ptr<Blas> blas = builder.finish();
    blas->fromKernel = fromKernel;
    return blas;
  });
}

// Returns the Embree scene of everything static, relative to the render origin, with instances of
// objects that occur often. The number of an entry is also the number of its record.
std::shared_ptr<const Blas> AccelBuilder::staticBlas() {
  const ScenePart& source = input_->flat.parts[0];
  const PartInfo& info = survey.parts()[0];
  Hash hash;
  hash << input_->origin << input_->scale << input_->reach;
  std::vector<std::shared_ptr<const Blas>> shared;
  for (uint32_t i = 0; i < source.items.size(); i++) {
    const Item& item = source.items[i];
    const Object& object = input_->scene.objects.at(item.object);
    hash << object.version << item.matrix;
    for (uint32_t g = 0; g < object.geometries.size(); g++)
      hash << info.drawn[info.firstEntry[i] + g] << maskOf(item, object.geometries[g], 0);
  }
  for (uint32_t i : info.sharedItems)
    shared.push_back(objectBlas(source.items[i].object, overrideMask(source.items[i].path.shader)));
  const auto signature = hash.digest<Signature>();
  if (static_.blas && static_.signature == signature) return static_.blas;
  static_.blas.reset(); // frees its memory before the next one is built
  const Matrix4d toKernel = uniformScale(input_->scale) * worldToRender_;
  BlasBuilder builder(*device_, spheres_, info.entries(), input_->reach);
  for (uint32_t i = 0; i < source.items.size(); i++) {
    const auto& geometries = input_->scene.objects.at(source.items[i].object).geometries;
    for (uint32_t g = 0; g < geometries.size(); g++)
      if (const uint32_t entry = info.firstEntry[i] + g; info.drawn[entry] == DrawnAs::baked)
        builder.add(geometries[g], toKernel * source.items[i].matrix * geometries[g].matrix, entry,
                    maskOf(source.items[i], geometries[g], 0));
  }
  for (size_t k = 0; k < shared.size(); k++) {
    const uint32_t i = info.sharedItems[k];
    builder.addInstance(shared[k], toKernel * source.items[i].matrix * shared[k]->fromKernel,
                        info.firstEntry[i]);
  }
  static_ = {signature, builder.finish(), buildNumber_};
  if (!source.items.empty()) objectBuilds++;
  return static_.blas;
}

} // namespace openrt
