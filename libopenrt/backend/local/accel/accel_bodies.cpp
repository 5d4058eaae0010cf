// accel_bodies.cpp: the Embree scenes of parts and objects, made once for each signature. Objects
// placed once, or small ones, are baked into the scene of their part; those with many copies have
// one of their own, which the copies are instances of.
#include <algorithm>

#include <xxhash.h>

#include "backend/local/accel/accel_build.h"

namespace openrt {
namespace {

// XXH3 over everything that goes into an Embree scene.
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
  return in_->shaders[in_->shaders.slotOf(shader)].traits & RTS_TRANSPARENT ? maskTransparent
                                                                            : maskOpaque;
}

uint32_t AccelBuilder::maskOf(const Item& item, const Geometry& g, uint32_t override) const {
  return override ? override : maskOf(item.path.shader ? item.path.shader : g.shader);
}

// The signature is worked out once a build or update.
template <class Sign, class Make> std::shared_ptr<const Body>
AccelBuilder::cached(const Key& key, const Sign& sign, const Make& make) {
  Cached& entry = bodies_[key];
  if (entry.checked == number_ && entry.body) return entry.body;
  entry.checked = number_;
  if (const Signature signature = sign(); !entry.body || entry.signature != signature) {
    entry.body = make();
    entry.signature = signature;
    objectBuilds++;
  }
  return entry.body;
}

// Bodies that the last build did not ask for and whose object is gone; those of parts out of sight
// stay.
void AccelBuilder::sweep() {
  std::erase_if(bodies_, [&](const auto& entry) {
    const Key& key = entry.first;
    const bool kept =
        entry.second.checked == number_ || (key.part && survey.partOf(key.object) != ~0u);
    return !kept;
  });
}

std::shared_ptr<const Body> AccelBuilder::objectBody(uint32_t object, uint32_t override) {
  const Object& source = in_->scene.objects.at(object);
  const Item item;
  if (std::all_of(source.geometries.begin(), source.geometries.end(),
                  [&](const Geometry& g) { return maskOf(item, g, 0) == override; }))
    override = 0; // it changes no mask
  const auto sign = [&] {
    Hash hash;
    hash << source.version;
    for (const Geometry& g : source.geometries) hash << maskOf(item, g, override);
    return hash.digest<Signature>();
  };
  return cached({object, false, override}, sign, [&] {
    const Box& box = survey.object(object).bounds;
    const Matrix4d fromKernel = kernelFrame(box.low, box.high), toKernel = inverse(fromKernel);
    BodyBuilder builder(*device_, spheres_, source.geometries.size());
    for (uint32_t g = 0; g < source.geometries.size(); g++)
      builder.add(source.geometries[g], toKernel * source.geometries[g].matrix, g,
                  maskOf(item, source.geometries[g], override));
    const std::shared_ptr<Body> body = builder.finish();
    body->fromKernel = fromKernel;
    return body;
  });
}

// What is baked of a part other than the static scene; null if nothing is.
std::shared_ptr<const Body> AccelBuilder::partBody(uint32_t part, uint32_t override) {
  const ScenePart& source = in_->flat.parts[part];
  const PartInfo& info = survey.parts()[part];
  if (!info.baked) return nullptr;
  const auto forEachBaked = [&](const auto& f) {
    for (uint32_t i = 0; i < source.items.size(); i++) {
      const Object& object = in_->scene.objects.at(source.items[i].object);
      for (uint32_t g = 0; g < object.geometries.size(); g++)
        if (const uint32_t entry = info.firstEntry[i] + g; info.drawn[entry] == DrawnAs::baked)
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
  return cached({source.object, true, override}, sign, [&] {
    Box box;
    forEachBaked([&](const Item& item, const Object& object, const Geometry& g, uint32_t) {
      box.add(survey.object(item.object).boxes[size_t(&g - object.geometries.data())], item.matrix);
    });
    const Matrix4d fromKernel = kernelFrame(box.low, box.high), toKernel = inverse(fromKernel);
    BodyBuilder builder(*device_, spheres_, info.entries());
    forEachBaked([&](const Item& item, const Object&, const Geometry& g, uint32_t entry) {
      builder.add(g, toKernel * item.matrix * g.matrix, entry, maskOf(item, g, override));
    });
    const std::shared_ptr<Body> body = builder.finish();
    body->fromKernel = fromKernel;
    return body;
  });
}

// Everything static, relative to the render origin, with instances of what is there many times. Its
// entries are records.
std::shared_ptr<const Body> AccelBuilder::staticBody() {
  const ScenePart& source = in_->flat.parts[0];
  const PartInfo& info = survey.parts()[0];
  Hash hash;
  hash << in_->origin << in_->scale;
  std::vector<std::shared_ptr<const Body>> heavy;
  for (uint32_t i = 0; i < source.items.size(); i++) {
    const Item& item = source.items[i];
    const Object& object = in_->scene.objects.at(item.object);
    hash << object.version << item.matrix;
    for (uint32_t g = 0; g < object.geometries.size(); g++)
      hash << info.drawn[info.firstEntry[i] + g] << maskOf(item, object.geometries[g], 0);
  }
  for (uint32_t i : info.heavyItems)
    heavy.push_back(objectBody(source.items[i].object, overrideMask(source.items[i].path.shader)));
  const auto signature = hash.digest<Signature>();
  if (static_.body && static_.signature == signature) return static_.body;
  static_.body.reset(); // before the next one takes its room
  const Matrix4d toKernel = uniformScale(in_->scale) * worldToRender_;
  BodyBuilder builder(*device_, spheres_, info.entries());
  for (uint32_t i = 0; i < source.items.size(); i++) {
    const auto& geometries = in_->scene.objects.at(source.items[i].object).geometries;
    for (uint32_t g = 0; g < geometries.size(); g++)
      if (const uint32_t entry = info.firstEntry[i] + g; info.drawn[entry] == DrawnAs::baked)
        builder.add(geometries[g], toKernel * source.items[i].matrix * geometries[g].matrix, entry,
                    maskOf(source.items[i], geometries[g], 0));
  }
  for (size_t k = 0; k < heavy.size(); k++) {
    const uint32_t i = info.heavyItems[k];
    builder.addInstance(heavy[k], toKernel * source.items[i].matrix * heavy[k]->fromKernel,
                        info.firstEntry[i]);
  }
  static_ = {signature, builder.finish(), number_};
  if (!source.items.empty()) objectBuilds++;
  return static_.body;
}

} // namespace openrt
