// indexed_line_set.cpp: IndexedLineSet (clause 6.24): polylines as segments, with colours per
// vertex or per polyline.
#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

class LineReader {
 public:
  LineReader(const nodes::IndexedLineSet& node, Faults& faults)
      : node_(node), faults_(faults), points_(coordinates(node.coord)),
        colors_(colorValues(node.color)) {
    // Colours that match the points one to one need no extra vertices.
    ownVertices_ = !allFinite(points_) || !allFinite(colors_) ||
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
    if (!colors_.empty()) mesh_.ownColors.push_back(color(place, point, line));
    return uint32_t(mesh_.ownPoints.size() - 1);
  }

  // Returns the colour by colorIndex if given, else by point or polyline (clause 6.24).
  Color color(size_t place, uint32_t point, uint64_t line) {
    int64_t at = node_.colorPerVertex ? point : int64_t(line);
    if (!node_.colorIndex.empty()) {
      uint64_t where = node_.colorPerVertex ? place : line;
      at = where < node_.colorIndex.size() ? node_.colorIndex[where] : -1;
    }
    if (at < 0 || uint64_t(at) >= colors_.size()) {
      faults_.add(Fault::colorMissing, place);
      return {1, 1, 1};
    }
    return isFinite(colors_[size_t(at)]) ? colors_[size_t(at)] : Color{};
  }

  const nodes::IndexedLineSet& node_;
  Faults& faults_;
  std::span<const Vec3f> points_;
  std::span<const Color> colors_;
  bool ownVertices_ = false;
  Mesh mesh_;
};

} // namespace

Mesh buildIndexedLineSet(const nodes::IndexedLineSet& node, const MeshOptions&, Faults& faults) {
  return LineReader(node, faults).run();
}

} // namespace xvrml
