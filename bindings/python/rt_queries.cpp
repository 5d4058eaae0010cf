// rt_queries.cpp: Implements the ray and point queries of xvrml.rt over arrays: the input has shape
// (..., 6), the result is a dict of arrays of shape (...). The input is processed in chunks that
// fit into the caches. All threads pack, trace and unpack each chunk, without the GIL.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "numbers.h"
#include "objects.h"
#include "openrt/queries.h"
#include "rt_objects.h"

namespace {

constexpr size_t chunk = size_t(1) << 17, grain = 8192;
constexpr uint32_t invalid = 0xFFFFFFFF;
constexpr float infinity = std::numeric_limits<float>::infinity();
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Shape = std::vector<py::ssize_t>;

struct Rows { // rows of numbers, with any shape before the last dimension
  Floats values;
  Shape shape; // lengths of all dimensions except the last
  size_t count = 0;
  Rows(const py::object& given, const char* name, py::ssize_t width) {
    const std::string expected = fmt::format("numbers of shape (..., {})", width);
    values = Floats(numberArray(given, name, expected));
    if (values.ndim() < 1 || values.shape(values.ndim() - 1) != width)
      throw py::value_error(name + (": " + expected) + " expected, not of shape " +
                            fromText(py::str(values.attr("shape"))));
    shape.assign(values.shape(), values.shape() + values.ndim() - 1);
    count = size_t(values.size() / width);
  }
};

template <class T> py::array_t<T> like(const Shape& shape, py::ssize_t width = 0) {
  Shape sides = shape;
  if (width) sides.push_back(width);
  return py::array_t<T>(sides);
}

template <class F> void parallel(size_t count, const F& f) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, grain), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

void pack(const float* from, float near, float far, RTray& to) {
  std::memcpy(to.origin, from, sizeof to.origin);
  std::memcpy(to.direction, from + 3, sizeof to.direction);
  to.tnear = near;
  to.tfar = far;
}

// The arrays common to all lists of hits, and pointers into them.
struct Hits {
  py::array_t<float> t, uv, normal;
  py::array_t<uint32_t> geometry, primitive, instance, name;
  float *tTo, *uvTo, *normalTo;
  uint32_t *geometryTo, *primitiveTo, *instanceTo, *nameTo;
  explicit Hits(const Shape& shape)
      : t(like<float>(shape)), uv(like<float>(shape, 2)), normal(like<float>(shape, 3)),
        geometry(like<uint32_t>(shape)), primitive(like<uint32_t>(shape)),
        instance(like<uint32_t>(shape)), name(like<uint32_t>(shape)), tTo(t.mutable_data()),
        uvTo(uv.mutable_data()), normalTo(normal.mutable_data()),
        geometryTo(geometry.mutable_data()), primitiveTo(primitive.mutable_data()),
        instanceTo(instance.mutable_data()), nameTo(name.mutable_data()) {}

  void take(size_t i, const RThit& hit) const {
    const bool met = hit.t < infinity;
    tTo[i] = hit.t;
    geometryTo[i] = met ? uint32_t(hit.userData) : invalid;
    primitiveTo[i] = met ? hit.primitive : invalid;
    instanceTo[i] = met ? hit.instance : 0;
    nameTo[i] = met ? hit.name : 0;
    uvTo[2 * i] = hit.u;
    uvTo[2 * i + 1] = hit.v;
    std::memcpy(normalTo + 3 * i, hit.normal, sizeof hit.normal);
  }
  py::dict dict() const {
    py::dict out;
    out["t_hit"] = t;
    out["geometry_ids"] = geometry;
    out["primitive_ids"] = primitive;
    out["primitive_uvs"] = uv;
    out["primitive_normals"] = normal;
    out["instance_ids"] = instance;
    out["names"] = name;
    return out;
  }
};

