// ply.cpp: reads PLY, text and binary in both byte orders (Turk, "The PLY Polygon File Format",
// 1994). Elements: vertex (positions, normals, colours, texture coordinates), face and tristrips
// (polygons, with colours or texture coordinates of corners), edge. Others are passed over.
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "parse/encodings.h"
#include "parse/mesh/bare_shape.h"
#include "parse/mesh/mesh_file.h"
#include "parse/mesh/ply_header.h"
#include "parse/mesh/text_cursor.h"

namespace xvrml {
namespace {

// Reads the numbers behind the header.
class Numbers {
 public:
  Numbers(std::string_view bytes, const PlyHeader& header)
      : text_(bytes), order_(header.order), p_(bytes.data()), end_(p_ + bytes.size()) {}

  const char* at() const { return order_ == PlyOrder::text ? text_.at() : nullptr; }
  // Moves to the next number and returns its place.
  const char* startRow() {
    if (order_ == PlyOrder::text) text_.skipSpace();
    return at();
  }
  uint64_t left() const {
    return order_ == PlyOrder::text ? uint64_t(text_.end() - text_.at()) : uint64_t(end_ - p_);
  }
  // Bytes that a number takes at least: a digit and a blank.
  uint64_t bytesOf(PlyType type) const { return order_ == PlyOrder::text ? 2 : plyTypeBytes(type); }

  double next(PlyType type) { return order_ == PlyOrder::text ? nextText(type) : nextBinary(type); }

 private:
  double nextText(PlyType type) {
    text_.skipSpace();
    float small = 0;
    double large = 0;
    const bool good = type == PlyType::float32 ? text_.number(small) : text_.number(large);
    if (!good)
      throw MeshFault{text_.at(),
                      fmt::format("expected a number, found {}; the rest of the file is "
                                  "left out",
                                  text_.atEnd() ? std::string("the end of the file")
                                                : describe(Name{text_.word()}))};
    return type == PlyType::float32 ? double(small) : large;
  }

  template <class T> double binary() {
    char bytes[sizeof(T)];
    if (size_t(end_ - p_) < sizeof(T))
      throw MeshFault{nullptr, "the PLY file ends early: fewer numbers than its header announces"};
    std::memcpy(bytes, p_, sizeof(T));
    p_ += sizeof(T);
    if (order_ == PlyOrder::big) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return double(value);
  }

  double nextBinary(PlyType type) {
    static_assert(std::endian::native == std::endian::little);
    switch (type) {
    case PlyType::int8: return binary<int8_t>();
    case PlyType::uint8: return binary<uint8_t>();
    case PlyType::int16: return binary<int16_t>();
    case PlyType::uint16: return binary<uint16_t>();
    case PlyType::int32: return binary<int32_t>();
    case PlyType::uint32: return binary<uint32_t>();
    case PlyType::float32: return binary<float>();
    default: return binary<double>();
    }
  }

  TextCursor text_;
  PlyOrder order_;
  const char* p_;
  const char* end_;
};

class PlyReader {
 public:
  explicit PlyReader(const MeshFile& file)
      : file_(file), header_(readPlyHeader(file)),
        numbers_(file.bytes.substr(header_.bytes), header_), scratch_(file.budget) {}

  void read() {
    try {
      for (const PlyElement& element : header_.elements) readElement(element);
    } catch (const MeshFault& fault) { // what has been read is shown
      file_.locator.error(fault.at, fault.message);
    }
    bad_.report(file_.locator, Severity::error,
                "faces or edges name a vertex that the file does not have, or too many corners");
    finish();
  }

