// meshes.h: the meshes of a world: one per geometry node, however many shapes use it. Meshes of
// equal content form groups. Meshes are built on first use, or before by jobs that others asked
// for. [the mapper's thread; jobs have copies of their nodes]
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/index_table.h"
#include "geometry/copied.h" // for the templates of the jobs
#include "geometry/geometry_jobs.h"
#include "geometry/half_space.h"
#include "geometry/matrix.h"
#include "geometry/mesh.h"
#include "geometry/texture_generator.h"
#include "geometry/texture_places.h"
#include "mapper/outermost.h"
#include "mapper/ration.h"
#include "xvrml/mapper.h"
#include "xvrml/node_map.h"

namespace xvrml::mapper {

class Meshes {
 public:
  explicit Meshes(World& world) : world_(world), quota_(world, "meshes") {}
  // Sets whether cylinders and cones are drawn without facets. Meshes are then built again.
  void setExactShapes(bool exact);
  // Sets the diameters of points and lines; 0: they are thin. Meshes are then built again.
  void setThickness(float points, float lines);
  // Returns the mesh number of a geometry node and adds a user with these textures.
  int32_t add(Node& geometry, TextureNeed need);
  void drop(int32_t mesh); // removes one user
  // Numbers without users. They are not reused before recycle().
  const std::vector<int32_t>& dropped() const { return dropped_; }
  void recycle();
  int32_t find(const Node* geometry) const;
  // Returns whether a geometry without a mesh is to be added later, because a job builds its mesh;
  // begins the job if it takes long.
  bool awaits(Node& geometry, TextureNeed need);
  // Gives up the job of a geometry that has changed.
  void spoil(const Node& geometry) { jobs_.giveUp(geometry); }
  uint64_t readBeside() const { return readBeside_; } // meshes that jobs have built
  size_t size() const { return entries_.size(); }
  // Requires texture coordinates for these textures from now on. Returns true if an already built
  // mesh has to be rebuilt.
  bool require(int32_t mesh, TextureNeed need);
  // Returns whether a PhysicalMaterial or UnlitMaterial shows a volume on the mesh. Its texture
  // coordinates in space are then for shaders of their class alone.
  bool takesPhysicalPlaces(int32_t mesh) const {
    return entries_[size_t(mesh)].need == TextureNeed::physicalVolume;
  }
  // Returns whether shapes need another surface, because since the mesh was built events have put a
  // ColorRGBA in place of a Color, or a Color in place of a ColorRGBA, or have changed how cube
  // maps are looked up, or whether texture coordinates are in space.
  bool switchedSurface(int32_t mesh) const {
    const Entry& entry = entries_[size_t(mesh)];
    return entry.known && (entry.extent.alpha != hasVertexAlpha(*entry.geometry) ||
                           entry.extent.byNormal != looksUpByNormal(*entry.geometry) ||
                           entry.extent.placed != hasTexPlaces(*entry.geometry));
  }
  // Invalidates the mesh because fields of the node have changed, or only the vectors of its
  // Coordinate or Normal.
  void changed(int32_t mesh, bool vectorsOnly = false);
  // Sets whether events reach the geometry. A dynamic mesh is never grouped with equal ones.
  void setDynamic(int32_t mesh, bool dynamic);
  bool dynamic(int32_t mesh) const { return entries_[size_t(mesh)].dynamic; }

