// lenses.cpp: lenses and mirrors made of analytic surfaces, against closed forms: focal lengths,
// aplanatic points, foci of conics, spherical aberration, caustics, pipes, the rainbow (D10, D12,
// D17, D18 of the accuracy catalogue). The colour of a target shows where the ray met it.
#include <functional>

#include "numeric/support.h"

namespace numeric {
namespace {

class Lenses : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
    rtQuality(RT_MAX_DEPTH, 2);
  }
  struct Place2 {
    double x, y;
  };
  // A square target of half the given edge about (x, y, z). Red and green are the place on it, blue
  // is 1, each times the transmittance of the lens.
  struct Target {
    Place2 middle;
    double z, half;
  };
  static RTid placeTarget(const Target& t) {
    const RTid object = rtBeginObject(0);
    Shader plain("VRML97");
    plain.setInt("lit", 0);
    rtBindShader(plain);
    rtBegin(RT_QUADS);
    for (const auto& c : {std::array{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
      rtColor3f(float(.5 + .5 * c[0]), float(.5 + .5 * c[1]), 1);
      rtVertex3d(t.middle.x + t.half * c[0], t.middle.y + t.half * c[1], t.z);
    }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  // Returns where on the target the ray from `from` towards `towards` arrives.
  static Place2 arrives(const Target& t, Vec from, Vec towards) {
    const RTid placed = placeTarget(t);
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(from.x, from.y, from.z, towards.x, towards.y, towards.z, .6, .8, 0);
    rtOrtho(1e-9);
    rtPopMatrix();
    const Rgba seen = render();
    rtDeleteInstance(placed);
    EXPECT_GT(seen.b, .2) << "the ray does not arrive";
    const auto along = [&](float colour) {
      return (double(colour) / double(seen.b) - .5) * 2 * t.half;
    };
    return {t.middle.x + along(seen.r), t.middle.y + along(seen.g)};
  }
  static Place2 arrivesDown(const Target& t, double x, double y = 0) {
    return arrives(t, {x, y, 4}, {x, y, 0});
  }

  // A piece of an asphere with its vertex at z. up: the front faces +z.
  static void asphere(double z, bool up, double curvature, double conic, double aperture,
                      std::initializer_list<double> terms = {}) {
    rtPushMatrix();
    rtTranslated(0, 0, z);
    (up ? rtDisable : rtEnable)(RT_CW_FRONT);
    rtAsphere(curvature, conic, terms.size(), terms.begin(), 0, aperture);
    rtDisable(RT_CW_FRONT);
    rtPopMatrix();
  }
  static RTid body(RTid shader, const std::function<void()>& draw) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    draw();
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  static Shader glass(double index = 1.5) { return Shader("Glass").set("index", {index}); }
  static Shader mirror() { return Shader("Mirror").set("reflectance", {1, 1, 1}); }
  // Finds the distance from the plane z = top at which a ray down at height h crosses the axis,
  // from two planes.
  static double crossing(double h, double top, double bottom, double half) {
    const double a = arrivesDown({{0, 0}, top, half}, h).x,
                 b = arrivesDown({{0, 0}, bottom, half}, h).x;
    return (top - bottom) * a / (a - b);
  }
};

TEST_F(Lenses, AThickLensHasTheFocalLengthOfTheLensmakersEquation) {
  constexpr double n = 1.5, r1 = 5, r2 = -8, d = 1.5;
  body(glass(n), [] {
    asphere(d, true, -1 / r1, 0, 2);  // the upper surface bulges upwards
    asphere(0, false, -1 / r2, 0, 2); // the lower one downwards
  });
  const double power = (n - 1) * (1 / r1 - 1 / r2 + (n - 1) * d / (n * r1 * r2)), f = 1 / power,
               back = f * (1 - (n - 1) * d / (n * r1));
  // The distance from the lower vertex at two heights gives the paraxial limit.
  const auto distance = [](double h) { return 1 + crossing(h, -1, -5, 2 * h); };
  const double limit = (4 * distance(.02) - distance(.04)) / 3;
  EXPECT_NEAR(limit / back, 1, 1e-5);
  // The slope behind the lens gives the focal length itself.
  const auto focal = [](double h) {
    const double a = arrivesDown({{0, 0}, -1, 2 * h}, h).x,
                 b = arrivesDown({{0, 0}, -5, 2 * h}, h).x;
    return h * 4 / (a - b);
  };
  EXPECT_NEAR((4 * focal(.02) - focal(.04)) / 3 / f, 1, 1e-5);
}

TEST_F(Lenses, TheAplanaticPointsOfASphereAreSharpAtAnyAperture) {
  constexpr double n = 1.5;
  body(glass(n), [] {
    const double c[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, low[3] = {-1, -1, -1},
                 high[3] = {1, 1, 1};
    rtQuadric(c, low, high);
  });
  rtQuality(RT_MAX_DEPTH, 1);
  // Rays that converge to n R below the centre meet at R / n below it, within the glass.
  for (const double angle : {.05, .2, .4, .55})
    for (const double turn : {0., 1., 2.5}) {
      const Vec d{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                  std::cos(angle)};
      const Place2 at =
          arrives({{0, 0}, -1 / n, .1}, {12 * d.x, 12 * d.y, -n + 12 * d.z}, {0, 0, -n});
      EXPECT_NEAR(at.x, 0, 1e-5) << angle;
      EXPECT_NEAR(at.y, 0, 1e-5) << angle;
    }
}

TEST_F(Lenses, APlanoHyperbolicLensFocusesABeamToAPoint) {
  constexpr double n = 1.5, f = 4, radius = f * (n - 1), thick = 1.2;
  body(glass(n), [] {
    asphere(thick, true, 0, 0, 2);
    asphere(0, false, 1 / radius, -n * n, 1.8);
  });
  double spot = 0;
  for (const double h : {.05, .3, .8, 1.2, 1.5, 1.7})
    for (const double turn : {0., .7, 2., 4.}) {
      const Place2 at = arrivesDown({{0, 0}, -f, .05}, h * std::cos(turn), h * std::sin(turn));
      spot = std::max(spot, std::hypot(at.x, at.y));
    }
  EXPECT_NEAR(spot, 0, 1e-5 * f);
  // A tenth before the focus the beam is a tenth as wide: the target does tell places apart.
  EXPECT_NEAR(arrivesDown({{0, 0}, -.9 * f, .2}, .5).x, .05, 1e-3);
}

TEST_F(Lenses, APolynomialThatRepeatsTheConicFocusesInTheSamePlace) {
  // A paraboloid as a sphere with even terms: z = r^2 / 2R, so a_4 = -c^3 / 8, a_6 = -c^5 / 16 ...
  constexpr double c = .25;
  body(mirror(), [] {
    asphere(0, true, c, 0, 1.5,
            {-std::pow(c, 3) / 8, -std::pow(c, 5) / 16, -5 * std::pow(c, 7) / 128,
             -7 * std::pow(c, 9) / 256, -21 * std::pow(c, 11) / 1024, -33 * std::pow(c, 13) / 2048,
             -429 * std::pow(c, 15) / 32768});
  });
  rtQuality(RT_MAX_DEPTH, 1);
  for (const double h : {.2, .6, 1., 1.4}) {
    const Place2 at = arrivesDown({{0, 0}, 1 / (2 * c), .05}, h);
    EXPECT_NEAR(at.x, 0, 1e-5 + 1e-4 * std::pow(h * c, 17)) << h;
  }
}

TEST_F(Lenses, AParabolicMirrorFocusesABeam) {
  constexpr double f = 2;
  body(mirror(), [] { asphere(0, true, 1 / (2 * f), -1, 5); });
  rtQuality(RT_MAX_DEPTH, 1);
  for (const double h : {.2, 1., 2., 3.})
    for (const double turn : {0., 1., 3.}) {
      const Place2 at = arrivesDown({{0, 0}, f, .05}, h * std::cos(turn), h * std::sin(turn));
      EXPECT_NEAR(at.x, 0, 1e-5 * f);
      EXPECT_NEAR(at.y, 0, 1e-5 * f);
    }
}

TEST_F(Lenses, D17LightFromTheFocusOfAParaboloidLeavesParallel) {
  constexpr double f = 2;
  rtPushMatrix();
  rtRotated(90, 0, 1, 0); // the axis is +x
  body(mirror(), [] { asphere(0, true, 1 / (2 * f), -1, 6); });
  rtPopMatrix();
  rtQuality(RT_MAX_DEPTH, 1);
  Shader sky("VRML97Environment"); // its colour encodes the angle from the zenith
  sky.setList("skyColor", {0, 0, 1, 1, 0, 1}).setList("skyAngle", {float(pi)});
  rtUseEnvironment(sky);
  for (const double up : {-.9, -.3, 0., .4, .8}) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(f, 0, 0, 0, up * f, .3, 0, 1, 0);
    rtOrtho(1e-9);
    rtPopMatrix();
    EXPECT_NEAR(double(render().r) * pi, pi / 2, 1e-6) << up;
  }
}

TEST_F(Lenses, D18AnEllipsoidSendsOneFocusToTheOther) {
  constexpr double a = 5, b = 3, e = 4;
  body(mirror(), [] {
    const double c[10] = {1 / (b * b), 1 / (b * b), 1 / (a * a), 0, 0, 0, 0, 0, 0, -1},
                 low[3] = {-b, -b, -a}, high[3] = {b, b, a};
    rtQuadric(c, low, high);
  });
  rtQuality(RT_MAX_DEPTH, 1);
  for (const Vec& d : {Vec{1, 0, .2}, Vec{.5, .8, -.1}, Vec{-.3, .2, 1}, Vec{.7, -.7, .5}}) {
    const Place2 at = arrives({{0, 0}, -e, .05}, {0, 0, e}, {d.x, d.y, e + d.z});
    EXPECT_NEAR(at.x, 0, 1e-5 * 2 * a);
    EXPECT_NEAR(at.y, 0, 1e-5 * 2 * a);
  }
}

TEST_F(Lenses, ASphericalMirrorHasItsAberration) {
  // A ray at height h = R sin t crosses the axis R / (2 cos t) from the centre.
  constexpr double r = 4;
  body(mirror(), [] { asphere(-r, true, 1 / r, 0, r); }); // the centre is at the origin
  rtQuality(RT_MAX_DEPTH, 1);
  for (const double t : {.05, .2, .4, .6}) {
    const double h = r * std::sin(t), from = -r / (2 * std::cos(t));
    // Two planes just below and above the crossing.
    const double a = arrivesDown({{0, 0}, from - .01, .05}, h).x,
                 b = arrivesDown({{0, 0}, from + .01, .05}, h).x;
    EXPECT_NEAR(from - .01 + .02 * a / (a - b), from, 1e-5 * r) << t;
  }
}

TEST_F(Lenses, TheCausticOfACircleIsTheNephroid) {
  // Caustic point of the rays about the angle t: (sin^3 t, -cos t (3/2 - cos^2 t)). There x is
  // extreme among the rays that meet the plane.
  body(mirror(), [] { asphere(-1, true, 1, 0, 1); });
  rtQuality(RT_MAX_DEPTH, 1);
  for (const double t : {.2, .3, .4, .5}) {
    const double x = std::pow(std::sin(t), 3), z = -std::cos(t) * (1.5 - std::cos(t) * std::cos(t));
    const Target target{{x, 0}, z, .05};
    const auto seen = [&](double angle) { return arrivesDown(target, std::sin(angle)).x; };
    constexpr double step = .02;
    const double before = seen(t - step), at = seen(t), after = seen(t + step);
    EXPECT_NEAR(at, x, 1e-5);
    EXPECT_TRUE((before > at && after > at) || (before < at && after < at));
    // The first derivative vanishes, up to the third order of the step.
    EXPECT_NEAR((after - before) / (2 * step), 0, 20 * step * step);
  }
}

TEST_F(Lenses, D12AMirroredPipeKeepsAllLightOverAHundredReflections) {
  // A ray at 45 degrees through the axis of a pipe of radius 1 meets the side every 2 along it.
  body(mirror(), [] {
    rtRotated(90, 1, 0, 0); // from the y axis to the z axis
    rtCylinder(1, -205, 5);
  });
  rtQuality(RT_MAX_DEPTH, 100);
  // Two planes between the last reflection and the next give the direction.
  const auto seenAt = [](double z) {
    const RTid placed = placeTarget({{0, 0}, z, 2});
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(0, 0, 0, 1, 0, -1, 0, 1, 0);
    rtOrtho(1e-9);
    rtPopMatrix();
    const Rgba seen = render();
    rtDeleteInstance(placed);
    EXPECT_EQ(seen.b, 1);
    return (double(seen.r) - .5) * 4;
  };
  const double first = seenAt(-199.5), last = seenAt(-200.5);
  EXPECT_NEAR(std::fabs(first - last), 1, 1e-5);
  // The triangle wave of the places; each ray starts a little inside, by its error bound.
  EXPECT_NEAR(last, .5, 1e-2);
}

TEST_F(Lenses, D10TheRainbowOfASphereIsAtItsAngle) {
  // The exit direction of a ray that is reflected once within a ball of index 1.33 turns back at
  // 42.5164 degrees. One path is followed with the hits and normals of ray queries.
  const RTid ball = rtBeginObject(0);
  const double c[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  rtBindShader(glass());
  rtQuadric(c, low, high);
  rtEndObject();
  rtBindShader(0);
  place(ball);
  rtOrtho(1);
  rtRender(); // commits
  const auto next = [](Vec& at, const Vec& d) {
    RTray ray{{float(at.x), float(at.y), float(at.z)},
              1e-4f,
              {float(d.x), float(d.y), float(d.z)},
              HUGE_VALF};
    RThit hit;
    rtCastRays(1, &ray, &hit);
    EXPECT_TRUE(std::isfinite(hit.t));
    at = {at.x + d.x * double(hit.t), at.y + d.y * double(hit.t), at.z + d.z * double(hit.t)};
    return Vec{double(hit.normal[0]), double(hit.normal[1]), double(hit.normal[2])};
  };
  const auto angleAt = [&](double h) {
    Vec at{h, 0, 5}, d{0, 0, -1};
    for (int event = 0; event < 3; event++) {
      const Vec n = next(at, d);
      const double cosine = d.x * n.x + d.y * n.y + d.z * n.z;
      if (event == 1) { // reflected
        d = {d.x - 2 * cosine * n.x, d.y - 2 * cosine * n.y, d.z - 2 * cosine * n.z};
        continue;
      }
      const double eta = event == 0 ? 1 / 1.33 : 1.33, side = cosine < 0 ? 1 : -1,
                   under = 1 - eta * eta * (1 - cosine * cosine),
                   k = -eta * cosine * side - std::sqrt(under);
      d = {eta * d.x + k * side * n.x, eta * d.y + k * side * n.y, eta * d.z + k * side * n.z};
    }
    return std::atan2(std::fabs(d.x), d.z) * 180 / pi; // from the way back to the sun
  };
  double largest = 0;
  for (double h = .84; h < .88; h += .001) largest = std::max(largest, angleAt(h));
  EXPECT_NEAR(largest, 42.5164, 1e-4 + 42.5 * 1e-6);
}

} // namespace
} // namespace numeric
