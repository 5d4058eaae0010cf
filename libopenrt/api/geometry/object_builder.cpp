// object_builder.cpp: merges rtBegin/rtEnd lists, chooses local origins, and adds attributes that
// are first set inside a list. Runs on the application's thread.
#include "api/geometry/object_builder.h"

#include <cstring>

#include <xxhash.h>

#include "api/geometry/transform.h"
#include "local_origin.h"
#include "scene/analytic.h"

namespace openrt {
namespace {

constexpr size_t maxMergedVertices = size_t(1) << 26; // further lists start another geometry
constexpr double maxReachInExtents = 64;
constexpr size_t recentArrays = 1024;
constexpr size_t fewParts = 16; // which are not worth a block

// Reserves room for more elements with amortised growth, so that the caller can append them without
// an allocation.
void reserveMore(std::vector<uint32_t>& indices, size_t more) {
  if (indices.capacity() - indices.size() < more)
    indices.reserve(std::max(indices.size() + more, 2 * indices.capacity()));
}

} // namespace

void WideBounds::add(const Vec3d& p) {
  exact = exact && fitsFloat(p.x) && fitsFloat(p.y) && fitsFloat(p.z);
  if (!any) {
    low = high = p;
    any = true;
  }
  low = min(low, p);
  high = max(high, p);
}

Vec3d WideBounds::origin() const {
  return {localOrigin(low.x, high.x), localOrigin(low.y, high.y), localOrigin(low.z, high.z)};
}

double WideBounds::reach(const Vec3d& from) const {
  return largest(max(abs(low - from), abs(high - from)));
}

void ObjectBuilder::begin(RTenum mode, const GeometryState& state) {
  require(!inList_, RT_INVALID_OPERATION, "already between rtBegin and rtEnd");
  const edit::Primitive primitive = primitiveOf(mode);
  const auto latched = latched_.find(state.shader);
  const bool parameters = latched != latched_.end();
  const size_t floats = parameters ? latched->second.values.size() : 0;
  const uint8_t present =
      uint8_t((current.present & ~HasParameters) | (parameters ? HasParameters : 0));
  const bool joins = open_ && primitive == primitive_ && present == vertices_.attributes() &&
                     state == state_ && vertices_.parameterFloats() == floats &&
                     vertices_.count() < maxMergedVertices;
  if (!joins) {
    std::vector<VaryingParameter> layout =
        parameters ? latched->second.layout : std::vector<VaryingParameter>();
    flush(vertices_.count());
    vertices_.restart(present, floats);
    indices_.clear();
    layout_ = std::move(layout);
    state_ = state;
    primitive_ = primitive;
    open_ = true;
    local_ = false;
  }
  current.present = present;
  current.parameters = parameters ? latched->second.values.data() : nullptr;
  mode_ = mode;
  listStart_ = vertices_.count();
  wideList_ = false;
  inList_ = true;
}

void ObjectBuilder::rejectVertex() const {
  require(inList_, RT_INVALID_OPERATION, "not between rtBegin and rtEnd");
  fail(RT_INVALID_VALUE, "a coordinate is not finite");
}

// Called when an attribute is set for the first time. Earlier lists are closed without it; the
// vertices of this list get its default value.
void ObjectBuilder::adaptAttributes() {
  if (listStart_ > 0) flush(listStart_);
  vertices_.addAttributes(current.present);
}

void ObjectBuilder::parameter(const VaryingParameter& which, std::span<const float> value,
                              std::span<const float> own) {
  require(inList_, RT_INVALID_OPERATION, "not between rtBegin and rtEnd");
  Latched& latched = latched_[state_.shader];
  size_t at = 0;
  for (const VaryingParameter& known : latched.layout) {
    if (known.index == which.index) {
      std::copy(value.begin(), value.end(), latched.values.begin() + ptrdiff_t(at));
      return;
    }
    at += known.floats;
  }
  Latched wider = latched;
  wider.layout.push_back(which);
  wider.values.insert(wider.values.end(), value.begin(), value.end());
  std::vector<VaryingParameter> layout = wider.layout;
  if (listStart_ > 0) flush(listStart_); // earlier lists do not have the parameter
  vertices_.addParameters(own.data(), own.size());
  latched = std::move(wider);
  layout_ = std::move(layout);
  current.parameters = latched.values.data();
  current.present |= HasParameters;
}

void ObjectBuilder::vertex(double x, double y, double z) {
  if (!inList_) rejectVertex();
  if (!(std::fabs(x) <= maxCoordinate && std::fabs(y) <= maxCoordinate &&
        std::fabs(z) <= maxCoordinate))
    fail(RT_INVALID_VALUE, "a coordinate is not finite or beyond 1e38");
  if (current.present != vertices_.attributes()) adaptAttributes();
  if (!wideList_) widenList();
  appendWide(x, y, z);
  try {
    vertices_.append(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), current);
  } catch (...) {
    wide_.pop_back();
    throw;
  }
}

