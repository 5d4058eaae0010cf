// motion.cpp: RT_MOTION against closed forms: instances at any depth, vertices, both, new shapes,
// far from the origin, and random scenes against all ways in which a point can have come to its
// place.
#include <functional>
#include <random>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

constexpr uint32_t channels = RT_RGBA | RT_DEPTH | RT_POSITION | RT_MOTION | RT_NAME;

// A hit of a frame.
struct Hit {
  Vec position, motion;
  int name = 0;
  bool isNew() const {
    return std::isnan(motion.x) && std::isnan(motion.y) && std::isnan(motion.z);
  }
};

Vec minus(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

// A placement in the plane z = constant: a turn about z and a translation.
struct Placement {
  double angle = 0, x = 0, y = 0, z = 0; // angle in radians
  Vec apply(const Vec& p) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y + x, s * p.x + c * p.y + y, p.z + z};
  }
  Vec undo(const Vec& p) const {
    const double c = std::cos(angle), s = std::sin(angle), dx = p.x - x, dy = p.y - y;
    return {c * dx + s * dy, c * dy - s * dx, p.z - z};
  }
  std::array<double, 16> matrix() const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x, y, z, 1};
  }
};

void move(RTid instance, const Placement& to) { rtInstanceMatrix(instance, to.matrix().data()); }

class Motion : public Scene {
 protected:
  static constexpr int edge = 16;

  static void lookAt(double x, double y, double wide = 4) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(x, y, 20);
    rtOrtho(wide);
    rtPopMatrix();
  }
  static std::vector<float> read(RTenum channel) {
    return drawing::readChannel(channel, edge, edge);
  }
  // Renders a frame and returns what its pixels hit. Where nothing is hit, the motion must be 0.
  static std::vector<Hit> frame() {
    rtFrameBuffer(edge, edge, channels);
    rtRender();
    const auto depth = read(RT_DEPTH), name = read(RT_NAME), p = read(RT_POSITION),
               m = read(RT_MOTION);
    std::vector<Hit> hits;
    for (size_t i = 0; i < depth.size(); i++) {
      const Vec motion{m[3 * i], m[3 * i + 1], m[3 * i + 2]};
      if (std::isfinite(depth[i]))
        hits.push_back({{p[3 * i], p[3 * i + 1], p[3 * i + 2]}, motion, int(name[i])});
      else
        expectMotion(motion, {0, 0, 0}, 0);
    }
    EXPECT_FALSE(hits.empty());
    return hits;
  }
  static void expectMotion(const Vec& got, const Vec& expected, double tolerance) {
    EXPECT_NEAR(got.x, expected.x, tolerance);
    EXPECT_NEAR(got.y, expected.y, tolerance);
    EXPECT_NEAR(got.z, expected.z, tolerance);
  }
  static void expectAll(const std::vector<Hit>& hits, const Vec& expected, double tolerance = 0) {
    for (const Hit& hit : hits) expectMotion(hit.motion, expected, tolerance);
  }
  // before: returns where the point of a hit was in the frame before.
  static void expectFrom(const std::vector<Hit>& hits, const std::function<Vec(const Hit&)>& before,
                         double tolerance = 2e-6) {
    for (const Hit& hit : hits)
      expectMotion(hit.motion, minus(hit.position, before(hit)), tolerance);
  }
  static void expectNew(const std::vector<Hit>& hits) {
    for (const Hit& hit : hits) EXPECT_TRUE(hit.isNew());
  }
  static std::vector<Hit> named(const std::vector<Hit>& hits, int name) {
    std::vector<Hit> found;
    for (const Hit& hit : hits)
      if (hit.name == name) found.push_back(hit);
    EXPECT_FALSE(found.empty()) << name;
    return found;
  }
  // Places an object under a name.
  static RTid placeAs(uint32_t name, RTid object, const Placement& where) {
    rtLoadName(name);
    rtPushMatrix();
    rtLoadMatrixd(where.matrix().data());
    const RTid instance = place(object);
    rtPopMatrix();
    rtLoadName(0);
    return instance;
  }
  // Defines a net of triangles.
  static RTid net(const std::function<Vec(double x, double y)>& place, RTid object = 0,
                  int cells = 3) {
    const auto point = [&](double x, double y) {
      const Vec p = place(x, y);
      return drawing::Point{p.x, p.y, p.z};
    };
    return drawing::net(point, object, cells);
  }
};

