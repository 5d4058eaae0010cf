// cie171.cpp: the analytic cases 5.2 to 5.8 of CIE 171:2006, "Test Cases to Assess the Accuracy of
// Lighting Computer Programs", with readings of sensors. The reference values are computed here
// from the formulas that the report derives its tables from, for scenes of the report's kind.
#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

class Cie171 : public Sensors {
 protected:
  // Illuminance of a polygon of luminance 1, seen from a point with a unit normal: Lambert's
  // formula in the frame of the point (catalogue R7).
  static double illuminance(const std::vector<Vec>& shape, Vec at, Vec n) {
    const Vec other = std::fabs(n.x) < .5 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    Vec u = cross(other, n);
    const double l = length(u);
    u = {u.x / l, u.y / l, u.z / l};
    const Vec v = cross(n, u);
    std::vector<Vec> local;
    for (const Vec& p : shape) {
      const Vec d{p.x - at.x, p.y - at.y, p.z - at.z};
      local.push_back({dot(d, u), dot(d, v), dot(d, n)});
    }
    return pi * polygon(clip(local, {0, 0, 1}, 0));
  }
  static void uniformSky(double luminance) {
    Shader sky("VRML97Environment");
    const float l = float(luminance);
    sky.setList("skyColor", {l, l, l});
    rtUseEnvironment(sky);
  }
  // Fresnel's reflectance at the boundary of a medium of index n, averaged over polarisation.
  static double fresnel(double degrees, double n) {
    const double c = std::cos(degrees * degree), s = std::sin(degrees * degree) / n,
                 t = std::sqrt(1 - s * s);
    const double rs = (c - n * t) / (c + n * t), rp = (n * c - t) / (n * c + t);
    return (rs * rs + rp * rp) / 2;
  }
  // The walls and the floor of a room of 4 m x 4 m x 3 m.
  static void blackRoom() {
    quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
    quad({-2, -2, 0}, {-2, 2, 0}, {-2, 2, 3}, {-2, -2, 3});
    quad({2, -2, 0}, {2, 2, 0}, {2, 2, 3}, {2, -2, 3});
    quad({-2, 2, 0}, {2, 2, 0}, {2, 2, 3}, {-2, 2, 3});
    quad({-2, -2, 0}, {2, -2, 0}, {2, -2, 3}, {-2, -2, 3});
  }
};

// E = I cos(angle) / d^2 on the floor of a black room.
TEST_F(Cie171, Case52PointLightSource) {
  blackRoom();
  use(bulb({0, 0, 3}, 4 * pi * 1000));
  const std::vector<Reading> got = readGrid({{0, 0, 1e-4}, {4, 0, 0}, {0, -4, 0}, 4, 4});
  for (int row = 0; row < 4; row++)
    for (int column = 0; column < 4; column++) {
      const double x = column - 1.5, y = 1.5 - row, h = 3 - 1e-4;
      const double d = std::sqrt(x * x + y * y + h * h);
      expectClose(got[size_t(4 * row + column)].value, 1000 * h / (d * d * d));
    }
}

// A luminous square in the ceiling, with the form factor of a polygon on the floor and on a wall.
TEST_F(Cie171, Case53AreaLightSource) {
  blackRoom();
  const std::vector<Vec> square = rectangle(.5, 3);
  lamp(square, 1000);
  for (const double x : {0., .5, 1., 1.5}) {
    const Vec at{x, .25, 1e-3};
    expectReading(read(at, up), 1000 * illuminance(square, at, up));
  }
  for (const double z : {.5, 1.5, 2.5}) {
    const Vec at{1.999, .25, z}, inwards{-1, 0, 0};
    expectReading(read(at, inwards), 1000 * illuminance(square, at, inwards));
  }
}

// The flux that enters by an opening of 1 m x 1 m in the roof under a uniform sky, pi L A, is the
// flux that the black surfaces of the room get.
TEST_F(Cie171, Case54LuminousFluxIsConserved) {
  blackRoom();
  for (const double s : {-1., 1.}) { // the roof around the opening
    quad({-2, s * .5, 3}, {2, s * .5, 3}, {2, s * 2, 3}, {-2, s * 2, 3});
    quad({s * .5, -.5, 3}, {s * 2, -.5, 3}, {s * 2, .5, 3}, {s * .5, .5, 3});
  }
  uniformSky(1000);
  rtQuality(RT_SAMPLES_PER_PIXEL, 8192);
  const double e = 1e-4;
  const std::pair<Grid, double> surfaces[] = {
      {{{0, 0, e}, {4, 0, 0}, {0, -4, 0}, 12, 12}, 16},
      {{{2 - e, 0, 1.5}, {0, -4, 0}, {0, 0, -3}, 12, 9}, 12},
      {{{e - 2, 0, 1.5}, {0, 4, 0}, {0, 0, -3}, 12, 9}, 12},
      {{{0, 2 - e, 1.5}, {4, 0, 0}, {0, 0, -3}, 12, 9}, 12},
      {{{0, e - 2, 1.5}, {-4, 0, 0}, {0, 0, -3}, 12, 9}, 12}};
  double flux = 0;
  for (const auto& [grid, area] : surfaces) {
    const std::vector<Reading> got = readGrid(grid);
    double sum = 0;
    for (const Reading& r : got) sum += r.value;
    flux += area * sum / double(got.size());
  }
  EXPECT_NEAR(flux, 1000 * pi, .007 * 1000 * pi);
}