  const Mesh& get(int32_t mesh);
  Node& geometry(int32_t mesh) const { return *entries_[size_t(mesh)].geometry; }
  // Size of a mesh. It stays known after the arrays are released.
  struct Extent {
    Mesh::Kind kind = Mesh::Kind::empty;
    uint64_t primitives = 0;
    double reach = 0;      // largest absolute coordinate
    bool alpha = false;    // it has opacities
    bool byNormal = false; // looksUpByNormal
    bool placed = false;   // hasTexPlaces
    bool thick = false;    // balls or rods in place of points or lines
  };
  Extent extent(int32_t mesh);
  // Returns the mesh whose object also draws this one: a mesh with equal content, perhaps itself.
  int32_t equal(int32_t mesh) const;
  // Returns the number of shapes that use this mesh or one of equal content.
  uint32_t users(int32_t mesh) const;
  // Grows bounds by the mesh, transformed by `matrix`. kept: what ClipPlanes leave of it.
  void grow(Bounds& bounds, int32_t mesh, const Matrix& matrix, const HalfSpaces& kept);
  // Returns the largest distance of the transformed mesh from a point. For a sphere scaled
  // non-uniformly, or sheared, this is an upper bound.
  double reach(int32_t mesh, const Matrix& matrix, const Vector& from, const HalfSpaces& kept);
  // Adds the points of the transformed mesh.
  void add(Outermost& outermost, int32_t mesh, const Matrix& matrix, const HalfSpaces& kept);
  // Frees the arrays; get() builds them again. Gives up jobs that nobody waits for.
  void release();

 private:
  void rebuildAll();
  MeshOptions optionsFor(TextureNeed need) const; // without limits and diagnostics
  static constexpr int32_t none_ = -1;
  struct Entry {
    NodeRef geometry;
    std::unique_ptr<Mesh> mesh; // null: not built, or released
    // The triangles of a released mesh that events change; null: they are read again.
    std::unique_ptr<MeshTopology> topology;
    Extent extent;
    uint64_t triangles = 0; // limit, set from the budget left when the mesh was first built
    uint32_t users = 0;
    // The group of equal content, and the neighbours in its list.
    int32_t group = none_, next = none_, previous = none_;
    TextureNeed need = TextureNeed::none;
    bool known = false, dynamic = false, said = false;
  };
  struct Built {
    std::unique_ptr<Mesh> mesh;
    uint64_t bytes;                   // that the mesh takes beside the arrays of its node
    uint64_t most;                    // triangles that its builder may have counted
    std::vector<Diagnostic> problems; // found by a job
    TextureNeed need;
  };
  uint64_t affordable() const;
  std::optional<Built> takeBuilt(const Entry& entry); // the mesh that a job has built
  Built build(Entry& entry);
  struct Group { // meshes with equal content
    uint64_t hash = 0;
    uint32_t users = 0;
    int32_t first = none_; // the member that stands for all
    int32_t next = none_;  // next free group
  };
  bool sameContent(int32_t a, int32_t b);
  void join(int32_t mesh); // joins the group of equal content
  void leave(int32_t mesh);
  const std::vector<Vec3f>& corners(int32_t mesh);
  // Visits the points that bound what is left of a mesh.
  template <class Visit> void eachCorner(int32_t mesh, const HalfSpaces& kept, const Visit& visit);
  void forgetCorners() {
    cornersOf_ = none_;
    std::vector<Vec3f>().swap(corners_);
  }
  int32_t newGroup(uint64_t hash);
  void count(int32_t mesh, int32_t users);

  World& world_;
  bool exactShapes_ = false;
  float pointSize_ = 0, lineWidth_ = 0;
  Quota quota_; // quota for the meshes that are built now
  std::vector<Entry> entries_;
  std::vector<int32_t> free_, dropped_, built_;
  NodeMap<int32_t> index_;
  GeometryJobs<Built> jobs_;
  uint64_t readBeside_ = 0;
  std::vector<Group> groups_;
  int32_t freeGroup_ = none_;
  IndexTable byContent_;      // groups by their hash
  int32_t cornersOf_ = none_; // the mesh that corners_ belongs to
  std::vector<Vec3f> corners_;
};

// Returns the number of triangles, line segments, points, spheres or exact surfaces of a mesh.
uint64_t primitivesOf(const Mesh& mesh);

// Copies a mesh with only the vertices that its indices use, in their order.
void compact(const Mesh& mesh, Mesh& out);

void growByPoint(Bounds& bounds, const Vector& point);
void growByBox(Bounds& bounds, const Bounds& box, const Matrix& matrix);

} // namespace xvrml::mapper