TEST_F(Motion, EverythingIsNewInTheFirstFrameAndThenRests) {
  place(square(0, 1));
  lookAt(0, 0);
  expectNew(frame());
  expectAll(frame(), {0, 0, 0});
  lookAt(.5, .25, 5); // the motion of the camera does not count
  expectAll(frame(), {0, 0, 0});
}

TEST_F(Motion, OfAnInstance) {
  const RTid instance = place(square(0, 1));
  lookAt(0, 0);
  frame();
  move(instance, {.x = .25, .y = -.5, .z = .125});
  expectAll(frame(), {.25, -.5, .125});
  expectAll(frame(), {0, 0, 0});
  move(instance, {.x = -.25, .y = -.5, .z = .125});
  expectAll(frame(), {-.5, 0, 0});
}

TEST_F(Motion, OfATurn) {
  Placement before{.x = .25}, now{.angle = .4, .x = .5, .y = .25};
  const RTid instance = placeAs(0, square(0, 1), before);
  lookAt(0, 0);
  frame();
  for (int i = 0; i < 3; i++) { // the first move makes the instance dynamic
    move(instance, now);
    expectFrom(frame(), [&](const Hit& hit) { return before.apply(now.undo(hit.position)); });
    before = now;
    now.angle += .7;
    now.y -= .125;
  }
}

TEST_F(Motion, OfNestedInstances) {
  const RTid leaf = square(0, .5);
  Placement innerBefore{.x = .75}, inner = innerBefore;
  const RTid group = rtBeginObject(0);
  const RTid child = placeAs(0, leaf, inner);
  rtEndObject();
  Placement outerBefore, outer;
  const Placement resting{.x = -1.75, .y = 1};
  const RTid moving = placeAs(1, group, outer);
  placeAs(2, group, resting);
  lookAt(0, 0, 6);
  expectNew(frame());
  const auto check = [&] {
    const std::vector<Hit> hits = frame();
    expectFrom(named(hits, 1), [&](const Hit& hit) {
      return outerBefore.apply(innerBefore.apply(inner.undo(outer.undo(hit.position))));
    });
    expectFrom(named(hits, 2), [&](const Hit& hit) {
      return resting.apply(innerBefore.apply(inner.undo(resting.undo(hit.position))));
    });
    outerBefore = outer;
    innerBefore = inner;
  };
  check();
  move(moving, outer = {.angle = .5, .y = -.25});
  check();
  move(child, inner = {.angle = -.25, .x = .5, .y = .25});
  check();
  move(moving, outer = {.angle = .25, .y = .25});
  move(child, inner = {.angle = 1, .x = .75});
  check();
  expectAll(frame(), {0, 0, 0});
}

TEST_F(Motion, OfVertices) {
  const RTid object = net([](double x, double y) { return Vec{x, y, 0}; });
  const RTid instance = place(object);
  lookAt(0, 0);
  frame();
  net([](double x, double y) { return Vec{1.25 * x, .75 * y, .5 * x}; }, object);
  // A linear map of the vertices maps the points between them, too.
  expectFrom(frame(), [](const Hit& hit) {
    return Vec{hit.position.x / 1.25, hit.position.y / .75, 0};
  });
  expectAll(frame(), {0, 0, 0});
  net([](double x, double y) { return Vec{x, y, 0}; }, object);
  const Placement now{.angle = .3, .x = .25};
  move(instance, now);
  expectFrom(frame(), [&](const Hit& hit) {
    const Vec p = now.undo(hit.position);
    return Vec{1.25 * p.x, .75 * p.y, .5 * p.x};
  });
}