void ObjectBuilder::appendWide(double x, double y, double z) {
  if (std::fabs(x) > maxCoordinate || std::fabs(y) > maxCoordinate || std::fabs(z) > maxCoordinate)
    fail(RT_INVALID_VALUE,
         "a coordinate is beyond 1e38, which cannot be mixed with vertices in double");
  wide_.push_back({x, y, z});
}

// Switches the list to double. Throws if an earlier vertex, given in float, exceeds maxCoordinate.
void ObjectBuilder::widenList() {
  std::vector<Vec3d> points;
  for (size_t i = listStart_; i < vertices_.count(); i++) {
    const float* p = vertices_.points() + 3 * i;
    if (std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}) > maxCoordinate)
      fail(RT_INVALID_VALUE, "a vertex in double cannot be mixed with coordinates beyond 1e38");
    points.push_back({p[0], p[1], p[2]});
  }
  wide_ = std::move(points);
  wideList_ = true;
}

// Chooses the local origin of a list in double, and whether the list is merged into the open
// geometry.
void ObjectBuilder::chooseOrigin() {
  if (!wideList_) {
    if (local_ && listStart_ > 0) flush(listStart_); // a list in float has no local origin
    local_ = false;
    return;
  }
  WideBounds bounds;
  for (const Vec3d& p : wide_) bounds.add(p);
  if (bounds.exact) {
    if (local_ && listStart_ > 0) flush(listStart_);
    local_ = false;
    return;
  }
  const double extent = std::max(
      {bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y, bounds.high.z - bounds.low.z});
  const bool joins =
      listStart_ > 0 && local_ && bounds.reach(origin_) <= maxReachInExtents * extent;
  if (!joins) {
    if (listStart_ > 0) flush(listStart_);
    local_ = true;
    origin_ = bounds.origin();
  }
  storeRelative(origin_);
}

void ObjectBuilder::storeRelative(const Vec3d& origin) {
  float* out = vertices_.points() + 3 * listStart_;
  for (const Vec3d& p : wide_) {
    *out++ = static_cast<float>(p.x - origin.x);
    *out++ = static_cast<float>(p.y - origin.y);
    *out++ = static_cast<float>(p.z - origin.z);
  }
}

void ObjectBuilder::end() {
  require(inList_, RT_INVALID_OPERATION, "not between rtBegin and rtEnd");
  const size_t count = vertices_.count() - listStart_;
  const size_t room = indexCount(mode_, count);
  reserveMore(indices_, room);
  if (!layout_.empty()) reserveMore(completing_, room);
  chooseOrigin();
  const size_t before = indices_.size(); // chooseOrigin() may have flushed earlier lists
  indices_.resize(before + room);
  const uint32_t first = static_cast<uint32_t>(listStart_);
  uint32_t* start = indices_.data() + before;
  const uint32_t* written = writeIndices(
      mode_, count, vertices_.points(),
      [first](size_t i) { return first + static_cast<uint32_t>(i); }, start, degenerate_,
      [&](size_t ordinal) {
        if (!layout_.empty())
          completing_.push_back(first +
                                static_cast<uint32_t>(completingVertex(mode_, count, ordinal)));
      });
  indices_.resize(before + static_cast<size_t>(written - start));
  if (written == start) vertices_.truncate(listStart_); // every primitive is degenerate
  inList_ = wideList_ = false;
  wide_.clear();
}

