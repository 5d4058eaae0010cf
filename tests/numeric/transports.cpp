// transports.cpp: the automatic choice of a transport, row by row of its table
// (render/path/transport.cpp), and the light that each transport reports to leave out. A picture of
// the chosen transport agrees with path tracing; one that leaves out light is darker.
#include <functional>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr RTenum direct = RT_TRANSPORT_DIRECT, whitted = RT_TRANSPORT_WHITTED,
                 path = RT_TRANSPORT_PATH, light = RT_TRANSPORT_LIGHT;
constexpr uint32_t images = RT_LEAVES_IMAGES, between = RT_LEAVES_BETWEEN,
                   emitters = RT_LEAVES_EMITTERS, sky = RT_LEAVES_SKY,
                   caustics = RT_LEAVES_CAUSTICS;

struct Row {
  const char* name;
  std::function<void()> world;
  RTenum chosen;
  uint32_t chosenLeaves, whittedLeaves, directLeaves; // RT_LEAVES_*
  // The transport whose picture has the same mean; 0: surfaces with `shade` follow a rule of their
  // own.
  RTenum reference = path;
};
void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

class Transports : public Scene, public testing::WithParamInterface<Row> {
 public: // building blocks of the scenes
  static Shader diffuse(double reflectance, double radiance = 0) {
    Shader s("Diffuse");
    return s.set("reflectance", {reflectance, reflectance, reflectance})
        .set("emission", {radiance, radiance, radiance});
  }
  static Shader material(double emissive = 0) {
    Shader s("VRML97");
    return s.set("diffuseColor", {.5, .5, .5}).set("emissiveColor", {emissive, emissive, emissive});
  }
  static Shader unlit() {
    return Shader("VRML97").setInt("lit", 0).set("emissiveColor", {.5, .5, .5});
  }
  // A floor with a wall on it, so that light reflects from one to the other.
  static void room(const Shader& shader) {
    const RTid face = square(shader, 2);
    place(face);
    rtPushMatrix();
    rtTranslated(-1, 0, 0);
    rtRotated(90, 0, 1, 0);
    place(face);
    rtPopMatrix();
  }
  // Off centre; it sees the floor and is seen from it.
  static void tilted(const Shader& shader, double z = 1) {
    rtPushMatrix();
    rtTranslated(.7, 0, z);
    rtRotated(-40, 0, 1, 0);
    place(square(shader, .4));
    rtPopMatrix();
  }
  static void ball(const Shader& shader) { // a closed body
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(.4f);
    rtEndObject();
    rtBindShader(0);
    rtPushMatrix();
    rtTranslated(.4, 0, 1);
    place(object);
    rtPopMatrix();
  }
  static void lamp(const Shader& shader) { // faces down, out of the camera's view
    rtPushMatrix();
    rtTranslated(0, 0, 3);
    rtRotated(180, 1, 0, 0);
    place(square(shader, .5));
    rtPopMatrix();
  }
  static void point() {
    const Shader s = Scene::point({.5, .5, 2.5}, {0, 0, .3});
    use(s);
  }
  static void backdrop(double radiance) {
    Shader s("VRML97Environment");
    const float r = float(radiance);
    rtUseEnvironment(s.setList("skyColor", {r, r, r}));
  }
  static void around(double radiance) {
    Shader s("EnvironmentMap");
    rtUseEnvironment(s.set("color", {radiance, radiance, radiance}));
  }
  static Shader glass() { return Shader("Glass"); }

 protected:
  double mean(RTenum transport, int samples, int seed) {
    rtQuality(RT_TRANSPORT, int(transport));
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    rtQuality(RT_SEED, seed);
    return Scene::mean(picture(8));
  }
};

