// sensor_scene.h: a fixture for photometric sensors (RT_MEASURE): readings at points and on grids.
// Lengths are metres, radiances cd/m2. Uses only the public C API.
#pragma once

#include "numeric/lamp_scene.h"

namespace numeric {

class Sensors : public Lamps {
 protected:
  struct Reading {
    double value = 0, halfWidth = 0;
    bool trusted = false;
  };
  // A grid of points: the middle of a plane, the edges of the plane, and how many points lie along
  // each.
  struct Grid {
    Vec middle, across, down;
    int columns = 1, rows = 1;
  };

  void SetUp() override {
    Lamps::SetUp();
    rtQuality(RT_MAX_DEPTH, 64);
    rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  }

  // Makes a frame of sensors. The normal is down x across, for luminance the direction of view.
  static std::vector<Reading> readGrid(const Grid& grid, RTenum measure = RT_MEASURE_ILLUMINANCE) {
    Vec n = cross(grid.down, grid.across);
    const double l = length(n);
    n = {n.x / l, n.y / l, n.z / l};
    const Vec u{grid.across.x / grid.columns, grid.across.y / grid.columns,
                grid.across.z / grid.columns},
        v{-grid.down.x / grid.rows, -grid.down.y / grid.rows, -grid.down.z / grid.rows};
    const double matrix[16] = {u.x,  u.y,  u.z,  0, v.x,           v.y,           v.z,           0,
                               -n.x, -n.y, -n.z, 0, grid.middle.x, grid.middle.y, grid.middle.z, 1};
    rtPushMatrix();
    rtLoadMatrixd(matrix);
    rtOrtho(grid.rows);
    rtPopMatrix();
    rtQuality(RT_MEASURE, int(measure));
    rtFrameBuffer(grid.columns, grid.rows, RT_RGBA | RT_ERROR | RT_TRUST);
    rtRender();
    const size_t count = size_t(grid.columns) * size_t(grid.rows);
    std::vector<float> rgba(4 * count), error(3 * count), trust(count);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    rtReadPixels(RT_ERROR, error.data(), error.size());
    rtReadPixels(RT_TRUST, trust.data(), trust.size());
    rtQuality(RT_MEASURE, RT_MEASURE_NOTHING);
    std::vector<Reading> out;
    for (size_t i = 0; i < count; i++) {
      EXPECT_EQ(rgba[4 * i], rgba[4 * i + 1]);
      EXPECT_EQ(rgba[4 * i], rgba[4 * i + 2]);
      out.push_back({double(rgba[4 * i]), double(error[3 * i]), trust[i] > 0});
    }
    return out;
  }
  // A sensor at one point. n: a unit vector along an axis or any other.
  static Reading read(Vec at, Vec n, RTenum measure = RT_MEASURE_ILLUMINANCE) {
    const Vec other = std::fabs(n.x) < .5 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    const Vec down = cross(other, n), across = cross(n, down);
    return readGrid({at, across, down, 1, 1}, measure)[0];
  }
  static constexpr Vec up{0, 0, 1}, below{0, 0, -1};

  // Expects the reading to be within its interval, widened from 95 % to 99.9 %, and the interval to
  // be narrow.
  static void expectReading(const Reading& got, double expected, double narrow = .01) {
    EXPECT_NEAR(got.value, expected, 1.6 * got.halfWidth + 2e-5 * expected);
    EXPECT_LT(got.halfWidth, narrow * expected);
  }

  // A black or grey quadrilateral, visible from both sides.
  static RTid quad(const Vec& a, const Vec& b, const Vec& c, const Vec& d, double reflectance = 0,
                   double radiance = 0) {
    const RTid object = rtBeginObject(0);
    rtBindShader(matt(reflectance, radiance));
    rtBegin(RT_QUADS);
    for (const Vec& p : {a, b, c, d}) rtVertex3d(p.x, p.y, p.z);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  // A point source of one intensity in all directions, in lumen.
  static Shader bulb(Vec at, double lumen) {
    Shader s("Luminaire");
    s.set("lumen", {lumen}).set("location", {at.x, at.y, at.z});
    return s;
  }
};

} // namespace numeric