// Makes a finished geometry from the first vertexCount vertices of the open geometry and all
// indices so far, which belong to closed lists.
void ObjectBuilder::flush(size_t vertexCount) {
  if (!indices_.empty()) {
    BuiltGeometry built{.state = state_, .primitive = primitive_};
    if (local_) built.state.matrix = state_.matrix * translation(origin_.x, origin_.y, origin_.z);
    auto indices = std::make_shared<Array>(indices_.size() * sizeof(uint32_t));
    std::memcpy(indices->data(), indices_.data(), indices->size());
    built.indices = std::move(indices);
    built.points = vertices_.copyPoints(vertexCount);
    built.normals = vertices_.copyNormals(vertexCount);
    built.texCoords = vertices_.copyTexCoords(vertexCount);
    built.colors = vertices_.copyColors(vertexCount);
    built.fogCoords = vertices_.copyFogCoords(vertexCount);
    addParameters(built, vertexCount);
    done_.push_back(std::move(built));
  }
  vertices_.dropFront(vertexCount);
  indices_.clear();
  completing_.clear();
  listStart_ = 0;
}

void ObjectBuilder::addParameters(BuiltGeometry& built, size_t vertexCount) const {
  size_t at = 0;
  for (const VaryingParameter& parameter : layout_) {
    const size_t count = parameter.perVertex ? vertexCount : completing_.size(),
                 n = parameter.floats;
    auto values = std::make_shared<Array>(count * n * sizeof(float));
    float* out = reinterpret_cast<float*>(values->data());
    for (size_t i = 0; i < count; i++)
      std::copy_n(vertices_.parameters(parameter.perVertex ? i : completing_[i]) + at, n,
                  out + n * i);
    built.parameters.push_back({parameter.index, parameter.perVertex, std::move(values)});
    at += n;
  }
}

void ObjectBuilder::draw(const DrawCall& call, const GeometryState& state) {
  require(!inList_, RT_INVALID_OPERATION, "between rtBegin and rtEnd");
  uint64_t degenerate = 0;
  std::optional<BuiltGeometry> built = buildDraw(call, state, current, degenerate);
  if (built) {
    flush(vertices_.count());
    open_ = false;
    shareArrays(*built);
    done_.push_back(std::move(*built));
  }
  degenerate_ += degenerate;
}

// Replaces the arrays of a geometry by recent ones with the same bytes, so that many equal parts
// take memory once while an object is defined. Other small arrays of many parts share blocks.
void ObjectBuilder::shareArrays(BuiltGeometry& built) {
  if (done_.empty()) return;
  recent_.resize(recentArrays);
  for (ArrayPtr* array : {&built.points, &built.indices, &built.normals, &built.texCoords,
                          &built.colors, &built.fogCoords}) {
    if (!*array) continue;
    ArrayPtr& known = recent_[XXH3_64bits((*array)->data(), (*array)->size()) % recentArrays];
    const bool same = known && known->size() == (*array)->size() &&
                      std::memcmp(known->data(), (*array)->data(), known->size()) == 0;
    if (!same) {
      const bool small = (*array)->size() <= ArrayBlocks::largestBytes;
      known = small && done_.size() >= fewParts ? blocks_.copy(**array) : *array;
    }
    *array = known;
  }
}

void ObjectBuilder::sphere(float radius, const GeometryState& state) {
  require(!inList_, RT_INVALID_OPERATION, "between rtBegin and rtEnd");
  require(std::isfinite(radius) && radius > 0, RT_INVALID_VALUE,
          "the radius must be positive and finite");
  flush(vertices_.count());
  open_ = false;
  BuiltGeometry built{.state = state, .primitive = edit::Primitive::Sphere};
  built.state.width = radius;
  done_.push_back(std::move(built));
}

void ObjectBuilder::analytic(edit::Primitive kind, std::vector<double> numbers,
                             const GeometryState& state) {
  require(!inList_, RT_INVALID_OPERATION, "between rtBegin and rtEnd");
  const std::string problem = AnalyticSurface::problemOf(kind, numbers);
  if (!problem.empty()) fail(RT_INVALID_VALUE, problem);
  flush(vertices_.count());
  open_ = false;
  BuiltGeometry built{.state = state, .primitive = kind};
  built.surface = std::move(numbers);
  done_.push_back(std::move(built));
}

std::vector<BuiltGeometry> ObjectBuilder::finish() {
  flush(vertices_.count());
  open_ = false;
  recent_.clear();
  return std::move(done_);
}

} // namespace openrt
