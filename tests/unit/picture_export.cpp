// The parts of exports that need no world: places of nodes, colours, transforms of pictures, keys
// of animations, vertices that are not finite, names of files.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "libpicture/export/beside.h"
#include "libpicture/export/gltf/motion.h"
#include "libpicture/export/gltf/scene.h"
#include "libpicture/export/remarks.h"
#include "libpicture/export/surface.h"
#include "libpicture/export/vertices.h"
#include "libpicture/files/formats.h"

namespace {

using namespace picture;
using namespace picture::gltf;
using xvrml::Rotation;
using xvrml::Vec3f;

constexpr double pi = std::numbers::pi;

void expectNear(const Vec& a, const Vec& b, double most) {
  EXPECT_LT(length(a + b * -1.0), most)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

Vec vecOf(const Vec3f& v) { return {v.x, v.y, v.z}; }

Vec scaled(const Vec& v, const Vec& s) { return {v.x * s.x, v.y * s.y, v.z * s.z}; }

// The point by the standard's formula: T C R SR S -SR -C.
Vec byTheStandard(const TransformFields& f, Vec p) {
  const Quaternion turn = quaternionOf(f.rotation), axes = quaternionOf(f.scaleOrientation);
  p = p + vecOf(f.center) * -1.0;
  p = rotated(axes, scaled(rotated(inverse(axes), p), vecOf(f.scale)));
  return rotated(turn, p) + vecOf(f.center) + vecOf(f.translation);
}

Vec byPlaces(const Places& places, Vec p) {
  for (size_t i = places.chain.size(); i-- > 0;) {
    const Place& place = places.chain[i];
    p = rotated(place.rotation, scaled(p, place.scale)) + place.translation;
  }
  return p;
}

TEST(ExportPlaces, AreTheMatrixOfATransform) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-2, 2);
  const auto vector = [&] { return Vec3f{number(random), number(random), number(random)}; };
  const auto turn = [&] {
    return Rotation{number(random), number(random), number(random), number(random)};
  };
  for (int i = 0; i < 200; ++i) {
    TransformFields fields{vector(), vector(), vector(), turn(), turn()};
    if (i % 4 == 1) fields.scaleOrientation = {};
    if (i % 4 == 2) fields.scale = {1.5f, 1.5f, 1.5f};
    if (i % 4 == 3) fields.center = {};
    for (const bool moves : {false, true}) {
      const Places places = placesOf(fields, moves);
      for (int k = 0; k < 3; ++k) {
        const Vec p = vecOf(vector());
        expectNear(byPlaces(places, p), byTheStandard(fields, p), 1e-5);
      }
    }
  }
}

TEST(ExportPlaces, AreFewWhereFewSuffice) {
  TransformFields fields;
  fields.center = {1, 2, 3};
  fields.rotation = {0, 1, 0, 1};
  fields.scale = {2, 3, 4};
  EXPECT_EQ(placesOf(fields, false).chain.size(), 1u);
  EXPECT_EQ(placesOf(fields, true).chain.size(), 2u);
  fields.scaleOrientation = {1, 0, 0, 1};
  EXPECT_EQ(placesOf(fields, false).chain.size(), 3u);
  EXPECT_EQ(placesOf(fields, true).scaleAt, 1u);
  fields.scale = {2, 2, 2}; // alike in all directions
  EXPECT_EQ(placesOf(fields, false).chain.size(), 1u);
}

TEST(ExportPlaces, HoldFiniteNumbersAlone) {
  TransformFields fields;
  fields.translation = {NAN, 0, 0};
  EXPECT_EQ(placesOf(fields, false).chain[0].translation.x, 0);
  const Quaternion none = quaternionOf(Rotation{0, 0, 0, 1}),
                   far = quaternionOf(Rotation{0, 1, 0, INFINITY});
  EXPECT_EQ(none.w, 1);
  EXPECT_EQ(far.w, 1);
  Json node = Json::object();
  setPlace(node, {{1e300, 0, 0}, {}, {1, 1, 1}});
  EXPECT_EQ(textOf(node), "{}");
}

TEST(ExportPlaces, RotationsOfMatricesAndDirections) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> number(-3, 3);
  for (int i = 0; i < 100; ++i) {
    const Quaternion q =
        quaternionOf(Rotation{number(random), number(random), number(random), number(random)});
    double matrix[16] = {};
    const Vec columns[3] = {rotated(q, {2, 0, 0}), rotated(q, {0, 2, 0}), rotated(q, {0, 0, 2})};
    for (int c = 0; c < 3; ++c) {
      matrix[4 * c] = columns[c].x;
      matrix[4 * c + 1] = columns[c].y;
      matrix[4 * c + 2] = columns[c].z;
    }
    EXPECT_NEAR(std::abs(dot(quaternionOf(matrix), q)), 1, 1e-9);
    const Vec3f direction{number(random), number(random), number(random)};
    const Vec wanted = vecOf(direction) / length(vecOf(direction));
    expectNear(rotated(quaternionToward(direction), {0, 0, -1}), wanted, 1e-6);
  }
  expectNear(rotated(quaternionToward({0, 0, 5}), {0, 0, -1}), {0, 0, 1}, 1e-12);
}

