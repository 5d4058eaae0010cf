// openrt_texture.cpp: Tests texture lookups against values worked out by hand.
#include "shading/texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace openrt {
namespace {

struct Rgba {
  float r, g, b, a;
};

ArrayPtr arrayOf(const void* data, size_t bytes) {
  auto array = std::make_shared<Array>(bytes);
  std::memcpy(array->data(), data, bytes);
  return array;
}

edit::TextureT describe(uint32_t components, uint32_t width, uint32_t height) {
  edit::TextureT d;
  d.components = components;
  d.width = width;
  d.height = height;
  return d;
}

Texture bytes(edit::TextureT d, const std::vector<uint8_t>& texels) {
  return {d, arrayOf(texels.data(), texels.size())};
}

Texture floats(edit::TextureT d, const std::vector<float>& texels) {
  d.isFloat = true;
  return {d, arrayOf(texels.data(), texels.size() * sizeof(float))};
}

Rgba at(const Texture& texture, float u, float v) {
  Rgba out{};
  const float* uv[2] = {&u, &v};
  float* rgba[4] = {&out.r, &out.g, &out.b, &out.a};
  texture.sample(1, uv, rgba);
  return out;
}

TEST(OpenrtTexture, TexelCentersGiveTheTexelsFirstRowAtTheBottom) {
  const Texture t = floats(describe(3, 2, 2), {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  EXPECT_EQ(t.components(), 3u);
  EXPECT_FLOAT_EQ(at(t, 0.25f, 0.25f).r, 1);
  EXPECT_FLOAT_EQ(at(t, 0.75f, 0.25f).g, 5);
  EXPECT_FLOAT_EQ(at(t, 0.25f, 0.75f).b, 9);
  EXPECT_FLOAT_EQ(at(t, 0.75f, 0.75f).r, 10);
  EXPECT_FLOAT_EQ(at(t, 0.5f, 0.5f).r, (1 + 4 + 7 + 10) / 4.0f);
  EXPECT_FLOAT_EQ(at(t, 0.375f, 0.25f).r, 0.75f * 1 + 0.25f * 4);
  EXPECT_FLOAT_EQ(at(t, 0.5f, 0.5f).a, 1);
}

TEST(OpenrtTexture, GreyIsReplicatedAndAlphaKept) {
  const Rgba grey = at(floats(describe(1, 1, 1), {0.5f}), 0.3f, 0.3f);
  EXPECT_FLOAT_EQ(grey.r, 0.5f);
  EXPECT_FLOAT_EQ(grey.g, 0.5f);
  EXPECT_FLOAT_EQ(grey.b, 0.5f);
  EXPECT_FLOAT_EQ(grey.a, 1);
  const Rgba two = at(floats(describe(2, 1, 1), {0.5f, 0.25f}), 0.3f, 0.3f);
  EXPECT_FLOAT_EQ(two.b, 0.5f);
  EXPECT_FLOAT_EQ(two.a, 0.25f);
  EXPECT_FLOAT_EQ(at(floats(describe(4, 1, 1), {1, 2, 3, 0.125f}), 0.3f, 0.3f).a, 0.125f);
}

TEST(OpenrtTexture, RepeatJoinsTheEndsClampHoldsThem) {
  auto d = describe(1, 2, 1);
  const Texture repeated = floats(d, {0, 1});
  EXPECT_FLOAT_EQ(at(repeated, 0.0f, 0.5f).r, 0.5f);
  EXPECT_FLOAT_EQ(at(repeated, 1.0f, 0.5f).r, 0.5f);
  EXPECT_FLOAT_EQ(at(repeated, 1.25f, 0.5f).r, 0);
  EXPECT_FLOAT_EQ(at(repeated, -0.25f, 0.5f).r, 1);
  d.wrapS = edit::Wrap::Clamp;
  const Texture clamped = floats(d, {0, 1});
  EXPECT_FLOAT_EQ(at(clamped, 0.0f, 0.5f).r, 0);
  EXPECT_FLOAT_EQ(at(clamped, 1.0f, 0.5f).r, 1);
  EXPECT_FLOAT_EQ(at(clamped, 7.0f, 0.5f).r, 1);
  EXPECT_FLOAT_EQ(at(clamped, -7.0f, 0.5f).r, 0);
}

TEST(OpenrtTexture, TheAxesWrapIndependently) {
  auto d = describe(1, 2, 2);
  d.wrapT = edit::Wrap::Clamp;
  const Texture t = floats(d, {0, 1, 2, 3});
  EXPECT_FLOAT_EQ(at(t, 1.25f, -3).r, 0);
  EXPECT_FLOAT_EQ(at(t, -0.25f, 4).r, 3);
}

// Returns the texel of one axis that a wrap mode has at an index (OpenGL 4.6, table 8.20), -1 for
// the border.
int wrapped(edit::Wrap wrap, int index, int size) {
  const auto modulo = [](int a, int n) { return (a % n + n) % n; };
  switch (wrap) {
  case edit::Wrap::Repeat: return modulo(index, size);
  case edit::Wrap::Clamp: return std::clamp(index, 0, size - 1);
  case edit::Wrap::Mirror: {
    const int i = modulo(index, 2 * size) - size;
    return size - 1 - (i >= 0 ? i : -(1 + i));
  }
  case edit::Wrap::Border: return index < 0 || index >= size ? -1 : index;
  }
  return -1;
}

constexpr edit::Wrap allWraps[] = {edit::Wrap::Repeat, edit::Wrap::Clamp, edit::Wrap::Mirror,
                                   edit::Wrap::Border};

// Every pair of modes is as OpenGL defines it, for all numbers of components and small sizes.
TEST(OpenrtTexture, WrapModesAreThoseOfOpenGl) {
  std::mt19937 random(7);
  const std::vector<float> border = {0.25f, 0.5f, 0.75f, 0.125f};
  for (int round = 0; round < 400; round++) {
    const uint32_t components = 1 + random() % 4, width = 1 + random() % 5,
                   height = 1 + random() % 5;
    auto d = describe(components, width, height);
    d.wrapS = allWraps[random() % 4];
    d.wrapT = allWraps[random() % 4];
    d.nearest = random() % 2;
    d.border = border;
    std::vector<float> texels(size_t(components) * width * height);
    for (float& texel : texels) texel = float(random() % 1000) / 1000;
    const Texture texture = floats(d, texels);
    const auto texel = [&](int i, int j, int c) -> double {
      const int x = wrapped(d.wrapS, i, int(width)), y = wrapped(d.wrapT, j, int(height));
      const bool alpha = c == 3 || (c == 1 && components == 2);
      if (x < 0 || y < 0) return border[alpha ? 3 : size_t(c)];
      return texels[size_t((y * int(width) + x) * int(components) + c)];
    };
    for (int place = 0; place < 50; place++) {
      // Places between the edges of texels, where the nearest one is certain.
      const auto between = [&](uint32_t size) {
        return (double(int(random() % (8 * size)) - int(4 * size)) + 0.1 +
                0.8 * double(random() % 997) / 997) /
               size;
      };
      const auto u = float(between(width)), v = float(between(height));
      const double x = double(u) * width - (d.nearest ? 0 : 0.5),
                   y = double(v) * height - (d.nearest ? 0 : 0.5);
      const int i = int(std::floor(x)), j = int(std::floor(y));
      const double s = d.nearest ? 0 : x - i, t = d.nearest ? 0 : y - j;
      const auto value = [&](int c) {
        return (texel(i, j, c) * (1 - s) + texel(i + 1, j, c) * s) * (1 - t) +
               (texel(i, j + 1, c) * (1 - s) + texel(i + 1, j + 1, c) * s) * t;
      };
      const bool grey = components <= 2;
      const Rgba seen = at(texture, u, v);
      const std::string where = std::to_string(components) + " components, " +
                                std::to_string(int(d.wrapS)) + std::to_string(int(d.wrapT)) +
                                " at " + std::to_string(u) + " " + std::to_string(v);
      ASSERT_NEAR(seen.r, value(0), 2e-5) << where;
      ASSERT_NEAR(seen.g, value(grey ? 0 : 1), 2e-5) << where;
      ASSERT_NEAR(seen.b, value(grey ? 0 : 2), 2e-5) << where;
      ASSERT_NEAR(seen.a, components % 2 == 0 ? value(int(components) - 1) : 1, 2e-5) << where;
    }
  }
}

TEST(OpenrtTexture, MirroredPicturesAreSymmetric) {
  for (const bool nearest : {false, true}) {
    auto d = describe(1, 5, 1);
    d.wrapS = edit::Wrap::Mirror;
    d.nearest = nearest;
    const Texture t = floats(d, {0.1f, 0.7f, 0.2f, 0.9f, 0.4f});
    std::mt19937 random(3);
    for (int i = 0; i < 2000; i++) {
      const float u = float(random() % 4096) / 2048; // sums with small integers are exact
      const float value = at(t, u, 0).r;
      EXPECT_EQ(at(t, -u, 0).r, value) << u;
      EXPECT_EQ(at(t, 2 - u, 0).r, value) << u;
      EXPECT_EQ(at(t, u + 1024, 0).r, value) << u;
      EXPECT_EQ(at(t, u - 1024, 0).r, value) << u;
    }
    EXPECT_EQ(at(t, 0, 0).r, 0.1f); // an edge meets its mirror image
    EXPECT_EQ(at(t, 1, 0).r, 0.4f);
  }
}

TEST(OpenrtTexture, ABorderBeginsAtTheEdgeAndBlendsOverATexel) {
  auto d = describe(1, 2, 1);
  d.wrapS = edit::Wrap::Border;
  d.border = {0.5f, 0, 0, 0};
  const Texture t = floats(d, {0, 1});
  EXPECT_FLOAT_EQ(at(t, 0, 0.5f).r, 0.25f); // half a texel, half the border
  EXPECT_FLOAT_EQ(at(t, -0.125f, 0.5f).r, 0.375f);
  EXPECT_FLOAT_EQ(at(t, -0.25f, 0.5f).r, 0.5f);
  EXPECT_FLOAT_EQ(at(t, 1, 0.5f).r, 0.75f);
  EXPECT_FLOAT_EQ(at(t, 1.25f, 0.5f).r, 0.5f);
  EXPECT_FLOAT_EQ(at(t, 100, 0.5f).r, 0.5f);
  EXPECT_FLOAT_EQ(at(t, 0.75f, 900).r, 1); // the other axis repeats
  d.nearest = true;
  const Texture blocks = floats(d, {0, 1});
  EXPECT_EQ(at(blocks, -0.001f, 0.5f).r, 0.5f);
  EXPECT_EQ(at(blocks, 0.001f, 0.5f).r, 0);
  EXPECT_EQ(at(blocks, 0.999f, 0.5f).r, 1);
  EXPECT_EQ(at(blocks, 1.001f, 0.5f).r, 0.5f);
  d.border.clear(); // as in recordings of older versions
  EXPECT_EQ(at(floats(d, {1, 1}), 7, 0.5f).r, 0);
}

// The border is linear, whatever the texels are; that of grey is its red.
TEST(OpenrtTexture, ABorderHasTheComponentsOfItsTexture) {
  for (const uint32_t components : {1u, 2u, 3u, 4u}) {
    auto d = describe(components, 1, 1);
    d.srgb = true;
    d.wrapS = d.wrapT = edit::Wrap::Border;
    d.border = {0.25f, 0.5f, 0.75f, 0.125f};
    const Rgba out = at(bytes(d, {9, 9, 9, 9}), 3, -3);
    EXPECT_EQ(out.r, 0.25f);
    EXPECT_EQ(out.g, components < 3 ? 0.25f : 0.5f);
    EXPECT_EQ(out.b, components < 3 ? 0.25f : 0.75f);
    EXPECT_EQ(out.a, components % 2 == 0 ? 0.125f : 1);
  }
}

TEST(OpenrtTexture, NearestTakesOneTexel) {
  auto d = describe(1, 2, 2);
  d.nearest = true;
  const Texture t = floats(d, {0, 1, 2, 3});
  EXPECT_EQ(at(t, 0.49f, 0.1f).r, 0);
  EXPECT_EQ(at(t, 0.51f, 0.1f).r, 1);
  EXPECT_EQ(at(t, 0.99f, 0.99f).r, 3);
  EXPECT_EQ(at(t, 1.01f, 0.1f).r, 0);
  // 1 - 1e-9 rounds to 1, which still belongs to the last texel
  EXPECT_EQ(at(t, -1e-9f, 0.1f).r, 1);
}

TEST(OpenrtTexture, BytesAreDecodedBeforeTheyAreMixed) {
  auto d = describe(1, 2, 1);
  EXPECT_FLOAT_EQ(at(bytes(d, {51, 51}), 0.25f, 0.5f).r, 0.2f);
  d.srgb = true;
  const Texture t = bytes(d, {0, 255});
  EXPECT_FLOAT_EQ(at(t, 0.5f, 0.5f).r, 0.5f);
  EXPECT_NEAR(at(bytes(d, {188, 188}), 0.5f, 0.5f).r, 0.50289,
              1e-5); // ((188/255 + .055) / 1.055)^2.4
  EXPECT_NEAR(at(bytes(d, {10, 10}), 0.5f, 0.5f).r, 10 / 255.0 / 12.92, 1e-8);
}

TEST(OpenrtTexture, AlphaBytesAreNeverSrgb) {
  auto d = describe(4, 1, 1);
  d.srgb = true;
  const Rgba rgba = at(bytes(d, {188, 188, 188, 51}), 0.5f, 0.5f);
  EXPECT_NEAR(rgba.r, 0.50289, 1e-5);
  EXPECT_FLOAT_EQ(rgba.a, 0.2f);
  auto grey = describe(2, 1, 1);
  grey.srgb = true;
  EXPECT_FLOAT_EQ(at(bytes(grey, {255, 51}), 0.5f, 0.5f).a, 0.2f);
}

TEST(OpenrtTexture, CoordinatesThatAreNotNumbersCountAsZero) {
  const float inf = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  for (const edit::Wrap wrap : allWraps)
    for (const bool nearest : {false, true}) {
      auto d = describe(1, 3, 3);
      d.wrapS = d.wrapT = wrap;
      d.border = {1, 1, 1, 1};
      d.nearest = nearest;
      const Texture t = floats(d, {1, 2, 3, 4, 5, 6, 7, 8, 9});
      const float zero = at(t, 0, 0).r;
      for (const float bad : {inf, -inf, nan}) EXPECT_EQ(at(t, bad, bad).r, zero);
      for (const float huge : {1e30f, -1e30f, 3.4e38f, -3.4e38f, 1e-45f}) {
        const float value = at(t, huge, huge).r;
        EXPECT_TRUE(value >= 1 && value <= 9) << huge << " gives " << value;
      }
    }
}

TEST(OpenrtTexture, WholeBatchesOfOddLength) {
  const Texture t = floats(describe(1, 4, 1), {0, 1, 2, 3});
  constexpr uint32_t n = 37;
  std::vector<float> u(n), v(n, 0.5f);
  std::vector<float> out[4];
  for (auto& c : out) c.assign(n + 1, -1.0f);
  for (uint32_t i = 0; i < n; i++) u[i] = (0.5f + float(i % 4)) / 4 + float(i / 4);
  const float* uv[2] = {u.data(), v.data()};
  float* rgba[4] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
  t.sample(n, uv, rgba);
  for (uint32_t i = 0; i < n; i++) EXPECT_NEAR(out[0][i], float(i % 4), 1e-5);
  EXPECT_EQ(out[0][n], -1.0f);
}

TEST(OpenrtTexture, DescriptionsThatDoNotFitSampleAsWhite) {
  const std::vector<float> texels(12, 0.5f);
  const ArrayPtr array = arrayOf(texels.data(), texels.size() * sizeof(float));
  auto tooLarge = describe(3, 3, 2);
  tooLarge.isFloat = true;
  auto wide = describe(4, 0x80000000u, 0x80000000u), empty = describe(1, 0, 5),
       five = describe(5, 1, 1);
  for (const auto& d : {tooLarge, wide, empty, five}) {
    const Texture t(d, array);
    EXPECT_EQ(t.components(), 0u);
    EXPECT_EQ(at(t, 0.3f, 0.3f).g, 1);
  }
  EXPECT_EQ(at(Texture(describe(1, 1, 1), nullptr), 0, 0).a, 1);
}

} // namespace
} // namespace openrt
