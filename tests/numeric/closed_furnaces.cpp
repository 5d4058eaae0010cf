// closed_furnaces.cpp: light in closed meshes of many vertices, with mirrors and glass inside. No
// ray leaves, whatever it met before: the sky outside is so bright that a single ray that leaves
// would show (decision 54).
#include <cstdint>
#include <map>
#include <ostream>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr double sky = 1e6;

struct Mesh {
  std::vector<double> points;
  std::vector<uint32_t> corners;
};

// Returns a closed sphere of radius 1 about the origin: 10 * 4^levels + 2 vertices.
Mesh icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                          {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                          {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<uint32_t> corners{0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < levels; level++) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [found, made] = middles.try_emplace(std::minmax(a, b), uint32_t(points.size()));
      if (made) {
        const Vec p = points[a], q = points[b];
        points.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
      }
      return found->second;
    };
    std::vector<uint32_t> finer;
    for (size_t t = 0; t < corners.size(); t += 3) {
      const uint32_t a = corners[t], b = corners[t + 1], c = corners[t + 2], ab = middle(a, b),
                     bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    corners = std::move(finer);
  }
  Mesh mesh{{}, std::move(corners)};
  for (const Vec& p : points) {
    const double size = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    mesh.points.insert(mesh.points.end(), {p.x / size, p.y / size, p.z / size});
  }
  return mesh;
}

// Returns the surface of a cube from -1 to 1, each side cut into n * n squares with shared
// vertices.
Mesh cube(int n) {
  Mesh mesh;
  std::map<std::array<int, 3>, uint32_t> numbers;
  const auto at = [&](std::array<int, 3> p) {
    const auto [found, made] = numbers.try_emplace(p, uint32_t(numbers.size()));
    if (made)
      for (const int x : p) mesh.points.push_back(2.0 * x / n - 1);
    return found->second;
  };
  for (int axis = 0; axis < 3; axis++)
    for (const int side : {0, n})
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> p{};
            p[size_t(axis)] = side;
            p[size_t(axis + 1) % 3] = u;
            p[size_t(axis + 2) % 3] = v;
            return at(p);
          };
          const uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                         d = corner(i, j + 1);
          mesh.corners.insert(mesh.corners.end(), {a, b, c, a, c, d});
        }
  return mesh;
}

struct Case {
  const char* name;
  bool round;
  double offset;
  bool moving;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class ClosedFurnaces : public Scene, public testing::WithParamInterface<Case> {
 protected:
  void SetUp() override {
    Scene::SetUp();
    Shader outside("VRML97Environment");
    outside.setList("skyColor", {float(sky), float(sky), float(sky)});
    rtUseEnvironment(outside);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    const double offset = GetParam().offset;
    rtTranslated(offset, -offset, offset);
  }
  static RTid object(const Mesh& mesh, RTid shader) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtVertexPointer(3, RT_DOUBLE, 0, mesh.points.data());
    rtDrawElements(RT_TRIANGLES, mesh.corners.size(), mesh.corners.data(), mesh.points.size() / 3);
    rtVertexPointer(3, RT_DOUBLE, 0, nullptr);
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  // Places a body at x, scaled.
  static void put(RTid object, Vec at, double scale, bool moving) {
    rtPushMatrix();
    rtTranslated(at.x, at.y, at.z);
    rtScaled(scale, scale, scale);
    const RTid placed = rtInstantiateObject(object);
    if (moving) rtInstanceHint(placed, RT_DYNAMIC);
    rtPopMatrix();
  }
  static Shader matt(double reflectance, double radiance) {
    Shader s("Diffuse");
    s.set("reflectance", {reflectance, reflectance, reflectance})
        .set("emission", {radiance, radiance, radiance});
    return s;
  }
  // Places a room with walls of this shader, and in it a mirror and a piece of glass.
  static void furnish(RTid walls) {
    const Case& c = GetParam();
    put(object(c.round ? icosphere(6) : cube(40), walls), {}, 3, c.moving);
    Shader mirror("Mirror");
    mirror.set("reflectance", {1, 1, 1});
    put(object(c.round ? icosphere(5) : cube(20), mirror), {-.8, 0, -1.5}, .6, c.moving);
    put(object(c.round ? icosphere(5) : cube(20), Shader("Glass")), {.8, 0, -1.5}, .6, c.moving);
    rtPerspective(100);
  }
};

// A room without lamps is black, to the last bit. Millions of rays look for its holes: those of the
// camera, of mirrors and glass, of random bounces, and those to the sky.
TEST_P(ClosedFurnaces, NoLightComesIn) {
  furnish(matt(.9, 0));
  rtQuality(RT_MAX_DEPTH, 8);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  const std::vector<float> rgba = picture(96);
  int lit = 0;
  for (size_t i = 0; i < rgba.size(); i += 4) lit += rgba[i] != 0;
  EXPECT_EQ(lit, 0);
  const RTstats s = stats();
  EXPECT_GT(s.rays.secondary + s.rays.shadow, 1'000'000u);
}

// The light of a furnace is e / (1 - a), whatever mirrors and glass do with it. Light that glass
// keeps within by total reflection is in balance, too, but takes more reflections than are
// followed.
TEST_P(ClosedFurnaces, NoLightIsLost) {
  if (!GetParam().round) return; // a cube of glass keeps light within by total reflection
  const double emission = .5, albedo = .5;
  furnish(matt(albedo, emission));
  rtQuality(RT_MAX_DEPTH, 100);
  rtQuality(RT_SAMPLES_PER_PIXEL, 36);
  EXPECT_NEAR(mean(picture(32)), emission / (1 - albedo), 4e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Rooms, ClosedFurnaces,
    testing::Values(Case{"ball", true, 0, false}, Case{"ballAt1e3", true, 1e3, false},
                    Case{"ballAt1e6", true, 1e6, false}, Case{"cube", false, 0, false},
                    Case{"movingBallAt1e3", true, 1e3, true}, Case{"movingCube", false, 0, true}),
    [](const auto& info) { return info.param.name; });

} // namespace
} // namespace numeric
