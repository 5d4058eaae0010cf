// nurbs_interpolators.cpp: the interpolators along curves and surfaces (ISO/IEC 19775-1 27.4.6,
// 27.4.8, 27.4.10) against closed forms.
#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {
namespace {

// A quarter of a circle in the plane of y and z from (0, 0, 1) to (0, 1, 0), in homogeneous points.
const std::string quarter = "controlPoint CoordinateDouble { point [ 0 0 1, 0 .70710678118654752 "
                            ".70710678118654752, 0 1 0 ] } "
                            "weight [ 1, .70710678118654752, 1 ]";

TEST(NurbsInterpolators, PositionsAreOnTheCurve) {
  Running r("DEF P NurbsPositionInterpolator { " + quarter + " }");
  const auto at = [&](float fraction) {
    r.set("P", "set_fraction", fraction);
    return std::get<SFVec3f>(r.browser.get(r.node("P"), "value_changed"));
  };
  for (const float fraction : {0.0f, 0.25f, 0.5f, 1.0f}) {
    const Vec3f p = at(fraction);
    EXPECT_NEAR(std::hypot(p.y, p.z), 1, 1e-6);
    EXPECT_EQ(p.x, 0);
  }
  EXPECT_NEAR(at(0.5f).y, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(at(-3), at(0));
  EXPECT_EQ(at(7), at(1));
}

TEST(NurbsInterpolators, OrientationsTurnZToTheTangent) {
  Running r("DEF O NurbsOrientationInterpolator { " + quarter + " }");
  r.set("O", "set_fraction", 0.0f); // the tangent is +y: a quarter of a turn about -x
  auto turn = std::get<SFRotation>(r.browser.get(r.node("O"), "value_changed"));
  EXPECT_NEAR(turn.x, -1, 1e-6);
  EXPECT_NEAR(turn.angle, M_PI / 2, 1e-6);
  r.set("O", "set_fraction", 1.0f); // -z: half a turn
  turn = std::get<SFRotation>(r.browser.get(r.node("O"), "value_changed"));
  EXPECT_NEAR(turn.angle, M_PI, 1e-5);
}

TEST(NurbsInterpolators, SurfacesGivePlacesAndUnitNormals) {
  Running r("DEF S NurbsSurfaceInterpolator { uDimension 2 vDimension 2 uOrder 2 vOrder 2 "
            "controlPoint Coordinate { point [ 0 0 0, 4 0 0, 0 2 0, 4 2 0 ] } }");
  r.set("S", "set_fraction", Vec2f{0.25f, 0.5f});
  EXPECT_EQ(std::get<SFVec3f>(r.browser.get(r.node("S"), "position_changed")), (Vec3f{1, 1, 0}));
  EXPECT_EQ(std::get<SFVec3f>(r.browser.get(r.node("S"), "normal_changed")), (Vec3f{0, 0, 1}));
}

TEST(NurbsInterpolators, WhatDoesNotFitIsSaidOnceAndSendsNothing) {
  Running r("DEF P NurbsPositionInterpolator { order 5 " + quarter + " }");
  for (int i = 0; i < 3; ++i) r.set("P", "set_fraction", 0.5f);
  EXPECT_EQ(std::get<SFVec3f>(r.browser.get(r.node("P"), "value_changed")), (Vec3f{0, 0, 0}));
  size_t said = 0;
  for (const Diagnostic& one : r.browser.world().diagnostics.list())
    said += one.message.find("order 5 needs as many") != std::string::npos;
  EXPECT_EQ(said, 1u);
}

TEST(NurbsInterpolators, ContoursAndCurvesAreAddedAndRemoved) {
  Running r("Shape { geometry DEF T NurbsTrimmedSurface { trimmingContour DEF A Contour2D { } } } "
            "Shape { geometry NurbsTrimmedSurface { trimmingContour "
            "DEF B Contour2D { children DEF C ContourPolyline2D { } } } }");
  const auto list = [&](const char* name) { return MFNode{r.browser.node(name)}; };
  r.set("T", "addTrimmingContour", list("B"));
  EXPECT_EQ(std::get<MFNode>(r.browser.get(r.node("T"), "trimmingContour")).size(), 2u);
  r.set("T", "removeTrimmingContour", list("A"));
  EXPECT_EQ(std::get<MFNode>(r.browser.get(r.node("T"), "trimmingContour")), list("B"));
  r.set("B", "removeChildren", list("C"));
  EXPECT_TRUE(std::get<MFNode>(r.browser.get(r.node("B"), "children")).empty());
}

} // namespace
} // namespace xvrml
