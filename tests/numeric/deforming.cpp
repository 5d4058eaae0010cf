// deforming.cpp: large meshes that deform. Their trees are refitted (decision 89), and pictures are
// those of the same mesh in a context of its own.
#include <functional>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int side = 165; // 2 x 164 x 164 triangles, more than refittedTriangles
constexpr int width = 48, height = 36;

// A point of the mesh; u and v are from -1 to 1.
using Shape = std::function<Vec(double u, double v)>;

Shape wave(double phase) {
  return [phase](double u, double v) {
    return Vec{u, .1 * std::sin(7 * u + phase) * std::cos(5 * v + phase), v};
  };
}

// across: whether the squares are cut along their other diagonals.
void define(RTid object, const Shape& shape, bool across = false) {
  std::vector<float> points;
  std::vector<uint32_t> indices;
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      const Vec p = shape(2. * x / (side - 1) - 1, 2. * y / (side - 1) - 1);
      points.insert(points.end(), {float(p.x), float(p.y), float(p.z)});
      const uint32_t a = uint32_t(y * side + x), b = a + 1, c = a + side, d = c + 1;
      if (x + 1 == side || y + 1 == side) continue;
      if (across)
        indices.insert(indices.end(), {a, c, d, a, d, b});
      else
        indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  rtBeginObject(object);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawElements(RT_TRIANGLES, indices.size(), indices.data(), points.size() / 3);
  rtEndObject();
}

// A context with the mesh, a lamp and a camera.
class Deforming {
 public:
  explicit Deforming(int threads, const std::string& options = {}) {
    context_ = rtNewContext(("threads=" + std::to_string(threads) + options).c_str());
    EXPECT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtFrameBuffer(width, height, RT_RGBA | RT_MOTION);
    rtBindShader(rtNewShader(rtNewShaderClass("VRML97", nullptr)));
    rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
    rtGenObjects(1, &object_);
    rtObjectHint(object_, RT_DYNAMIC);
    rtLoadIdentity();
    rtLookAt(.3, 1.7, 2.1, 0, 0, 0, 0, 1, 0);
    rtPerspective(45);
    rtLoadIdentity();
  }
  ~Deforming() { rtDeleteContext(context_); }
  Deforming(const Deforming&) = delete;
  Deforming& operator=(const Deforming&) = delete;

  // Returns the picture of the mesh with this shape.
  std::vector<float> look(const Shape& shape, bool across = false) {
    rtMakeCurrent(context_);
    define(object_, shape, across);
    if (!placed_) rtInstantiateObject(object_);
    placed_ = true;
    rtRender();
    std::vector<float> picture(size_t(4 * width * height));
    rtReadPixels(RT_RGBA, picture.data(), picture.size());
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    return picture;
  }
  RTid object() const { return object_; }
  RTbvhStats bvh() {
    rtMakeCurrent(context_);
    RTstats s{};
    s.size = sizeof s;
    rtGetStats(&s);
    return s.bvh;
  }

 private:
  RTcontext context_;
  RTid object_ = 0;
  bool placed_ = false;
};

// Returns the picture of a context that never saw another shape.
std::vector<float> fresh(const Shape& shape, bool across = false) {
  return Deforming(1).look(shape, across);
}

TEST(DeformingMesh, IsRefittedAndLooksLikeANewOne) {
  for (const int threads : {1, 2}) {
    Deforming mesh(threads);
    mesh.look(wave(0));
    const uint64_t built = mesh.bvh().objectBuilds;
    for (int i = 1; i < 6; i++) EXPECT_EQ(mesh.look(wave(.3 * i)), fresh(wave(.3 * i))) << i;
    EXPECT_EQ(mesh.bvh().objectBuilds, built) << "the tree was built again";
  }
}

TEST(DeformingMesh, IsBuiltAgainWhereItsTreeWouldCostMore) {
  Deforming mesh(1);
  mesh.look(wave(0));
  const uint64_t built = mesh.bvh().objectBuilds;
  const Shape rolled = [](double u, double v) {
    return Vec{.3 * std::cos(9 * u) * (1.2 + u), .3 * std::sin(9 * u) * (1.2 + u), v};
  };
  EXPECT_EQ(mesh.look(rolled), fresh(rolled));
  EXPECT_EQ(mesh.bvh().objectBuilds, built + 1);
  EXPECT_EQ(mesh.look(rolled), fresh(rolled));
  EXPECT_EQ(mesh.bvh().objectBuilds, built + 1) << "the new tree was not kept";
}

TEST(DeformingMesh, MayHaveOtherTrianglesOfTheSameNumber) {
  Deforming mesh(1);
  mesh.look(wave(0));
  const uint64_t built = mesh.bvh().objectBuilds;
  EXPECT_EQ(mesh.look(wave(.5), true), fresh(wave(.5), true));
  EXPECT_EQ(mesh.bvh().objectBuilds, built + 1);
}

TEST(DeformingMesh, SurvivesAnyPoints) {
  Deforming mesh(2);
  mesh.look(wave(0));
  const auto scaled = [](double x, double y, double z) -> Shape {
    return [=](double u, double v) {
      const Vec p = wave(.2)(u, v);
      return Vec{x * p.x, y * p.y, z * p.z};
    };
  };
  for (const Shape& shape :
       {scaled(0, 0, 0), scaled(1, 1, 1), scaled(1, 0, 0), scaled(1e30, 1e30, 1e30),
        scaled(1e-30, 1e-30, 1e-30), scaled(1e38, 1, 1e-3), scaled(1, 1e-6, 1e-4), wave(.4)})
    EXPECT_EQ(mesh.look(shape), fresh(shape));
}

TEST(DeformingMesh, StaysWhereAPointIsNoNumber) {
  Deforming mesh(1);
  const std::vector<float> before = mesh.look(wave(0));
  define(mesh.object(), [](double u, double v) { return Vec{u, u > .5 ? NAN : 0, v}; });
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
  EXPECT_EQ(mesh.look(wave(0)), before);
}

// Part of the triangles are slivers, which are intersected in double precision (decision 41).
TEST(DeformingMesh, MayHaveSlivers) {
  const auto stretched = [](double phase, double from) -> Shape {
    return [=](double u, double v) {
      Vec p = wave(phase)(u, v);
      if (u > from) p.x = from + 400 * (u - from);
      return p;
    };
  };
  Deforming mesh(2);
  for (int i = 0; i < 4; i++) { // the same slivers twice, then others
    const Shape shape = stretched(.1 * i, i < 2 ? .9 : .8);
    EXPECT_EQ(mesh.look(shape), fresh(shape)) << i;
  }
}

TEST(DeformingMesh, LeavesNoMemoryBehind) {
  Deforming mesh(1);
  for (int i = 0; i < 4; i++) mesh.look(wave(.01 * i));
  const uint64_t bytes = mesh.bvh().bytes;
  for (int i = 0; i < 200; i++) mesh.look(wave(.01 * i));
  EXPECT_LE(mesh.bvh().bytes, bytes + bytes / 100);
}

} // namespace
} // namespace numeric
