// accel_records.cpp: writes the records of clusters: the data that shading needs for each placed
// geometry.
#include <algorithm>

#include "backend/local/accel/accel_build.h"
#include "render/huge_spheres.h"
#include "shading/parameters.h"

namespace openrt {
namespace {

// Computes the inverse transpose, scaled by a positive factor so that its largest element is 1. It
// is used for directions, whose length does not matter.
Rows<float> normalMatrixOf(const Matrix4d& m) {
  const Vec3d a = m.column(0), b = m.column(1), c = m.column(2);
  const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b); // columns of the cofactors
  const double size = largest(max(max(abs(bc), abs(ca)), abs(ab)));
  const double s = (m.determinant() < 0 ? -1 : 1) / (size > 0 ? size : 1);
  return Rows<float>::ofColumns(Vec3f(bc * s), Vec3f(ca * s), Vec3f(ab * s));
}

void setInstance(Record& r, RecordFrames& frames, const Matrix4d& kernelToRender) {
  r.instanced = true;
  frames.toRender = Affine::from(kernelToRender);
  frames.kernelNormal = normalMatrixOf(kernelToRender);
}

// The gradient of an analytic surface points to its front in every frame.
bool flipped(const Geometry& g, const Matrix4d& asTheKernelSeesIt) {
  if (g.surface) return g.clockwise;
  return g.primitive == edit::Primitive::Triangles &&
         g.clockwise != (asTheKernelSeesIt.determinant() < 0);
}

} // namespace

uint32_t AccelBuilder::bucketOf(uint32_t slot, const Inherited& path) {
  const RtsClass* shaderClass = input_->shaders[slot].shaderClass;
  const auto [found, fresh] = buckets_.try_emplace({shaderClass, path.lightSet, path.fog},
                                                   uint32_t(accel_->buckets.size()));
  if (fresh) accel_->buckets.push_back({shaderClass, path.lightSet, path.fog});
  return found->second;
}

// Returns whether the parameter values of a geometry are valid for the shader it is drawn with: the
// classes must be the same, and the arrays long enough.
bool AccelBuilder::carriesParameters(const Geometry& g, uint32_t slot) const {
  if (g.parameters.empty()) return false;
  const uint32_t own = input_->shaders.slotOf(g.shader);
  if (own == 0 || input_->shaders[own].shaderClass != input_->shaders[slot].shaderClass)
    return false;
  const RtsClass& table = *input_->shaders[own].shaderClass;
  return std::all_of(g.parameters.begin(), g.parameters.end(), [&](const GeometryParameter& p) {
    const size_t count =
        p.perVertex ? (g.points ? g.points->count<float>() / 3 : 0) : g.primitives();
    const size_t floats =
        p.index < table.paramCount ? parameterFloats(table.params[p.index].type) : 0;
    return floats > 0 && p.values && p.values->count<float>() >= count * floats;
  });
}

// toRender: from the geometry's local frame to render space.
Record AccelBuilder::recordOf(const Inherited& path, const Geometry& g, const Matrix4d& toRender) {
  Record r;
  r.primitive = g.primitive;
  r.primitives = uint32_t(g.primitives());
  r.shader = input_->shaders.slotOf(path.shader ? path.shader : g.shader);
  const ShaderSlot& shader = input_->shaders[r.shader];
  // The back faces of a body with a medium are needed, even if the geometry asks for culling. A
  // line or point that rays pass is met once, where a ray enters it.
  r.cull = isThin(g.primitive) ? (shader.traits & RTS_TRANSPARENT) || isStippled(g)
                               : g.cull && !shader.shaderClass->medium;
  r.pattern = g.stipple.pattern;
  r.bucket = bucketOf(r.shader, path);
  r.name = g.name ? g.name : path.name;
  r.instance = path.instance;
  r.userData = path.userData;
  r.indices = g.indices ? g.indices->as<uint32_t>() : nullptr;
  r.normals = g.normals ? g.normals->as<float>() : nullptr;
  r.texCoords = g.texCoords ? g.texCoords->as<float>() : nullptr;
  r.colors = g.colors ? g.colors->as<float>() : nullptr;
  r.fogCoords = g.fogCoords ? g.fogCoords->as<float>() : nullptr;
  r.texGen = g.texGen;
  if (carriesParameters(g, r.shader)) {
    r.parameters = g.parameters.data();
    r.parameterCount = uint32_t(g.parameters.size());
  }
  r.scale = 1 / accel_->scale_;
  r.normalMatrix = normalMatrixOf(toRender);
  return r;
}