TEST(ExportSurface, FormulasOfTheDocument) {
  EXPECT_NEAR(roughnessOfShininess(0), 1, 1e-6);
  EXPECT_NEAR(roughnessOfShininess(0.2f), 0.5188, 1e-3);
  EXPECT_NEAR(roughnessOfShininess(1), std::pow(2.0 / 130, 0.25), 1e-6);
  EXPECT_NEAR(reflectanceOf(1.5f, 0), 0.04, 1e-6);
  EXPECT_NEAR(reflectanceOf(1.35f, 7.47f), 0.913, 2e-3); // red of aluminium
  const xvrml::Color grey = linearOf({0.5f, 0, 2});
  EXPECT_NEAR(grey.r, 0.21404, 1e-5);
  EXPECT_EQ(grey.g, 0);
  EXPECT_EQ(grey.b, 1);
  EXPECT_NEAR(codeOf(grey).r, 0.5, 1e-6);
  EXPECT_EQ(linearOf({NAN, NAN, NAN}).r, 0);
}

TEST(ExportLights, CandelaAreThoseOfTheDistance) {
  // An irradiance of 1 at 2 m without attenuation.
  EXPECT_NEAR(candelaOf(1, {1, 0, 0}, 2, 1), 4, 1e-12);
  EXPECT_NEAR(candelaOf(3, {0, 0, 1}, 10, 1), 3, 1e-9);
  EXPECT_NEAR(candelaOf(3, {0, 0, 1}, 10, 0.1), 3 * 0.01, 1e-9); // in decimetres
  EXPECT_NEAR(candelaOf(1, {0, 0, 0}, 2, 1), 4, 1e-12);
}

TEST(ExportPictures, TransformsAreThoseOfTheExtension) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(0.2f, 3);
  for (int i = 0; i < 100; ++i) {
    // a rotation times scales in u v, as any TextureTransform with one of both
    const double angle = number(random), x = number(random), y = -double(number(random));
    const double c = std::cos(angle), s = std::sin(angle), e = number(random), f = number(random);
    // u v -> R S u v + o is s t -> D R S D s t + ...
    const std::array<float, 6> m = {float(c * x), float(s * x), float(-s * y),
                                    float(c * y), float(e),     float(f)};
    const auto t = textureTransformOf(m);
    ASSERT_TRUE(t);
    const double ps = number(random), pt = number(random);
    const double wantedU = m[0] * ps + m[2] * pt + m[4],
                 wantedV = 1 - (m[1] * ps + m[3] * pt + m[5]);
    const double u = ps * t->scale[0], v = (1 - pt) * t->scale[1];
    const double rc = std::cos(t->rotation), rs = std::sin(t->rotation);
    EXPECT_NEAR(rc * u + rs * v + t->offset[0], wantedU, 1e-4);
    EXPECT_NEAR(rc * v - rs * u + t->offset[1], wantedV, 1e-4);
  }
  EXPECT_FALSE(textureTransformOf({1, 0, 0.5f, 1, 0, 0})); // shear
  EXPECT_TRUE(textureTransformOf({0, 0, 0, 0, 0, 0}));
}

struct TurnMotion {
  xvrml::nodes::TimeSensor clock;
  xvrml::nodes::OrientationInterpolator turn;
  Keys keys() { return keysOf({&clock, &turn, nullptr, Path::rotation}); }
};

TEST(ExportMotion, FullTurnsGoTheirWay) {
  TurnMotion motion;
  motion.clock.cycleInterval = 8;
  motion.turn.key = {0, 0.5f, 1};
  motion.turn.keyValue = {{0, 1, 0, 0}, {0, 1, 0, float(pi)}, {0, 1, 0, float(2 * pi)}};
  const Keys keys = motion.keys();
  ASSERT_EQ(keys.times.size(), 5u);
  EXPECT_EQ(keys.width, 4u);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(keys.times[i], 2 * float(i), 1e-5);
    EXPECT_NEAR(keys.values[i][1], std::sin(pi / 4 * double(i)), 1e-5);
    EXPECT_NEAR(keys.values[i][3], std::cos(pi / 4 * double(i)), 1e-5);
  }
}