// Calls f for chunks of rays and checks for Ctrl-C between them.
template <class F> void inChunks(const CurrentContext& use, size_t count, const F& f) {
  for (size_t first = 0; first < count; first += chunk) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    {
      const ReleaseGil release;
      f(first, std::min(chunk, count - first));
    }
    use.check();
  }
}

void checkEnds(float near, float far) {
  if (!(near >= 0 && far >= near))
    throw py::value_error("tnear, tfar: 0 <= tnear <= tfar expected");
}

py::dict castRays(const RtContextPtr& self, const py::object& given, float near, float far) {
  const Rows rays(given, "rays", 6);
  checkEnds(near, far);
  const Hits hits(rays.shape);
  const CurrentContext use(self, false);
  use.commit();
  std::vector<RTray> packed(std::min(chunk, rays.count));
  std::vector<RThit> found(packed.size());
  const float* from = rays.values.data();
  inChunks(use, rays.count, [&](size_t first, size_t n) {
    parallel(n, [&](size_t i) { pack(from + 6 * (first + i), near, far, packed[i]); });
    rtCastRays(n, packed.data(), found.data());
    parallel(n, [&](size_t i) { hits.take(first + i, found[i]); });
  });
  return hits.dict();
}

py::array testOcclusions(const RtContextPtr& self, const py::object& given, float near, float far) {
  const Rows rays(given, "rays", 6);
  checkEnds(near, far);
  py::array_t<bool> out = like<bool>(rays.shape);
  bool* to = out.mutable_data();
  const CurrentContext use(self, false);
  use.commit();
  std::vector<RTray> packed(std::min(chunk, rays.count));
  std::vector<uint8_t> found(packed.size());
  const float* from = rays.values.data();
  inChunks(use, rays.count, [&](size_t first, size_t n) {
    parallel(n, [&](size_t i) { pack(from + 6 * (first + i), near, far, packed[i]); });
    rtOccludedRays(n, packed.data(), found.data());
    for (size_t i = 0; i < n; ++i) to[first + i] = found[i] != 0;
  });
  return out;
}

std::vector<uint32_t> counted(const CurrentContext& use, const Rows& rays, float near, float far) {
  std::vector<uint32_t> counts(rays.count);
  std::vector<RTray> packed(std::min(chunk, rays.count));
  const float* from = rays.values.data();
  inChunks(use, rays.count, [&](size_t first, size_t n) {
    parallel(n, [&](size_t i) { pack(from + 6 * (first + i), near, far, packed[i]); });
    rtCountHits(n, packed.data(), counts.data() + first);
  });
  return counts;
}

py::array countIntersections(const RtContextPtr& self, const py::object& given, float near,
                             float far) {
  const Rows rays(given, "rays", 6);
  checkEnds(near, far);
  const CurrentContext use(self, false);
  use.commit();
  const std::vector<uint32_t> counts = counted(use, rays, near, far);
  py::array_t<int32_t> out = like<int32_t>(rays.shape);
  std::copy(counts.begin(), counts.end(), out.mutable_data());
  return out;
}

py::dict listIntersections(const RtContextPtr& self, const py::object& given, float near,
                           float far) {
  const Rows rays(given, "rays", 6);
  checkEnds(near, far);
  const CurrentContext use(self, false);
  use.commit();
  const std::vector<uint32_t> counts = counted(use, rays, near, far);
  std::vector<size_t> first(rays.count + 1);
  for (size_t i = 0; i < rays.count; ++i) first[i + 1] = first[i] + counts[i];
  const auto total = py::ssize_t(first.back());
  const Hits hits(Shape{total});
  py::array_t<int64_t> splits(py::ssize_t(rays.count) + 1), ids(total);
  std::copy(first.begin(), first.end(), splits.mutable_data());
  int64_t* idTo = ids.mutable_data();
  std::vector<RTray> packed(std::min(chunk, rays.count));
  std::vector<RThit> found;
  std::vector<size_t> places;
  const float* from = rays.values.data();
  inChunks(use, rays.count, [&](size_t begin, size_t n) {
    const size_t base = first[begin];
    places.assign(first.begin() + std::ptrdiff_t(begin),
                  first.begin() + std::ptrdiff_t(begin + n + 1));
    for (size_t& place : places) place -= base;
    found.resize(places.back());
    parallel(n, [&](size_t i) { pack(from + 6 * (begin + i), near, far, packed[i]); });
    rtListHits(n, packed.data(), places.data(), found.data());
    parallel(n, [&](size_t i) {
      for (size_t k = places[i]; k < places[i + 1]; ++k) {
        hits.take(base + k, found[k]);
        idTo[base + k] = int64_t(begin + i);
      }
    });
  });
  py::dict out = hits.dict();
  out["ray_splits"] = splits;
  out["ray_ids"] = ids;
  return out;
}

