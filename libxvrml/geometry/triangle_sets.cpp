// triangle_sets.cpp: the sets of triangles, strips, fans and quadrilaterals of X3D (ISO/IEC 19775-1
// clauses 11.4.6 to 11.4.8, 11.4.12 to 11.4.14, 32.4.5 and 32.4.6) as faces of a FaceSet. Their
// colours, normals and texture coordinates belong to the coordinates.
#include <algorithm>
#include <string>
#include <utility>

#include "geometry/builders.h"
#include "geometry/polygons/face_set.h"
#include "geometry/polygons/plain_triangles.h"
#include "geometry/texture_mapping.h"

namespace xvrml {
namespace {

enum class Pattern : uint8_t { triangles, quads, strip, fan };

// The corners of a node: indices of coordinates, or without them all coordinates in their order.
struct Corners {
  bool indexed = false;
  std::span<const int32_t> index;
  uint32_t count = 0; // without indices

  uint32_t size() const { return indexed ? uint32_t(index.size()) : count; }
  uint32_t at(uint32_t place) const { return indexed ? uint32_t(index[place]) : place; }
};

class SetReader {
 public:
  SetReader(FaceSet& set, const Corners& corners, Pattern pattern, uint64_t limit, Faults& faults)
      : set_(set), corners_(corners), pattern_(pattern), limit_(limit), faults_(faults) {
    set_.faceStart.push_back(0);
    set_.ignoreNoArea = pattern == Pattern::strip; // triangles without area join strips
  }

  // Reads the corners from one place up to another. Corners after the last whole face are ignored.
  void run(uint32_t begin, uint32_t end) {
    const uint32_t step = pattern_ == Pattern::triangles ? 3 : pattern_ == Pattern::quads ? 4 : 1;
    const uint32_t size = std::max(step, 3u);
    for (uint32_t i = begin; end - i >= size && !full_; i += step) switch (pattern_) {
      case Pattern::triangles: face({i, i + 1, i + 2}); break;
      case Pattern::quads: face({i, i + 1, i + 2, i + 3}); break;
      case Pattern::fan: face({begin, i + 1, i + 2}); break;
      case Pattern::strip: // each second triangle runs the other way
        if ((i - begin) % 2 == 0)
          face({i, i + 1, i + 2});
        else
          face({i + 1, i, i + 2});
        break;
      }
  }

  // Reads runs that end with an index of -1.
  void runsByIndex() {
    for (uint32_t begin = 0, end = 0; begin < corners_.size(); begin = end + 1) {
      for (end = begin; end < corners_.size() && corners_.index[end] != -1;) end++;
      if (end - begin < 3 && end > begin) faults_.add(Fault::fewVertices, begin);
      run(begin, end);
    }
  }

  // Reads runs of as many corners as `counts` says.
  void runsByCount(std::span<const int32_t> counts, std::string_view field) {
    uint32_t begin = 0;
    bool wrong = false, missing = false;
    for (size_t i = 0; i < counts.size(); i++) {
      const uint32_t left = corners_.size() - begin;
      if (counts[i] < 3 && !std::exchange(wrong, true))
        faults_.note(std::string(field) + "[" + std::to_string(i) + "] is " +
                     std::to_string(counts[i]) + ", but should be 3 or more");
      if (int64_t(counts[i]) > int64_t(left) && !std::exchange(missing, true))
        faults_.note(std::string(field) + "[" + std::to_string(i) + "] asks for " +
                     std::to_string(counts[i]) + " vertices where " + std::to_string(left) +
                     " are left");
      const uint32_t count = std::min(uint32_t(std::max(counts[i], 0)), left);
      run(begin, begin + count);
      begin += count;
    }
    if (counts.empty() && corners_.size() > 0)
      faults_.note(std::string(field) + " is empty; nothing is drawn");
  }

 private:
  void face(std::initializer_list<uint32_t> places) {
    if (set_.faceStart.size() > limit_) {
      faults_.add(Fault::overLimit, *places.begin());
      full_ = true;
      return;
    }
    for (const uint32_t place : places)
      if (corners_.at(place) >= set_.points.size()) { // also catches negative indices
        faults_.add(Fault::indexRange, place);
        return;
      }
    const uint32_t first = uint32_t(set_.corners.size());
    auto& corners = set_.corners;
    for (const uint32_t place : places)
      if (corners.size() == first || corners.back() != corners_.at(place))
        corners.push_back(corners_.at(place));
    if (corners.size() > first + 1 && corners.back() == corners[first]) corners.pop_back();
    if (corners.size() < first + 3) {
      corners.resize(first);
      if (pattern_ != Pattern::strip) faults_.add(Fault::fewVertices, *places.begin());
      return;
    }
    set_.faceStart.push_back(uint32_t(corners.size()));
    set_.faceName.push_back(*places.begin());
  }

