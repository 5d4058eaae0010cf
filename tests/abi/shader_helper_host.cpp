// shader_helper_host.cpp: the features of openrts.hpp beyond shading: custom lobes, media, rays and
// facts about a hit, frequencies, prepare, extents, projections, transports.
#include "openrt/openrts.hpp"

#include <gtest/gtest.h>

#include "abi/fake_host.h"

namespace openrt::test {
namespace {

// A custom lobe whose light encodes its arguments.
struct Echo {
  float a, b;
  rts::Color evaluate(rts::Vec3 toEye, rts::Vec3 direction, rts::Vec3 normal) const {
    return {a * rts::dot(direction, normal), b, toEye.z};
  }
  float density(rts::Vec3, rts::Vec3 direction, rts::Vec3) const { return direction.z; }
  rts::Sample sample(rts::Vec3, rts::Vec2 square, rts::Vec3 normal) const {
    return {normal, {square.x, square.y, a}, 4};
  }
};
struct Plain { // no floats, and its sample() gives only a direction
  static constexpr bool transmits = true;
  rts::Color evaluate(rts::Vec3, rts::Vec3, rts::Vec3) const { return {1, 2, 3}; }
  float density(rts::Vec3, rts::Vec3, rts::Vec3) const { return 2; }
  rts::Vec3 sample(rts::Vec3, rts::Vec2, rts::Vec3 normal) const { return normal; }
};

struct Everything : rts::Surface<Everything> {
  rts::Param<float> width{"width", .5f, "a number", 0, 1, rts::PerVertex};
  rts::Param<rts::Color> tint{"tint", {1, 1, 1}, "a colour", rts::PerTriangle};
  rts::Param<int32_t> whole{"whole", 1, "an integer"};
  float doubled, unused;