py::dict closestPoints(const RtContextPtr& self, const py::object& given, float radius) {
  const Rows points(given, "query_points", 3);
  if (!(radius > 0)) throw py::value_error("radius: above 0 expected");
  const Hits hits(points.shape);
  py::array_t<float> where = like<float>(points.shape, 3);
  float* whereTo = where.mutable_data();
  const CurrentContext use(self, false);
  use.commit();
  std::vector<RTclosest> found(std::min(chunk, points.count));
  const float* from = points.values.data();
  inChunks(use, points.count, [&](size_t first, size_t n) {
    rtClosestPoints(n, from + 3 * first, radius, found.data());
    parallel(n, [&](size_t i) {
      const RTclosest& c = found[i];
      RThit hit{c.distance, c.u,    c.v,         {c.normal[0], c.normal[1], c.normal[2]},
                c.instance, c.name, c.primitive, c.userData};
      hits.take(first + i, hit);
      for (int k = 0; k < 3; ++k)
        whereTo[3 * (first + i) + size_t(k)] =
            c.distance < infinity ? c.point[k] : std::numeric_limits<float>::quiet_NaN();
    });
  });
  py::dict out = hits.dict();
  out["points"] = where;
  out["distances"] = out["t_hit"];
  PyDict_DelItemString(out.ptr(), "t_hit");
  return out;
}

} // namespace

void defineRtQueries(py::class_<RtContext, RtContextPtr>& context) {
  context
      .def("cast_rays", castRays, py::arg("rays"), py::kw_only(), py::arg("tnear") = 0.0f,
           py::arg("tfar") = infinity,
           "Returns the nearest hits of rays (..., 6): origin and direction. The result is a dict "
           "of arrays: t_hit (infinite for a miss), geometry_ids (Instance.user_data), "
           "primitive_ids, primitive_uvs, primitive_normals, instance_ids, names.")
      .def("test_occlusions", testOcclusions, py::arg("rays"), py::kw_only(),
           py::arg("tnear") = 0.0f, py::arg("tfar") = infinity,
           "Returns whether each ray hits anything between tnear and tfar: bool of shape (...).")
      .def("count_intersections", countIntersections, py::arg("rays"), py::kw_only(),
           py::arg("tnear") = 0.0f, py::arg("tfar") = infinity,
           "Returns the number of surfaces on each ray: int32 of shape (...).")
      .def("list_intersections", listIntersections, py::arg("rays"), py::kw_only(),
           py::arg("tnear") = 0.0f, py::arg("tfar") = infinity,
           "Returns all hits of the rays, nearest first: the arrays of cast_rays, of shape (n,), "
           "and ray_ids and ray_splits. The hits of ray i are ray_splits[i] to ray_splits[i + 1].")
      .def("compute_closest_points", closestPoints, py::arg("query_points"), py::kw_only(),
           py::arg("radius") = infinity,
           "Returns the surface points nearest to points (..., 3), as a dict of points, distances, "
           "geometry_ids, primitive_ids, primitive_uvs, primitive_normals, instance_ids and names. "
           "radius: maximum distance; the point is NaN if no surface is that near.");
}