TEST(ExportMotion, KeysCoverTheCycleAndIncrease) {
  xvrml::nodes::TimeSensor clock;
  clock.cycleInterval = 10;
  xvrml::nodes::PositionInterpolator move;
  move.key = {0, 0.25f, 0.25f, 0.25f, 0.5f};
  move.keyValue = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {9, 9, 9}};
  const Keys keys = keysOf({&clock, &move, nullptr, Path::translation});
  ASSERT_EQ(keys.times.size(), 6u);
  for (size_t i = 1; i < 6; ++i) EXPECT_LT(keys.times[i - 1], keys.times[i]);
  EXPECT_NEAR(keys.times[3], 2.5, 1e-4);
  EXPECT_EQ(keys.times.back(), 10);
  EXPECT_EQ(keys.values.back()[0], 4);
  move.keyValue[0].x = NAN;
  EXPECT_TRUE(keysOf({&clock, &move, nullptr, Path::translation}).times.empty());
  clock.cycleInterval = 0;
  move.keyValue[0].x = 0;
  EXPECT_TRUE(keysOf({&clock, &move, nullptr, Path::translation}).times.empty());
}

TEST(ExportMotion, KeysOutsideOfTheCycleCutTheCurve) {
  xvrml::nodes::TimeSensor clock;
  clock.cycleInterval = 4;
  xvrml::nodes::PositionInterpolator move;
  const auto keysWith = [&](std::vector<float> key, std::vector<xvrml::Vec3f> values) {
    move.key = std::move(key);
    move.keyValue = std::move(values);
    return keysOf({&clock, &move, nullptr, Path::translation});
  };
  Keys keys = keysWith({-1, 2}, {{0, 0, 0}, {9, 0, 0}});
  EXPECT_EQ(keys.times, (std::vector<float>{0, 4}));
  EXPECT_NEAR(keys.values[0][0], 3, 1e-5);
  EXPECT_NEAR(keys.values[1][0], 6, 1e-5);
  keys =
      keysWith({0, 0.5f, 0.25f, 1}, {{0, 0, 0}, {1, 0, 0}, {7, 0, 0}, {2, 0, 0}}); // one goes back
  EXPECT_EQ(keys.times, (std::vector<float>{0, 2, 4}));
  keys = keysWith({-2, -1}, {{1, 0, 0}, {5, 0, 0}});
  EXPECT_EQ(keys.values.front()[0], 5);
  keys = keysWith({2, 3}, {{1, 0, 0}, {5, 0, 0}});
  EXPECT_EQ(keys.values.back()[0], 1);
  keys = keysWith({0, 1, 2}, {{1, 0, 0}, {2, 0, 0}, {8, 0, 0}});
  EXPECT_EQ(keys.times, (std::vector<float>{0, 4}));

  TurnMotion motion;
  motion.clock.cycleInterval = 1;
  motion.turn.key = {-1, 1};
  motion.turn.keyValue = {{0, 0, 1, 0}, {0, 0, 1, float(pi / 2)}};
  EXPECT_NEAR(motion.keys().values.front()[2], std::sin(pi / 8), 1e-6);
}

// A Hermite spline through points at equal distances is 3 t^2 - 2 t^3 where it rests at its ends.
TEST(ExportMotion, CurvesAreSampled) {
  xvrml::nodes::TimeSensor clock;
  clock.cycleInterval = 16;
  xvrml::nodes::SplinePositionInterpolator move;
  move.key = {0, 1};
  move.keyValue = {{0, 0, 0}, {1, 0, 0}};
  const Keys keys = keysOf({&clock, &move, nullptr, Path::translation});
  ASSERT_EQ(keys.times.size(), 17u);
  for (size_t i = 0; i < 17; ++i) {
    const double t = double(i) / 16;
    EXPECT_NEAR(keys.times[i], double(i), 1e-5);
    EXPECT_NEAR(keys.values[i][0], t * t * (3 - 2 * t), 1e-6);
  }
  xvrml::nodes::SquadOrientationInterpolator turn;
  turn.key = {0, 0.5f, 0.5f, 1};
  turn.keyValue = {{0, 1, 0, 0}, {0, 1, 0, 1}, {0, 1, 0, 2}, {0, 1, 0, 3}};
  const Keys turns = keysOf({&clock, &turn, nullptr, Path::rotation});
  EXPECT_EQ(turns.width, 4u);
  ASSERT_EQ(turns.times.size(), 34u); // no places between keys at one time
  EXPECT_NEAR(turns.values.back()[1], std::sin(1.5), 1e-6);
  move.key.clear();
  EXPECT_TRUE(keysOf({&clock, &move, nullptr, Path::translation}).times.empty());
}