TEST_F(Motion, OfSpheres) {
  const Shader shader("Diffuse");
  const RTid object = drawing::ball(shader, 1), instance = place(object);
  lookAt(0, 0);
  frame();
  const Placement now{.angle = .5, .x = .25};
  move(instance, now);
  expectFrom(frame(), [&](const Hit& hit) { return now.undo(hit.position); });
  drawing::ball(shader, 1.25f, object);
  expectFrom(frame(), [&](const Hit& hit) {
    const Vec p = now.undo(hit.position);
    return now.apply({p.x / 1.25, p.y / 1.25, p.z / 1.25});
  });
}

TEST_F(Motion, OfLinesAndPoints) {
  const auto draw = [](RTid object, float up) {
    const RTid defined = rtBeginObject(object);
    rtBegin(RT_LINES);
    rtVertex3f(-2, up, 0);
    rtVertex3f(2, up, 0);
    rtEnd();
    rtPointSize(3);
    rtBegin(RT_POINTS);
    rtVertex3f(0, up + 1, 0);
    rtEnd();
    rtEndObject();
    return defined;
  };
  const RTid object = draw(0, 0);
  place(object);
  lookAt(0, 0);
  frame();
  draw(object, .25f);
  expectAll(frame(), {0, .25, 0});
}

TEST_F(Motion, IsNotANumberForWhatIsNew) {
  const RTid leaf = square(0, .5), object = net([](double x, double y) {
                                     return Vec{x * .5, y * .5, 0};
                                   });
  placeAs(1, leaf, {.x = -1});
  placeAs(2, object, {.x = 1});
  lookAt(0, 0, 6);
  frame();
  RTid fresh = placeAs(3, leaf, {.y = 1.5});
  std::vector<Hit> hits = frame();
  expectNew(named(hits, 3));
  expectAll(named(hits, 1), {0, 0, 0});
  expectAll(frame(), {0, 0, 0});
  rtInstanceVisible(fresh, 0);
  frame();
  rtInstanceVisible(fresh, 1);
  hits = frame();
  expectNew(named(hits, 3));
  expectAll(named(hits, 2), {0, 0, 0});
  net([](double x, double y) { return Vec{x * .5, y * .5, 0}; }, object, 4); // other triangles
  hits = frame();
  expectNew(named(hits, 2));
  expectAll(named(hits, 3), {0, 0, 0});
  rtDeleteInstance(fresh); // in the scene itself, another instance is another thing
  placeAs(3, leaf, {.y = 1.5});
  expectNew(named(frame(), 3));
}

TEST_F(Motion, InstancesOfAnObjectThatIsDefinedAgainAreMatched) {
  const RTid leaf = square(0, .25), other = square(0, .25);
  const auto define = [&](RTid group, double up, bool third) {
    const RTid defined = rtBeginObject(group);
    placeAs(1, leaf, {.x = -1, .y = up});
    placeAs(2, leaf, {.x = 0, .y = -up});
    placeAs(2, leaf, {.x = 1, .y = 2 * up});
    if (third) placeAs(2, leaf, {.x = 1, .y = 1});
    placeAs(2, other, {.y = 1});
    rtEndObject();
    return defined;
  };
  const RTid group = define(0, 0, false);
  place(group);
  lookAt(0, 0);
  frame();
  define(group, .25, false);
  const std::vector<Hit> hits = frame();
  expectAll(named(hits, 1), {0, .25, 0});
  for (const Hit& hit : named(hits, 2)) // told apart by their object, or else by their order
    expectMotion(hit.motion, {0, hit.position.x > .5 ? .5 : hit.position.y > .5 ? 0 : -.25, 0}, 0);
  define(group, .25, true);
  for (const Hit& hit : frame()) {
    const bool many = hit.name == 2 && !(hit.position.x < .5 && hit.position.y > .5);
    EXPECT_EQ(hit.isNew(), many) << "which of three these two were is not known";
  }
}

TEST_F(Motion, HasAllDigitsFarFromTheOrigin) {
  const double far = 1e6;
  const RTid object = net([](double x, double y) { return Vec{x, y, 0}; });
  const RTid moving = placeAs(1, object, {.x = far});
  placeAs(2, object, {.x = far, .y = 3});
  lookAt(far, 1, 8);
  frame();
  move(moving, {.x = far + 1.0 / 1024, .y = -.125});
  std::vector<Hit> hits = frame();
  expectAll(named(hits, 1), {1.0 / 1024, -.125, 0});
  expectAll(named(hits, 2), {0, 0, 0});
  net([](double x, double y) { return Vec{x, y + .25, 0}; }, object);
  expectAll(frame(), {0, .25, 0}, 1e-7);
}

