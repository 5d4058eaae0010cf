// accel_build.h: keeps an Accel in step with the scene. What Embree scenes hold is cached under a
// signature of everything that goes into them: after any edit those whose signature is unchanged
// are used again. Moves of clusters and redefinitions of dynamic objects change the Accel in place;
// everything else makes a new one out of cached bodies. Either way the result is what a first build
// of the same scene gives. Application thread, between frames.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"
#include "backend/local/thin.h"

namespace openrt {

struct BuildInput {
  const Scene& scene;
  Flattened& flat; // light sets may be added
  const ShaderTable& shaders;
  Vec3d origin; // of render space, in the world
  double scale = 1;
  PixelFootprint footprint;
};

class AccelBuilder {
 public:
  explicit AccelBuilder(std::shared_ptr<EmbreeDevice> device)
      : device_(std::move(device)), spheres_(*device_) {}

  Survey survey; // of the scene as of the last build or update

  std::shared_ptr<Accel> build(const BuildInput& input);
  // clusters: those that were placed anew, ascending; objects: redefined ones, which the survey has
  // taken. thin: the camera's pixels changed.
  void update(Accel& accel, const BuildInput& input, const std::vector<uint32_t>& clusters,
              const std::vector<uint32_t>& objects, bool thin);
  // Whether an Accel stands at this origin and scale.
  static bool standsAt(const Accel& accel, const Vec3d& origin, double scale);

  struct Counts { // of what an Accel shows
    uint64_t triangles = 0, uniqueTriangles = 0, degenerate = 0, rejectedInstances = 0;
  };
  Counts count(const Accel& accel, const Flattened& flat) const;
  uint64_t objectBuilds = 0, topLevelBuilds = 0; // since it was made

 private:
  struct Signature {
    uint64_t low = 0, high = 0;
    bool operator==(const Signature&) const = default;
  };
  struct Cached {
    Signature signature;
    std::shared_ptr<const Body> body;
    uint64_t checked = 0; // the build or update that last asked for it
  };
  struct Key { // of a body: its object, whether it is the part rooted there or the object alone,
               // and the mask of an override
    uint32_t object = 0;
    bool part = false;
    uint32_t mask = 0;
    auto operator<=>(const Key&) const = default;
  };

  // Bodies. (accel_bodies.cpp)
  uint32_t maskOf(uint32_t shader) const; // of a surface shader's id
  uint32_t overrideMask(uint32_t shader) const { return shader ? maskOf(shader) : 0; }
  uint32_t maskOf(const Item& item, const Geometry& geometry, uint32_t override) const;
  std::shared_ptr<const Body> staticBody();
  std::shared_ptr<const Body> partBody(uint32_t part, uint32_t override);
  std::shared_ptr<const Body> objectBody(uint32_t object, uint32_t override);
  template <class Sign, class Make>
  std::shared_ptr<const Body> cached(const Key& key, const Sign& signature, const Make& make);
  void sweep();

  // Clusters. (accel_clusters.cpp)
  void begin(Accel& accel, const BuildInput& input);
  void layOut();
  void place(uint32_t cluster);
  void placeInstances(uint32_t cluster);
  bool placeInstance(uint32_t slot, std::shared_ptr<const Body> body, uint32_t record,
                     const Matrix4d& toRender);
  void placeThin(uint32_t cluster);
  void hide(uint32_t cluster);
  void finish();

  // Records. (accel_records.cpp)
  void writeRecords(uint32_t cluster);
  bool carriesParameters(const Geometry& g, uint32_t slot) const;
  Record recordOf(const Inherited& path, const Geometry& geometry, const Matrix4d& toRender);
  uint32_t bucketOf(uint32_t shaderSlot, uint32_t lightSet);

  std::shared_ptr<EmbreeDevice> device_;
  UnitSpheres spheres_;
  std::map<Key, Cached> bodies_;
  Cached static_;
  std::map<std::pair<const RtsClass*, uint32_t>, uint32_t> buckets_;
  // Of the build or update at hand:
  const BuildInput* in_ = nullptr;
  Accel* accel_ = nullptr;
  Matrix4d worldToRender_;
  bool changed_ = false; // something of the top level
  uint64_t number_ = 0;
};

} // namespace openrt
