// mapper_motion.cpp: the motion of worlds (RT_MOTION): moved Transforms, nested ones, coordinates
// that are interpolated, Billboards, merged content, and what is new.
#include <cmath>
#include <functional>
#include <map>

#include "unit/mapper_fixture.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

struct Hit {
  Vec3f position, motion;
  bool isNew() const { return std::isnan(motion.x) && std::isnan(motion.y); }
};

class MapMotion : public MapRunning {
 protected:
  static constexpr int edge = 24;

  // Shows the events sent before. Returns the hits of each Shape, by its DEF name.
  std::map<std::string, std::vector<Hit>> show() { return show(mapper_->viewpointCamera(0)); }
  std::map<std::string, std::vector<Hit>> show(const CameraSettings& camera) {
    mapper_->update(engine_->takeChanges());
    mapper_->map(camera);
    rtFrameBuffer(edge, edge, RT_RGBA | RT_NAME | RT_POSITION | RT_MOTION);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    std::vector<float> name(edge * edge), p(3 * name.size()), m(3 * name.size());
    rtReadPixels(RT_NAME, name.data(), name.size());
    rtReadPixels(RT_POSITION, p.data(), p.size());
    rtReadPixels(RT_MOTION, m.data(), m.size());
    std::map<std::string, std::vector<Hit>> hits;
    for (size_t i = 0; i < name.size(); i++)
      if (name[i] != 0)
        hits[mapper_->names().at(size_t(name[i]))].push_back(
            {{p[3 * i], p[3 * i + 1], p[3 * i + 2]}, {m[3 * i], m[3 * i + 1], m[3 * i + 2]}});
    return hits;
  }
  static void expectMotion(const std::vector<Hit>& hits,
                           const std::function<Vec3f(const Vec3f&)>& expected,
                           double tolerance = 1e-5) {
    EXPECT_FALSE(hits.empty());
    for (const Hit& hit : hits) {
      const Vec3f motion = expected(hit.position);
      EXPECT_NEAR(hit.motion.x, motion.x, tolerance);
      EXPECT_NEAR(hit.motion.y, motion.y, tolerance);
      EXPECT_NEAR(hit.motion.z, motion.z, tolerance);
    }
  }
  static void expectMotion(const std::vector<Hit>& hits, const Vec3f& expected,
                           double tolerance = 1e-6) {
    expectMotion(
        hits, [&](const Vec3f&) { return expected; }, tolerance);
  }
  static void expectNew(const std::vector<Hit>& hits) {
    EXPECT_FALSE(hits.empty());
    for (const Hit& hit : hits) EXPECT_TRUE(hit.isNew());
  }
  // A world with a Shape that nothing changes, to the left.
  static std::string rest(const std::string& body) {
    return "Viewpoint { position 0 0 12 }\nTransform { translation -3 0 0 children DEF Rest Shape "
           "{ geometry Box { } } }\nDEF I PositionInterpolator { }\n" +
           body;
  }
};

TEST_F(MapMotion, OfATransformThatIsRouted) {
  load(rest("DEF T Transform { children DEF S Shape { geometry Box { } } }\n"
            "ROUTE I.value_changed TO T.set_translation\n"));
  show();
  send("T", "set_translation", Vec3f{1, .5f, 0});
  auto hits = show();
  expectMotion(hits["S"], {1, .5f, 0});
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  hits = show();
  expectMotion(hits["S"], {0, 0, 0}, 0);
  send("T", "set_translation", Vec3f{0, .5f, -1});
  expectMotion(show()["S"], {-1, 0, -1});
}

TEST_F(MapMotion, OfNestedTransforms) {
  load(rest("DEF A Transform { children DEF B Transform { translation 1 0 0 children DEF S Shape { "
            "geometry Box { } } } }\nROUTE I.value_changed TO A.set_translation\nROUTE "
            "I.value_changed TO B.set_translation\n"));
  show();
  send("A", "set_translation", Vec3f{0, .5f, 0});
  send("B", "set_translation", Vec3f{.5f, 0, 0});
  auto hits = show();
  expectMotion(hits["S"], {-.5f, .5f, 0});
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  send("A", "set_rotation", Rotation{0, 0, 1, .5f});
  const float c = std::cos(.5f), s = std::sin(.5f);
  expectMotion(show()["S"], [&](const Vec3f& p) { // a turn about the point 0 .5 0
    const float y = p.y - .5f;
    return Vec3f{p.x - (c * p.x + s * y), y - (c * y - s * p.x), 0};
  });
}

