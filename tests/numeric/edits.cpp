// edits.cpp: edits build as few acceleration structures as expected, and their effect is visible:
// against closed forms and against the same scene made static. edit_sequences.cpp compares
// sequences of edits with scenes made at once.
#include "numeric/support.h"

namespace numeric {
namespace {

struct Matrix {
  double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};
Matrix at(double x, double y = 0, double z = 0, double scale = 1) {
  return {{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, x, y, z, 1}};
}

class Edits : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    use(tilted(0));
  }
  // Renders and returns the number of acceleration structures built.
  struct Built {
    uint64_t objects, topLevels;
    bool operator==(const Built&) const = default;
    friend void PrintTo(const Built& b, std::ostream* out) {
      *out << b.objects << " objects, " << b.topLevels << " top levels";
    }
  };
  Built built() {
    rtRender();
    const RTstats now = stats();
    const Built result{now.bvh.objectBuilds - last_.bvh.objectBuilds,
                       now.bvh.topLevelBuilds - last_.bvh.topLevelBuilds};
    last_ = now;
    return result;
  }
  static RTid placeAt(RTid object, const Matrix& m, RTenum hint = RT_STATIC) {
    const RTid id = rtInstantiateObject(object);
    rtInstanceMatrix(id, m.m);
    rtInstanceHint(id, hint);
    return id;
  }
  static void move(RTid instance, const Matrix& m) { rtInstanceMatrix(instance, m.m); }
  // Three squares side by side; the camera looks at the middle one.
  RTid threeSquares(RTenum hint) {
    const RTid s = square(Shader("VRML97"), 1);
    placeAt(s, at(-4));
    const RTid middle = placeAt(s, at(0), hint);
    placeAt(s, at(4));
    return middle;
  }

 private:
  RTstats last_{};
};

TEST_F(Edits, MovingADynamicInstanceBuildsTheTopLevelOnly) {
  const RTid instance = threeSquares(RT_DYNAMIC);
  expectGrey(look(), .8);
  built();
  for (int i = 1; i < 5; i++) {
    move(instance, at(0, 3 * i));
    EXPECT_EQ(built(), (Built{0, 1}));
    expectGrey(look(0, 3 * i), .8);
    expectGrey(look(), 0);
    built();
  }
}

TEST_F(Edits, AStaticInstanceBecomesDynamicOnce) {
  const RTid instance = threeSquares(RT_STATIC);
  expectGrey(look(), .8);
  built();
  move(instance, at(0, 3));
  // The static scene without the square, and the square's own structure.
  EXPECT_EQ(built(), (Built{2, 1}));
  expectGrey(look(0, 3), .8);
  built();
  move(instance, at(0, 6));
  EXPECT_EQ(built(), (Built{0, 1}));
}

TEST_F(Edits, RedefiningADynamicObjectBuildsItAlone) {
  threeSquares(RT_STATIC);
  const RTid object = square(Shader("VRML97"), 1);
  rtObjectHint(object, RT_DYNAMIC);
  for (int i = 0; i < 3; i++) placeAt(object, at(4 * i, 8));
  built();
  const auto redefine = [&](double half) {
    rtBeginObject(object);
    rtBegin(RT_QUADS);
    rtVertex3d(-half, -half, 0);
    rtVertex3d(half, -half, 0);
    rtVertex3d(half, half, 0);
    rtVertex3d(-half, half, 0);
    rtEnd();
    rtEndObject();
  };
  redefine(1); // the hint takes effect here
  built();
  expectGrey(look(5.5, 8), 0);
  built();
  redefine(1.8);
  EXPECT_EQ(built(), (Built{1, 1}));
  expectGrey(look(5.5, 8), .8);
  expectGrey(look(9.5, 8), .8);
  expectGrey(look(5.5, 0), 0);
}

