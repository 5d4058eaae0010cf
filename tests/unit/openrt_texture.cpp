// openrt_texture.cpp: Tests texture lookups against values worked out by hand.
#include "shading/texture.h"

#include <cmath>
#include <cstring>
#include <limits>
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

TEST(OpenrtTexture, TexelCentresGiveTheTexelsFirstRowAtTheBottom) {
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
  for (const bool clamp : {false, true})
    for (const bool nearest : {false, true}) {
      auto d = describe(1, 3, 3);
      d.wrapS = d.wrapT = clamp ? edit::Wrap::Clamp : edit::Wrap::Repeat;
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