// Returns the Embree scenes of the baked geometry of a cluster, by group.
std::vector<std::shared_ptr<const Blas>> AccelBuilder::bakedBlases(const Cluster& cluster) {
  if (cluster.part == 0) return {accel_->static_};
  std::vector<std::shared_ptr<const Blas>> blases;
  for (uint32_t group = 0; group < survey.parts()[cluster.part].baked; group++)
    blases.push_back(partBlas(cluster.part, group, overrideMask(cluster.path.shader)));
  return blases;
}

void AccelBuilder::writeRecords(uint32_t c) {
  const Cluster& cluster = input_->flat.clusters[c];
  Accel::PlacedCluster& placed = accel_->placed_[c];
  const auto baked = bakedBlases(cluster);
  RecordFrames* free = accel_->frames_.data() + placed.firstFrames;
  placed.transparent = placed.culls = false;
  placed.rejected = 0;
  for (uint32_t i = 0; i < input_->flat.parts[cluster.part].items.size(); i++)
    writeItem(c, i, baked, free);
}

// Writes the records of an item of a cluster. free: the first frames that no record has yet.
void AccelBuilder::writeItem(uint32_t c, uint32_t i,
                             const std::vector<std::shared_ptr<const Blas>>& baked,
                             RecordFrames*& free) {
  const Cluster& cluster = input_->flat.clusters[c];
  const PartInfo& info = survey.parts()[cluster.part];
  Accel::PlacedCluster& placed = accel_->placed_[c];
  const bool root = cluster.part == 0;
  const Matrix4d partToRender = worldToRender_ * cluster.world;
  const Item& item = input_->flat.parts[cluster.part].items[i];
  const auto& geometries = input_->scene.objects.at(item.object).geometries;
  const Inherited path = input_->flat.inherit(cluster.path, item.path);
  const Matrix4d itemToRender = partToRender * item.matrix;
  Affine& toObject = accel_->toObject_[placed.firstItem + i];
  toObject = Affine::from(inverse(itemToRender));
  bool rejected = !itemToRender.usable();
  std::shared_ptr<const Blas> shared;
  if (info.drawn[info.firstEntry[i]] == DrawnAs::shared)
    shared = objectBlas(item.object, overrideMask(path.shader));
  for (uint32_t k = 0; k < geometries.size(); k++) {
    const Geometry& g = geometries[k];
    const uint32_t entry = info.firstEntry[i] + k;
    const Matrix4d toRender = itemToRender * g.matrix;
    const bool sphere = g.primitive == edit::Primitive::Sphere;
    const Matrix4d unit = sphere ? toRender * uniformScale(g.width) : toRender;
    Record r = recordOf(path, g, toRender);
    r.toObject = &toObject;
    RecordFrames* const frames = hasFrames(g, info.drawn[entry], root) ? free++ : nullptr;
    if (frames) r.frames = frames;
    const auto setPlace = [&](const Matrix4d& kernelToRender) {
      setInstance(r, *frames, kernelToRender);
      rejected |= !isTraceable(uniformScale(input_->scale) * kernelToRender, input_->reach);
    };
    switch (info.drawn[entry]) {
    case DrawnAs::baked: {
      const Blas& blas = *baked[info.groupOf(entry)];
      if (!root)
        setPlace(partToRender * blas.fromKernel);
      else if (sphere && !similarity(uniformScale(input_->scale) * toRender) &&
               !isHugeSphere(uniformScale(input_->scale) * unit))
        setPlace(unit); // baked as an instance of the unit sphere
      r.flip = flipped(g, root ? toRender : item.matrix * g.matrix);
      r.vertices = blas.vertices[entry];
      break;
    }
    case DrawnAs::shared:
      setPlace(itemToRender * shared->fromKernel);
      r.flip = flipped(g, g.matrix);
      r.vertices = shared->vertices[k];
      break;
    case DrawnAs::ellipsoid: setPlace(unit); break;
    case DrawnAs::thin: break;
    }
    r.surface = g.surface.get();
    if (sphere || g.surface) {
      frames->toRender = Affine::from(unit);
      frames->fromRender = Affine::from(inverse(unit));
    }
    placed.transparent |= (input_->shaders[r.shader].traits & RTS_TRANSPARENT) != 0;
    placed.culls |= r.cull;
    accel_->records[placed.firstRecord + entry] = r;
  }
  placed.rejected += rejected;
}

} // namespace openrt