  FaceSet& set_;
  const Corners& corners_;
  Pattern pattern_;
  uint64_t limit_;
  Faults& faults_;
  bool full_ = false;
};

// Binds values to the coordinates in their order.
template <class T> void bind(Attribute<T>& attribute, uint32_t used, Fault fault, Faults& faults) {
  if (attribute.values.empty()) return;
  attribute.per = Attribute<T>::Per::point;
  if (attribute.values.size() < used) faults.add(fault, attribute.values.size());
}

constexpr float smoothAll = 4; // more than any angle between faces

// Returns a set with the values of a node and no faces.
template <class Node> FaceSet valuesOf(const Node& node) {
  FaceSet set;
  Coordinates given = coordinates(node.coord);
  set.takePoints(given.points, std::move(given.own));
  set.solid = node.solid;
  set.ccw = node.ccw;
  ColorValues colors = colorValues(node.color);
  set.takeColors(colors.rgb, std::move(colors.own), std::move(colors.alphas));
  set.normals.values = normalVectors(node.normal);
  TexCoordValues texCoords = textureCoordinates(node.texCoord);
  set.takeTexCoords(texCoords.points, std::move(texCoords.own), std::move(texCoords.places));
  set.fogCoords = fogCoordinates(node.fogCoord, set.points.size());
  return set;
}

// Makes the faces with read(reader), and then the mesh. smooth: vertices without a normal get the
// mean of the normals of all faces that share their coordinate.
template <class Node, class Read> Mesh build(const Node& node, Pattern pattern, bool smooth,
                                             const MeshOptions& options, Faults& faults,
                                             Corners corners, const Read& read) {
  FaceSet set = valuesOf(node);
  if (set.points.size() >= noValue / 2 || corners.index.size() >= noValue / 2) {
    faults.note("too many points or indices");
    return {};
  }
  corners.count = uint32_t(set.points.size());
  SetReader reader(set, corners, pattern, triangleLimit(options), faults);
  read(reader, corners.size());
  if (set.corners.empty()) return {};
  const uint32_t used = *std::max_element(set.corners.begin(), set.corners.end()) + 1;
  bind(set.colors, used, Fault::colorMissing, faults);
  bind(set.normals, used, Fault::normalMissing, faults);
  bind(set.texCoords, used, Fault::texCoordMissing, faults);
  if (smooth && node.normalPerVertex) set.creaseAngle = smoothAll;
  if (options.needTexCoords && set.texCoords.values.empty()) {
    set.texCoords.own = defaultTextureMapping(set.points, set.corners);
    set.texCoords.values = set.texCoords.own;
    set.texCoords.per = Attribute<Vec2f>::Per::point;
  }
  return buildFaceMesh(std::move(set), options, faults);
}

constexpr auto oneRun = [](SetReader& reader, uint32_t corners) { reader.run(0, corners); };
constexpr auto byIndex = [](SetReader& reader, uint32_t) { reader.runsByIndex(); };

} // namespace

Mesh buildIndexedTriangleSet(const nodes::IndexedTriangleSet& node, const MeshOptions& options,
                             Faults& faults) {
  const FaceSet set = valuesOf(node);
  Mesh mesh;
  if (set.ownPoints.empty() && set.points.size() < noValue / 2 && node.index.size() < noValue / 2 &&
      buildPlain({node.index, false, node.normalPerVertex ? smoothAll : 0, node.solid, node.ccw},
                 set, options, mesh))
    return mesh;
  return build(node, Pattern::triangles, true, options, faults, {true, node.index}, oneRun);
}

Mesh buildIndexedTriangleStripSet(const nodes::IndexedTriangleStripSet& node,
                                  const MeshOptions& options, Faults& faults) {
  return build(node, Pattern::strip, true, options, faults, {true, node.index}, byIndex);
}

Mesh buildIndexedTriangleFanSet(const nodes::IndexedTriangleFanSet& node,
                                const MeshOptions& options, Faults& faults) {
  return build(node, Pattern::fan, true, options, faults, {true, node.index}, byIndex);
}

Mesh buildIndexedQuadSet(const nodes::IndexedQuadSet& node, const MeshOptions& options,
                         Faults& faults) {
  return build(node, Pattern::quads, true, options, faults, {true, node.index}, oneRun);
}

// Faces of a TriangleSet or QuadSet share no coordinates, so that they are flat.
Mesh buildTriangleSet(const nodes::TriangleSet& node, const MeshOptions& options, Faults& faults) {
  return build(node, Pattern::triangles, false, options, faults, {}, oneRun);
}

Mesh buildQuadSet(const nodes::QuadSet& node, const MeshOptions& options, Faults& faults) {
  return build(node, Pattern::quads, false, options, faults, {}, oneRun);
}

Mesh buildTriangleStripSet(const nodes::TriangleStripSet& node, const MeshOptions& options,
                           Faults& faults) {
  return build(node, Pattern::strip, true, options, faults, {}, [&](SetReader& reader, uint32_t) {
    reader.runsByCount(node.stripCount, "stripCount");
  });
}

Mesh buildTriangleFanSet(const nodes::TriangleFanSet& node, const MeshOptions& options,
                         Faults& faults) {
  return build(node, Pattern::fan, true, options, faults, {},
               [&](SetReader& reader, uint32_t) { reader.runsByCount(node.fanCount, "fanCount"); });
}

} // namespace xvrml