TEST_F(Edits, WhatIsNoGeometryBuildsNothing) {
  Shader s("VRML97");
  const RTid plane = place(square(s));
  placeAt(square(s, 1), at(0, 0, 3), RT_DYNAMIC);
  look();
  built();
  s.set("diffuseColor", {.5, .5, .5});
  EXPECT_EQ(built(), (Built{0, 0}));
  expectGrey(look(), .5);
  built();
  const RTid lamp = use(tilted(60));
  EXPECT_EQ(built(), (Built{0, 0}));
  expectGrey(look(), .75);
  rtRemoveLight(lamp);
  rtInstanceUserData(plane, 0);
  rtQuality(RT_SEED, 5);
  rtFrameBuffer(3, 3, RT_RGBA);
  look(.1, .1);
  EXPECT_EQ(built().objects, 0u);
}

TEST_F(Edits, HiddenThingsCostNothingUntilTheyAreSeen) {
  const RTid s = square(Shader("VRML97"), 1);
  const RTid shown = placeAt(s, at(0), RT_DYNAMIC);
  const RTid hidden =
      placeAt(square(Shader("VRML97").set("diffuseColor", {.4, .4, .4}), 1), at(0), RT_DYNAMIC);
  rtInstanceVisible(hidden, 0);
  EXPECT_EQ(built(), (Built{1, 1}));
  expectGrey(look(), .8);
  built();
  rtInstanceVisible(shown, 0);
  rtInstanceVisible(hidden, 1);
  EXPECT_EQ(built(), (Built{1, 1}));
  expectGrey(look(), .4);
  built();
  rtInstanceVisible(shown, 1);
  rtInstanceVisible(hidden, 0);
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(), .8);
  rtInstanceVisible(shown, 0);
  expectGrey(look(), 0);
}

TEST_F(Edits, DynamicCopiesShareOneStructure) {
  const RTid s = square(Shader("VRML97"), .4);
  std::vector<RTid> copies;
  for (int i = 0; i < 100; i++) copies.push_back(placeAt(s, at(i % 10, i / 10), RT_DYNAMIC));
  EXPECT_EQ(built(), (Built{1, 1}));
  const RTid added = placeAt(s, at(30), RT_DYNAMIC);
  EXPECT_EQ(built(), (Built{0, 1}));
  rtDeleteInstance(copies[11]);
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(1, 1), 0);
  expectGrey(look(2, 1), .8);
  expectGrey(look(30, 0), .8);
  rtInstanceShader(added, Shader("VRML97").set("diffuseColor", {.2, .2, .2}));
  expectGrey(look(30, 0), .2);
  expectGrey(look(2, 1), .8);
  EXPECT_EQ(built().objects, 0u);
}

// A dynamic instance in an object that is instantiated several times, once dynamically.
TEST_F(Edits, NestedDynamicInstances) {
  const RTid s = square(Shader("VRML97"), 1);
  const RTid group = rtBeginObject(0);
  const RTid inner = placeAt(s, at(0, 1.5), RT_DYNAMIC);
  placeAt(s, at(0, -1.5));
  rtEndObject();
  const RTid outer = placeAt(group, at(-5), RT_DYNAMIC);
  placeAt(group, at(5, 0, 0, .5));
  expectGrey(look(-5, 1.5), .8);
  expectGrey(look(-5, -1.5), .8);
  expectGrey(look(5, .75), .8);
  expectGrey(look(5, -.75), .8);
  built();
  move(inner, at(0, 4));
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(-5, 1.5), 0);
  expectGrey(look(-5, 4), .8);
  expectGrey(look(-5, -1.5), .8);
  expectGrey(look(5, 2), .8);
  built();
  move(outer, at(-5, 10));
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(-5, 14), .8);
  expectGrey(look(-5, 8.5), .8);
  expectGrey(look(-5, 4), 0);
  expectGrey(look(5, 2), .8);
  rtInstanceVisible(outer, 0);
  move(inner, at(0, 1.5));
  expectGrey(look(-5, 11.5), 0);
  expectGrey(look(5, .75), .8);
  rtInstanceVisible(outer, 1);
  expectGrey(look(-5, 11.5), .8);
}

TEST_F(Edits, ASingularMatrixHidesAndAGoodOneShowsAgain) {
  const RTid instance = threeSquares(RT_DYNAMIC);
  built();
  move(instance, at(0, 0, 0, 0));
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(), 0);
  EXPECT_EQ(stats().rejected.instances, 1u);
  built();
  move(instance, at(0));
  EXPECT_EQ(built(), (Built{0, 1}));
  expectGrey(look(), .8);
  EXPECT_EQ(stats().rejected.instances, 0u);
}