  const char* prepare() {
    doubled = 2 * width;
    return width > 1 ? "width: larger than 1" : nullptr;
  }
  void release() { doubled = -1; }
  uint32_t needs() const { return width > .1f ? RTS_GLOSSY : RTS_SPECULAR; }
  rts::Medium medium() const { return {{1.1f, 1.2f, 1.3f}, {0, .5f, 1}, 3, whole != 0}; }
  void surface(const rts::Hit& hit, rts::Closures& out) const {
    out.glossy({.1f, .2f, .3f}, width, 1.5f);
    out.roughDielectric(tint, 1.25f, .25f);
    if (hit.lane % 2) out.normal({0, .6f, .8f});
    out.custom({.5f, .5f, .5f}, Echo{width, doubled});
    out.custom({.25f, .25f, .25f}, Plain{});
    out.custom({.125f, .125f, .125f}, Echo{7, 8}); // another one of the same kind
  }
};

struct Glowing : rts::Surface<Glowing> {
  rts::Param<float> emission{"emission", 1, "radiance"};
  rts::Param<int32_t> even{"even", 1, "emits the same everywhere"};
  bool emits() const { return emission > 0; }
  bool emitsUniformly() const { return even != 0; }
  void surface(const rts::Hit&, rts::Closures& out) const {
    out.emission({emission, emission, emission});
  }
};

// Returns the facts about a hit as radiance.
struct Asking : rts::Surface<Asking> {
  static constexpr uint32_t needs = RTS_GLOBAL;
  rts::Param<int32_t> what{"what", 0, "which question"};
  rts::Shaded shade(const rts::Hit& hit) const {
    switch (what) {
    case 0: return {hit.trace({0, 0, -1}), {}, {}};
    case 1: return {hit.occluded({0, 0, -1}, .5f), hit.occluded({0, 0, -1}), {}};
    case 2: {
      const rts::Found found = hit.findHit({1, 2, 3}, {0, 0, -1});
      return {{found.position.z, found.distance, float(found.name)},
              {float(hit.findHit({0, 0, 1}).any()), found.normal.z, 0},
              {}};
    }
    case 3: {
      const rts::Vec2 a = hit.random(0), b = hit.random(3), again = hit.random(3),
                      none = hit.random(4);
      return {{a.x, a.y, b.x}, {b.y, again.x, none.x}, {}};
    }
    case 4: {
      const auto local = hit.local();
      const auto slopes = hit.derivatives();
      return {{local.position.x, local.position.y, local.normal.x},
              {slopes.alongS.x, slopes.alongT.y, hit.error()},
              {}};
    }
    default: {
      const auto ids = hit.ids();
      return {{float(ids.name), float(ids.instance), float(ids.primitive)},
              {float(hit.depth()), hit.throughput().b, 0},
              {}};
    }
    }
  }
};

struct Lamp : rts::LightSource<Lamp> {
  rts::Illumination illuminate(rts::Vec3) const { return {}; }
  rts::Extent extent() const { return {{1, 2, 3}, {0, 1, 0}, .5f, 7, 9, false, true}; }
};
struct Eye : rts::Camera<Eye> {
  static constexpr bool parallel = true;
  rts::Ray generate(rts::Vec2, rts::Vec2) const { return {}; }
  rts::Projection project(rts::Vec3 point, rts::Vec2 lens, rts::Vec2 size) const {
    return {{point.x * size.x, point.y * size.y}, {0, 0, lens.x}, 4};
  }
};
struct Follow : rts::Transport<Follow> {
  rts::Vec4 radiance(const rts::CameraRay& ray) const {
    float alpha = 0;
    const rts::Color c = ray.trace(&alpha);
    return {c.r, c.g, ray.random(1).x, alpha};
  }
};

template <class T> const RtsClass& classOf() { // once per class, as RTS_PLUGIN does
  static const RtsClass* const c = rts::detail::classOf<T>("a class");
  return *c;
}

// A batch of hits at the origin, seen from above, with space for results.
struct Batch {
  explicit Batch(const RtsClass& shaderClass, uint32_t n) : params(shaderClass) {
    for (size_t k = 0; k < 19; k++) in[k] = Lanes(n, k == 5 ? -1.f : k == 8 || k == 11 ? 1.f : 0.f);
    for (size_t c = 0; c < 3; c++) {
      hits.position[c] = in[c].data();
      hits.direction[c] = in[3 + c].data();
      hits.geometric[c] = in[6 + c].data();
      hits.normal[c] = in[9 + c].data();
      out[c] = Lanes(n);
      out[3 + c] = Lanes(n);
      shading.radiance[c] = out[c].data();
      shading.transmission[c] = out[3 + c].data();
    }
    for (size_t c = 0; c < 2; c++) hits.uv[c] = in[12 + c].data();
    for (size_t c = 0; c < 4; c++) hits.color[c] = in[14 + c].data();
    hits.distance = hits.segment = in[18].data();
    hits.count = host.hitCount = n;
    flags.assign(n + RTS_LANES, 0);
    hits.flags = flags.data();
    pointers.assign(n + RTS_LANES, params.get());
    hits.params = pointers.data();
  }
  FakeHost host;
  ParamBlock params;
  Lanes in[19], out[6];
  std::vector<uint32_t> flags;
  std::vector<const void*> pointers;
  RtsHits hits{};
  RtsShading shading{};
};

TEST(ShaderHelperHost, LobesOfOnesOwn) {
  const RtsClass& c = classOf<Everything>();
  Batch b(c, 19);
  ASSERT_EQ(c.prepare(&b.host, b.params.get()), nullptr);
  RtsSurface out{};
  c.surface(&b.host, b.host.batch(), &b.hits, &out);
  ASSERT_EQ(b.host.lobes.size(), 5u);
  const auto lobe = [&](size_t k) -> const RtsLobe& { return b.host.lobes[k].table; };
  EXPECT_EQ(lobe(0).kind, RTS_LOBE_GLOSSY);
  EXPECT_EQ(lobe(0).parameter[0][18], .5f);
  EXPECT_EQ(lobe(0).parameter[1][18], 1.5f);
  EXPECT_EQ(lobe(1).kind, RTS_LOBE_ROUGH_DIELECTRIC);
  EXPECT_EQ(lobe(1).parameter[0][3], 1.25f);
  EXPECT_EQ(lobe(1).parameter[1][3], .25f);
  EXPECT_EQ(lobe(0).normal[2][1], 1); // the normal applies to lobes added later
  EXPECT_EQ(lobe(2).normal[2][1], .8f);
  EXPECT_EQ(lobe(2).normal[2][2], 1);
  EXPECT_EQ(lobe(2).data[1][5], 1);
  EXPECT_EQ(lobe(2).functions->transmits, 0u);
  EXPECT_EQ(lobe(3).functions->transmits, 1u);
  EXPECT_EQ(lobe(3).data[0], nullptr);
  EXPECT_EQ(lobe(4).functions, lobe(2).functions);
  EXPECT_EQ(lobe(4).data[0][18], 7);
  EXPECT_EQ(lobe(4).weight[1][18], .125f);

  const uint32_t hit[2] = {1, 18};
  float x[2] = {0, 0}, y[2] = {0, .6f}, z[2] = {1, .8f}, values[3][2], density[2];
  const float* const direction[3] = {x, y, z};
  float* const value[3] = {values[0], values[1], values[2]};
  lobe(2).functions->evaluate(&lobe(2), &b.hits, 2, hit, direction, value, density);
  EXPECT_FLOAT_EQ(values[0][0], .5f * .8f);
  EXPECT_FLOAT_EQ(values[0][1], .5f * .8f);
  EXPECT_FLOAT_EQ(values[1][1], 1);
  EXPECT_FLOAT_EQ(values[2][1], 1);
  EXPECT_FLOAT_EQ(density[1], .8f);
  const float u[2] = {.25f, .5f}, v[2] = {.75f, 1};
  const float* const square[2] = {u, v};
  float d[3][2];
  float* const chosen[3] = {d[0], d[1], d[2]};
  lobe(2).functions->sample(&lobe(2), &b.hits, 2, hit, square, chosen, value, density);
  EXPECT_FLOAT_EQ(d[1][0], .6f);
  EXPECT_FLOAT_EQ(values[0][1], .5f);
  EXPECT_FLOAT_EQ(density[0], 4);
  lobe(3).functions->sample(&lobe(3), &b.hits, 2, hit, square, chosen, value, density);
  EXPECT_FLOAT_EQ(values[2][0], 1.5f); // the value divided by the pdf
  EXPECT_FLOAT_EQ(density[0], 2);
}

TEST(ShaderHelperHost, PrepareReleaseMediaTraitsAndFrequencies) {
  const RtsClass& c = classOf<Everything>();
  FakeHost host;
  ParamBlock p(c);
  EXPECT_EQ(c.prepare(&host, p.get()), nullptr);
  EXPECT_EQ(static_cast<const Everything*>(p.get())->doubled, 1);
  EXPECT_EQ(c.traits(&host, p.get()), unsigned(RTS_GLOSSY));
  RtsMedium m{};
  EXPECT_EQ(c.medium(&host, p.get(), &m), 1);
  EXPECT_EQ(m.index[2], 1.3f);
  EXPECT_EQ(m.absorption[1], .5f);
  EXPECT_EQ(m.priority, 3);
  c.release(&host, p.get());
  EXPECT_EQ(static_cast<const Everything*>(p.get())->doubled, -1);
  p.set("width", {2});
  EXPECT_STREQ(c.prepare(&host, p.get()), "width: larger than 1");
  p.set("width", {.05f});
  p.setInt("whole", 0);
  EXPECT_EQ(c.traits(&host, p.get()), unsigned(RTS_SPECULAR));
  EXPECT_EQ(c.medium(&host, p.get(), &m), 0);
  ASSERT_EQ(c.paramCount, 3u);
  EXPECT_EQ(c.frequency[0], RTS_PER_VERTEX);
  EXPECT_EQ(c.frequency[1], RTS_PER_TRIANGLE);
  EXPECT_EQ(c.frequency[2], RTS_PER_SHADER);
  EXPECT_EQ(c.params[0].maximum, 1);
  EXPECT_EQ(classOf<Asking>().traits(&host, nullptr), unsigned(RTS_GLOBAL | RTS_UNLIT));
}

TEST(ShaderHelperHost, TraitsOfEmission) {
  const RtsClass& c = classOf<Glowing>();
  FakeHost host;
  ParamBlock p(c);
  EXPECT_EQ(c.traits(&host, p.get()), unsigned(RTS_SPECULAR | RTS_EMISSIVE | RTS_UNIFORM_EMISSION));
  p.setInt("even", 0);
  EXPECT_EQ(c.traits(&host, p.get()), unsigned(RTS_SPECULAR | RTS_EMISSIVE));
  p.setInt("even", 1);
  p.set("emission", {0});
  EXPECT_EQ(c.traits(&host, p.get()), unsigned(RTS_SPECULAR));
}

struct Told {
  int what;
  float radiance[3], transmission[3];
};
void expectTold(const Told& t) {
  const RtsClass& c = classOf<Asking>();
  Batch b(c, 20);
  b.params.setInt("what", t.what);
  c.shade(&b.host, b.host.batch(), &b.hits, &b.shading);
  for (size_t k = 0; k < 3; k++) {
    EXPECT_FLOAT_EQ(b.out[k][2], t.radiance[k]) << "question " << t.what << ", " << k;
    EXPECT_FLOAT_EQ(b.out[3 + k][2], t.transmission[k]) << "question " << t.what << ", " << k;
  }
}

// Lane 2 of 20, with the values of fake_host.h.
TEST(ShaderHelperHost, HitsSendRaysAndAsk) {
  expectTold({0, {.25f, .5f, .75f}, {0, 0, 0}});
  expectTold({1, {1, 1, 1}, {0, 0, 0}});
  expectTold({2, {-1, 4, 7}, {0, 1, 0}});
  expectTold({3, {.002f, .012f, .302f}, {.312f, .302f, .5f}});
  expectTold({4, {2, 2.1f, 12}, {2, 12.1f, 3e-6f}});
  expectTold({5, {102, 202, 302}, {2, .5f / 3, 0}});
}

TEST(ShaderHelperHost, EveryQuestionIsAskedOnceABatchAndRaysBearTheirHit) {
  const RtsClass& c = classOf<Asking>();
  Batch b(c, 20);
  b.params.setInt("what", 3);
  c.shade(&b.host, b.host.batch(), &b.hits, &b.shading);
  EXPECT_EQ(b.host.randomCalls, 2u);
  b.params.setInt("what", 0);
  c.shade(&b.host, b.host.batch(), &b.hits, &b.shading);
  ASSERT_EQ(b.host.requestHits.size(), 20u);
  EXPECT_EQ(b.host.requestHits[13], 13u);
}

TEST(ShaderHelperHost, ExtentsAndProjections) {
  FakeHost host;
  const RtsClass& lamp = classOf<Lamp>();
  const RtsClass& eye = classOf<Eye>();
  RtsExtent e{};
  const ParamBlock p(lamp), q(eye);
  EXPECT_EQ(lamp.extent(&host, p.get(), &e), 1);
  EXPECT_EQ(e.position[2], 3);
  EXPECT_EQ(e.direction[1], 1);
  EXPECT_EQ(e.cosine, .5f);
  EXPECT_EQ(e.power, 7);
  EXPECT_EQ(e.radius, 9);
  using Floats = std::vector<float>;
  Lanes x(Floats{1, 2}), y(Floats{3, 4}), z(Floats{5, 6}), u(Floats{.25f, .5f}), out[6];
  for (Lanes& o : out) o = Lanes(2);
  const float* local[3] = {x.data(), y.data(), z.data()};
  const float* lens[2] = {u.data(), u.data()};
  const float size[2] = {10, 100};
  RtsProjection projection{{out[0].data(), out[1].data()},
                           {out[2].data(), out[3].data(), out[4].data()},
                           out[5].data(),
                           0};
  eye.project(&host, host.batch(), q.get(), 2, local, lens, size, &projection);
  EXPECT_EQ(out[0][1], 20);
  EXPECT_EQ(out[1][1], 400);
  EXPECT_EQ(out[4][1], .5f);
  EXPECT_EQ(out[5][0], 4);
  EXPECT_EQ(projection.parallel, 1);
}

TEST(ShaderHelperHost, TransportsFollowCameraRays) {
  FakeHost host;
  host.hitCount = 3;
  const RtsClass& c = classOf<Follow>();
  EXPECT_EQ(c.kind, RTS_TRANSPORT);
  const ParamBlock p(c);
  Lanes zero(3), down(std::vector<float>{-1, 1, -1}), ends(std::vector<float>{10, 10, .5f}), out[4];
  for (Lanes& o : out) o = Lanes(3);
  RtsRequest rays{3,
                  nullptr,
                  {zero.data(), zero.data(), zero.data()},
                  {zero.data(), zero.data(), down.data()},
                  ends.data()};
  float* rgba[4] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
  c.radiance(&host, host.batch(), p.get(), &rays, rgba);
  EXPECT_EQ(out[1][0], .5f);
  EXPECT_EQ(out[3][0], 1);
  EXPECT_EQ(out[3][1], 0);
  EXPECT_EQ(out[0][2], 0) << "the floor lies beyond the end";
  EXPECT_FLOAT_EQ(out[2][2], .102f);
}

} // namespace
} // namespace openrt::test
