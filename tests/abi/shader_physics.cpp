// shader_physics.cpp: properties of every stock surface for all parameters: energy conservation,
// reciprocity, pdfs that match the sampling (chi-square), and finite numbers everywhere (accuracy
// catalogue A1, "BRDF checks"). The surfaces run as plug-ins in the fake host. The engine's own
// lobes are evaluated through render/surface/lobes.h.
#include <cfloat>
#include <cmath>
#include <numeric>
#include <ostream>

#include <gtest/gtest.h>

#include "../plugins/shaders/microfacet.h"
#include "abi/chi_square.h"
#include "abi/surface_at_one_hit.h"

namespace openrt::test {
namespace {

// Lobes of the engine that no stock surface uses.
struct Glossy : rts::Surface<Glossy> {
  rts::Param<float> alpha{"alpha", .3f, "width"},
      eta{"eta", 0, "index outside over inside; 0: every facet reflects all"};
  void surface(const rts::Hit&, rts::Closures& out) const {
    out.glossy({1, .5f, .25f}, alpha, eta);
  }
};

const RtsClass& classNamed(const std::string& name) {
  static const RtsClass* const glossy = rts::detail::classOf<Glossy>("Glossy");
  return name == "Glossy" ? *glossy : SurfaceAtOneHit::registry().find(name, "");
}

struct Case {
  const char* name;
  const char* shader;
  std::vector<Setting> settings;
  bool white = false; // the surface reflects all light
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Setting whiteColor{"color", {1, 1, 1}};
const std::vector<Case> cases = {
    {"Diffuse", "Diffuse", {}},
    {"DiffuseWhite", "Diffuse", {{"reflectance", {1, 1, 1}}}, true},
    {"Phong", "Phong", {}},
    {"PhongSharp", "Phong", {{"specularColor", {1, 1, 1}}, {"shininess", {4}}}},
    {"PhongFlat",
     "Phong",
     {{"diffuseColor", {0, 0, 0}}, {"specularColor", {1, 1, 1}}, {"shininess", {0}}}},
    {"PhongBroad",
     "Phong",
     {{"diffuseColor", {0, 0, 0}}, {"specularColor", {1, 1, 1}}, {"shininess", {.02f}}}},
    {"PhongMiddle",
     "Phong",
     {{"diffuseColor", {0, 0, 0}}, {"specularColor", {1, 1, 1}}, {"shininess", {.2f}}}},
    {"PhongFull", "Phong", {{"diffuseColor", {1, .5f, 0}}, {"specularColor", {1, 1, 1}}}},
    {"Mirror", "Mirror", {}},
    {"Metal", "Metal", {}},
    {"MetalRough05", "Metal", {{"roughness", {.05f}}}},
    {"MetalRough20", "Metal", {{"roughness", {.2f}}}},
    {"MetalRough50", "Metal", {{"roughness", {.5f}}}},
    {"MetalRough100", "Metal", {{"roughness", {1}}}},
    {"Reflector", "Reflector", {{"dust", {.1f}}}},
    {"ReflectorRough", "Reflector", {{"roughness", {.1f}}, {"dust", {.2f}}}},
    {"Plastic", "Plastic", {}},
    {"PlasticWhite", "Plastic", {whiteColor}, true},
    {"PlasticDense", "Plastic", {whiteColor, {"index", {2.5f}}}, true},
    {"PlasticRough10", "Plastic", {whiteColor, {"roughness", {.1f}}}, true},
    {"PlasticRough40", "Plastic", {whiteColor, {"roughness", {.4f}}}, true},
    {"PlasticRough100", "Plastic", {whiteColor, {"roughness", {1}}}, true},
    {"PlasticLacquer",
     "Plastic",
     {{"color", {.08f, .2f, .14f}}, {"transparency", {.17f}}, {"roughness", {.2f}}}},
    {"PlasticLacquerSmooth", "Plastic", {whiteColor, {"transparency", {.5f}}}},
    {"PlasticLacquerClear",
     "Plastic",
     {{"color", {0, .5f, 1}}, {"transparency", {1}}, {"roughness", {.3f}}}},
    {"Physical", "Physical", {}},
    {"PhysicalGold", "Physical", {{"baseColor", {1, .77f, .34f}}, {"roughness", {.3f}}}},
    {"PhysicalPolished", "Physical", {{"roughness", {0}}}, true},
    {"PhysicalWhite", "Physical", {{"metallic", {0}}}, true},
    {"PhysicalWhite00", "Physical", {{"metallic", {0}}, {"roughness", {0}}}, true},
    {"PhysicalWhite05", "Physical", {{"metallic", {0}}, {"roughness", {.05f}}}, true},
    {"PhysicalWhite20", "Physical", {{"metallic", {0}}, {"roughness", {.2f}}}, true},
    {"PhysicalWhite37", "Physical", {{"metallic", {0}}, {"roughness", {.37f}}}, true},
    {"PhysicalDense", "Physical", {{"metallic", {0}}, {"roughness", {.5f}}, {"ior", {3}}}, true},
    {"PhysicalNoStep", "Physical", {{"metallic", {0}}, {"roughness", {.7f}}, {"ior", {1}}}, true},
    {"PhysicalMixed",
     "Physical",
     {{"metallic", {.5f}}, {"roughness", {.4f}}, {"baseColor", {.9f, .5f, .1f}}}},
    {"PhysicalBlended",
     "Physical",
     {{"metallic", {0}}, {"roughness", {.6f}}, {"alphaMode", {2}}, {"transparency", {.3f}}},
     true},
    {"CarPaint", "CarPaint", {{"flakeSize", {.1f}}}},
    {"CarPaintFlakes",
     "CarPaint",
     {{"flakes", {1}}, {"flakeSize", {.1f}}, {"flakeColor", {1, 1, 1}}}},
    {"CarPaintWhite", "CarPaint", {{"flakes", {0}}, whiteColor}, true},
    {"Wood", "Wood", {}},
    {"WoodVarnished", "Wood", {{"varnish", {1.5f}}}},
    {"Marble", "Marble", {}},
    {"MarblePolished", "Marble", {{"polish", {1.4f}}}},
    {"Checker", "Checker", {}},
    {"CheckerCoated", "Checker", {{"coating", {1.5f}}}},
    {"Glass", "Glass", {}, true},
    {"EngineGlossy01", "Glossy", {{"alpha", {.01f}}}},
    {"EngineGlossy05", "Glossy", {{"alpha", {.05f}}, {"eta", {1 / 1.5f}}}},
    {"EngineGlossy30", "Glossy", {{"alpha", {.3f}}}},
    {"EngineGlossy100", "Glossy", {{"alpha", {1}}, {"eta", {1.5f}}}},
    {"Vrml97", "VRML97", {}},
    {"Vrml97Shiny", "VRML97", {{"specularColor", {1, .5f, .2f}}, {"shininess", {.5f}}}},
    {"Vrml97Overfull",
     "VRML97",
     {{"diffuseColor", {1, 1, 1}}, {"specularColor", {5, 5, 5}}, {"shininess", {.05f}}}},
    {"Vrml97Clear", "VRML97", {{"diffuseColor", {1, 1, 1}}, {"transparency", {.3f}}}, true},
    {"Vrml97Unlit", "VRML97", {{"lit", {0}}}},
    {"X3d", "X3DMaterial", {}},
    {"X3dShiny", "X3DMaterial", {{"specularColor", {1, .5f, .2f}}, {"shininess", {.5f}}}},
    {"X3dOverfull",
     "X3DMaterial",
     {{"diffuseColor", {1, 1, 1}}, {"specularColor", {5, 5, 5}}, {"shininess", {.05f}}}},
    {"X3dClear", "X3DMaterial", {{"diffuseColor", {1, 1, 1}}, {"transparency", {.3f}}}, true},
    {"X3dOpaque",
     "X3DMaterial",
     {{"diffuseColor", {1, 1, 1}}, {"transparency", {.3f}}, {"alphaMode", {0}}},
     true},
    {"X3dMasked",
     "X3DMaterial",
     {{"diffuseColor", {1, 1, 1}}, {"transparency", {.9f}}, {"alphaMode", {1}}},
     true},
    {"X3dUnfilled", "X3DMaterial", {{"filled", {0}}}, true},
    {"X3dTwoSided",
     "X3DMaterial",
     {{"twoSided", {1}}, {"backDiffuseColor", {1, 1, 1}}, {"backTransparency", {1}}}},
    {"X3dUnlit", "X3DMaterial", {{"lit", {0}}}},
    {"X3dMirror",
     "X3DMaterial",
     {{"mirror", {1}}, {"diffuseColor", {1, 1, 1}}, {"specularColor", {1, 1, 1}}}},
    {"X3dUnlitMirror", "X3DMaterial", {{"mirror", {1}}, {"lit", {0}}}},
    {"GlobalIllumination",
     "GlobalIllumination",
     {{"specularColor", {.5f, .5f, .5f}}, {"transparency", {.5f}}}},
    {"Fog", "Fog", {}},
    {"RoughGlass", "RoughGlass", {{"roughness", {.05f}}}},
    {"RoughGlass40", "RoughGlass", {{"roughness", {.4f}}}},
    {"RoughGlass100", "RoughGlass", {{"roughness", {1}}}},
};

const rts::Vec3 places[] = {{.013f, .021f, .003f}, {.37f, 1.21f, .4f}, {-2.3f, .11f, 5.7f}};

class ShaderPhysics : public testing::TestWithParam<Case> {
 protected:
  SurfaceAtOneHit surface{classNamed(GetParam().shader), GetParam().settings};
};

// Returns the light that a white environment reflects to the eye. Lobes with a single direction
// contribute their weight. The others contribute the integral of their values, estimated with their
// own samples. Light that crossed the boundary was scaled by eta^2; this is undone.
rts::Color furnace(const std::vector<LobeAtHit>& lobes, int side) {
  rts::Color all;
  for (const LobeAtHit& lobe : lobes) {
    if (!lobe.scatters()) {
      all = all + lobe.weight();
      continue;
    }
    double sum[3] = {};
    const float eta = lobe.kind() == RTS_LOBE_ROUGH_DIELECTRIC ? lobe.lobe->parameter[0][0] : 1;
    for (int a = 0; a < side; a++)
      for (int b = 0; b < side; b++) {
        // Shifted by an irrational part of a cell, so that a choice by further digits does not
        // align with the grid.
        const float u = (float(a) + .5f) / float(side),
                    v = (float(b) + std::fmod(.618034f * float(a * side + b), 1.f)) / float(side);
        const rts::Sample s = lobe.sample({u, v});
        if (!(s.density > 0)) continue;
        const double clear = rts::dot(s.direction, lobe.normal()) < 0 ? 1 / (double(eta) * eta) : 1;
        sum[0] += clear * s.quotient.r;
        sum[1] += clear * s.quotient.g;
        sum[2] += clear * s.quotient.b;
      }
    const double n = double(side) * side;
    all = all + lobe.weight() * rts::Color{float(sum[0] / n), float(sum[1] / n), float(sum[2] / n)};
  }
  return all;
}

TEST_P(ShaderPhysics, ReflectsNoMoreThanItGets) {
  for (int k = 0; k < 64; k++) {
    const double angle = k == 63 ? 89.9 : 90.0 * k / 63;
    const rts::Color all = furnace(surface.lobes(towards(angle, 37 * k), places[k % 3]), 64);
    const bool white = GetParam().white;
    for (float c : {all.r, all.g, all.b}) {
      EXPECT_LE(c, 1 + 1e-3f) << angle << " degrees";
      if (white) { EXPECT_NEAR(c, 1, 1e-3f) << angle << " degrees"; }
    }
  }
}

// f = weight x value / cosine is reciprocal. Light through boundaries obeys another law (scaled by
// the square of the index) and is tested with the engine's lobes.
TEST_P(ShaderPhysics, TheWayBackIsTheSame) {
  Random random(7);
  int compared = 0;
  for (int k = 0; k < 10000; k++) {
    const auto direction = [&] {
      const float z = std::fmax(.02f, random()), phi = 2 * rts::pi * random(),
                  s = std::sqrt(1 - z * z);
      return rts::Vec3{s * std::cos(phi), s * std::sin(phi), z};
    };
    const rts::Vec3 a = direction(), b = direction(), place = places[k % 3];
    struct Answer {
      rts::Color f;
      rts::Vec3 normal;
    };
    const auto answers = [&](rts::Vec3 eye, rts::Vec3 light) {
      std::vector<Answer> all;
      for (const LobeAtHit& lobe : surface.lobes(eye, place)) {
        if (!lobe.scatters()) continue;
        const float cosine = rts::dot(light, lobe.normal());
        all.push_back({cosine > 0 ? lobe.weight() * lobe.value(light) / cosine : rts::Color{},
                       lobe.normal()});
      }
      return all;
    };
    const std::vector<Answer> there = answers(a, b), back = answers(b, a);
    ASSERT_EQ(there.size(), back.size());
    for (size_t l = 0; l < there.size(); l++) {
      const rts::Vec3 n = there[l].normal;
      if (rts::length(n - back[l].normal) > 0 || rts::dot(a, n) < .01f || rts::dot(b, n) < .01f)
        continue; // a flake that faces away
      compared++;
      const float f = there[l].f.g, g = back[l].f.g;
      ASSERT_NEAR(f, g, 1e-5f * std::fmax(std::fmax(f, g), 1e-3f))
          << "pair " << k << ", lobe " << l;
    }
  }
  if (compared == 0) GTEST_SKIP() << "no lobe that scatters";
}

const float viewAngles[] = {0, 35, 70, 85};

// Chi-square test with 80 x 160 bins of the sphere.
TEST_P(ShaderPhysics, SamplesFallAsTheirDensitySays) {
  // Sidak correction: 1 % for all tests together
  const double level = 1 - std::pow(1 - .01, 1.0 / (double(cases.size()) * 8));
  int tested = 0;
  for (const float angle : viewAngles) {
    const std::vector<LobeAtHit> lobes = surface.lobes(towards(angle, 20), places[0]);
    for (size_t l = 0; l < lobes.size(); l++) {
      if (!lobes[l].scatters()) continue;
      tested++;
      Random random(uint64_t(100 * angle) + l);
      double lost = 0;
      SphereHistogram seen(lobes[l].normal());
      const int n = 100000;
      for (int k = 0; k < n; k++) {
        const float u = random(), v = random();
        const rts::Sample s = lobes[l].sample({u, v});
        if (s.density > 0)
          seen.count(s.direction);
        else
          lost++;
      }
      const auto density = [&](rts::Vec3 d) {
        float p = 0;
        lobes[l].value(d, &p);
        return double(p);
      };
      const Expected expected = seen.expect(density);
      EXPECT_NEAR(expected.total + lost / n, 1, 4 * std::sqrt(lost / n / n) + 2e-3)
          << "lobe " << l << " at " << angle;
      const double p = seen.chiSquareTail(expected, n, lost);
      EXPECT_GT(p, level) << "lobe " << l << " at " << angle << " degrees";
    }
  }
  if (tested == 0) GTEST_SKIP() << "no lobe that scatters";
}

TEST_P(ShaderPhysics, QuotientsAreValuesOverDensities) {
  for (const float angle : {0.f, 50.f, 80.f, 89.f}) {
    const std::vector<LobeAtHit> lobes = surface.lobes(towards(angle, 110), places[1]);
    for (const LobeAtHit& lobe : lobes) {
      if (!lobe.scatters()) continue;
      Random random(3);
      for (int k = 0; k < 1000; k++) {
        const float u = random(), v = random();
        const rts::Sample s = lobe.sample({u, v});
        if (!(s.density > 0)) continue;
        EXPECT_NEAR(rts::length(s.direction), 1, 1e-5);
        if (std::fabs(rts::dot(s.direction, lobe.normal())) < 1e-3f)
          continue; // rounding of the cosine dominates
        float density = 0;
        const rts::Color value = lobe.value(s.direction, &density);
        ASSERT_NEAR(density, s.density, 5e-3f * s.density) << angle << " degrees, sample " << k;
        ASSERT_NEAR(value.g, s.quotient.g * s.density, 5e-3f * std::fmax(value.g, 1e-3f))
            << angle << " degrees, sample " << k;
      }
    }
  }
}

TEST_P(ShaderPhysics, EverythingIsFinite) {
  const rts::Vec3 extremes[] = {{1, 0, 0},        {0, -1, 0},       {0, 0, 1}, {0, 0, -1},
                                towards(89.9999), towards(90.0001), {0, 0, 0}};
  const auto finite = [](rts::Color c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
  };
  for (const rts::Vec3 eye : extremes)
    for (const rts::Vec3 place : {rts::Vec3{0, 0, 0}, rts::Vec3{1e30f, -1e30f, 3e9f}})
      for (const LobeAtHit& lobe : surface.lobes(eye, place)) {
        EXPECT_TRUE(finite(lobe.weight()));
        EXPECT_NEAR(rts::length(lobe.normal()), 1, 1e-5);
        if (!lobe.scatters()) continue;
        for (const rts::Vec3 d : extremes) {
          float density = 0;
          EXPECT_TRUE(finite(lobe.value(d, &density)))
              << d.x << " " << d.y << " " << d.z << " from " << eye.x << " " << eye.z;
          EXPECT_TRUE(std::isfinite(density) && density >= 0);
        }
        for (const float u : {0.f, .5f, 1 - 0x1p-24f})
          for (const float v : {0.f, .5f, 1 - 0x1p-24f}) {
            const rts::Sample s = lobe.sample({u, v});
            EXPECT_TRUE(std::isfinite(s.density) && s.density >= 0) << u << " " << v;
            if (s.density > 0) { EXPECT_TRUE(finite(s.quotient)) << u << " " << v; }
          }
      }
}

// Between polished and rough, where pdfs are of the order of 1e7.
TEST(Facets, NearlyPolishedIsFinite) {
  for (const char* shader : {"Metal", "Physical", "Plastic", "Reflector", "RoughGlass"})
    for (const float roughness : {0.f, 1e-30f, 1e-4f, 1.01e-4f, 1e-3f}) {
      SurfaceAtOneHit surface(shader, {{"roughness", {roughness}}});
      for (const float angle : {0.f, 45.f, 89.99f, 90.f}) {
        const rts::Color all = furnace(surface.lobes(towards(angle)), 16);
        EXPECT_TRUE(all.g >= 0 && all.g <= 1 + 1e-3f)
            << shader << " " << roughness << " at " << angle << ": " << all.g;
      }
      // Nearly polished must equal polished.
      SurfaceAtOneHit polished(shader, {{"roughness", {0}}});
      const float smooth = furnace(polished.lobes(towards(45)), 16).g,
                  nearly = furnace(surface.lobes(towards(45)), 16).g;
      EXPECT_NEAR(nearly, smooth, 6e-3f) << shader << " " << roughness;
    }
}

// For light that crosses a rough boundary f(a, b) / n_a^2 is the same in both directions (E. Veach,
// "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 5.2), seen from outside or
// inside.
TEST(RoughBoundary, TheWayBackIsTheSameScaledByTheIndices) {
  for (const float roughness : {.1f, .4f, 1.f}) {
    SurfaceAtOneHit surface("RoughGlass", {{"roughness", {roughness}}});
    Random random(11);
    int compared = 0;
    for (int k = 0; k < 3000; k++) {
      const auto direction = [&] {
        const float z = std::fmax(.05f, random()), phi = 2 * rts::pi * random(),
                    s = std::sqrt(1 - z * z);
        return rts::Vec3{s * std::cos(phi), s * std::sin(phi), z};
      };
      const rts::Vec3 out = direction(), in = direction(); // on opposite sides
      const auto mirrored = [](rts::Vec3 v) { return rts::Vec3{v.x, v.y, -v.z}; };
      const float there = surface.lobes(out)[0].value(mirrored(in)).g / in.z;
      const float back = surface.lobes(in, {}, true)[0].value(mirrored(out)).g / out.z;
      if (there == 0 && back == 0) continue;
      compared++;
      const float f = there, g = back / (1.5f * 1.5f);
      // Floats of narrow lobes: the rounding of a microfacet's normal is about 1e-7, which the
      // distribution magnifies by 1 / roughness.
      ASSERT_NEAR(f, g, (1e-5f + 2e-6f / roughness) * std::fmax(std::fmax(f, g), 1e-2f))
          << roughness << " pair " << k;
    }
    EXPECT_GT(compared, 300) << roughness;
  }
}

// The microfacets visible from a direction cover exactly the visible surface. This is the weak
// white furnace of E. Heitz (JCGT 3(2), 2014, eq. 53): with facets that reflect everything, before
// masking of the reflected light, the integral of D G1 / (4 cos o) over all mirror directions is 1,
// including those below the horizon.
TEST(Facets, WeakWhiteFurnace) {
  for (const float alpha : {.02f, .1f, .3f, .6f, 1.f})
    for (const float angle : {0.f, 30.f, 60.f, 80.f, 89.f}) {
      const microfacet::Ggx ggx{alpha};
      const rts::Vec3 o = towards(angle);
      double sum = 0;
      const int across = 2000, around = 128;
      // Tangents of the facets' angles, distributed by u, which crowds them towards steep ones.
      for (int i = 0; i < across; i++) {
        const double w = 1 - (i + .5) / across, tangent = alpha * std::sqrt((1 - w * w) / (w * w));
        const double c = 1 / std::sqrt(1 + tangent * tangent);
        const double s = tangent * c;
        double ring = 0;
        for (int j = 0; j < around; j++) {
          const double phi = 2 * M_PI * (j + .5) / around;
          const rts::Vec3 h{float(s * std::cos(phi)), float(s * std::sin(phi)), float(c)};
          const double seen = std::max(0.f, rts::dot(o, h));
          ring += ggx.seen(o, h) * 4 * seen /
                  // Pdf of the mirror directions divided by that of these points.
                  (ggx.facets(h) * c);
        }
        sum += ring * 2 * w / around / across;
      }
      EXPECT_NEAR(sum, 1, 2e-3) << alpha << " at " << angle;
    }
}

// The highlight of ISO/IEC 14772-1 keeps its brightness: with the light in the mirror direction
// both give OS, here times N.L.
TEST(Vrml97Lobes, AHighlightIsAsBrightAsTheStandardSays) {
  for (const float shininess : {0.f, .02f, .2f, 1.f}) {
    SurfaceAtOneHit surface("VRML97", {{"diffuseColor", {0, 0, 0}},
                                       {"specularColor", {.4f, .2f, .1f}},
                                       {"shininess", {shininess}}});
    for (const float angle : {0.f, 30.f, 60.f}) {
      rts::Color sum;
      for (const LobeAtHit& lobe : surface.lobes(towards(angle)))
        if (lobe.scatters())
          sum = sum + lobe.weight() * lobe.value(towards(-angle)) *
                          rts::pi; // a light's colour is radiance
      const float cosine = std::cos(angle * rts::pi / 180);
      EXPECT_NEAR(sum.r, .4f * cosine, 1e-4f) << shininess << " at " << angle;
      EXPECT_NEAR(sum.b, .1f * cosine, 1e-4f) << shininess << " at " << angle;
    }
  }
}

TEST(Vrml97Lobes, EmissionAndOpacity) {
  SurfaceAtOneHit surface("GlobalIllumination",
                          {{"emissiveColor", {2, 1, 0}}, {"transparency", {.25f}}});
  const std::vector<LobeAtHit> lobes = surface.lobes({0, 0, 1});
  EXPECT_FLOAT_EQ(surface.emission().r, 1.5f);
  EXPECT_FLOAT_EQ(surface.emission().g, .75f);
  ASSERT_EQ(lobes.size(), 2u);
  EXPECT_EQ(lobes[0].kind(), RTS_LOBE_DIFFUSE);
  EXPECT_FLOAT_EQ(lobes[0].weight().r, .6f);
  EXPECT_EQ(lobes[1].kind(), RTS_LOBE_TRANSPARENT);
  EXPECT_FLOAT_EQ(lobes[1].weight().r, .25f);
  const RtsClass& c = surface.shaderClass();
  EXPECT_EQ(c.traits(&surface.host(), surface.params()),
            unsigned(RTS_GLOBAL | RTS_TRANSPARENT | RTS_EMISSIVE | RTS_UNIFORM_EMISSION));
  EXPECT_EQ(c.shade, nullptr);
}

INSTANTIATE_TEST_SUITE_P(Stock, ShaderPhysics, testing::ValuesIn(cases),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace openrt::test