// Directional transmittance of a clear pane: (1 - R) / (1 + R) with all reflections inside. The
// pane is at right angles to z, and the sensor looks through it at a uniform sky.
TEST_F(Cie171, Case55DirectionalTransmittanceOfClearGlass) {
  Shader glass("Glass");
  glass.set("index", {1.52});
  const RTid face = square(glass, 1000);
  placeAt(1.006, face);
  placeAt(1, face, true);
  uniformSky(1000);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  // The pane mirrors a black floor, so that only the light that passes is measured.
  quad({-2000, -2000, -1}, {2000, -2000, -1}, {2000, 2000, -1}, {-2000, 2000, -1});
  for (const double angle : {0., 10., 20., 30., 40., 50., 60., 70.}) {
    const double r = fresnel(angle, 1.52), a = angle * degree;
    const Reading got = read({0, 0, 0}, {std::sin(a), 0, std::cos(a)}, RT_MEASURE_LUMINANCE);
    expectClose(got.value, 1000 * (1 - r) / (1 + r), 2e-3);
  }
}

// A matt patch under parallel light of 1000 lx sends rho E / pi; the illuminance at points around
// it is that times the polygon's.
TEST_F(Cie171, Case56ReflectionByADiffuseSurface) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  const double rho = .3, e = 1000;
  const std::vector<Vec> patch = rectangle(2, 0);
  quad(patch[0], patch[1], patch[2], patch[3], rho);
  Shader sun = directional({0, 0, -1});
  sun.set("intensity", {1}).set("color", {e / pi, e / pi, e / pi});
  use(sun);
  for (const double x : {0., 1., 3.}) {
    const Vec at{x, .5, 3};
    expectReading(read(at, below), rho * e / pi * illuminance(patch, at, below));
  }
  const Vec beside{3, 0, 1}, inwards{-1, 0, 0};
  expectReading(read(beside, inwards), rho * e / pi * illuminance(patch, beside, inwards));
}

// The same with a black plate that hides a part of the patch from the sensor. It is parallel to the
// light, so it casts no shadow.
TEST_F(Cie171, Case57DiffuseReflectionWithAnObstruction) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  const double rho = .5, e = 1000;
  const std::vector<Vec> patch = rectangle(2, 0);
  quad(patch[0], patch[1], patch[2], patch[3], rho);
  quad({0, -50, 1e-4}, {0, 50, 1e-4}, {0, 50, 1}, {0, -50, 1});
  Shader sun = directional({0, 0, -1});
  sun.set("color", {e / pi, e / pi, e / pi});
  use(sun);
  // Seen from (2, 0, 2) over the plate's upper edge at z = 1, the floor begins at x = -2; below the
  // plate's foot it ends at x = 0. Everything between is hidden.
  for (const double x : {1., 1.5}) {
    const Vec at{x, 0, 2};
    const double hiddenFrom = -x; // the line from (x, 2) by (0, 1) meets the floor at -x
    const double visible = illuminance(clip(patch, {1, 0, 0}, 0), at, below) +
                           illuminance(clip(patch, {-1, 0, 0}, -hiddenFrom), at, below);
    expectReading(read(at, below), rho * e / pi * visible);
  }
}

// In a closed room whose surfaces reflect alike, the interreflected illuminance is on average
// rho / (1 - rho) times the direct one, which is flux over area.
TEST_F(Cie171, Case58InternallyReflectedComponent) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  const double flux = 10000, area = 6 * 16, h = 2, e = 1e-4;
  for (const double rho : {.1, .5, .8}) {
    std::vector<RTid> walls;
    const double s[2] = {-2, 2};
    for (const double x : s) {
      walls.push_back(quad({x, -2, -2}, {x, 2, -2}, {x, 2, 2}, {x, -2, 2}, rho));
      walls.push_back(quad({-2, x, -2}, {2, x, -2}, {2, x, 2}, {-2, x, 2}, rho));
      walls.push_back(quad({-2, -2, x}, {2, -2, x}, {2, 2, x}, {-2, 2, x}, rho));
    }
    const RTid source = use(bulb({0, 0, 0}, flux));
    double sum = 0;
    const Grid faces[] = {{{0, 0, e - 2}, {4, 0, 0}, {0, -4, 0}, 6, 6},
                          {{0, 0, 2 - e}, {4, 0, 0}, {0, 4, 0}, 6, 6},
                          {{2 - e, 0, 0}, {0, -4, 0}, {0, 0, -4}, 6, 6},
                          {{e - 2, 0, 0}, {0, 4, 0}, {0, 0, -4}, 6, 6},
                          {{0, 2 - e, 0}, {4, 0, 0}, {0, 0, -4}, 6, 6},
                          {{0, e - 2, 0}, {-4, 0, 0}, {0, 0, -4}, 6, 6}};
    for (const Grid& face : faces) {
      const std::vector<Reading> got = readGrid(face);
      for (int i = 0; i < 36; i++) {
        const double u = (i % 6 + .5) * 4 / 6 - 2, v = (i / 6 + .5) * 4 / 6 - 2,
                     d = std::sqrt(u * u + v * v + h * h);
        sum += got[size_t(i)].value - flux / (4 * pi) * h / (d * d * d);
      }
    }
    EXPECT_NEAR(sum / 216, flux / area * rho / (1 - rho), .01 * flux / area * rho / (1 - rho));
    for (const RTid wall : walls) rtDeleteInstance(wall);
    rtRemoveLight(source);
  }
}

} // namespace
} // namespace numeric
