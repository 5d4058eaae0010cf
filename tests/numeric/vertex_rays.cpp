// vertex_rays.cpp: rays of pictures that are aimed exactly at vertices of closed meshes: no camera
// ray, no ray to a lamp, and no ray that a mirror or glass sends on leaves one (decision 54).
#include <cstdint>
#include <ostream>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int size = 96; // pixels each way
constexpr double fov = 60;

// Returns x or y, at depth 1, of the ray through the middle of a pixel.
double middleOf(int pixel) { return std::tan(fov * pi / 360) * (2 * (pixel + .5) / size - 1); }

// A closed mesh: a grid whose vertices are given for each pixel, and an apex behind it.
template <class VertexOf> RTid closedMesh(RTid shader, const VertexOf& vertexOf, Vec apex) {
  std::vector<double> points;
  const auto add = [&](Vec p) { points.insert(points.end(), {p.x, p.y, p.z}); };
  for (int y = 0; y < size; y++)
    for (int x = 0; x < size; x++) add(vertexOf(x, y));
  add(apex);
  std::vector<uint32_t> corners;
  const auto at = [](int x, int y) { return uint32_t(y * size + x); };
  for (int y = 0; y + 1 < size; y++)
    for (int x = 0; x + 1 < size; x++)
      corners.insert(corners.end(), {at(x, y), at(x + 1, y), at(x, y + 1), at(x, y + 1),
                                     at(x + 1, y), at(x + 1, y + 1)});
  const uint32_t top = uint32_t(size * size);
  constexpr int last = size - 1;
  for (int i = 0; i < last; i++) {
    corners.insert(corners.end(), {at(i + 1, 0), at(i, 0), top, at(i, last), at(i + 1, last), top});
    corners.insert(corners.end(), {at(0, i), at(0, i + 1), top, at(last, i + 1), at(last, i), top});
  }
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtVertexPointer(3, RT_DOUBLE, 0, points.data());
  rtDrawElements(RT_TRIANGLES, corners.size(), corners.data(), points.size() / 3);
  rtVertexPointer(3, RT_DOUBLE, 0, nullptr);
  rtEndObject();
  rtBindShader(0);
  return object;
}

struct Placement {
  const char* name;
  double offset, turn, scale;
  bool moving;
};
void PrintTo(const Placement& p, std::ostream* out) { *out << p.name; }

class VertexRays : public Scene, public testing::WithParamInterface<Placement> {
 protected:
  void place() {
    const Placement& p = GetParam();
    rtLoadIdentity();
    rtTranslated(p.offset, -p.offset, p.offset);
    rtRotated(p.turn, 1, 2, 3);
    rtScaled(p.scale, p.scale, p.scale);
  }
  void instantiate(RTid object) {
    const RTid instance = rtInstantiateObject(object);
    if (GetParam().moving) rtInstanceHint(instance, RT_DYNAMIC);
  }
  static Shader glowing() {
    Shader s("VRML97");
    s.setInt("lit", 1).set("emissiveColor", {1, 1, 1}).set("diffuseColor", {0, 0, 0});
    return s;
  }
  // Renders and returns how many pixels are dark, but for the border.
  static int darkPixels() {
    const std::vector<float> rgba = picture(size);
    int dark = 0;
    for (int y = 1; y + 1 < size; y++)
      for (int x = 1; x + 1 < size; x++) dark += !(rgba[size_t(4 * (y * size + x))] > .5f);
    return dark;
  }
};

TEST_P(VertexRays, NoCameraRayLeavesAClosedMesh) {
  const RTcontext own = rtGetCurrent();
  std::vector<float> first;
  for (const char* config : {"threads=1", "threads=3"}) {
    const RTcontext context = rtNewContext(config);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    place();
    rtPerspective(fov);
    instantiate(closedMesh(glowing(),
                           [](int x, int y) {
                             const double depth = 2 + .2 * std::sin(.3 * x) * std::cos(.2 * y);
                             return Vec{depth * middleOf(x), depth * middleOf(y), -depth};
                           },
                           {0, 0, 3}));
    const std::vector<float> rgba = picture(size);
    rtDeleteContext(context);
    int left = 0;
    // At the border of the grid the aim may be beside the mesh by a rounding error.
    for (int y = 1; y + 1 < size; y++)
      for (int x = 1; x + 1 < size; x++) left += rgba[size_t(4 * (y * size + x))] != 1;
    EXPECT_EQ(left, 0) << config;
    if (first.empty()) first = rgba;
    EXPECT_TRUE(rgba == first) << "the number of threads changes the picture";
  }
  rtMakeCurrent(own);
}

