// accel_build.h: builds and updates the Accel of a scene. Embree scenes (Blas) are cached with a
// hash of all their input; after an edit those with an unchanged hash are reused. Moved clusters
// and redefined dynamic objects change the Accel in place; every other edit makes a new Accel from
// cached scenes. The result is always the same as that of a first build. Called on the application
// thread, between frames; build() also on another thread beside frames, while nothing else is
// called.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"
#include "backend/local/thin.h"

namespace openrt {

struct BuildInput {
  const Scene& scene;
  Flattened& flat; // light sets may be added
  const ShaderTable& shaders;
  Vec3d origin; // origin of render space, in the world
  double scale = 1;
  double reach = 0; // the size of the scene (Survey), in the units of the kernels
  PixelFootprint footprint;
  bool besideFrames = false; // frames trace the structures of before meanwhile
};

class AccelBuilder {
 public:
  explicit AccelBuilder(std::shared_ptr<EmbreeDevice> device)
      : device_(std::move(device)), spheres_(*device_) {}

  Survey survey; // the scene at the last build or update

  std::shared_ptr<Accel> build(const BuildInput& input);
  // Changes an Accel in place.
  //   clusters  those that moved, ascending
  //   objects   those that were redefined; the survey already knows them
  //   thin      the pixel footprint changed, so all lines and points are rebuilt
  void update(Accel& accel, const BuildInput& input, const std::vector<uint32_t>& clusters,
              const std::vector<uint32_t>& objects, bool thin);
  // Returns about how many triangles update() would build into new Embree scenes.
  uint64_t trianglesToBuild(const BuildInput& input, const std::vector<uint32_t>& clusters,
                            const std::vector<uint32_t>& objects) const;
  // Returns whether an Accel has the origin, scale and reach of an input.
  static bool hasFrame(const Accel& accel, const BuildInput& input);

  struct Counts { // counts the visible parts of an Accel
    uint64_t triangles = 0, uniqueTriangles = 0, degenerate = 0, rejectedInstances = 0;
  };
  Counts count(const Accel& accel, const Flattened& flat) const;
  uint64_t objectBuilds = 0, topLevelBuilds = 0; // since the builder was created

 private:
  struct Signature {
    uint64_t low = 0, high = 0;
    bool operator==(const Signature&) const = default;
  };
  struct Cached {
    Signature signature;
    std::shared_ptr<Blas> blas;
    uint64_t checked = 0; // number of the build or update that last used it
  };
  struct Key {
    uint32_t object = 0;
    bool part = false;  // true: the part rooted at the object; false: the object alone
    uint32_t mask = 0;  // the mask of a shader override, 0: none
    uint32_t group = 0; // number in PartInfo::groups, for a part
    auto operator<=>(const Key&) const = default;
  };

  // Embree scenes of parts and objects (accel_blas.cpp).
  bool hasBlas(uint32_t part, const BuildInput& input) const;
  uint32_t maskOf(uint32_t shader) const; // shader: id of a surface shader
  uint32_t overrideMask(uint32_t shader) const { return shader ? maskOf(shader) : 0; }
  uint32_t maskOf(const Item& item, const Geometry& geometry, uint32_t override) const;
  std::shared_ptr<const Blas> staticBlas();
  std::shared_ptr<const Blas> partBlas(uint32_t part, uint32_t group, uint32_t override);
  std::shared_ptr<const Blas> objectBlas(uint32_t object, uint32_t override);
  template <class Sign, class Make>
  std::shared_ptr<const Blas> cached(const Key& key, const Sign& signature, const Make& make);
  void evictUnused();

  // Clusters (accel_clusters.cpp).
  void begin(Accel& accel, const BuildInput& input);
  void layOut();
  void place(uint32_t cluster);
  void placeInstances(uint32_t cluster);
  bool placeInstance(uint32_t slot, std::shared_ptr<const Blas> blas, uint32_t record,
                     const Matrix4d& toRender);
  void placeThin(uint32_t cluster);
  void hide(uint32_t cluster);
  void finish();

  // Records (accel_records.cpp).
  std::vector<std::shared_ptr<const Blas>> bakedBlases(const Cluster& cluster);
  void writeRecords(uint32_t cluster);
  void writeItem(uint32_t cluster, uint32_t item,
                 const std::vector<std::shared_ptr<const Blas>>& baked, RecordFrames*& free);
  bool carriesParameters(const Geometry& g, uint32_t slot) const;
  Record recordOf(const Inherited& path, const Geometry& geometry, const Matrix4d& toRender);
  uint32_t bucketOf(uint32_t shaderSlot, const Inherited& path);

  std::shared_ptr<EmbreeDevice> device_;
  UnitSpheres spheres_;
  std::map<Key, Cached> blases_;
  Cached static_;
  std::map<std::tuple<const RtsClass*, uint32_t, uint32_t>, uint32_t> buckets_;
  // State of the current build or update.
  const BuildInput* input_ = nullptr;
  Accel* accel_ = nullptr;
  Matrix4d worldToRender_;
  bool changed_ = false;     // the top level changed
  uint64_t buildNumber_ = 0; // counts builds and updates
};

} // namespace openrt
