// editor_probes.cpp: Tests what probes read from pictures, and when a change counts.
#include <algorithm>

#include "csv_field.h"
#include "edit/probes.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using picture::Picture;

constexpr const char* text =
    "#VRML V2.0 utf8\n"
    "DEF WALL Shape { geometry Box { size 20 20 2 } }\n"
    "DEF SCREEN Transform { translation 100 0 3 children Shape { geometry Box { size 1 1 1 } } }\n";

// A picture of 8 x 8 pixels with one grey in all of them.
Picture grey(float luminance, float halfWidth, bool trusted = true) {
  Picture picture;
  picture.width = picture.height = 8;
  picture.planes[RT_RGBA].assign(4 * 64, luminance);
  picture.planes[RT_ERROR].assign(3 * 64, halfWidth);
  picture.planes[RT_SAMPLES].assign(64, 100);
  picture.planes[RT_TRUST].assign(64, trusted ? 1.f : 0.f);
  return picture;
}

struct ProbesOfAWall : testing::Test {
  EditedWorld world{text};
  EditView view = front();
  Probes probes;
  void read(const Picture& picture) { probes.read(world.browser, picture, view); }
};

TEST_F(ProbesOfAWall, ThePixelOfThePlaceIsRead) {
  Picture picture = grey(0, 0.5f);
  // The point (2, 1, 1) is 9 before the viewer: at (.537, .268) of the picture.
  std::fill_n(&picture.planes[RT_RGBA][4 * (2 * 8 + 6)], 3, 7.f);
  probes.add({2, 1, 1});
  EXPECT_EQ(probes.all()[0].state, Probe::State::waiting);
  read(picture);
  EXPECT_EQ(probes.all()[0].state, Probe::State::read);
  EXPECT_FLOAT_EQ(probes.all()[0].now.luminance, 7);
  EXPECT_FLOAT_EQ(probes.all()[0].now.luminanceHalfWidth, .5f);
  EXPECT_EQ(probes.all()[0].now.samples, 100u);
}

TEST_F(ProbesOfAWall, APointerSaysWhatIsSeenAndItsLight) {
  PointerReading pointer{0, 0, {}, {}};
  EXPECT_EQ(pointerText(pointer, true), "") << "nobody has looked yet";
  pointer.seen = "WALL  Shape\nnormal 0 0 1";
  EXPECT_EQ(pointerText(pointer, true), "waits for a still picture\nWALL  Shape\nnormal 0 0 1");
  EXPECT_EQ(pointerText(pointer, false), "V measures the light here\nWALL  Shape\nnormal 0 0 1");
  pointer.light = picture::readPlace(grey(200, 3), 0, 0);
  EXPECT_EQ(pointerText(pointer, true),
            "200 cd/m2 +- 1.5 %  trusted\n"
            "radiance  R 200 +- 3  G 200 +- 3  B 200 +- 3\nWALL  Shape\nnormal 0 0 1");
}

TEST_F(ProbesOfAWall, APlaceIsReadInThePixelThatHoldsIt) {
  Picture picture = grey(0, 1);
  const auto mark = [&](int x, int y) {
    std::fill_n(&picture.planes[RT_RGBA][4 * size_t(y * 8 + x)], 3, float(1 + x + 10 * y));
  };
  for (int i = 0; i < 64; ++i) mark(i % 8, i / 8);
  const auto at = [&](double x, double y) { return picture::readPlace(picture, x, y).luminance; };
  EXPECT_FLOAT_EQ(at(-1, 1), 1) << "the left upper corner";
  EXPECT_FLOAT_EQ(at(1, -1), 78) << "the right lower corner is in the last pixel";
  EXPECT_FLOAT_EQ(at(-0.26, 0.99), 3);
  EXPECT_FLOAT_EQ(at(-0.24, 0.99), 4);
}

TEST_F(ProbesOfAWall, WhatIsNotSeenIsNotRead) {
  probes.add({0, 0, 1});
  probes.add({0, 50, 1});
  probes.add({0, 0, 20});
  read(grey(1, .1f));
  EXPECT_EQ(probes.all()[0].state, Probe::State::read);
  EXPECT_EQ(probes.all()[1].state, Probe::State::outside);
  EXPECT_EQ(probes.all()[2].state, Probe::State::outside);
  world.editor.editor().set(*world.node("SCREEN"), "translation", xvrml::Vec3f{0, 0, 3});
  read(grey(1, .1f));
  EXPECT_EQ(probes.all()[0].state, Probe::State::hidden) << "something stands before it";
  world.editor.undo();
  world.editor.editor().remove({nullptr, "", 0});
  read(grey(1, .1f));
  EXPECT_EQ(probes.all()[0].state, Probe::State::hidden) << "nothing is there any more";
}

TEST_F(ProbesOfAWall, WhatIsNoLongerTrueIsNotShown) {
  probes.add({0, 0, 1});
  read(grey(10, 3));
  probes.keep();
  probes.expire();
  EXPECT_TRUE(probes.isWaiting());
  EXPECT_FALSE(probes.differences()[0]);
}

