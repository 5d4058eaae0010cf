// luminous_openings.cpp: luminaires as the camera sees them: the luminance of their openings
// against closed forms, and that they change no illuminance. Uses the C API.
#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

// Intensities fall from 100 cd at 0 degrees to 50 cd at 60 degrees and 0 cd at 90 degrees.
double candelaAt(double degrees) {
  return degrees <= 60 ? 100 - 50 * degrees / 60 : 50 * (90 - degrees) / 30;
}

class LuminousOpenings : public Sensors {
 protected:
  static constexpr Vec lampAt{0, 0, 2};

  void SetUp() override {
    Sensors::SetUp();
    rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  }
  // A luminaire that hangs at lampAt. sizes: width, length and height in metres, as IES files have
  // them. down: intensities at 0, 60, 90 and 180 degrees.
  static Shader lamp(const std::string& sizes, const std::string& down = "100 50 0 0",
                     int shown = 1) {
    Shader s("Luminaire");
    rtBindShader(s);
    rtParameterString(rtParameterHandle("profile"),
                      ("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 1 1 2 " + sizes +
                       "\n1 1 100\n0 60 90 180\n0\n" + down)
                          .c_str());
    rtBindShader(0);
    s.set("location", {lampAt.x, lampAt.y, lampAt.z}).setInt("shown", shown);
    return s;
  }
  // Returns a point at 1.5 m from the middle of the lamp, at an angle from its axis.
  static Vec eyeAt(double degrees) {
    return {1.5 * std::sin(degrees * degree), 0, lampAt.z - 1.5 * std::cos(degrees * degree)};
  }
  static Rgba seenFrom(Vec eye, Vec to = lampAt) {
    cameraAt(eye, to, 1e-4);
    return render();
  }
};

TEST_F(LuminousOpenings, ThePanelHasTheLuminanceOfItsFile) {
  use(lamp(".6 .3 0"));
  for (const double angle : {0., 30., 45., 75.}) {
    const Rgba seen = seenFrom(eyeAt(angle));
    expectGrey(seen, candelaAt(angle) / (.6 * .3 * std::cos(angle * degree)), 1e-4);
    EXPECT_FLOAT_EQ(seen.a, 1);
  }
  expectGrey(seenFrom(eyeAt(150)), 0); // nothing shines upwards
  // The opening is .3 m long towards the x axis, and .6 m wide.
  expectGrey(seenFrom({.14, .29, 0}, {.14, .29, 2}), 100 / .18, 1e-4);
  expectGrey(seenFrom({.16, .29, 0}, {.16, .29, 2}), 0);
  expectGrey(seenFrom({.14, .31, 0}, {.14, .31, 2}), 0);
}

TEST_F(LuminousOpenings, ABoxAndACylinderHaveSides) {
  const RTid box = use(lamp(".6 .3 .2"));
  for (const double angle : {30., 60.}) {
    const double sine = std::sin(angle * degree), cosine = std::cos(angle * degree);
    expectGrey(seenFrom(eyeAt(angle)), candelaAt(angle) / (.18 * cosine + .6 * .2 * sine), 1e-4);
  }
  rtRemoveLight(box);
  use(lamp("-.4 -.4 .2"));
  expectGrey(seenFrom(eyeAt(30)), candelaAt(30) / (pi * .04 * std::cos(30 * degree) + .4 * .2 * .5),
             1e-4);
  // From its side it is .2 m high.
  const double level = 75 * degree,
               side = candelaAt(75) / (pi * .04 * std::cos(level) + .4 * .2 * std::sin(level));
  const Vec middle{.2, 0, 2};
  expectGrey(seenFrom({.2 + std::sin(level), 0, 2 - std::cos(level)}, middle), side, 1e-4);
}

TEST_F(LuminousOpenings, AMirrorShowsIt) {
  use(lamp(".6 .3 0"));
  Shader mirror("Mirror");
  mirror.set("reflectance", {.5, .5, .5});
  place(square(mirror));
  // The image of the lamp lies at z = -2.
  const double angle = std::atan2(1, 3);
  expectGrey(seenFrom({1, 0, 1}, {0, 0, -2}),
             .5 * candelaAt(angle / degree) / (.18 * std::cos(angle)), 1e-4);
}

// The first surface of a ball of glass reflects R and lets 1 - R pass, and so does the second.
TEST_F(LuminousOpenings, GlassShowsIt) {
  use(lamp("4 4 0"));
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  ball(Shader("Glass"), .5);
  const double r = .04, through = (1 - r) * (1 - r) / (1 - r * r);
  const double straight = 100. / 16;
  expectGrey(seenFrom({0, 0, -3}), straight * through, .02);
}

TEST_F(LuminousOpenings, AMediumThatScattersDimsIt) {
  use(lamp(".6 .3 0"));
  Shader fog("Fog");
  fog.set("scattering", {.2, .2, .2}).set("absorption", {.1, .1, .1});
  ball(fog, 8);
  expectGrey(seenFrom({0, 0, -1}), 100 / .18 * std::exp(-3 * .3), 1e-4);
}

TEST_F(LuminousOpenings, WhatIsBeforeItHidesItAndACeilingDoesNot) {
  use(lamp(".6 .3 0"));
  placeAt({0, 0, 2}, square(matt(.5)), true); // the ceiling, in the plane of the opening
  expectGrey(seenFrom(eyeAt(30)), candelaAt(30) / (.18 * std::cos(30 * degree)), 1e-4);
  placeAt({0, 0, 1.5}, square(matt(0)), true);
  expectGrey(seenFrom(eyeAt(30)), 0);
}

TEST_F(LuminousOpenings, NoIlluminanceChanges) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  place(square(matt(.7), 3));
  placeAt({0, 0, 3}, square(matt(.7), 3), true);
  const auto readings = [](int shown) {
    const RTid used = use(lamp(".6 .6 .1", "100 50 0 0", shown));
    std::vector<Reading> all = readGrid({{0, 0, 1}, {2, 0, 0}, {0, -2, 0}, 4, 4});
    all.push_back(read({0, 0, 1}, below));
    rtRemoveLight(used);
    return all;
  };
  const std::vector<Reading> seen = readings(1), hidden = readings(0);
  for (size_t i = 0; i < seen.size(); i++) {
    EXPECT_GT(seen[i].value, 0);
    EXPECT_EQ(seen[i].value, hidden[i].value) << i;
    EXPECT_EQ(seen[i].halfWidth, hidden[i].halfWidth) << i;
  }
  // Surfaces that scatter light show the same as well.
  rtQuality(RT_MAX_DEPTH, 3);
  const auto floorAt = [](int shown) {
    const RTid used = use(lamp(".6 .6 .1", "100 50 0 0", shown));
    const float seen = seenFrom({1, 0, 1}, {1, .5, 0}).r;
    rtRemoveLight(used);
    return seen;
  };
  EXPECT_EQ(floorAt(1), floorAt(0));
}

TEST_F(LuminousOpenings, ALuminanceSensorReadsIt) {
  use(lamp(".6 .3 0"));
  expectClose(read({0, 0, 1}, up, RT_MEASURE_LUMINANCE).value, 100 / .18, 1e-4);
}

} // namespace
} // namespace numeric
