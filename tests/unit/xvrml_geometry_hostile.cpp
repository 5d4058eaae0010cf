// xvrml_geometry_hostile.cpp: geometry nodes filled with random nonsense from a fixed seed.
// Building them never crashes; every index is in range, every number finite, and there is at most
// one warning.
#include <random>

#include "unit/mesh_checks.h"

namespace xvrml::test {
namespace {

class Chaos {
 public:
  explicit Chaos(uint32_t seed) : engine_(seed) {}

  int below(int n) { return int(engine_() % uint32_t(n)); }
  bool chance(int percent) { return below(100) < percent; }

  float number() {
    if (chance(3)) {
      static constexpr float odd[] = {NAN,      INFINITY, -INFINITY, 0.f,   -0.f,       1e38f,
                                      -3.4e38f, 1e-38f,   1e-45f,    1e20f, 16777216.f, -1e-20f};
      return odd[below(int(std::size(odd)))];
    }
    if (chance(40)) return float(below(5) - 2); // makes equal values likely
    return float(int32_t(engine_())) / 1e9f;
  }
  Vec3f vector() { return {number(), number(), number()}; }

  MFVec3f vectors(int most) {
    MFVec3f result(size_t(below(most)));
    for (Vec3f& v : result) v = vector();
    return result;
  }
  MFVec2f vectors2(int most) {
    MFVec2f result(size_t(below(most)));
    for (Vec2f& v : result) v = {number(), number()};
    return result;
  }
  MFColor colors(int most) {
    MFColor result(size_t(below(most)));
    for (Color& c : result) c = {number(), number(), number()};
    return result;
  }
  MFRotation rotations(int most) {
    MFRotation result(size_t(below(most)));
    for (Rotation& r : result) r = {number(), number(), number(), number()};
    return result;
  }
  MFInt32 indices(int most, int points) {
    MFInt32 result(size_t(below(most)));
    for (int32_t& i : result) {
      i = chance(20) ? -1 : below(points + 1);
      if (chance(1)) i = int32_t(engine_());
    }
    return result;
  }

 private:
  std::mt19937 engine_;
};

template <class T> void fillFaces(Made<T>& node, Chaos& chaos, int points) {
  if (chaos.chance(50)) node->color = color(chaos.colors(points + 3));
  if (chaos.chance(50)) node->normal = normal(chaos.vectors(points + 3));
  if (chaos.chance(50)) node->texCoord = textureCoordinate(chaos.vectors2(points + 3));
  node->colorPerVertex = chaos.chance(50);
  node->normalPerVertex = chaos.chance(50);
  node->ccw = chaos.chance(50);
  node->solid = chaos.chance(50);
  node->creaseAngle = chaos.chance(50) ? chaos.number() : 0;
}

template <class T> void check(Made<T>& node, Chaos& chaos) {
  Built built = build(node, chaos.chance(50));
  expectSound(built.mesh);
  EXPECT_LE(built.diagnostics.list().size(), 1u);
}

TEST(GeometryHostile, IndexedFaceSet) {
  for (uint32_t seed = 0; seed < 1500 && !testing::Test::HasFailure(); seed++) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    int points = 1 + chaos.below(60);
    Made<nodes::IndexedFaceSet> node("IndexedFaceSet");
    MFVec3f coordinates = chaos.vectors(points);
    if (chaos.chance(40)) // flat, so that faces intersect themselves
      for (Vec3f& p : coordinates) p.z = 0;
    node->coord = coordinate(coordinates);
    node->coordIndex = chaos.indices(300, int(coordinates.size()));
    fillFaces(node, chaos, points);
    if (chaos.chance(50)) node->colorIndex = chaos.indices(300, points);
    if (chaos.chance(50)) node->normalIndex = chaos.indices(300, points);
    if (chaos.chance(50)) node->texCoordIndex = chaos.indices(300, points);
    node->convex = chaos.chance(50);
    check(node, chaos);
  }
}

TEST(GeometryHostile, LargeSelfCrossingFaces) {
  for (uint32_t seed = 0; seed < 12; seed++) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    Made<nodes::IndexedFaceSet> node("IndexedFaceSet");
    MFVec3f points(size_t(20 + 30 * seed));
    for (Vec3f& p : points)
      p = {float(chaos.below(1000)), float(chaos.below(1000)), chaos.chance(10) ? 1.f : 0.f};
    for (size_t i = 0; i < points.size(); i++) node->coordIndex.push_back(int32_t(i));
    node->coord = coordinate(points);
    node->creaseAngle = 1;
    node->convex = false;
    check(node, chaos);
  }
}

TEST(GeometryHostile, ElevationGrid) {
  for (uint32_t seed = 0; seed < 800; seed++) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    Made<nodes::ElevationGrid> node("ElevationGrid");
    node->xDimension = chaos.below(12) - 1;
    node->zDimension = chaos.below(12) - 1;
    node->height.resize(size_t(chaos.below(130)));
    for (float& h : node->height) h = chaos.number();
    if (chaos.chance(50)) node->xSpacing = chaos.number();
    if (chaos.chance(50)) node->zSpacing = chaos.number();
    fillFaces(node, chaos, 60);
    check(node, chaos);
  }
}

TEST(GeometryHostile, Extrusion) {
  for (uint32_t seed = 0; seed < 1500; seed++) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    Made<nodes::Extrusion> node("Extrusion");
    if (chaos.chance(80)) node->spine = chaos.vectors(20);
    if (chaos.chance(80)) node->crossSection = chaos.vectors2(20);
    if (chaos.chance(30) && !node->spine.empty()) node->spine.push_back(node->spine[0]);
    if (chaos.chance(30) && !node->crossSection.empty())
      node->crossSection.push_back(node->crossSection[0]);
    if (chaos.chance(60)) node->scale = chaos.vectors2(20);
    if (chaos.chance(60)) node->orientation = chaos.rotations(20);
    node->creaseAngle = chaos.chance(50) ? chaos.number() : 0;
    node->convex = chaos.chance(50);
    node->ccw = chaos.chance(50);
    node->beginCap = chaos.chance(70);
    node->endCap = chaos.chance(70);
    check(node, chaos);
  }
}

TEST(GeometryHostile, LinesAndPoints) {
  for (uint32_t seed = 0; seed < 800; seed++) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    int points = 1 + chaos.below(30);
    Made<nodes::IndexedLineSet> node("IndexedLineSet");
    node->coord = coordinate(chaos.vectors(points));
    node->coordIndex = chaos.indices(100, points);
    if (chaos.chance(60)) node->color = color(chaos.colors(points + 3));
    if (chaos.chance(50)) node->colorIndex = chaos.indices(100, points);
    node->colorPerVertex = chaos.chance(50);
    check(node, chaos);
    Made<nodes::PointSet> cloud("PointSet");
    cloud->coord = node->coord;
    cloud->color = node->color;
    check(cloud, chaos);
  }
}

TEST(GeometryHostile, PropertyNodesOfTheWrongType) {
  Made<nodes::IndexedFaceSet> node("IndexedFaceSet");
  Made<nodes::Box> box("Box");
  node->coord = box;
  node->color = box;
  node->normal = box;
  node->texCoord = box;
  node->coordIndex = {0, 1, 2, -1};
  Built built = build(node);
  EXPECT_EQ(built.mesh.kind, Mesh::Kind::empty);
  EXPECT_EQ(built.diagnostics.warnings(), 1u);
  Made<nodes::Text> text("Text");
  text->string = {"x"};
  text->fontStyle = box;
  expectSound(build(text).mesh);
}

} // namespace
} // namespace xvrml::test