TEST_P(Transports, TheChoiceLeavesNothingOutThatPathsFind) {
  const Row& row = GetParam();
  row.world();
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(0, 0, 2.4);
  rtPerspective(50);
  rtPopMatrix();
  const double chosen = mean(RT_TRANSPORT_AUTO, 256, 1);
  EXPECT_EQ(stats().transport.chosen, row.chosen) << stats().transport.reason;
  EXPECT_EQ(stats().transport.leavesOut, row.chosenLeaves);
  EXPECT_LT(std::string(stats().transport.reason).size(), sizeof(RTtransportStats::reason) - 1)
      << "cut off";
  if (row.reference) {
    const double reference = mean(row.reference, 1024, 2);
    RTtransportInfo info{};
    info.size = sizeof info;
    ASSERT_EQ(rtGetTransportInfo(row.chosen, &info), 1);
    // Without random decisions only the sample positions differ.
    expectClose(chosen, reference, info.tracesPaths ? 2e-2 : 2e-3);
    const double plain = mean(whitted, 256, 1);
    EXPECT_EQ(stats().transport.leavesOut, row.whittedLeaves);
    if (row.whittedLeaves)
      EXPECT_LT(plain, reference * .98) << "what whitted says it leaves out is there";
    else
      expectClose(plain, reference, 2e-3);
  } else {
    mean(whitted, 1, 1);
    EXPECT_EQ(stats().transport.leavesOut, row.whittedLeaves);
  }
  mean(direct, 1, 1);
  EXPECT_EQ(stats().transport.leavesOut, row.directLeaves);
}

using T = Transports;
const Row rows[] = {
    {"AskedForGlobalLight",
     [] {
       T::room(Shader("GlobalIllumination"));
       T::point();
     },
     path, 0, between, between},
    {"DiffuseAndAnEmitter",
     [] {
       T::room(T::diffuse(.5));
       T::lamp(T::diffuse(0, 8));
     },
     path, 0, between | emitters, between | emitters},
    {"DiffuseAndAMaterialThatGlows",
     [] {
       T::room(T::diffuse(.5));
       T::lamp(T::material(8));
     },
     path, 0, between | emitters, between | emitters},
    {"DiffuseUnderABackground",
     [] {
       T::room(T::diffuse(.5));
       T::backdrop(2);
     },
     path, 0, between | sky, between | sky},
    {"DiffuseUnderABlackBackground",
     [] {
       T::room(T::diffuse(.5));
       T::backdrop(0);
     },
     whitted, 0, 0, 0},
    {"DiffuseUnderAnEnvironment",
     [] {
       T::room(T::diffuse(.5));
       T::around(5);
     },
     path, 0, between | sky, between | sky},
    {"DiffuseAndALamp",
     [] {
       T::room(T::diffuse(.5));
       T::point();
     },
     path, 0, between, between},
    {"PhongUnderABackground",
     [] {
       T::room(Shader("Phong"));
       T::backdrop(1);
     },
     path, 0, between | sky, between | sky},
    {"RoughMetalUnderABackground",
     [] {
       Shader s("Metal");
       T::room(s.set("roughness", {.3}));
       T::backdrop(1);
     },
     path, 0, between | sky, between | sky},
    {"RoughGlassUnderABackground",
     [] {
       T::ball(Shader("RoughGlass"));
       T::backdrop(1);
     },
     path, 0, between | sky, between | sky},
    {"MaterialsAndAnEmitter",
     [] {
       T::room(T::material());
       T::lamp(T::diffuse(0, 8));
     },
     path, 0, between | emitters, between | emitters},
    {"MaterialsUnderAnEnvironment",
     [] {
       T::room(T::material());
       T::around(1);
     },
     path, 0, between | sky, between | sky},
    {"MaterialsUnderABackground",
     [] {
       T::room(T::material());
       T::backdrop(1);
       T::point();
     },
     direct, between, between, between, 0},
    {"MaterialsAndAMaterialThatGlows",
     [] {
       T::room(T::material());
       T::lamp(T::material(8));
     },
     direct, between, between, between, 0},
    {"MaterialsAloneInTheDark", [] { T::room(T::material()); }, direct, 0, 0, 0},
    {"UnlitUnderAnEnvironment",
     [] {
       T::room(T::unlit());
       T::around(1);
     },
     direct, 0, 0, 0},
    {"DiffuseGlassAndAnEmitter",
     [] {
       T::room(T::diffuse(.5));
       T::ball(T::glass());
       T::lamp(T::diffuse(0, 8));
     },
     light, 0, between | emitters, images | between | emitters},
    {"DiffuseAMirrorAndALamp",
     [] {
       T::room(T::diffuse(.5));
       T::tilted(Shader("Mirror"));
       T::point();
     },
     light, caustics, between, images | between, light},
    {"DiffuseAndGlassUnderABackground", // no light source to trace light from
     [] {
       T::room(T::diffuse(.5));
       T::ball(T::glass());
       T::backdrop(1);
     },
     path, 0, between | sky, images | between | sky},
    {"MaterialsAMirrorAndALamp",
     [] {
       T::room(T::material());
       T::tilted(Shader("Mirror"));
       T::point();
     },
     whitted, between, between, images | between, 0},
    {"GlassAndAnEmitter", // an absorbing ball scatters nothing
     [] {
       T::ball(T::glass().set("absorption", {1, 2, 3}));
       T::room(T::diffuse(0, 1));
     },
     whitted, 0, 0, images},
    {"GlassUnderAnEnvironment",
     [] {
       T::ball(T::glass());
       T::around(1);
     },
     whitted, 0, 0, images},
    {"MirrorGlassAndUnlit",
     [] {
       T::tilted(Shader("Mirror"), .5);
       T::ball(Shader("Metal"));
       T::room(T::unlit());
       T::backdrop(1);
       T::point();
     },
     whitted, 0, 0, images},
    {"AnEmitterAlone", [] { T::room(T::diffuse(0, 1)); }, whitted, 0, 0, 0},
};
INSTANTIATE_TEST_SUITE_P(Table, Transports, testing::ValuesIn(rows),
                         [](const auto& info) { return std::string(info.param.name); });