TEST_F(Motion, IsThatOfTheFirstSample) {
  const RTid instance = place(square(0, 1));
  lookAt(0, 0);
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  frame();
  const Placement now{.angle = .5, .x = .25};
  move(instance, now);
  expectFrom(frame(), [&](const Hit& hit) { return now.undo(hit.position); });
}

TEST_F(Motion, NeedsNoEarlierFrameWithTheChannel) {
  const RTid instance = place(square(0, 1));
  lookAt(0, 0);
  for (int i = 1; i <= 3; i++) {
    move(instance, {.x = .125 * i});
    rtFrameBuffer(edge, edge, RT_RGBA);
    rtRender();
  }
  move(instance, {.x = .125, .y = .25});
  expectAll(frame(), {-.25, .25, 0});
}

TEST_F(Motion, OfOldPicturesIsNotKept) {
  const RTid instance = place(square(0, 1));
  lookAt(0, 0);
  frame();
  rtFrameBuffer(edge, edge, RT_RGBA);
  move(instance, {.x = .125});
  rtRender();
  std::vector<float> plane(3 * edge * edge);
  rtReadPixels(RT_MOTION, plane.data(), plane.size());
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
}

// A scene of three levels, all of whose instances and both of whose objects may change.
class RandomMotion : public Motion {
 protected:
  struct Placed {
    RTid instance = 0;
    Placement now, before;
  };
  double number(double most) {
    return std::uniform_real_distribution<double>(-most, most)(random_);
  }
  Placement anywhere(double z) {
    return {.angle = number(3), .x = number(2), .y = number(2), .z = z};
  }
  void build() {
    leaf_ = net([](double x, double y) { return Vec{x * .4, y * .4, 0}; });
    group_ = rtBeginObject(0);
    // The heights of the squares tell how they have come to their places.
    for (int i = 0; i < 3; i++) inner_[i] = made(leaf_, anywhere(.25 * i));
    rtEndObject();
    for (int i = 0; i < 3; i++) outer_[i] = made(group_, anywhere(i));
  }
  static Placed made(RTid object, const Placement& at) { return {placeAs(0, object, at), at, at}; }
  void change() {
    for (Placed& p : inner_) p.before = p.now;
    for (Placed& p : outer_) p.before = p.now;
    before_ = scale_;
    const auto shift = [&](Placed& p) {
      p.now = anywhere(p.now.z);
      move(p.instance, p.now);
    };
    if (random_() % 3) shift(inner_[random_() % 3]);
    if (random_() % 3) shift(outer_[random_() % 3]);
    if (random_() % 4) return;
    scale_ = .75 + number(.25);
    net([&](double x, double y) { return Vec{x * .4 * scale_, y * .4, 0}; }, leaf_);
  }
  Vec before(const Hit& hit) const {
    const auto height = long(std::lround(4 * hit.position.z));
    const Placed &outer = outer_[height / 4], &inner = inner_[height % 4];
    Vec p = inner.now.undo(outer.now.undo(hit.position));
    p.x *= before_ / scale_;
    return outer.before.apply(inner.before.apply(p));
  }
  std::mt19937 random_{7};
  RTid leaf_ = 0, group_ = 0;
  Placed inner_[3], outer_[3];
  double scale_ = 1, before_ = 1;
};

TEST_F(RandomMotion, IsThatOfAllInstancesAbove) {
  build();
  lookAt(0, 0, 8);
  expectNew(frame());
  for (int i = 0; i < 60; i++) {
    SCOPED_TRACE(i);
    change();
    expectFrom(
        frame(), [&](const Hit& hit) { return before(hit); }, 5e-6);
    if (i % 5 == 0) expectAll(frame(), {0, 0, 0});
  }
}

} // namespace
} // namespace numeric
