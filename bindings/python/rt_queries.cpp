// rt_queries.cpp: Implements the ray and point queries of xvrml.rt over arrays: the input has shape
// (..., 6), the result is a dict of arrays of shape (...). The input is processed in chunks that
// fit into the caches. All threads pack, trace and unpack each chunk, without the GIL.

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "arrays.h"
#include "numbers.h"
#include "objects.h"
#include "openrt/query.h"
#include "parallel_for.h"
#include "rt_objects.h"

namespace {

constexpr size_t chunk = size_t(1) << 17, grain = 8192;
constexpr uint32_t invalid = 0xFFFFFFFF;
constexpr double infinity = std::numeric_limits<double>::infinity();
using Shape = ArrayShape;

template <class T> struct Rows { // rows of numbers, with any shape before the last dimension
  py::array_t<T, py::array::c_style | py::array::forcecast> values;
  Shape shape; // lengths of all dimensions except the last
  size_t count = 0;
  Rows(const py::object& given, const char* name, py::ssize_t width) {
    const std::string expected = fmt::format("numbers of shape (..., {})", width);
    values = decltype(values)(numberArray(given, name, expected));
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
  return newArray<T>(std::move(sides));
}

template <class F> void parallel(size_t count, const F& f) {
  parallelFor(tbb::blocked_range<size_t>(0, count, grain), [&](const auto& range) {
    for (size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

// The arrays common to all lists of hits, and pointers into them. T: float or double.
template <class T> struct Hits {
  py::array_t<T> t, uv, normal;
  py::array_t<uint32_t> geometry, primitive, instance, name;
  T *tTo, *uvTo, *normalTo;
  uint32_t *geometryTo, *primitiveTo, *instanceTo, *nameTo;
  explicit Hits(const Shape& shape)
      : t(like<T>(shape)), uv(like<T>(shape, 2)), normal(like<T>(shape, 3)),
        geometry(like<uint32_t>(shape)), primitive(like<uint32_t>(shape)),
        instance(like<uint32_t>(shape)), name(like<uint32_t>(shape)), tTo(t.mutable_data()),
        uvTo(uv.mutable_data()), normalTo(normal.mutable_data()),
        geometryTo(geometry.mutable_data()), primitiveTo(primitive.mutable_data()),
        instanceTo(instance.mutable_data()), nameTo(name.mutable_data()) {}

  template <class Hit> void take(size_t i, const Hit& hit) const {
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

// The same with places and bounds of the errors.
struct DoubleHits : Hits<double> {
  py::array_t<double> point, tError, uvError, pointError;
  double *pointTo, *tErrorTo, *uvErrorTo, *pointErrorTo;
  explicit DoubleHits(const Shape& shape)
      : Hits(shape), point(like<double>(shape, 3)), tError(like<double>(shape)),
        uvError(like<double>(shape)), pointError(like<double>(shape)),
        pointTo(point.mutable_data()), tErrorTo(tError.mutable_data()),
        uvErrorTo(uvError.mutable_data()), pointErrorTo(pointError.mutable_data()) {}
  void take(size_t i, const RThitd& hit) const {
    Hits::take(i, hit);
    for (size_t k = 0; k < 3; ++k)
      pointTo[3 * i + k] =
          hit.t < infinity ? hit.position[k] : std::numeric_limits<double>::quiet_NaN();
    tErrorTo[i] = hit.tError;
    uvErrorTo[i] = hit.uvError;
    pointErrorTo[i] = hit.positionError;
  }
  py::dict dict() const {
    py::dict out = Hits::dict();
    out["points"] = point;
    out["t_errors"] = tError;
    out["uv_errors"] = uvError;
    out["point_errors"] = pointError;
    return out;
  }
};

// Each precision has its own types and calls.
struct Single {
  using Number = float;
  using Ray = RTray;
  using Hit = RThit;
  using Arrays = Hits<float>;
  static constexpr auto cast = rtCastRays;
  static constexpr auto occluded = rtOccludedRays;
  static constexpr auto count = rtCountHits;
  static constexpr auto list = rtListHits;
  using Closest = RTclosest;
  static constexpr auto closest = rtClosestPoints;
};
struct Double {
  using Number = double;
  using Ray = RTrayd;
  using Hit = RThitd;
  using Arrays = DoubleHits;
  static constexpr auto cast = rtCastRaysd;
  static constexpr auto occluded = rtOccludedRaysd;
  static constexpr auto count = rtCountHitsd;
  static constexpr auto list = rtListHitsd;
  using Closest = RThitd;
  static constexpr auto closest = rtClosestPointsd;
};

// The arguments that all ray queries have.
template <class P> struct Query {
  Rows<typename P::Number> rays;
  typename P::Number near, far;
  CurrentContext use;
  std::vector<typename P::Ray> packed; // a chunk
  Query(const RtContextPtr& context, const py::object& given, double near, double far)
      : rays(given, "rays", 6), near(typename P::Number(near)), far(typename P::Number(far)),
        use(context, false), packed(std::min(chunk, rays.count)) {
    use.commit();
  }
  // Calls f(first, count) for chunks of rays, which are packed, and checks for Ctrl-C between them.
  template <class F> void inChunks(const F& f) {
    for (size_t first = 0; first < rays.count; first += chunk) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      {
        const ReleaseGil release;
        const size_t count = std::min(chunk, rays.count - first);
        parallel(count, [&](size_t i) { pack(first + i, packed[i]); });
        f(first, count);
      }
      use.check();
    }
  }
  void pack(size_t ray, typename P::Ray& to) const {
    const auto* from = rays.values.data() + 6 * ray;
    std::memcpy(to.origin, from, sizeof to.origin);
    std::memcpy(to.direction, from + 3, sizeof to.direction);
    to.tnear = near;
    to.tfar = far;
  }
};

void checkEnds(double near, double far) {
  if (!(near >= 0 && far >= near))
    throw py::value_error("tnear, tfar: 0 <= tnear <= tfar expected");
}

// Calls f with Single or Double.
template <class F> auto withPrecision(const std::string& precision, const F& f) {
  if (precision == "single") return f(Single());
  if (precision == "double") return f(Double());
  throw py::value_error("precision: 'single' or 'double' expected, not '" + precision + "'");
}

template <class P>
py::dict cast(const RtContextPtr& self, const py::object& given, double near, double far) {
  Query<P> query(self, given, near, far);
  const typename P::Arrays hits(query.rays.shape);
  std::vector<typename P::Hit> found(query.packed.size());
  query.inChunks([&](size_t first, size_t n) {
    P::cast(n, query.packed.data(), found.data());
    parallel(n, [&](size_t i) { hits.take(first + i, found[i]); });
  });
  return hits.dict();
}

py::dict castRays(const RtContextPtr& self, const py::object& given, double near, double far,
                  const std::string& precision) {
  checkEnds(near, far);
  return withPrecision(precision, [&]<class P>(P) { return cast<P>(self, given, near, far); });
}

py::array testOcclusions(const RtContextPtr& self, const py::object& given, double near, double far,
                         const std::string& precision) {
  checkEnds(near, far);
  return withPrecision(precision, [&]<class P>(P) -> py::array {
    Query<P> query(self, given, near, far);
    py::array_t<bool> out = like<bool>(query.rays.shape);
    bool* to = out.mutable_data();
    std::vector<uint8_t> found(query.packed.size());
    query.inChunks([&](size_t first, size_t n) {
      P::occluded(n, query.packed.data(), found.data());
      for (size_t i = 0; i < n; ++i) to[first + i] = found[i] != 0;
    });
    return out;
  });
}

template <class P> std::vector<uint32_t> counted(Query<P>& query) {
  std::vector<uint32_t> counts(query.rays.count);
  query.inChunks(
      [&](size_t first, size_t n) { P::count(n, query.packed.data(), counts.data() + first); });
  return counts;
}

py::array countIntersections(const RtContextPtr& self, const py::object& given, double near,
                             double far, const std::string& precision) {
  checkEnds(near, far);
  return withPrecision(precision, [&]<class P>(P) -> py::array {
    Query<P> query(self, given, near, far);
    const std::vector<uint32_t> counts = counted(query);
    py::array_t<int32_t> out = like<int32_t>(query.rays.shape);
    std::copy(counts.begin(), counts.end(), out.mutable_data());
    return out;
  });
}

template <class P>
py::dict list(const RtContextPtr& self, const py::object& given, double near, double far) {
  Query<P> query(self, given, near, far);
  const std::vector<uint32_t> counts = counted(query);
  std::vector<size_t> first(query.rays.count + 1);
  for (size_t i = 0; i < query.rays.count; ++i) first[i + 1] = first[i] + counts[i];
  const auto total = py::ssize_t(first.back());
  const typename P::Arrays hits(Shape{total});
  auto splits = newArray<int64_t>({py::ssize_t(query.rays.count) + 1});
  auto ids = newArray<int64_t>({total});
  std::copy(first.begin(), first.end(), splits.mutable_data());
  int64_t* idTo = ids.mutable_data();
  std::vector<typename P::Hit> found;
  std::vector<size_t> places;
  query.inChunks([&](size_t begin, size_t n) {
    const size_t base = first[begin];
    places.assign(first.begin() + std::ptrdiff_t(begin),
                  first.begin() + std::ptrdiff_t(begin + n + 1));
    for (size_t& place : places) place -= base;
    found.resize(places.back());
    P::list(n, query.packed.data(), places.data(), found.data());
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

py::dict listIntersections(const RtContextPtr& self, const py::object& given, double near,
                           double far, const std::string& precision) {
  checkEnds(near, far);
  return withPrecision(precision, [&]<class P>(P) { return list<P>(self, given, near, far); });
}

// Calls f for chunks of points and checks for Ctrl-C between them.
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

// The arrays of closest places in both precisions.
struct SinglePlaces : Hits<float> {
  py::array_t<float> point;
  float* pointTo;
  explicit SinglePlaces(const Shape& shape)
      : Hits(shape), point(like<float>(shape, 3)), pointTo(point.mutable_data()) {}
  void take(size_t i, const RTclosest& c) const {
    Hits::take(i, RThit{c.distance,
                        c.u,
                        c.v,
                        {c.normal[0], c.normal[1], c.normal[2]},
                        c.instance,
                        c.name,
                        c.primitive,
                        c.userData});
    for (size_t k = 0; k < 3; ++k)
      pointTo[3 * i + k] =
          c.distance < infinity ? c.point[k] : std::numeric_limits<float>::quiet_NaN();
  }
  py::dict dict() const {
    py::dict out = Hits::dict();
    out["points"] = point;
    return out;
  }
};

template <class P, class Places>
py::dict closest(const RtContextPtr& self, const py::object& given, double most) {
  const Rows<typename P::Number> points(given, "query_points", 3);
  const auto radius = typename P::Number(most);
  if (!(radius > 0)) throw py::value_error("radius: above 0 expected");
  const Places places(points.shape);
  const CurrentContext use(self, false);
  use.commit();
  std::vector<typename P::Closest> found(std::min(chunk, points.count));
  const auto* from = points.values.data();
  inChunks(use, points.count, [&](size_t first, size_t n) {
    P::closest(n, from + 3 * first, radius, found.data());
    parallel(n, [&](size_t i) { places.take(first + i, found[i]); });
  });
  py::dict out = places.dict();
  const auto rename = [&](const char* name, const char* as) {
    if (!out.contains(name)) return;
    out[as] = out[name];
    PyDict_DelItemString(out.ptr(), name);
  };
  rename("t_hit", "distances");
  rename("t_errors", "distance_errors");
  return out;
}

py::dict closestPoints(const RtContextPtr& self, const py::object& given, double radius,
                       const std::string& precision) {
  return withPrecision(precision, [&]<class P>(P) {
    if constexpr (std::is_same_v<P, Single>)
      return closest<P, SinglePlaces>(self, given, radius);
    else
      return closest<P, DoubleHits>(self, given, radius);
  });
}

} // namespace

void defineRtQueries(py::class_<RtContext, RtContextPtr>& context) {
  // Defines a query of rays.
  const auto define = [&](const char* name, auto function, const char* text) {
    context.def(name, function, py::arg("rays"), py::kw_only(), py::arg("tnear") = 0.0,
                py::arg("tfar") = infinity, py::arg("precision") = "single", text);
  };
  define("cast_rays", castRays,
         "Returns the nearest hits of rays (..., 6): origin and direction. The result is a dict of "
         "arrays: t_hit (infinite for a miss), geometry_ids (Instance.user_data), primitive_ids, "
         "primitive_uvs, primitive_normals, instance_ids, names. precision: 'single' or 'double'; "
         "with 'double', rays are float64, and points, t_errors, uv_errors and point_errors are "
         "added.");
  define("test_occlusions", testOcclusions,
         "Returns whether each ray hits anything between tnear and tfar: bool of shape (...). "
         "precision: as for cast_rays.");
  define("count_intersections", countIntersections,
         "Returns the number of surfaces on each ray: int32 of shape (...). precision: as for "
         "cast_rays.");
  define("list_intersections", listIntersections,
         "Returns all hits of the rays, nearest first: the arrays of cast_rays, of shape (n,), and "
         "ray_ids and ray_splits. The hits of ray i are ray_splits[i] to ray_splits[i + 1].");
  context.def(
      "compute_closest_points", closestPoints, py::arg("query_points"), py::kw_only(),
      py::arg("radius") = infinity, py::arg("precision") = "single",
      "Returns the surface points nearest to points (..., 3), as a dict of points, distances, "
      "geometry_ids, primitive_ids, primitive_uvs, primitive_normals, instance_ids and names. "
      "radius: maximum distance; the point is NaN if no surface is that near. precision: 'single' "
      "or "
      "'double'; with 'double', points are float64, and distance_errors, uv_errors and "
      "point_errors "
      "are bounds.");
}
