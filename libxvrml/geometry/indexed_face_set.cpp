// indexed_face_set.cpp: IndexedFaceSet (clause 6.23): reads faces and attribute indices from the
// node's lists.
#include <algorithm>

#include "geometry/builders.h"
#include "geometry/polygons/face_set.h"
#include "geometry/polygons/plain_triangles.h"
#include "geometry/texture_mapping.h"

namespace xvrml {
namespace {

// Gives each face or corner its value from an index list, a value list and a flag, such as
// colorIndex, color and colorPerVertex.
struct Binding {
  bool perVertex = true;
  std::span<const int32_t> index; // empty: coordIndex (per vertex), or the faces in order
  size_t values = 0;
  Fault fault = Fault::colorMissing;

  uint32_t check(int64_t value, uint64_t place, Faults& faults) const {
    if (value >= 0 && uint64_t(value) < values) return uint32_t(value);
    faults.add(fault, place);
    return noValue;
  }
  uint32_t ofFace(uint64_t face, Faults& faults) const {
    if (index.empty()) return check(int64_t(face), face, faults);
    return check(face < index.size() ? index[face] : -1, face, faults);
  }
  uint32_t ofCorner(uint64_t place, int32_t point, Faults& faults) const {
    if (index.empty()) return check(point, place, faults);
    return check(place < index.size() ? index[place] : -1, place, faults);
  }
};

template <class T> struct Bound {
  Attribute<T>& attribute;
  Binding binding;

  // Values that match the points one to one need no index.
  void start(size_t points) {
    using Per = typename Attribute<T>::Per;
    if (attribute.values.empty())
      attribute.per = Per::none;
    else if (!binding.perVertex)
      attribute.per = Per::face;
    else
      attribute.per =
          binding.index.empty() && attribute.values.size() >= points ? Per::point : Per::corner;
    binding.values = attribute.values.size();
  }
  void corner(uint64_t place, int32_t point, Faults& faults) {
    if (attribute.per == Attribute<T>::Per::corner)
      attribute.index.push_back(binding.ofCorner(place, point, faults));
  }
  void face(uint64_t face, Faults& faults) {
    if (attribute.per == Attribute<T>::Per::face)
      attribute.index.push_back(binding.ofFace(face, faults));
  }
};

class FaceReader {
 public:
  FaceReader(const nodes::IndexedFaceSet& node, FaceSet& set, Faults& faults)
      : node_(node), set_(set),
        faults_(faults), colors_{set.colors,
                                 {node.colorPerVertex, node.colorIndex, 0, Fault::colorMissing}},
        normals_{set.normals, {node.normalPerVertex, node.normalIndex, 0, Fault::normalMissing}},
        texCoords_{set.texCoords, {true, node.texCoordIndex, 0, Fault::texCoordMissing}} {
    colors_.start(set.points.size());
    normals_.start(set.points.size());
    texCoords_.start(set.points.size());
  }

  void run() {
    const auto& index = node_.coordIndex;
    set_.corners.reserve(index.size());
    set_.faceStart.reserve(index.size() / 4 + 2);
    set_.faceStart.push_back(0);
    uint64_t face = 0;
    for (size_t begin = 0; begin < index.size(); face++) {
      size_t end = begin;
      while (end < index.size() && index[end] != -1) end++;
      if (end > begin) readFace(begin, end, face);
      begin = end + 1; // the last -1 may be missing
    }
    // Two triangles at least, of which nothing says where one ends.
    set_.reportCrossed = face == 1 && index.size() >= 6 && index.back() != -1 && !repeats_;
  }