class Unlisted : public Scene {};

// Geometry parameters may make a surface scatter that would not with its shader's own values.
TEST_F(Unlisted, ValuesOfAGeometryMayScatter) {
  const Shader black = Transports::diffuse(0);
  const RTid object = rtBeginObject(0);
  rtBindShader(black);
  rtBegin(RT_QUADS);
  rtNormal3f(0, 0, 1);
  const int handle = rtParameterHandle("reflectance");
  for (const auto& corner : {std::array{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
    rtParameter3f(handle, .5f, .5f, .5f);
    rtVertex3d(corner[0], corner[1], 0);
  }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  Transports::backdrop(1);
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  expectGrey(look(), .5, 1e-2);
  EXPECT_EQ(stats().transport.chosen, path);
}

// The choice is made again for each frame.
TEST_F(Unlisted, AScenesChangeChangesTheChoice) {
  place(square(Transports::diffuse(.5)));
  look();
  EXPECT_EQ(stats().transport.chosen, whitted);
  Shader sky("VRML97Environment");
  rtUseEnvironment(sky.setList("skyColor", {0, 0, 0}));
  look();
  EXPECT_EQ(stats().transport.chosen, whitted);
  sky.setList("skyColor", {1, 1, 1});
  EXPECT_GT(look().g, .3);
  EXPECT_EQ(stats().transport.chosen, path);
  sky.setList("skyColor", {0, 0, 0});
  EXPECT_EQ(look().g, 0);
  EXPECT_EQ(stats().transport.chosen, whitted);
  const RTid lamp = use(point({0, 0, 3}, {0, 0, 1}));
  look();
  EXPECT_EQ(stats().transport.chosen, path);
  rtRemoveLight(lamp);
  look();
  EXPECT_EQ(stats().transport.chosen, whitted);
}

// The search finds a small sun between the positions of the coarse scan.
TEST_F(Unlisted, ASmallSunIsSeen) {
  constexpr int width = 512, height = 256;
  std::vector<float> texels(size_t(3 * width * height), 0.0f);
  texels[3 * (200 * width + 333)] = 1000;
  RTid map = 0;
  rtGenTextures(1, &map);
  rtBindTexture(map);
  rtTexImage2D(3, width, height, RT_FLOAT, texels.data());
  rtUseEnvironment(Shader("EnvironmentMap").setTexture("texture", map));
  place(square(Transports::diffuse(.5)));
  look();
  EXPECT_EQ(stats().transport.chosen, path);
}

} // namespace
} // namespace numeric
