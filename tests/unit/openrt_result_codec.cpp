// openrt_result_codec.cpp: Tests the encoding of job results. Decoding returns exactly what was
// encoded and refuses anything else.
#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "render/frame/result_codec.h"
#include "scene/channels.h"

namespace openrt {
namespace {

constexpr Tile tile{16, 32, 29, 40};
constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();

edit::FrameSettingsT frameOf(uint32_t channels) {
  edit::FrameSettingsT frame;
  frame.width = 40;
  frame.height = 40;
  frame.channels = channels;
  frame.samples = 64;
  return frame;
}

// Makes sums with all difficult values, for exactly the channels of the frame.
JobResult resultOf(const edit::FrameSettingsT& frame, const Job& job, uint32_t seed) {
  std::mt19937 random(seed);
  const auto number = [&]() -> double {
    switch (random() % 10) {
    case 0: return nan;
    case 1: return -inf;
    case 2: return -0.0;
    case 3: return 1e-310; // denormal
    case 4: return 1e-40;  // denormal as a float
    case 5: return 1e300;
    case 6: return 0.5;
    case 7: return std::bit_cast<double>(0x7ff4deadbeef0001u); // signalling NaN with a payload
    default: return std::ldexp(double(random()), -20) + std::ldexp(double(random()), -60);
    }
  };
  const bool floats = random() % 2, same = random() % 3 == 0;
  const double one = number();
  const auto value = [&]() -> double {
    return same ? one : floats ? double(float(random())) : number();
  };
  const RequiredSums g = requiredSums(frame);
  JobResult result;
  result.ledger = {number(),
                   number(),
                   number(),
                   {number(), number(), number(), number()},
                   {number(), number(), number(), number()},
                   job.count};
  result.sums.resize(tile.pixels());
  for (uint32_t pixel = 0; pixel < tile.pixels() && g.names; pixel++)
    for (uint64_t k = random() % 4; k > 0; k--) result.hits.add(pixel, uint32_t(random() % 5));
  result.hits.finish();
  for (PixelSums& s : result.sums) {
    s.samples = job.count;
    for (double& x : s.rgba) x = value();
    for (const ChannelInfo& row : channelTable)
      for (uint32_t k = 0; k < row.components && (frame.channels & row.bit); k++) {
        if (row.source == ChannelSource::firstSample) s.firstValues[row.place + k] = float(value());
        if (row.source == ChannelSource::mean) s.valueSums[row.place + k] = value();
      }
    for (int k = 0; k < 3; k++) {
      if (g.spread) {
        s.first[k] = value();
        s.delta[k] = value();
        s.delta2[k] = value();
      }
      if (!g.error) continue;
      s.closed[k] = value();
      s.closed2[k] = value();
      s.closed3[k] = value();
      s.closed4[k] = value();
      s.grey[k] = value();
      s.largest[k] = float(value());
    }
    s.random = g.error ? uint8_t(random() % 4) : 0;
    if (g.error && job.replicates.many() && job.count >= job.replicates.size())
      s.replicates = job.count / job.replicates.size();
  }
  return result;
}

// Compares the bytes of sums that were zero at first, also between the fields.
bool sameBytes(const std::vector<PixelSums>& a, const std::vector<PixelSums>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); i++)
    if (std::memcmp(&a[i], &b[i], offsetof(PixelSums, random)) != 0 || a[i].random != b[i].random)
      return false;
  return true;
}

TEST(ResultCodec, EveryCombinationOfChannelsComesBackExactly) {
  for (uint32_t channels = 1; channels <= allChannels; channels++) {
    const edit::FrameSettingsT frame = frameOf(channels);
    const Job job{
        .number = 3, .first = 32, .count = 32, .replicates = {7, channels % 2 ? 3u : 31u}};
    const JobResult in = resultOf(frame, job, channels);
    const std::vector<std::byte> bytes = encodeResult(frame, job, in);
    JobResult out;
    out.light.resize(5); // left over from an earlier job
    ASSERT_TRUE(decodeResult(frame, job, tile, bytes, out)) << channels;
    ASSERT_TRUE(sameBytes(in.sums, out.sums)) << channels;
    ASSERT_TRUE(std::ranges::equal(in.hits.all(), out.hits.all())) << channels;
    ASSERT_EQ(std::memcmp(&in.ledger, &out.ledger, sizeof(Ledger)), 0);
    ASSERT_TRUE(out.light.empty());
    ASSERT_EQ(encodeResult(frame, job, out), bytes);
  }
}

