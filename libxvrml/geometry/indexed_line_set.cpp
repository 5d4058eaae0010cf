// indexed_line_set.cpp: IndexedLineSet (clause 6.24) and LineSet of X3D (ISO/IEC 19775-1 11.4.9):
// polylines as segments, with colours per vertex or per polyline.
#include <algorithm>
#include <string>
#include <utility>

#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

// The fields of both nodes.
struct Lines {
  const NodeRef& coord;
  const NodeRef& color;
  const NodeRef& fogCoord;
  std::span<const int32_t> coordIndex;
  bool colorPerVertex = true;
  std::span<const int32_t> colorIndex = {};
};

class LineReader {
 public:
  LineReader(const Lines& node, Faults& faults)
      : node_(node), faults_(faults), given_(coordinates(node.coord)), points_(given_.points),
        values_(colorValues(node.color)), colors_(values_.rgb),
        fogCoords_(fogCoordinates(node.fogCoord, points_.size())) {
    // Colours that match the points one to one need no extra vertices.
    ownVertices_ = !given_.own.empty() || !allFinite(points_) || !allFinite(colors_) ||
                   !values_.alphas.empty() || !fogCoords_.empty() ||
                   (!colors_.empty() && (!node.colorPerVertex || !node.colorIndex.empty() ||
                                         colors_.size() < points_.size()));
  }

  Mesh run() {
    const auto& index = node_.coordIndex;
    if (points_.size() >= UINT32_MAX || index.size() >= UINT32_MAX) {
      faults_.note("too many points or indices");
      return {};
    }
    uint64_t line = 0;
    for (size_t begin = 0; begin < index.size(); line++) {
      size_t end = begin;
      while (end < index.size() && index[end] != -1) end++;
      if (end > begin) readLine(begin, end, line);
      begin = end + 1;
    }
    if (mesh_.ownIndices.empty()) return {};
    mesh_.kind = Mesh::Kind::lines;
    mesh_.solid = false;
    mesh_.viewOwn();
    if (!ownVertices_) {
      mesh_.points = points_;
      if (!colors_.empty()) mesh_.colors = colors_.first(points_.size());
    }
    return std::move(mesh_);
  }

 private:
  bool sound(size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
      if (uint32_t(node_.coordIndex[i]) >= points_.size()) {
        faults_.add(Fault::indexRange, i);
        return false;
      }
      if (ownVertices_ && !isFinite(points_[size_t(node_.coordIndex[i])])) {
        faults_.add(Fault::notFinite, i);
        return false;
      }
    }
    return true;
  }

  void readLine(size_t begin, size_t end, uint64_t line) {
    if (!sound(begin, end)) return;
    uint32_t previous = 0;
    size_t previousPlace = end, segments = 0;
    for (size_t i = begin; i < end; i++) {
      // Segments of length zero are skipped.
      if (previousPlace != end &&
          points_[size_t(node_.coordIndex[previousPlace])] == points_[size_t(node_.coordIndex[i])])
        continue;
      uint32_t vertex = addVertex(i, line);
      if (previousPlace != end) {
        mesh_.ownIndices.insert(mesh_.ownIndices.end(), {previous, vertex});
        segments++;
      }
      previous = vertex;
      previousPlace = i;
    }
    if (!segments) faults_.add(Fault::fewVertices, begin);
  }

  uint32_t addVertex(size_t place, uint64_t line) {
    uint32_t point = uint32_t(node_.coordIndex[place]);
    if (!ownVertices_) return point;
    mesh_.ownPoints.push_back(points_[point]);
    if (!fogCoords_.empty()) mesh_.ownFogCoords.push_back(fogCoords_[point]);
    if (!colors_.empty()) addColor(place, point, line);
    return uint32_t(mesh_.ownPoints.size() - 1);
  }

  // Adds the colour by colorIndex if given, else by point or polyline (clause 6.24).
  void addColor(size_t place, uint32_t point, uint64_t line) {
    int64_t at = node_.colorPerVertex ? point : int64_t(line);
    if (!node_.colorIndex.empty()) {
      uint64_t where = node_.colorPerVertex ? place : line;
      at = where < node_.colorIndex.size() ? node_.colorIndex[where] : -1;
    }
    Color color{1, 1, 1};
    float alpha = 1;
    if (at < 0 || uint64_t(at) >= colors_.size()) {
      faults_.add(Fault::colorMissing, place);
    } else {
      color = isFinite(colors_[size_t(at)]) ? colors_[size_t(at)] : Color{};
      if (!values_.alphas.empty()) alpha = values_.alphas[size_t(at)];
    }
    mesh_.ownColors.push_back(color);
    if (!values_.alphas.empty()) mesh_.ownAlphas.push_back(alpha);
  }

  const Lines& node_;
  Faults& faults_;
  Coordinates given_;
  std::span<const Vec3f> points_;
  ColorValues values_;
  std::span<const Color> colors_;
  std::vector<float> fogCoords_;
  bool ownVertices_ = false;
  Mesh mesh_;
};

} // namespace

Mesh buildIndexedLineSet(const nodes::IndexedLineSet& node, const MeshOptions&, Faults& faults) {
  const Lines lines{node.coord,      node.color,          node.fogCoord,
                    node.coordIndex, node.colorPerVertex, node.colorIndex};
  return LineReader(lines, faults).run();
}

Mesh buildLineSet(const nodes::LineSet& node, const MeshOptions&, Faults& faults) {
  const size_t points = coordinates(node.coord).points.size();
  if (points >= INT32_MAX || node.vertexCount.size() >= INT32_MAX) {
    faults.note("too many points or lines");
    return {};
  }
  // The index of an IndexedLineSet of the same lines.
  MFInt32 index;
  size_t next = 0;
  bool wrong = false, missing = false;
  for (size_t i = 0; i < node.vertexCount.size(); i++) {
    const int32_t wanted = node.vertexCount[i];
    if (wanted < 2 && !std::exchange(wrong, true))
      faults.note("vertexCount[" + std::to_string(i) + "] is " + std::to_string(wanted) +
                  ", but should be 2 or more");
    if (wanted > 0 && size_t(wanted) > points - next && !std::exchange(missing, true))
      faults.note("vertexCount[" + std::to_string(i) + "] asks for " + std::to_string(wanted) +
                  " vertices where " + std::to_string(points - next) + " are left");
    const size_t end = next + std::min(size_t(std::max(wanted, 0)), points - next);
    if (wanted >= 2)
      for (size_t point = next; point < end; point++) index.push_back(int32_t(point));
    if (!index.empty() && index.back() != -1) index.push_back(-1);
    next = end;
  }
  if (node.vertexCount.empty() && points > 0) faults.note("vertexCount is empty; nothing is drawn");
  return LineReader({node.coord, node.color, node.fogCoord, index}, faults).run();
}

} // namespace xvrml