 private:
  void readFace(size_t begin, size_t end, uint64_t face) {
    const auto& index = node_.coordIndex;
    for (size_t i = begin; i < end; i++) {
      if (uint32_t(index[i]) >= set_.points.size()) { // also catches negative indices
        faults_.add(Fault::indexRange, i);
        return;
      }
    }
    // Drop repeated vertices, also a last vertex that equals the first.
    places_.clear();
    for (size_t i = begin; i < end; i++)
      if (places_.empty() || index[places_.back()] != index[i]) places_.push_back(i);
    while (places_.size() > 1 && index[places_.back()] == index[places_.front()])
      places_.pop_back();
    if (places_.size() < 3) {
      faults_.add(Fault::fewVertices, begin);
      return;
    }
    repeats_ = namesPointsAgain(index);
    if (repeats_) faults_.add(Fault::repeated, begin);
    for (size_t place : places_) {
      set_.corners.push_back(uint32_t(index[place]));
      colors_.corner(place, index[place], faults_);
      normals_.corner(place, index[place], faults_);
      texCoords_.corner(place, index[place], faults_);
    }
    colors_.face(face, faults_);
    normals_.face(face, faults_);
    set_.faceStart.push_back(uint32_t(set_.corners.size()));
    set_.faceName.push_back(uint32_t(begin));
  }

  // Returns whether more than a third of the face's points are named before in it. Faces with
  // holes, which are joined to the outline by two edges each, stay below that. Exporters forget the
  // -1 between faces; what is drawn then is garbage.
  bool namesPointsAgain(std::span<const int32_t> index) {
    if (places_.size() < 9) return false;
    named_.clear();
    for (const size_t place : places_) named_.push_back(index[place]);
    std::sort(named_.begin(), named_.end());
    const auto different = std::unique(named_.begin(), named_.end()) - named_.begin();
    return 3 * (places_.size() - size_t(different)) > places_.size();
  }

  const nodes::IndexedFaceSet& node_;
  FaceSet& set_;
  Faults& faults_;
  Bound<Color> colors_;
  Bound<Vec3f> normals_;
  Bound<Vec2f> texCoords_;
  std::vector<size_t> places_;
  std::vector<int32_t> named_;
  bool repeats_ = false; // the last face
};

// Uses the node's arrays directly if they are triangles whose points each are one vertex.
bool buildInPlace(const nodes::IndexedFaceSet& node, const FaceSet& set, const MeshOptions& options,
                  Mesh& mesh) {
  const bool normals =
                 set.normals.values.empty() || (node.normalPerVertex && node.normalIndex.empty()),
             colors = set.colors.values.empty() || (node.colorPerVertex && node.colorIndex.empty()),
             texCoords = set.texCoords.values.empty() || node.texCoordIndex.empty();
  return normals && colors && texCoords &&
         buildPlain({node.coordIndex, true, node.creaseAngle, node.solid, node.ccw}, set, options,
                    mesh);
}

} // namespace

Mesh buildIndexedFaceSet(const nodes::IndexedFaceSet& node, const MeshOptions& options,
                         Faults& faults) {
  FaceSet set;
  Coordinates given = coordinates(node.coord);
  set.takePoints(given.points, std::move(given.own));
  if (node.coordIndex.empty()) return {};
  if (set.points.size() >= noValue / 2 || node.coordIndex.size() >= noValue / 2) {
    faults.note("too many points or indices");
    return {};
  }
  ColorValues colors = colorValues(node.color);
  set.takeColors(colors.rgb, std::move(colors.own), std::move(colors.alphas));
  set.normals.values = normalVectors(node.normal);
  TexCoordValues texCoords = textureCoordinates(node.texCoord);
  set.takeTexCoords(texCoords.points, std::move(texCoords.own), std::move(texCoords.places));
  set.fogCoords = fogCoordinates(node.fogCoord, set.points.size());
  Mesh mesh;
  if (set.ownPoints.empty() && buildInPlace(node, set, options, mesh)) return mesh;

  set.solid = node.solid;
  set.ccw = node.ccw;
  set.convex = node.convex;
  set.creaseAngle = node.creaseAngle;
  FaceReader(node, set, faults).run();
  if (options.needTexCoords && set.texCoords.values.empty()) {
    set.texCoords.own = defaultTextureMapping(set.points, set.corners);
    set.texCoords.values = set.texCoords.own;
    set.texCoords.per = Attribute<Vec2f>::Per::point;
  }
  return buildFaceMesh(std::move(set), options, faults);
}

} // namespace xvrml