TEST(ResultCodec, WhatIsTheSameEverywhereIsSentOnce) {
  const edit::FrameSettingsT frame = frameOf(allChannels);
  const Job job{.count = 32, .replicates = {0, 3}};
  JobResult in;
  in.sums.resize(tile.pixels());
  EXPECT_LT(encodeResult(frame, job, in).size(), 500u);
}

TEST(ResultCodec, FloatsTravelAsFloats) {
  const edit::FrameSettingsT frame = frameOf(RT_RGBA);
  const Job job{.count = 1};
  JobResult in;
  in.sums.resize(tile.pixels());
  for (size_t i = 0; i < in.sums.size(); i++)
    for (int k = 0; k < 4; k++) in.sums[i].rgba[k] = double(float(i) / 3);
  EXPECT_EQ(encodeResult(frame, job, in).size(), 11 * 8 + 4 * (1 + 4 * tile.pixels()));
}

TEST(ResultCodec, LightComesBackExactly) {
  const edit::FrameSettingsT frame = frameOf(RT_RGBA);
  const Job job{.kind = Job::Kind::light, .number = 2, .count = 1000};
  std::mt19937 random(1);
  for (const int density : {0, 1, 30, 99, 100}) {
    JobResult in, out;
    in.light.resize(40 * 40 * 3);
    for (float& x : in.light)
      if (int(random() % 100) < density) x = random() % 9 ? float(random()) : -0.0f;
    const std::vector<std::byte> bytes = encodeResult(frame, job, in);
    EXPECT_LE(bytes.size(), 88 + 12 + in.light.size() * 4 * 2);
    ASSERT_TRUE(decodeResult(frame, job, tile, bytes, out));
    ASSERT_EQ(out.light.size(), in.light.size());
    EXPECT_EQ(std::memcmp(in.light.data(), out.light.data(), in.light.size() * 4), 0);
  }
}

TEST(ResultCodec, WhatIsCutOrTooLongIsRefused) {
  const edit::FrameSettingsT frame = frameOf(allChannels);
  const Job samples{.count = 32, .replicates = {0, 3}},
      light{.kind = Job::Kind::light, .count = 10};
  JobResult in = resultOf(frame, samples, 5), out;
  in.light.resize(40 * 40 * 3);
  for (size_t i = 0; i < in.light.size(); i += 40) in.light[i] = 1;
  in.light.back() = 1;
  for (const Job& job : {samples, light}) {
    const std::vector<std::byte> bytes = encodeResult(frame, job, in);
    ASSERT_TRUE(decodeResult(frame, job, tile, bytes, out));
    for (size_t size = 0; size < bytes.size(); size += 1 + size / 50) {
      const bool whole = job.kind == Job::Kind::light && size >= 88 && (size - 88) % 12 == 0;
      EXPECT_EQ(decodeResult(frame, job, tile, std::span(bytes).first(size), out), whole)
          << size; // the light sums may end in zeros
    }
    std::vector<std::byte> longer = bytes;
    longer.push_back(std::byte(0));
    EXPECT_FALSE(decodeResult(frame, job, tile, longer, out));
    EXPECT_FALSE(decodeResult(frame, job, tile, std::vector<std::byte>(bytes.size()), out) &&
                 job.kind == Job::Kind::light);
  }
  // A result of another tile or another frame.
  const std::vector<std::byte> bytes = encodeResult(frame, samples, in);
  EXPECT_FALSE(decodeResult(frame, samples, {0, 0, 16, 16}, bytes, out));
  EXPECT_FALSE(decodeResult(frameOf(RT_RGBA), samples, tile, bytes, out));
}

TEST(ResultCodec, RandomBytesDoNoHarm) {
  std::mt19937 random(2);
  const edit::FrameSettingsT frame = frameOf(allChannels);
  const Job samples{.count = 32, .replicates = {0, 3}},
      light{.kind = Job::Kind::light, .count = 10};
  JobResult good = resultOf(frame, samples, 5), out;
  good.light.assign(40 * 40 * 3, 0.5f);
  for (const Job& job : {samples, light}) {
    const std::vector<std::byte> bytes = encodeResult(frame, job, good);
    for (int i = 0; i < 2000; i++) {
      std::vector<std::byte> wrong = bytes;
      for (int k = 0; k < 1 + i % 5; k++)
        wrong[random() % std::min<size_t>(wrong.size(), i % 2 ? 64 : wrong.size())] =
            std::byte(random());
      wrong.resize(random() % (wrong.size() + 10));
      decodeResult(frame, job, tile, wrong, out);
      if (!out.sums.empty()) { ASSERT_EQ(out.sums.size(), tile.pixels()); }
    }
  }
}

} // namespace
} // namespace openrt