TEST_F(MapMotion, OfCoordinatesThatAreInterpolated) {
  load(rest("DEF CI CoordinateInterpolator { key [ 0 1 ] keyValue [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 "
            "0, -1 -1 1, 1 -1 1, 1 2 1, -1 2 1 ] }\nDEF S Shape { geometry IndexedFaceSet { coord "
            "DEF C Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } coordIndex [ 0 1 2 3 "
            "-1 ] } }\nROUTE CI.value_changed TO C.set_point\n"));
  show();
  send("CI", "set_fraction", .5f);
  auto hits = show();
  // The upper edge has moved from 1 to 1.5.
  expectMotion(hits["S"], [](const Vec3f& p) {
    return Vec3f{0, p.y - ((p.y + 1) / 2.5f * 2 - 1), .5f};
  });
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  expectMotion(show()["S"], {0, 0, 0}, 0);
}

TEST_F(MapMotion, OfMergedContentThatIsWrittenAgain) {
  load(rest("ORTStatic { children [ DEF T Transform { children DEF S Shape { geometry Box { } } }\n"
            "DEF U Transform { translation 3 0 0 children DEF V Shape { geometry Sphere { } } } ] "
            "}\nROUTE I.value_changed TO T.set_translation\n"));
  show();
  for (const float x : {.5f, -.25f}) {
    const float before = x > 0 ? 0 : .5f;
    send("T", "set_translation", Vec3f{x, 0, 0});
    auto hits = show();
    expectMotion(hits["S"], {x - before, 0, 0});
    expectMotion(hits["V"], {0, 0, 0}, 0);
    expectMotion(hits["Rest"], {0, 0, 0}, 0);
  }
}

TEST_F(MapMotion, OfABillboardThatTurnsToTheCamera) {
  load(rest("Billboard { children DEF S Shape { geometry Box { } } }\n"));
  CameraSettings camera = mapper_->viewpointCamera(0);
  show(camera);
  const float angle = .3f, c = std::cos(angle), s = std::sin(angle);
  const double turned[16] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 12 * s, 0, 12 * c, 1};
  std::copy_n(turned, 16, camera.matrix);
  auto hits = show(camera);
  expectMotion(hits["S"], [&](const Vec3f& p) {
    return Vec3f{p.x - (c * p.x - s * p.z), 0, p.z - (s * p.x + c * p.z)};
  });
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  expectMotion(show(camera)["S"], {0, 0, 0}, 0);
}

TEST_F(MapMotion, WhatASwitchOrALodShowsAnewIsNew) {
  load(rest("DEF W Switch { whichChoice 0 choice [ DEF A Shape { geometry Box { } } DEF B Shape { "
            "geometry Box { } } ] }\nTransform { translation 3 0 0 children LOD { range [ 20 ] "
            "level [ DEF Near Shape { geometry Box { } } DEF Far Shape { geometry Sphere { } } ] } "
            "}\n"));
  show();
  send("W", "set_whichChoice", int32_t(1));
  auto hits = show();
  expectNew(hits["B"]);
  EXPECT_TRUE(hits["A"].empty());
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  expectMotion(hits["Near"], {0, 0, 0}, 0);
  expectMotion(show()["B"], {0, 0, 0}, 0);
  CameraSettings camera = mapper_->viewpointCamera(0);
  camera.matrix[14] = 30;
  hits = show(camera);
  expectNew(hits["Far"]);
  EXPECT_TRUE(hits["Near"].empty());
  expectMotion(hits["B"], {0, 0, 0}, 0);
}

TEST_F(MapMotion, AShapeThatNothingWasKnownToReachIsNewOnce) {
  load(rest("DEF T Transform { children DEF S Shape { geometry Box { } } }\n"));
  show();
  send("T", "set_translation", Vec3f{1, 0, 0});
  auto hits = show();
  expectNew(hits["S"]);
  expectMotion(hits["Rest"], {0, 0, 0}, 0);
  send("T", "set_translation", Vec3f{1, 1, 0});
  expectMotion(show()["S"], {0, 1, 0});
}

} // namespace
