// openrt_texture_volumes.cpp: Tests lookups in textures with depth against values worked out by
// hand, and the calls of the API that make them.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"
#include "shading/texture.h"

namespace openrt {
namespace {

struct Rgba {
  float r, g, b, a;
};

// A volume of 2 x 2 x 2 texels of one component: 0, 10, 20 ... 70, s fastest and r slowest.
edit::TextureT eight() {
  edit::TextureT d;
  d.components = 1;
  d.width = d.height = d.depth = 2;
  d.isFloat = true;
  d.wrapS = d.wrapT = d.wrapR = edit::Wrap::Clamp;
  return d;
}
Texture volume(const edit::TextureT& d,
               const std::vector<float>& texels = {0, 10, 20, 30, 40, 50, 60, 70}) {
  auto array = std::make_shared<Array>(texels.size() * sizeof(float));
  std::memcpy(array->data(), texels.data(), array->size());
  return {d, array};
}
Rgba at(const Texture& texture, float s, float t, float r) {
  Rgba out{};
  const float* str[3] = {&s, &t, &r};
  float* rgba[4] = {&out.r, &out.g, &out.b, &out.a};
  texture.sampleVolume(1, str, rgba);
  return out;
}

TEST(OpenrtTextureVolumes, TexelCentresAndTheMeanBetweenThem) {
  const Texture t = volume(eight());
  EXPECT_FLOAT_EQ(at(t, .25f, .25f, .25f).r, 0);
  EXPECT_FLOAT_EQ(at(t, .75f, .25f, .25f).r, 10);
  EXPECT_FLOAT_EQ(at(t, .25f, .75f, .25f).r, 20);
  EXPECT_FLOAT_EQ(at(t, .25f, .25f, .75f).r, 40);
  EXPECT_FLOAT_EQ(at(t, .5f, .5f, .5f).r, 35);
  EXPECT_FLOAT_EQ(at(t, .25f, .25f, .375f).r, 10); // a quarter of the way
  EXPECT_FLOAT_EQ(at(t, .25f, .25f, .375f).g, 10); // grey
  EXPECT_FLOAT_EQ(at(t, .25f, .25f, .375f).a, 1);
}

TEST(OpenrtTextureVolumes, EachAxisHasItsWrap) {
  edit::TextureT d = eight();
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 7).r, 40);
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, -7).r, 0);
  d.wrapR = edit::Wrap::Repeat;
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 3.25f).r, 0);
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 0).r, 20); // between the last and the first slice
  d.wrapR = edit::Wrap::Mirror;
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 1.25f).r, 40);
  d.wrapR = edit::Wrap::Border;
  d.border = {100, 100, 100, 1};
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 3).r, 100);
  EXPECT_FLOAT_EQ(at(volume(d), .25f, .25f, 1).r, 70); // half the slice, half the border
}

TEST(OpenrtTextureVolumes, NearestBytesAndComponents) {
  edit::TextureT d = eight();
  d.nearest = true;
  EXPECT_FLOAT_EQ(at(volume(d), .1f, .9f, .6f).r, 60);
  d = eight();
  d.isFloat = false;
  d.components = 4;
  d.width = d.height = 1;
  auto texels = std::make_shared<Array>(8);
  const uint8_t bytes[8] = {255, 0, 0, 51, 0, 0, 255, 153};
  std::memcpy(texels->data(), bytes, 8);
  const Rgba mean = at(Texture(d, texels), .5f, .5f, .5f);
  EXPECT_FLOAT_EQ(mean.r, .5f);
  EXPECT_FLOAT_EQ(mean.g, 0);
  EXPECT_FLOAT_EQ(mean.b, .5f);
  EXPECT_FLOAT_EQ(mean.a, .4f);
  d.components = 2;
  d.depth = 4;
  EXPECT_FLOAT_EQ(at(Texture(d, texels), .5f, .5f, .625f).r, 0);   // third slice: 0 0
  EXPECT_FLOAT_EQ(at(Texture(d, texels), .5f, .5f, .875f).a, .6f); // fourth: 255 153
}

TEST(OpenrtTextureVolumes, PlacesThatAreNoneAndShortArrays) {
  const float inf = std::numeric_limits<float>::infinity(), nan = NAN;
  const Texture t = volume(eight());
  EXPECT_FLOAT_EQ(at(t, nan, .25f, .75f).r, 40);
  EXPECT_FLOAT_EQ(at(t, inf, -inf, nan).r, 0);
  edit::TextureT d = eight();
  d.depth = 3;
  EXPECT_EQ(volume(d).components(), 0u);
  EXPECT_FLOAT_EQ(at(volume(d), .5f, .5f, .5f).r, 1);
  d.depth = 0;
  EXPECT_EQ(volume(d).components(), 0u);
  d = eight();
  d.width = d.height = d.depth = 1u << 23;
  EXPECT_EQ(volume(d).components(), 0u);
}

// A picture has one slice everywhere, and sample() sees the first one of a volume.
TEST(OpenrtTextureVolumes, PicturesAndVolumesMeetInTheFirstSlice) {
  edit::TextureT d = eight();
  d.depth = 1;
  for (const float r : {-3.0f, 0.0f, .4f, NAN}) EXPECT_FLOAT_EQ(at(volume(d), .75f, .25f, r).r, 10);
  const float u = .75f, v = .25f;
  const float* uv[2] = {&u, &v};
  Rgba out{};
  float* rgba[4] = {&out.r, &out.g, &out.b, &out.a};
  volume(eight()).sample(1, uv, rgba);
  EXPECT_FLOAT_EQ(out.r, 10);
}

TEST(OpenrtTextureVolumes, SizesOfTheCallAreChecked) {
  RTcontext context = rtNewContext("threads=1 backend=null");
  ASSERT_NE(context, nullptr);
  const std::vector<uint8_t> bytes(64, 1);
  const auto error = [&](int components, int w, int h, int d) {
    rtTexImage3D(components, w, h, d, RT_UNSIGNED_BYTE, bytes.data());
    return rtGetError();
  };
  EXPECT_EQ(error(1, 2, 2, 2), RTenum(RT_INVALID_OPERATION)); // none is bound
  RTid id = 0;
  rtGenTextures(1, &id);
  rtBindTexture(id);
  EXPECT_EQ(error(2, 2, 3, 4), RTenum(RT_NO_ERROR));
  for (const auto& [w, h, d] : {std::array{0, 1, 1},
                                {1, 1, 0},
                                {1, 1, -1},
                                {1, 1, 65537},
                                {65536, 65536, 65536},
                                {2147483647, 2147483647, 2147483647},
                                {1024, 1024, 257}})
    EXPECT_EQ(error(1, w, h, d), RTenum(RT_INVALID_VALUE)) << w << ' ' << h << ' ' << d;
  EXPECT_EQ(error(5, 1, 1, 1), RTenum(RT_INVALID_VALUE));
  rtTexParameteri(RT_TEXTURE_WRAP_R, RT_CLAMP_TO_EDGE);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  rtTexParameteri(RT_TEXTURE_WRAP_R, RT_LINEAR);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_ENUM));
  rtDeleteContext(context);
}

} // namespace
} // namespace openrt