 private:
  void readElement(const PlyElement& element) {
    uint64_t least = 0; // bytes
    for (const PlyProperty& property : element.properties)
      least += numbers_.bytesOf(property.isList ? property.countType : property.type);
    if (least == 0) return;
    // The last number of a text has no blank behind it.
    const uint64_t most = (numbers_.left() + 1) / least;
    const uint64_t count = std::min(element.count, most);
    if (element.name == "vertex") startVertices(element, count);
    for (uint64_t i = 0; i < count; ++i) readRow(element);
    if (count < element.count)
      throw MeshFault{nullptr, fmt::format("the PLY file ends early: it announces {} rows of "
                                           "element {}, and {} fit into the file",
                                           element.count, element.name, count)};
  }

  void startVertices(const PlyElement& element, uint64_t count) {
    if (count > INT32_MAX / 4) throw MeshFault{nullptr, "too many vertices in a PLY file"};
    hasVertices_ = true;
    const auto has = [&](PlyUse use) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [use](const PlyProperty& p) { return p.use == use; });
    };
    hasNormals_ = has(PlyUse::nx) && has(PlyUse::ny) && has(PlyUse::nz);
    hasColors_ = has(PlyUse::red) && has(PlyUse::green) && has(PlyUse::blue);
    hasTexCoords_ = has(PlyUse::s) && has(PlyUse::t);
    scratch_.take(count *
                  (sizeof(Vec3f) * (1 + hasNormals_ + hasColors_) + sizeof(Vec2f) * hasTexCoords_));
    shape_.points.reserve(count);
    if (hasNormals_) shape_.normals.reserve(count);
    if (hasColors_) shape_.colors.reserve(count);
    if (hasTexCoords_) shape_.texCoords.reserve(count);
  }

  void readRow(const PlyElement& element) {
    row_ = numbers_.startRow();
    list_.clear();
    corners_.clear();
    std::fill(std::begin(values_), std::end(values_), 0.0);
    for (const PlyProperty& property : element.properties) {
      if (property.isList)
        readList(property);
      else
        values_[size_t(property.use)] = numbers_.next(property.type) * property.scale;
    }
    if (element.name == "vertex")
      addVertex();
    else if (element.name == "face")
      addFace();
    else if (element.name == "tristrips")
      addStrips();
    else if (element.name == "edge")
      addEdge();
  }

  void readList(const PlyProperty& property) {
    const double count = numbers_.next(property.countType);
    if (!(count >= 0 &&
          count * double(numbers_.bytesOf(property.type)) <= double(numbers_.left() + 1)))
      throw MeshFault{numbers_.at(), fmt::format("a list of {} numbers does not fit into the file; "
                                                 "the rest of it is left out",
                                                 count)};
    std::vector<double>& to = property.use == PlyUse::texCoords ? corners_ : list_;
    const bool wanted = property.use == PlyUse::texCoords || property.use == PlyUse::indices;
    for (uint64_t i = 0; i < uint64_t(count); ++i) {
      const double value = numbers_.next(property.type);
      if (wanted) to.push_back(value);
    }
  }

  float value(PlyUse use) const { return float(values_[size_t(use)]); }
  Color color() const {
    const auto part = [this](PlyUse use) { return std::clamp(value(use), 0.0f, 1.0f); };
    return {part(PlyUse::red), part(PlyUse::green), part(PlyUse::blue)};
  }

  void addVertex() {
    shape_.points.push_back({value(PlyUse::x), value(PlyUse::y), value(PlyUse::z)});
    if (hasNormals_)
      shape_.normals.push_back({value(PlyUse::nx), value(PlyUse::ny), value(PlyUse::nz)});
    if (hasColors_) shape_.colors.push_back(color());
    if (hasTexCoords_) shape_.texCoords.push_back({value(PlyUse::s), value(PlyUse::t)});
  }

  // Faces may stand before the vertices that they name.
  bool isVertex(double index) const {
    const uint64_t present = hasVertices_ ? shape_.points.size() : header_.vertices;
    return index >= 0 && index < double(present) && std::trunc(index) == index;
  }
  void reserveCorners(size_t count) {
    MFInt32& index = shape_.coordIndex;
    if (index.capacity() - index.size() >= count) return;
    const size_t more = std::max<size_t>(index.size(), std::max<size_t>(count, 4096));
    scratch_.take(more * sizeof(int32_t));
    index.reserve(index.size() + more);
  }