TEST_F(ProbesOfAWall, AChangeCountsWhenTheIntervalsPart) {
  probes.add({0, 0, 1});
  EXPECT_FALSE(probes.differences()[0]);
  read(grey(10, 3));
  EXPECT_FALSE(probes.differences()[0]) << "nothing was kept";
  probes.keep();
  read(grey(16, 4)); // 6 +- 5
  ASSERT_TRUE(probes.differences()[0]);
  EXPECT_FLOAT_EQ(float(probes.differences()[0]->value), 6);
  EXPECT_FLOAT_EQ(float(probes.differences()[0]->halfWidth), 5);
  EXPECT_TRUE(probes.differences()[0]->isSignificant);
  read(grey(14.9f, 4));
  EXPECT_FALSE(probes.differences()[0]->isSignificant);
  read(grey(100, 4, false));
  EXPECT_FALSE(probes.differences()[0]->isSignificant) << "not trusted";
  read(grey(10, 0));
  EXPECT_FALSE(probes.differences()[0]->isSignificant);
  view.camera.matrix[12] = .1;
  read(grey(16, 4));
  EXPECT_FALSE(probes.differences()[0]) << "another view";
}

TEST_F(ProbesOfAWall, SeveralProbesShareTheChanceOfAnError) {
  // One alone: 2.2 standard deviations are significant at 5 %. The first one among three needs 1.7
  // %.
  probes.add({0, 0, 1});
  read(grey(10, 0));
  probes.keep();
  read(grey(12.2f, 1.96f));
  EXPECT_TRUE(probes.differences()[0]->isSignificant);
  probes.add({1, 0, 1});
  probes.add({-1, 0, 1});
  read(grey(10, 0));
  probes.keep();
  read(grey(12.2f, 1.96f));
  for (const auto& one : probes.differences()) EXPECT_FALSE(one->isSignificant);
  read(grey(12.6f, 1.96f)); // 0.9 %: less than 1.7 %, and the others follow
  for (const auto& one : probes.differences()) EXPECT_TRUE(one->isSignificant);
}

TEST_F(ProbesOfAWall, TheTableHasALineForEachProbe) {
  probes.add({0, 0, 1});
  probes.add({0, 50, 1});
  probes.rename(2, "Desk, \"left\"");
  read(grey(10, 1));
  probes.keep();
  read(grey(15, 0));
  EXPECT_EQ(probes.csv(),
            "probe,x,y,z,quantity,unit,value,half_width,trusted,before,before_half_width,"
            "difference,difference_half_width,significant,left,top,width,height,"
            "least,most,uniformity,name\n"
            "1,0,0,1,luminance,cd/m2,15,0,true,10,1,5,1,true,,,,,,,,\n"
            "2,0,50,1,luminance,cd/m2,,,,,,,,,,,,,,,,\"Desk, \"\"left\"\"\"\n");
}

TEST_F(ProbesOfAWall, AProbeSaysItsName) {
  probes.add({0, 0, 1});
  EXPECT_EQ(titleOf(probes.all()[0]), "1");
  probes.rename(1, "Desk");
  probes.rename(7, "no probe has this number");
  EXPECT_EQ(titleOf(probes.all()[0]), "1 Desk");
  read(grey(200, 3));
  EXPECT_EQ(probeText(probes.all()[0], {}), "1 Desk  200 cd/m2 +- 1.5 %  trusted");
  probes.rename(1, "two\nlines\x1b");
  EXPECT_EQ(probes.all()[0].name, "two lines\\x1b");
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "\xc3\xa4";
  probes.rename(1, "x" + umlauts);
  EXPECT_EQ(probes.all()[0].name, "x" + umlauts.substr(0, 198)) << "no half character";
  probes.rename(1, "");
  EXPECT_EQ(titleOf(probes.all()[0]), "1");
}

TEST_F(ProbesOfAWall, ARectangleIsReadInItsOwnView) {
  probes.add(regionBetween(-.5, -.5, .5, .5), view);
  Picture picture = grey(10, 0);
  std::fill_n(&picture.planes[RT_RGBA][4 * (3 * 8 + 3)], 3, 2.f); // one of 4 x 4 pixels
  read(picture);
  ASSERT_EQ(probes.all()[0].state, Probe::State::read);
  EXPECT_FLOAT_EQ(probes.all()[0].now.luminance, 9.5f);
  probes.keep();
  read(grey(10, 0));
  ASSERT_TRUE(probes.differences()[0]);
  EXPECT_NEAR(probes.differences()[0]->value, .5, 1e-5);
  EXPECT_TRUE(probes.differences()[0]->isSignificant);
  EXPECT_NE(
      probes.csv().find("\n1,,,,luminance,cd/m2,10,0,true,9.5,0,0.5,0,true,2,2,4,4,10,10,1,\n"),
      std::string::npos)
      << probes.csv();
  EXPECT_NE(probeText(probes.all()[0], probes.differences()[0]).find("uniformity 1"),
            std::string::npos);
  view.camera.matrix[12] = .1;
  read(grey(10, 0));
  EXPECT_EQ(probes.all()[0].state, Probe::State::otherView);
  EXPECT_FALSE(probes.differences()[0]);
}