TEST_F(Edits, RayQueriesSeeTheLastCommit) {
  const RTid instance = threeSquares(RT_DYNAMIC);
  rtInstanceUserData(instance, 77);
  const auto cast = [](float x, float y) {
    const RTray ray{{x, y, 9}, 0, {0, 0, -1}, 100};
    RThit hit;
    rtCastRays(1, &ray, &hit);
    uint8_t blocked = 0;
    rtOccludedRays(1, &ray, &blocked);
    EXPECT_EQ(blocked, hit.instance != 0);
    return hit;
  };
  rtRender();
  EXPECT_EQ(cast(0, 0).instance, instance);
  move(instance, at(0, 5, 1));
  EXPECT_EQ(cast(0, 0).instance, instance); // not committed yet
  rtRender();
  EXPECT_EQ(cast(0, 0).instance, 0u);
  const RThit hit = cast(0, 5);
  EXPECT_EQ(hit.instance, instance);
  EXPECT_EQ(hit.userData, 77u);
  EXPECT_FLOAT_EQ(hit.t, 8);
  EXPECT_FLOAT_EQ(hit.normal[2], 1);
  EXPECT_NE(cast(4, 0).instance, instance);
}

// The scene of a frame in flight does not change.
TEST_F(Edits, FramesInFlightKeepTheirScene) {
  const RTid instance = threeSquares(RT_DYNAMIC);
  rtTranslated(0, 0, 20);
  rtOrtho(1e-6);
  rtLoadIdentity();
  rtFrameBuffer(64, 64, RT_RGBA);
  const auto center = [] {
    std::vector<float> pixels(4 * 64 * 64);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    return Rgba{pixels[0], pixels[1], pixels[2], pixels[3]};
  };
  rtSwapBuffers();
  for (int i = 0; i < 6; i++) {
    move(instance, at(0, i % 2 ? 0 : 5));
    rtSwapBuffers();
    expectGrey(center(), i % 2 ? 0 : .8);
  }
}

TEST_F(Edits, ScopedLightsStayWithDynamicInstances) {
  const RTid s = square(Shader("VRML97"), 1);
  const RTid left = placeAt(s, at(-3), RT_DYNAMIC), right = placeAt(s, at(3), RT_DYNAMIC);
  rtLightScope(use(tilted(60)), left);
  expectGrey(look(-3), 1.2);
  expectGrey(look(3), .8);
  move(left, at(-3, 4));
  move(right, at(3, 4));
  expectGrey(look(-3, 4), 1.2);
  expectGrey(look(3, 4), .8);
}

// Lines keep their width in pixels wherever they and the camera move.
TEST_F(Edits, LinesMoveWithTheirInstance) {
  const RTid object = rtBeginObject(0);
  rtBindShader(Shader("VRML97").setInt("lit", 0));
  rtLineWidth(2);
  rtBegin(RT_LINES);
  rtVertex3f(-1, 0, 0);
  rtVertex3f(1, 0, 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  const RTid instance = placeAt(object, at(0), RT_DYNAMIC);
  place(square(Shader("VRML97").set("diffuseColor", {0, 0, 0}), 20));
  // Number of pixels around y that show the line, in a picture of height 8.
  const auto bright = [](double y) {
    rtTranslated(0, y, 20);
    rtOrtho(8);
    rtLoadIdentity();
    rtFrameBuffer(16, 16, RT_RGBA);
    rtRender();
    std::vector<float> pixels(4 * 16 * 16);
    rtReadPixels(RT_RGBA, pixels.data(), pixels.size());
    int count = 0;
    for (size_t i = 0; i < pixels.size(); i += 4) count += pixels[i] > .5f;
    return count;
  };
  const int before = bright(0);
  EXPECT_GT(before, 5);
  built();
  move(instance, at(0, 2));
  EXPECT_EQ(built(), (Built{0, 1}));
  EXPECT_EQ(bright(2), before);
  EXPECT_EQ(bright(9), 0);
}

} // namespace
} // namespace numeric