// The floor is within the mesh, the lamp outside. The line from the place that a pixel sees to the
// lamp passes a vertex. At the border of the picture the floor is outside of the mesh.
TEST_P(VertexRays, NoRayToALampLeavesAClosedMesh) {
  place();
  rtPerspective(fov);
  Shader floor("VRML97");
  floor.setInt("lit", 1).set("diffuseColor", {1, 1, 1});
  rtPushMatrix();
  rtTranslated(0, 0, -2);
  instantiate(square(floor));
  rtPopMatrix();
  instantiate(closedMesh(floor,
                         [](int x, int y) {
                           return Vec{middleOf(x), middleOf(y), 2};
                         },
                         {0, 0, -40}));
  use(point({0, 0, 6}, {1, 0, 0}));
  const std::vector<float> rgba = picture(size);
  int lit = 0;
  for (int y = size * 3 / 10; y < size * 7 / 10; y++)
    for (int x = size * 3 / 10; x < size * 7 / 10; x++)
      lit += rgba[size_t(4 * (y * size + x))] != 0;
  EXPECT_EQ(lit, 0);
}

// The mirror sends the ray of each pixel to a vertex.
TEST_P(VertexRays, NoRayFromAMirrorLeavesAClosedMesh) {
  place();
  rtPerspective(fov);
  Shader mirror("Mirror");
  mirror.set("reflectance", {1, 1, 1});
  rtPushMatrix();
  rtTranslated(0, 0, -1);
  instantiate(square(mirror, .7));
  rtPopMatrix();
  instantiate(closedMesh(glowing(),
                         [](int x, int y) {
                           const double way = 4 + .2 * std::sin(.3 * x) * std::cos(.2 * y);
                           return Vec{way * middleOf(x), way * middleOf(y), way - 2};
                         },
                         {0, 0, -40}));
  for (const RTenum transport : {RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    EXPECT_EQ(darkPixels(), 0);
  }
}

// A slab of glass shifts the ray of each pixel, by Snell's law, to a vertex.
TEST_P(VertexRays, NoRayThroughGlassLeavesAClosedMesh) {
  place();
  rtPerspective(fov);
  constexpr double index = 1.5, thick = .5;
  const Shader glass = Shader("Glass").set("index", {index});
  for (const bool back : {false, true}) {
    rtPushMatrix();
    rtTranslated(0, 0, back ? -1 - thick : -1);
    if (back) rtRotated(180, 1, 0, 0);
    instantiate(square(glass, .9));
    rtPopMatrix();
  }
  instantiate(closedMesh(glowing(),
                         [](int x, int y) {
                           const double mx = middleOf(x), my = middleOf(y), m = std::hypot(mx, my),
                                        sine = m / std::sqrt(1 + m * m) / index,
                                        inside = sine / std::sqrt(1 - sine * sine) / m,
                                        way = 2.5 + thick * inside +
                                              .2 * std::sin(.3 * x) * std::cos(.2 * y);
                           return Vec{way * mx, way * my, -1 - thick - (way - 1 - thick * inside)};
                         },
                         {0, 0, 3}));
  for (const RTenum transport : {RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    EXPECT_EQ(darkPixels(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Placements, VertexRays,
    testing::Values(Placement{"asItIs", 0, 0, 1, false}, Placement{"far1", 1, 0, 1, false},
                    Placement{"far1e3", 1e3, 30, 1, false}, Placement{"far1e6", 1e6, 75, 1, false},
                    Placement{"turned", 0, 40, 1, false}, Placement{"scaled", 0, 0, 3.7, false},
                    Placement{"instance", 1, 40, .3, true},
                    Placement{"farInstance", 1e6, 40, .3, true}),
    [](const auto& info) { return info.param.name; });

} // namespace
} // namespace numeric