TEST(ExportVertices, KeepWhatIsGood) {
  xvrml::GeometryArrays arrays;
  arrays.kind = xvrml::GeometryArrays::Kind::triangles;
  arrays.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {NAN, 0, 0}, {5, 5, 5}};
  arrays.indices = {0, 1, 2, 0, 1, 3, 0, 1, 9, 2, 1, 4};
  arrays.normals = {{0, 0, 2}, {0, 0, 0}, {NAN, 0, 0}, {1, 0, 0}, {0, 3, 0}};
  arrays.ccw = false;
  const Vertices vertices(arrays);
  EXPECT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices.leftOut(), 2u);
  ASSERT_EQ(vertices.indices().size(), 6u);
  EXPECT_EQ(vertices.indices()[1], 2u); // turned round
  EXPECT_EQ(vertices.point(3).x, 5);
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(length(vecOf(vertices.normal(i))), 1, 1e-6);
  arrays.indices = {0, 3, 9};
  EXPECT_TRUE(Vertices(arrays).empty());
  arrays.points = {};
  arrays.indices = {};
  EXPECT_TRUE(Vertices(arrays).empty());
}

TEST(ExportNames, AreSafeAndDiffer) {
  const auto folder = std::filesystem::temp_directory_path() / ("names" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const std::string input = (folder / "a_b_0.png").string();
  std::ofstream(input) << "x";
  NamesBeside names((folder / "a b.gltf").string(), {input});
  EXPECT_EQ(names.choose("_0", ".png"), "a_b_0_2.png"); // the world was made of the other one
  EXPECT_EQ(names.choose("", ".bin"), "a_b.bin");
  EXPECT_EQ(names.choose("", ".bin"), "a_b_2.bin");
  EXPECT_EQ(NamesBeside("x/\xff\n'.gltf", {}).choose("", ".bin"), "___.bin");
  EXPECT_EQ(NamesBeside("x/y.gltf", {}).pathOf("y.bin"), "x/y.bin");
  EXPECT_EQ(NamesBeside("model.bin", {}).choose("", ".bin"), "model_2.bin");
  EXPECT_FALSE(hasFilesBeside("-"));
  EXPECT_FALSE(hasFilesBeside("/dev/null"));
  std::filesystem::remove_all(folder);
}

TEST(ExportRemarks, CountKinds) {
  Remarks remarks;
  remarks.leaveOut("Fog");
  remarks.leaveOut("Sound");
  remarks.leaveOut("Fog");
  remarks.change("a Billboard does not turn");
  EXPECT_EQ(remarks.sentences("glTF"),
            (std::vector<std::string>{"glTF has nothing for: Fog (2 times), Sound",
                                      "a Billboard does not turn"}));
  EXPECT_TRUE(Remarks().sentences("glTF").empty());
}

TEST(ExportFormats, AreFoundBySuffix) {
  EXPECT_EQ(exportFormatOf("a/b.GLB")->suffix, "glb");
  EXPECT_EQ(exportFormatOf("b.wrl"), nullptr);
  EXPECT_EQ(exportFormatOf("folder.stl/b"), nullptr);
  EXPECT_EQ(exportFormatNamed(""), nullptr);
}

TEST(ExportFormats, PngHasAnyNumberOfComponents) {
  for (int components = 1; components <= 4; ++components) {
    const std::string png =
        pngOf(std::vector<uint8_t>(size_t(6 * components), 7), 3, 2, components);
    ASSERT_GT(png.size(), 30u);
    constexpr uint8_t types[] = {0, 4, 2, 6};
    EXPECT_EQ(uint8_t(png[25]), types[components - 1]);
  }
}

TEST(ExportDocument, TextsAreUtf8AndListsAreNotEmpty) {
  Document document;
  EXPECT_EQ(document.text("").find("nodes"), std::string::npos);
  document.addRoot(document.add("nodes", {{"name", "\xff\"a"}}));
  document.add(
      Elements{std::string("\1\2\3", 3), 3, unsignedByte, "SCALAR", noTarget, false, {}, {}});
  const Json json = Json::parse(document.text("a.bin"));
  EXPECT_EQ(json["nodes"][0]["name"], "\xef\xbf\xbd\"a");
  EXPECT_EQ(json["bufferViews"][0]["byteLength"], 3);
  EXPECT_EQ(json["buffers"][0]["byteLength"], 4);
  EXPECT_EQ(json["buffers"][0]["uri"], "a.bin");
  EXPECT_EQ(json["scenes"][0]["nodes"][0], 0);
}

} // namespace
