// accel_build.h: works out an Accel: which placements are baked and which are instances, records, buckets, Embree scenes.
#pragma once

#include <map>

#include "backend/local/accel.h"
#include "backend/local/bake.h"

namespace openrt {

class AccelBuilder {
 public:
  AccelBuilder(Accel& accel, const Scene& scene, const Flattened& flat, const ShaderTable& shaders, const Vec3d& origin,
               const PixelFootprint& footprint);
  void build();

 private:
  struct Use { // of an object by placements
    uint64_t placements = 0, triangles = 0;
    bool bakeOnly = false; // lines, points and ellipsoids cannot be instanced
    Box bounds;
  };
  void surveyObjects();
  void chooseScale();
  bool baked(uint32_t object) const;
  void bakePlacement(const Placement& placement);
  void instancePlacement(const Placement& placement);
  uint32_t objectScene(const Placement& placement, Matrix4d& fromKernel);
  uint32_t addRecord(const Placement& placement, const Geometry& geometry, const Matrix4d& toRender);
  uint32_t unitSphere(uint32_t mask);
  void addGeometry(PartScene& to, const Geometry& geometry, const Matrix4d& toKernel, uint32_t record, uint32_t mask);
  void addTriangles(PartScene& to, const Geometry& geometry, const Matrix4d& toKernel, uint32_t record, uint32_t mask);
  void merge(PartScene& to, const std::vector<float>& vertices, const uint32_t* index, const std::vector<uint32_t>* which,
             size_t count, uint32_t record, uint32_t mask, bool filtered);
  void addThin(const Geometry& geometry, const Matrix4d& toKernel, uint32_t record);
  void addSphere(PartScene& to, const Geometry& geometry, const Matrix4d& toKernel, uint32_t record, uint32_t mask);
  void finish(PartScene& to, bool last);
  uint32_t maskOf(uint32_t shaderSlot) const;
  uint32_t bucketOf(uint32_t shaderSlot, uint32_t lightSet);
  float pixelRadius(const float* p, float pixels) const;

  Accel& accel_;
  const Scene& scene_;
  const Flattened& flat_;
  const ShaderTable& shaders_;
  Matrix4d worldToRender_;
  Vec3d origin_;
  PixelFootprint footprint_;
  std::map<uint32_t, Use> uses_;
  std::map<std::pair<const RtsClass*, uint32_t>, uint32_t> buckets_;
  std::map<std::pair<uint32_t, int>, std::pair<uint32_t, Matrix4d>>
      objectScenes_;                                      // (object, mask of an override); (0, mask): unit sphere
  std::vector<std::vector<const float*>> objectVertices_; // by object scene and geometry
  // Of the scene being filled:
  std::map<std::pair<uint32_t, bool>, std::unique_ptr<Part>> merged_; // triangles of small geometries, by (mask, filtered)
  std::map<uint32_t, std::unique_ptr<Part>> spheres_;                 // by mask
  std::unique_ptr<Part> curves_;
  struct VertexOf { // where a record's vertices lie
    uint32_t record;
    Part* part;
    size_t offset;
  };
  std::vector<VertexOf> vertexOf_;
};

} // namespace openrt
