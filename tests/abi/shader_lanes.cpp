// shader_lanes.cpp: the lanes of openrts.hpp: every operation gives the bytes that it gives for one
// float, and a class whose functions are templates gives the bytes that its functions give hit by
// hit, for batches of every length.
#include "openrt/openrts.hpp"

#include <gtest/gtest.h>

#include "abi/fake_host.h"

namespace openrt::test {
namespace {

using rts::Lanes;
using rts::Mask;
using LaneVec3 = rts::Vec3Of<Lanes>;
using LaneColor = rts::ColorOf<Lanes>;

uint32_t bitsOf(float x) {
  uint32_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

// Numbers of all kinds, in an order that differs by `shift`, for all lanes of a batch.
std::vector<float> numbers(uint32_t n, uint32_t shift) {
  const float kinds[] = {0.0f,  -0.0f, 1.0f,    -1.0f,  0.3f,   -7.5f,    1e-30f,    -1e-42f, 3e38f,
                         1e30f, -1e9f, 1 / 3.f, 16.25f, 2e-20f, INFINITY, -INFINITY, NAN};
  std::vector<float> out;
  for (uint32_t i = 0; i < n; i++) out.push_back(kinds[(i * 5 + shift) % 17]);
  return out;
}

// Compares an operation of Lanes with that of floats. The sign of a NaN is not defined.
template <class F> void sameForEachLane(const char* name, const F& operation) {
  for (uint32_t shift = 0; shift < 17; shift++) {
    const std::vector<float> a = numbers(17 * 16, 0), b = numbers(17 * 16, shift),
                             c = numbers(17 * 16, 3 * shift + 1);
    for (uint32_t i = 0; i + Lanes::size <= a.size(); i += Lanes::size) {
      const Lanes got = operation(Lanes::load(&a[i]), Lanes::load(&b[i]), Lanes::load(&c[i]));
      for (uint32_t k = 0; k < Lanes::size; k++) {
        const float wanted = operation(a[i + k], b[i + k], c[i + k]);
        if (std::isnan(wanted))
          EXPECT_TRUE(std::isnan(got[k])) << name;
        else
          EXPECT_EQ(bitsOf(got[k]), bitsOf(wanted))
              << name << ' ' << a[i + k] << ' ' << b[i + k] << ' ' << c[i + k];
      }
    }
  }
}
#define EXPECT_SAME(expression)                                                                    \
  sameForEachLane(#expression, [](auto a, auto b, auto c) {                                        \
    using F = decltype(a);                                                                         \
    using Vec3 [[maybe_unused]] = rts::Vec3Of<F>;                                                  \
    using Color [[maybe_unused]] = rts::ColorOf<F>;                                                \
    (void)b;                                                                                       \
    (void)c;                                                                                       \
    return expression;                                                                             \
  })

TEST(ShaderLanes, OperationsGiveTheBytesOfFloats) {
  EXPECT_SAME(a + b);
  EXPECT_SAME(a - b);
  EXPECT_SAME(a * b);
  EXPECT_SAME(a / b);
  EXPECT_SAME(-a);
  EXPECT_SAME(2 * a + b / 3);
  EXPECT_SAME(rts::smaller(a, b));
  EXPECT_SAME(rts::larger(a, b));
  EXPECT_SAME(rts::absolute(a));
  EXPECT_SAME(rts::squareRoot(a));
  EXPECT_SAME(rts::select(a < b, b, c));
  EXPECT_SAME(rts::select(a <= b, b, c));
  EXPECT_SAME(rts::select(a > b, b, c));
  EXPECT_SAME(rts::select(a >= b, b, c));
  EXPECT_SAME(rts::select(a == b, b, c));
  EXPECT_SAME(rts::select(a != b, b, c));
  EXPECT_SAME(rts::select((a < b) & (b < c), F(1), 0));
  EXPECT_SAME(rts::select((a < b) | (b < c), F(1), 0));
  EXPECT_SAME(rts::select(!(a < b), F(1), 0));
  EXPECT_SAME(rts::eachLane([](float x, float y) { return std::pow(x, y); }, a, b));
}

TEST(ShaderLanes, VectorsAndColoursGiveTheBytesOfFloats) {
  EXPECT_SAME(rts::dot(Vec3{a, b, c}, Vec3{b, c, a}));
  EXPECT_SAME(rts::dot(Vec3{a, b, c}, rts::Vec3{1, 2, 3}));
  EXPECT_SAME(rts::cross(Vec3{a, b, c}, Vec3{b, c, a}).y);
  EXPECT_SAME(rts::length(Vec3{a, b, c}));
  EXPECT_SAME(rts::normalize(Vec3{a, b, c}).x);
  EXPECT_SAME(rts::reflect(Vec3{a, b, c}, Vec3{0, 0, 1}).z);
  EXPECT_SAME((2 * Vec3{a, b, c} - rts::Vec3{1, 2, 3} + -Vec3{c, b, a} * c).z);
  EXPECT_SAME(rts::select(a < b, Vec3{a, b, c}, rts::Vec3{1, 2, 3}).z);
  EXPECT_SAME((Color{a, b, c} * Color{c, a, b} + rts::Color{1, 2, 3} * b).b);
  EXPECT_SAME(((2 * Color{a, b, c} - Color{b, b, b}) / c).r);
  EXPECT_SAME(rts::select(a < b, Color{a, b, c}, rts::Color{1, 2, 3}).b);
}

TEST(ShaderLanes, UniformValuesAreTheSameInEveryLane) {
  const Lanes minusZero(-0.0f);
  for (uint32_t i = 0; i < Lanes::size; i++) {
    EXPECT_EQ(bitsOf(minusZero[i]), bitsOf(-0.0f));
    EXPECT_EQ(Lanes()[i], 0);
    EXPECT_TRUE(Mask(true)[i]);
    EXPECT_FALSE(Mask(false)[i]);
    EXPECT_EQ(LaneVec3(rts::Vec3{1, 2, 3}).y[i], 2);
    EXPECT_EQ(LaneColor(rts::Color{1, 2, 3}).b[i], 3);
  }
  EXPECT_EQ(RTS_LANES % Lanes::size, 0u);
}

// Two classes with the same formulas: for several hits, and for one hit only.
struct Formulas {
  template <class F> static rts::ColorOf<F> tint(F cosine) {
    return rts::Color{0.7f, 0.8f, 0.9f} * rts::select(cosine > 0.3f, 1 / (1 + cosine), cosine);
  }
  template <class F> static rts::ShadedOf<F> shaded(const rts::HitOf<F>& hit) {
    const rts::ColorOf<F> c = tint(rts::dot(rts::normalize(hit.position), hit.normal));
    return {c * rts::select(hit.back(), 0.5f, hit.distance), c * hit.uv.x, c};
  }
  template <class F>
  static rts::ColorOf<F> reflected(const rts::HitOf<F>& hit, const rts::LightOf<F>& light) {
    return light.color * rts::larger(0, rts::dot(hit.normal, light.toLight)) + light.ambient;
  }
  template <class F>
  static void lobes(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out, float share) {
    const auto local = hit.local();
    out.diffuse(tint(hit.cosine()) * share);
    out.normal(rts::normalize(hit.normal + local.position));
    out.glossy({hit.uv.x, hit.uv.y, share}, hit.segment, 1.5f);
    out.emission({hit.color.x, hit.color.y, local.normal.z});
    const rts::Vec4Of<F> texel = hit.sample({1}, hit.uv);
    out.albedo({texel.x, texel.y, rts::select(hit.line(), 1, texel.z)});
  }
  template <class F> static rts::IlluminationOf<F> lit(rts::Vec3Of<F> point) {
    const rts::Vec3Of<F> way = rts::Vec3{1, 2, 3} - point;
    return {way, rts::Color{1, 2, 3} * (1 / rts::dot(way, way)), {}};
  }
};

struct Several : rts::Surface<Several> {
  rts::Param<float> share{"share", 0.5f, "a number"};
  template <class F> rts::ShadedOf<F> shade(const rts::HitOf<F>& hit) const {
    return Formulas::shaded(hit);
  }
  template <class F>
  rts::ColorOf<F> reflect(const rts::HitOf<F>& hit, const rts::LightOf<F>& light) const {
    return Formulas::reflected(hit, light);
  }
  template <class F> rts::ColorOf<F> transmit(const rts::HitOf<F>& hit) const {
    return rts::Color{1, 1, 1} * (hit.uv.x * *share);
  }
  template <class F> void surface(const rts::HitOf<F>& hit, rts::ClosuresOf<F>& out) const {
    Formulas::lobes(hit, out, share);
  }
};
struct Single : rts::Surface<Single> {
  rts::Param<float> share{"share", 0.5f, "a number"};
  rts::Shaded shade(const rts::Hit& hit) const { return Formulas::shaded(hit); }
  rts::Color reflect(const rts::Hit& hit, const rts::Light& light) const {
    return Formulas::reflected(hit, light);
  }
  rts::Color transmit(const rts::Hit& hit) const {
    return rts::Color{1, 1, 1} * (hit.uv.x * *share);
  }
  void surface(const rts::Hit& hit, rts::Closures& out) const { Formulas::lobes(hit, out, share); }
};
struct SeveralPoints : rts::LightSource<SeveralPoints> {
  template <class F> rts::IlluminationOf<F> illuminate(rts::Vec3Of<F> point) const {
    return Formulas::lit(point);
  }
};
struct SinglePoint : rts::LightSource<SinglePoint> {
  rts::Illumination illuminate(rts::Vec3 point) const { return Formulas::lit(point); }
};
struct SeveralAround : rts::Environment<SeveralAround> {
  template <class F> rts::Vec4Of<F> miss(rts::Vec3Of<F> d) const {
    return {d.x / d.y, rts::larger(d.x, d.z), d.z, 1};
  }
  template <class F> rts::FogOf<F> attenuate(rts::Vec3Of<F> v) const {
    return {rts::Color{.1f, .2f, .3f}, 1 / (1 + rts::length(v))};
  }
};
struct SingleAround : rts::Environment<SingleAround> {
  rts::Vec4 miss(rts::Vec3 d) const { return {d.x / d.y, rts::larger(d.x, d.z), d.z, 1}; }
  rts::Fog attenuate(rts::Vec3 v) const { return {{.1f, .2f, .3f}, 1 / (1 + rts::length(v))}; }
};
struct SeveralPixels : rts::Camera<SeveralPixels> {
  template <class F> rts::RayOf<F> generate(rts::Vec2Of<F> pixel, rts::Vec2 size) const {
    return {{}, rts::normalize(rts::Vec3Of<F>{pixel.x - size.x, size.y - pixel.y, -1})};
  }
};
struct SinglePixel : rts::Camera<SinglePixel> {
  rts::Ray generate(rts::Vec2 pixel, rts::Vec2 size) const {
    return {{}, rts::normalize({pixel.x - size.x, size.y - pixel.y, -1})};
  }
};

template <class T> const RtsClass& classOf() { // once per class, as RTS_PLUGIN does
  static const RtsClass* const c = rts::detail::classOf<T>("a class");
  return *c;
}

TEST(ShaderLanes, TemplatesRunInLanesAndOthersHitByHit) {
  EXPECT_TRUE(rts::detail::SurfacesLanes<Several>::value);
  EXPECT_TRUE(rts::detail::ShadesLanes<Several>::value);
  EXPECT_TRUE(rts::detail::ReflectsLanes<Several>::value);
  EXPECT_TRUE(rts::detail::TransmitsLanes<Several>::value);
  EXPECT_TRUE(rts::detail::IlluminatesLanes<SeveralPoints>::value);
  EXPECT_TRUE(rts::detail::MissesLanes<SeveralAround>::value);
  EXPECT_TRUE(rts::detail::AttenuatesLanes<SeveralAround>::value);
  EXPECT_TRUE(rts::detail::GeneratesLanes<SeveralPixels>::value);
  EXPECT_FALSE(rts::detail::SurfacesLanes<Single>::value);
  EXPECT_FALSE(rts::detail::ShadesLanes<Single>::value);
  EXPECT_FALSE(rts::detail::ReflectsLanes<Single>::value);
  EXPECT_FALSE(rts::detail::TransmitsLanes<Single>::value);
  EXPECT_FALSE(rts::detail::IlluminatesLanes<SinglePoint>::value);
  EXPECT_FALSE(rts::detail::MissesLanes<SingleAround>::value);
  EXPECT_FALSE(rts::detail::AttenuatesLanes<SingleAround>::value);
  EXPECT_FALSE(rts::detail::GeneratesLanes<SinglePixel>::value);
}

// Arrays of n values, different in every lane and array; zero if `factor` is 0.
struct Arrays {
  Arrays(size_t count, uint32_t n, float factor) : lanes(count) {
    for (size_t k = 0; k < count; k++) {
      std::vector<float> values;
      for (uint32_t i = 0; i < n; i++)
        values.push_back(factor * std::sin(float(7 * k + 3 * i + 1)));
      lanes[k] = Lanes_(values);
    }
  }
  float* operator[](size_t k) { return lanes[k].data(); }
  using Lanes_ = openrt::test::Lanes;
  std::vector<Lanes_> lanes;
};

// A batch of n hits. Every third group of lanes has a hit with parameters of its own.
struct Batch {
  Batch(const RtsClass& c, uint32_t n)
      : usual(c), other(c), in(19, n, 1), flags(n + RTS_LANES), params(n + RTS_LANES, usual.get()) {
    other.set("share", {0.25f});
    for (uint32_t i = 0; i < n; i++) {
      flags[i] = i % 5 == 0 ? RTS_HIT_BACK : i % 7 == 0 ? RTS_HIT_LINE : 0;
      if (i % (3 * rts::Lanes::size) == 1) params[i] = other.get();
    }
    for (size_t k = 0; k < 3; k++) {
      hits.position[k] = in[k];
      hits.direction[k] = in[3 + k];
      hits.geometric[k] = in[6 + k];
      hits.normal[k] = in[9 + k];
    }
    for (size_t k = 0; k < 2; k++) hits.uv[k] = in[12 + k];
    for (size_t k = 0; k < 4; k++) hits.color[k] = in[14 + k];
    hits.distance = hits.segment = in[18];
    hits.count = n;
    hits.flags = flags.data();
    hits.params = params.data();
    host.hitCount = n;
    host.textures = {{4, {.1f, .2f, .3f, .4f}}};
    host.shining = {{{0, .6f, .8f}, {1, 2, 3}, {.1f, .2f, .3f}, .5f}};
  }
  ParamBlock usual, other;
  Arrays in;
  std::vector<uint32_t> flags;
  std::vector<const void*> params;
  RtsHits hits{};
  FakeHost host;
};

// The bits of the first n values of arrays.
std::vector<uint32_t> bitsOf(const std::vector<const float*>& arrays, uint32_t n) {
  std::vector<uint32_t> bits;
  for (const float* a : arrays)
    for (uint32_t i = 0; i < n; i++) bits.push_back(bitsOf(a[i]));
  return bits;
}

std::vector<uint32_t> surfaceBits(const RtsClass& c, uint32_t n) {
  Batch b(c, n);
  Arrays out(6, n, 0);
  RtsSurface surface{{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
  c.surface(&b.host, b.host.batch(), &b.hits, &surface);
  std::vector<const float*> arrays;
  for (size_t k = 0; k < 6; k++) arrays.push_back(out[k]);
  for (const FakeLobe& lobe : b.host.lobes) {
    arrays.insert(arrays.end(), lobe.table.weight, lobe.table.weight + 3);
    arrays.insert(arrays.end(), lobe.table.normal, lobe.table.normal + 3);
    arrays.insert(arrays.end(), lobe.table.parameter, lobe.table.parameter + 2);
  }
  return bitsOf(arrays, n);
}

std::vector<uint32_t> shadeBits(const RtsClass& c, uint32_t n) {
  Batch b(c, n);
  Arrays out(12, n, 0);
  RtsShading shading{{out[0], out[1], out[2]}, {out[3], out[4], out[5]}, {out[6], out[7], out[8]}};
  c.shade(&b.host, b.host.batch(), &b.hits, &shading);
  float* const through[3] = {out[9], out[10], out[11]};
  for (size_t k = 0; k < 3; k++) b.hits.normal[k] = b.hits.geometric[k] = nullptr;
  c.transmit(&b.host, b.host.batch(), &b.hits, through);
  std::vector<const float*> arrays;
  for (size_t k = 0; k < 12; k++) arrays.push_back(out[k]);
  return bitsOf(arrays, n);
}

std::vector<uint32_t> lightBits(const RtsClass& c, uint32_t n) {
  FakeHost host;
  const ParamBlock params(c);
  Arrays in(3, n, 1), out(9, n, 0);
  const float* const local[3] = {in[0], in[1], in[2]};
  RtsIllumination light{
      {out[0], out[1], out[2]}, {out[3], out[4], out[5]}, {out[6], out[7], out[8]}, 0};
  c.illuminate(&host, host.batch(), params.get(), n, local, &light);
  return bitsOf({out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7], out[8]}, n);
}

std::vector<uint32_t> environmentBits(const RtsClass& c, uint32_t n) {
  FakeHost host;
  const ParamBlock params(c);
  Arrays in(3, n, 1), out(8, n, 0);
  const float* const v[3] = {in[0], in[1], in[2]};
  float* const rgba[4] = {out[0], out[1], out[2], out[3]};
  float* const fog[3] = {out[4], out[5], out[6]};
  c.miss(&host, host.batch(), params.get(), n, v, rgba);
  c.attenuate(&host, host.batch(), params.get(), n, v, fog, out[7]);
  return bitsOf({out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7]}, n);
}

std::vector<uint32_t> cameraBits(const RtsClass& c, uint32_t n) {
  FakeHost host;
  const ParamBlock params(c);
  Arrays in(2, n, 1), out(6, n, 0);
  const float* const xy[2] = {in[0], in[1]};
  const float size[2] = {4, 3};
  RtsRays rays{{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
  c.generate(&host, host.batch(), params.get(), n, xy, size, &rays);
  return bitsOf({out[0], out[1], out[2], out[3], out[4], out[5]}, n);
}

TEST(ShaderLanes, ClassesGiveTheBytesOfSingleHits) {
  for (uint32_t n = 1; n <= 33; n++) {
    EXPECT_EQ(surfaceBits(classOf<Several>(), n), surfaceBits(classOf<Single>(), n)) << n;
    EXPECT_EQ(shadeBits(classOf<Several>(), n), shadeBits(classOf<Single>(), n)) << n;
    EXPECT_EQ(lightBits(classOf<SeveralPoints>(), n), lightBits(classOf<SinglePoint>(), n)) << n;
    EXPECT_EQ(environmentBits(classOf<SeveralAround>(), n),
              environmentBits(classOf<SingleAround>(), n))
        << n;
    EXPECT_EQ(cameraBits(classOf<SeveralPixels>(), n), cameraBits(classOf<SinglePixel>(), n)) << n;
  }
}

TEST(ShaderLanes, HitsOfOneBatchShareTheirLobes) {
  Batch b(classOf<Several>(), 33);
  Arrays out(3, 33, 0);
  RtsSurface surface{{out[0], out[1], out[2]}, {}};
  classOf<Several>().surface(&b.host, b.host.batch(), &b.hits, &surface);
  EXPECT_EQ(b.host.lobes.size(), 2u); // diffuse and glossy, though some hits are visited one by one
}

} // namespace
} // namespace openrt::test