TEST_F(ProbesOfAWall, SensorsReadIlluminanceInAnyView) {
  const double point[3] = {0, 0, 1}, normal[3] = {0, 0, 1}, seen[3] = {0, 0, -1};
  const picture::PlacedSensor sensor = picture::sensorAt(point, normal, seen);
  const auto measure = [&](float lux, float halfWidth) {
    std::vector<picture::Measurement> readings;
    for (const picture::PlacedSensor& one : probes.waitingSensors()) {
      picture::Measurement reading;
      reading.sensor = one;
      reading.value = {lux};
      reading.halfWidth = {halfWidth};
      reading.trusted = {1};
      reading.samples = {64};
      readings.push_back(reading);
    }
    probes.take(readings);
    return readings.size();
  };
  probes.add({0, 0, 1});
  probes.addSensor(sensor);
  read(grey(10, 1));
  EXPECT_FALSE(probes.isWaiting()) << "a sensor does not wait for pictures";
  EXPECT_EQ(probes.all()[1].state, Probe::State::waiting);
  EXPECT_EQ(measure(412, 6), 1u);
  EXPECT_EQ(measure(1, 1), 0u) << "it has been read";
  EXPECT_EQ(probeText(probes.all()[1], {}), "2  412 lx +- 1.5 %  trusted");
  probes.keep();
  view.camera.matrix[12] = .1; // another view
  probes.expire();
  read(grey(10, 1));
  EXPECT_EQ(probes.all()[1].state, Probe::State::read);
  probes.expireSensors();
  EXPECT_EQ(measure(371, 5), 1u);
  const auto changes = probes.differences();
  EXPECT_FALSE(changes[0]) << "pictures of two views are not compared";
  ASSERT_TRUE(changes[1]);
  EXPECT_EQ(changes[1]->value, -41);
  EXPECT_TRUE(changes[1]->isSignificant);
  EXPECT_NE(probes.csv().find("\n2,0,0,1,illuminance,lx,371,5,true,412,6,-41,"), std::string::npos)
      << probes.csv();
  probes.clear();
  probes.addSensor(sensor);
  EXPECT_EQ(measure(5, 1), 1u);
}

TEST_F(ProbesOfAWall, ASensorOfSeveralPointsHasTheirMean) {
  const double point[3] = {0, 0, 1}, normal[3] = {0, 0, 1}, seen[3] = {0, 0, -1};
  picture::PlacedSensor sensor = picture::sensorAt(point, normal, seen);
  sensor.columns = 2;
  sensor.rows = 2;
  sensor.column[0] = sensor.row[1] = 4;
  sensor.column[1] = sensor.column[2] = sensor.row[0] = sensor.row[2] = 0;
  probes.addSensor(sensor);
  EXPECT_EQ(probes.all()[0].point, (std::array<double, 3>{2, 2, 1}));
  picture::Measurement reading;
  reading.sensor = probes.waitingSensors().at(0);
  reading.value = {100, 200, 300, 400};
  reading.halfWidth = {10, 10, 10, 10};
  reading.trusted = {1, 1, 1, 1};
  reading.samples = {64, 64, 32, 64};
  probes.take({reading});
  // Four independent errors of 10 are 20 / 4 for the mean, and 1.6 times as much to be sure.
  EXPECT_EQ(probeText(probes.all()[0], {}),
            "1  mean 250 lx +- 3.2 %  trusted  100 to 400, uniformity 0.4");
  EXPECT_EQ(probes.all()[0].now.samples, 32u);
  EXPECT_NE(probes.csv().find("1,2,2,1,illuminance,lx,250,8,true,,,,,,,,,,100,400,0.4,\n"),
            std::string::npos)
      << probes.csv();
  reading.trusted[2] = 0;
  probes.expireSensors();
  probes.take({reading});
  EXPECT_FALSE(probes.all()[0].now.trusted);
}

TEST_F(ProbesOfAWall, AReadingOfAProbeThatHasGoneIsNotThatOfTheNextOne) {
  const double point[3] = {0, 0, 1}, other[3] = {5, 0, 1}, normal[3] = {0, 0, 1},
               seen[3] = {0, 0, -1};
  probes.addSensor(picture::sensorAt(point, normal, seen));
  picture::Measurement reading;
  reading.sensor = probes.waitingSensors().at(0);
  reading.value = {412};
  reading.halfWidth = {6};
  reading.trusted = {1};
  reading.samples = {64};
  probes.clear();
  probes.addSensor(picture::sensorAt(other, normal, seen));
  probes.take({reading});
  EXPECT_EQ(probes.all()[0].state, Probe::State::waiting);
}

TEST(CsvField, FormulasGetAnApostropheAndNumbersDoNot) {
  for (const char* formula : {"=1+1", "@a", "-2+3+cmd|' /C calc'!A0", "+a", "-"})
    EXPECT_EQ(csvField(formula), "\"'" + std::string(formula) + "\"");
  for (const char* text : {"-1 0 2e-3", "+4", "Lens", "a=b", ""})
    EXPECT_EQ(csvField(text), "\"" + std::string(text) + "\"");
}

} // namespace