  void addFace() {
    if (list_.size() < 3 ||
        !std::all_of(list_.begin(), list_.end(), [this](double index) { return isVertex(index); }))
      return bad_.add(row_);
    reserveCorners(list_.size() + 1);
    for (const double index : list_) shape_.coordIndex.push_back(int32_t(index));
    shape_.coordIndex.push_back(-1);
    shape_.convex = shape_.convex && list_.size() == 3;
    if (header_.faceColors && !hasColors_) {
      scratch_.take(sizeof(Color));
      faceColors_.push_back(color());
    }
    if (header_.cornerTexCoords && !hasTexCoords_) addCorners();
  }

  // Texture coordinates of the face's corners, as MeshLab writes them. A face without them gets 0.
  void addCorners() {
    corners_.resize(2 * list_.size());
    scratch_.take(list_.size() * (sizeof(Vec2f) + sizeof(int32_t)));
    for (size_t i = 0; i < list_.size(); ++i) {
      shape_.texCoordIndex.push_back(int32_t(shape_.texCoords.size()));
      shape_.texCoords.push_back({float(corners_[2 * i]), float(corners_[2 * i + 1])});
    }
    shape_.texCoordIndex.push_back(-1);
  }

  // Strips of triangles, separated by -1; every second triangle is turned.
  void addStrips() {
    size_t first = 0;
    for (size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] < 0) {
        first = i + 1;
        continue;
      }
      if (i < first + 2) continue;
      const double* corner = &list_[i - 2];
      if (!isVertex(corner[0]) || !isVertex(corner[1]) || !isVertex(corner[2])) {
        bad_.add(row_);
        continue;
      }
      if (corner[0] == corner[1] || corner[1] == corner[2] || corner[0] == corner[2]) continue;
      const bool turned = (i - first) % 2 != 0;
      reserveCorners(4);
      for (const int k : {turned ? 1 : 0, turned ? 0 : 1, 2})
        shape_.coordIndex.push_back(int32_t(corner[k]));
      shape_.coordIndex.push_back(-1);
    }
  }

  void addEdge() {
    const double from = values_[size_t(PlyUse::vertex1)], to = values_[size_t(PlyUse::vertex2)];
    if (!isVertex(from) || !isVertex(to)) return bad_.add(row_);
    scratch_.take(3 * sizeof(int32_t));
    for (const double index : {from, to, -1.0}) edges_.push_back(int32_t(index));
  }

  void finish() {
    if (shape_.points.empty()) return;
    PointRange().add(shape_.points).report(file_.locator);
    if (!faceColors_.empty()) {
      shape_.colors = std::move(faceColors_);
      shape_.colorPerVertex = false;
    }
    if (shape_.coordIndex.empty()) {
      shape_.kind = edges_.empty() ? MeshKind::points : MeshKind::lines;
      shape_.coordIndex = std::move(edges_);
    }
    if (!shape_.texCoords.empty()) shape_.texture = header_.texture;
    NodeStream nodes(file_);
    writeBareShape(nodes, std::move(shape_));
  }

  const MeshFile& file_;
  const PlyHeader header_;
  Numbers numbers_;
  Scratch scratch_;
  BareShape shape_;
  MFColor faceColors_;
  MFInt32 edges_;
  bool hasVertices_ = false, hasNormals_ = false, hasColors_ = false, hasTexCoords_ = false;
  double values_[size_t(PlyUse::count)] = {};
  std::vector<double> list_, corners_; // numbers of the face that is being read
  const char* row_ = nullptr;          // where it begins in a text
  FaultCount bad_;
};

} // namespace

void readPly(const MeshFile& file) { PlyReader(file).read(); }

} // namespace xvrml
