// kept_sums.cpp: sums of frames that are kept (openrt/sums.h): a frame that is continued has the
// bytes of one that was not interrupted, frames of several seeds add up to the same bytes in any
// order, and the intervals of the sum contain the truth. Damaged bytes are refused.
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "numeric/support.h"
#include "openrt/sums.h"

namespace numeric {
namespace {

constexpr std::pair<uint32_t, int> planes[] = {{RT_RGBA, 4},     {RT_DEPTH, 1},    {RT_NORMAL, 3},
                                               {RT_VARIANCE, 3}, {RT_SAMPLES, 1},  {RT_ERROR, 3},
                                               {RT_TRUST, 1},    {RT_COVERAGE, 16}};
constexpr int width = 48, height = 32;
constexpr uint32_t channels =
    RT_RGBA | RT_DEPTH | RT_NORMAL | RT_VARIANCE | RT_SAMPLES | RT_COVERAGE;
constexpr uint32_t withErrors = channels | RT_ERROR | RT_TRUST;

struct Delete {
  void operator()(RTsums sums) const { rtDeleteSums(sums); }
};
using Sums = std::unique_ptr<RTsumsObject, Delete>;

struct Told { // how a frame is made
  int samples = 64;
  uint32_t channels = numeric::channels;
  int seed = 0, threads = 1, progressive = 0;
  RTenum transport = RT_TRANSPORT_PATH;
  double error = 0;
  double brightness = 1; // brightness of the lamp: another world if it differs
};

void defineScene(const Told& told) {
  Shader floor("Diffuse"), lamp("Diffuse");
  floor.set("reflectance", {.7, .6, .5});
  lamp.set("emission", {told.brightness, told.brightness, told.brightness});
  const auto square = [](RTid shader, double half, double z, bool down) {
    rtLoadName(down ? 2 : 1);
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtBegin(RT_QUADS);
    rtNormal3f(0, 0, down ? -1 : 1);
    const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (const auto& c : corners) rtVertex3d(half * c[0], half * c[1], z);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    rtLoadIdentity();
    rtInstantiateObject(object);
  };
  square(floor, 4, 0, false);
  square(floor, 1, .7, false); // casts a shadow
  square(lamp, .5, 3, true);
  if (told.transport == RT_TRANSPORT_LIGHT) {
    Shader mirror("Metal");
    const RTid object = rtBeginObject(0);
    rtBindShader(mirror);
    rtBegin(RT_QUADS);
    const double corners[4][2] = {{-2, 0}, {2, 0}, {2, 3}, {-2, 3}};
    for (const auto& c : corners) rtVertex3d(c[0], 2, c[1]);
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    rtInstantiateObject(object);
  }
  rtLoadIdentity();
  rtLookAt(0, -5, 4, 0, 0, 0, 0, 0, 1);
  rtPerspective(50);
  rtLoadIdentity();
}

// A context with the scene and the settings of a frame.
class Maker {
 public:
  explicit Maker(const Told& told, bool keep = true) : told_(told) {
    context = rtNewContext(("threads=" + std::to_string(told.threads)).c_str());
    EXPECT_NE(context, nullptr);
    if (keep) rtKeepSums(1);
    defineScene(told);
    settings(told);
  }
  ~Maker() {
    rtMakeCurrent(context);
    rtDeleteContext(context);
  }
  Maker(const Maker&) = delete;
  void settings(const Told& told) const {
    rtFrameBuffer(width, height, told.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, told.samples);
    rtQuality(RT_SEED, told.seed);
    rtQuality(RT_PROGRESSIVE, told.progressive);
    rtQuality(RT_TRANSPORT, int(told.transport));
    rtQuality(RT_MAX_DEPTH, 4);
    rtQualityf(RT_TARGET_ERROR, told.error);
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  }
  Sums sums() const { return Sums(rtGetSums(context)); }
  RTcontext context = nullptr;

 private:
  Told told_;
};

// Returns all channels of the frame that is current, and the statistics that belong to it.
std::vector<float> pixels(uint32_t wanted) {
  std::vector<float> all;
  for (const auto& [bit, components] : planes) {
    if (!(wanted & bit)) continue;
    std::vector<float> one(size_t(width) * height * size_t(components));
    rtReadPixels(bit, one.data(), one.size());
    all.insert(all.end(), one.begin(), one.end());
  }
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  return all;
}

std::vector<float> pixelsOf(const Sums& sums, uint32_t wanted) {
  std::vector<float> all;
  for (const auto& [bit, components] : planes) {
    if (!(wanted & bit)) continue;
    std::vector<float> one(size_t(width) * height * size_t(components));
    EXPECT_EQ(rtReadSumsPixels(sums.get(), bit, one.data(), one.size()), 1)
        << (rtGetError(), rtGetErrorMessage());
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

template <class T> bool equal(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expectSameNumbers(const RTstats& a, const RTstats& b) {
  EXPECT_EQ(std::memcmp(&a.rays, &b.rays, sizeof a.rays), 0);
  EXPECT_EQ(std::memcmp(&a.error, &b.error, sizeof a.error), 0);
  EXPECT_EQ(std::memcmp(&a.leftOut, &b.leftOut, sizeof a.leftOut), 0);
}

RTstats statsHere() {
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  return stats;
}

int appendBytes(const void* data, size_t size, void* to) {
  auto& out = *static_cast<std::vector<char>*>(to);
  out.insert(out.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size);
  return 1;
}

std::vector<char> bytesOf(const Sums& sums) {
  std::vector<char> out;
  EXPECT_EQ(rtWriteSums(sums.get(), appendBytes, &out), 1);
  return out;
}

Sums fromBytes(const std::vector<char>& bytes) {
  return Sums(rtReadSums(bytes.data(), bytes.size()));
}

RTsumsInfo infoOf(const Sums& sums) {
  RTsumsInfo info{};
  info.size = sizeof info;
  EXPECT_EQ(rtGetSumsInfo(sums.get(), &info), 1);
  return info;
}

struct Made {
  std::vector<float> pixels;
  RTstats stats{};
};

Made whole(const Told& told, bool keep = false) {
  const Maker maker(told, keep);
  rtRender();
  Made made{pixels(told.channels), statsHere()};
  return made;
}

// Returns sums of the frame at several moments, as bytes. The last ones are those of the finished
// frame.
std::vector<std::vector<char>> moments(const Told& told, const Sums& from = nullptr) {
  const Maker maker(told);
  if (from) rtContinueFrom(from.get());
  rtSwapBuffers();
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  std::vector<std::vector<char>> out;
  double next = 0;
  while (rtProgress(maker.context) < 1 && next < 1) {
    const Sums sums = maker.sums();
    const double done = infoOf(sums).done;
    if (done < next) continue;
    out.push_back(bytesOf(sums));
    next = done + .2;
  }
  rtFinishFrame();
  out.push_back(bytesOf(maker.sums()));
  return out;
}

// Makes the frame of the maker from sums of an earlier one.
void renderFrom(const Sums& sums) {
  rtContinueFrom(sums.get());
  rtRender();
}

std::string lastError() {
  EXPECT_EQ(rtGetError(), RTenum(RT_SUMS_ERROR));
  return rtGetErrorMessage();
}

const Told tellings[] = {
    {},
    {.samples = 100},
    {.samples = 9},
    {.samples = 100, .progressive = 1},
    {.samples = 64, .channels = withErrors},
    {.samples = 70, .channels = withErrors, .progressive = 1},
    {.samples = 64, .channels = withErrors, .transport = RT_TRANSPORT_LIGHT},
    {.samples = 64, .progressive = 1, .transport = RT_TRANSPORT_LIGHT},
    {.samples = 128, .channels = withErrors, .error = .05},
    {.samples = 128, .channels = withErrors, .progressive = 1, .error = .05},
};

TEST(KeptSums, AreThoseOfAnOrdinaryFrame) {
  for (const Told& told : tellings) {
    SCOPED_TRACE(&told - tellings);
    const Made plain = whole(told), kept = whole(told, true);
    EXPECT_TRUE(equal(plain.pixels, kept.pixels));
    EXPECT_EQ(plain.stats.error.halfWidth, kept.stats.error.halfWidth);
  }
}

TEST(KeptSums, AContinuedFrameHasTheSameBytes) {
  for (Told told : tellings) {
    const Made plain = whole(told, true);
    for (const int threads : {1, 2}) {
      told.threads = threads;
      const auto all = moments(told);
      ASSERT_FALSE(all.empty());
      for (const std::vector<char>& bytes : all) {
        const Sums sums = fromBytes(bytes);
        ASSERT_TRUE(sums) << lastError();
        Told later = told;
        later.threads = 3 - threads;
        later.progressive = 1 - told.progressive; // does not change pictures
        const Maker maker(later);
        renderFrom(sums);
        EXPECT_TRUE(equal(pixels(told.channels), plain.pixels));
        expectSameNumbers(statsHere(), plain.stats);
      }
    }
  }
}

TEST(KeptSums, AFrameGetsMoreSamples) {
  for (const Told& told :
       {Told{.samples = 64}, Told{.samples = 100}, Told{.samples = 64, .channels = withErrors},
        Told{.samples = 64, .transport = RT_TRANSPORT_LIGHT}}) {
    Told longer = told;
    longer.samples = told.channels == withErrors ? 120 : 200;
    const Made plain = whole(longer, true);
    const Sums sums = fromBytes(moments(told).back());
    ASSERT_TRUE(sums);
    const Maker maker(longer);
    renderFrom(sums);
    if (rtGetError() == RTenum(RT_SUMS_ERROR)) { // so small a picture has other photons then
      const std::string why = rtGetErrorMessage();
      EXPECT_NE(why.find("photons"), why.npos) << why;
      EXPECT_TRUE(told.channels == withErrors || told.transport == RT_TRANSPORT_LIGHT);
      continue;
    }
    EXPECT_TRUE(equal(pixels(longer.channels), plain.pixels));
    expectSameNumbers(statsHere(), plain.stats);
  }
}

// Returns why a frame cannot continue from the sums of another.
std::string refusal(const Told& had, const Told& wanted) {
  const Sums sums = fromBytes(moments(had).front());
  const Maker maker(wanted);
  renderFrom(sums);
  return lastError();
}

TEST(KeptSums, OfSomethingElseAreRefused) {
  const Told told;
  const auto names = [&](const Told& wanted, const char* what, Told had = {}) {
    const std::string why = refusal(had, wanted);
    EXPECT_NE(why.find(what), why.npos) << why;
  };
  names({.seed = 1}, "seed 0");
  names({.brightness = 2}, "another world");
  names({.samples = 32}, "cannot get fewer");
  names({.channels = withErrors}, "set of channels");
  names({.transport = RT_TRANSPORT_DIRECT}, "transport");
  names({.samples = 64}, "at least 32", {.samples = 16});
  names({.samples = 128, .channels = withErrors}, "replicates",
        {.samples = 64, .channels = withErrors});
  names({.samples = 256, .error = .05}, "target error", {.samples = 128, .error = .05});
}

Sums finished(int seed, Told told = {}) {
  told.seed = seed;
  return fromBytes(moments(told).back());
}

Sums added(const Sums& a, const Sums& b) {
  Sums sums(rtMergeSums(a.get(), b.get()));
  EXPECT_TRUE(sums) << (rtGetError(), rtGetErrorMessage());
  return sums;
}

TEST(KeptSums, AddUpToTheSameBytesInAnyOrderAndGrouping) {
  for (const Told& told :
       {Told{.samples = 32}, Told{.samples = 40, .channels = withErrors},
        Told{.samples = 32, .channels = withErrors, .transport = RT_TRANSPORT_LIGHT}}) {
    std::vector<Sums> seeds;
    for (const int seed : {0, 1, 2, 3, 6}) seeds.push_back(finished(seed, told));
    const Sums inOrder =
        added(added(added(added(seeds[0], seeds[1]), seeds[2]), seeds[3]), seeds[4]);
    const Sums pairs = added(added(seeds[4], seeds[2]), added(seeds[3], added(seeds[1], seeds[0])));
    EXPECT_TRUE(equal(bytesOf(inOrder), bytesOf(pairs)));
    EXPECT_TRUE(equal(bytesOf(inOrder), bytesOf(fromBytes(bytesOf(pairs)))));
    EXPECT_TRUE(equal(pixelsOf(inOrder, told.channels), pixelsOf(pairs, told.channels)));
    const RTsumsInfo info = infoOf(pairs);
    EXPECT_TRUE(info.seeds == 5 && info.firstSeed == 0 && info.lastSeed == 6 && info.complete);
  }
}

TEST(KeptSums, OfOneFrameHaveItsPicture) {
  for (const Told& told :
       {Told{.samples = 100, .channels = withErrors}, Told{.samples = 9},
        Told{.samples = 64, .channels = withErrors, .transport = RT_TRANSPORT_LIGHT}}) {
    const Made plain = whole(told, true);
    EXPECT_TRUE(equal(pixelsOf(finished(0, told), told.channels), plain.pixels));
    RTstats stats{};
    stats.size = sizeof stats;
    EXPECT_EQ(rtGetSumsStats(finished(0, told).get(), &stats), 1);
    expectSameNumbers(stats, plain.stats);
  }
}

TEST(KeptSums, ThatDoNotBelongTogetherAreNotAdded) {
  const auto refused = [](const Sums& a, const Sums& b, const char* what) {
    EXPECT_EQ(rtMergeSums(a.get(), b.get()), nullptr);
    const std::string why = lastError();
    EXPECT_NE(why.find(what), why.npos) << why;
  };
  const Sums first = finished(0), second = finished(1);
  refused(first, first, "seed 0");
  refused(added(first, second), second, "seed 1");
  refused(first, finished(1, {.samples = 32}), "samples a pixel");
  refused(first, finished(1, {.brightness = 2}), "another world");
  refused(first, finished(1, {.channels = withErrors}), "channels");
  const Sums begun = fromBytes(moments({.seed = 1}).front());
  if (!infoOf(begun).complete) refused(first, begun, "not finished");
  const Told adaptive{.samples = 128, .error = .05};
  refused(finished(0, adaptive), finished(1, adaptive), "target error");
}

// The mean over the seeds is the mean of their pictures, and the interval of the sum contains the
// truth, a picture of many samples, about as often as it says.
TEST(KeptSums, TheirIntervalsContainTheTruth) {
  const Told told{.samples = 64, .channels = withErrors};
  Sums all = finished(0, told);
  std::vector<float> mean = pixelsOf(all, RT_RGBA);
  constexpr int seeds = 4;
  for (int seed = 1; seed < seeds; seed++) {
    const Sums next = finished(seed, told);
    const std::vector<float> one = pixelsOf(next, RT_RGBA);
    for (size_t i = 0; i < mean.size(); i++) mean[i] += one[i];
    all = added(all, next);
  }
  const std::vector<float> sum = pixelsOf(all, RT_RGBA), half = pixelsOf(all, RT_ERROR),
                           trust = pixelsOf(all, RT_TRUST),
                           one = pixelsOf(finished(0, told), RT_ERROR);
  const std::vector<float> truth =
      whole({.samples = 16384, .channels = RT_RGBA, .seed = 77}).pixels;
  double inside = 0, trusted = 0, before = 0, after = 0;
  for (size_t i = 0; i < trust.size(); i++)
    for (size_t k = 0; k < 3; k++) {
      EXPECT_NEAR(sum[4 * i + k], mean[4 * i + k] / seeds, 1e-5 * (1 + mean[4 * i + k]));
      if (trust[i] == 0 || half[3 * i + k] == 0) continue;
      trusted++;
      inside += std::fabs(sum[4 * i + k] - truth[4 * i + k]) <= half[3 * i + k];
      const double of = one[3 * i + k], ofSum = half[3 * i + k];
      before += of * of;
      after += ofSum * ofSum;
    }
  ASSERT_GT(trusted, 500);
  EXPECT_GT(inside / trusted, .93);
  EXPECT_LT(inside / trusted, .985);
  EXPECT_NEAR(std::sqrt(after / before), .5, .1); // a quarter of the variance
}

TEST(KeptSums, DamagedBytesAreRefused) {
  const std::vector<char> bytes = bytesOf(finished(0, {.samples = 4}));
  const auto refused = [](const std::vector<char>& some) {
    EXPECT_EQ(rtReadSums(some.data(), some.size()), nullptr);
    EXPECT_EQ(rtGetError(), RTenum(RT_SUMS_ERROR));
  };
  refused({});
  for (size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 97)
    refused({bytes.begin(), bytes.begin() + std::ptrdiff_t(n)});
  for (size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 97) {
    std::vector<char> flipped = bytes;
    flipped[i] = char(flipped[i] ^ 0x40);
    refused(flipped);
  }
  std::vector<char> longer = bytes;
  longer.push_back(0);
  refused(longer);
}

TEST(KeptSums, WrongCallsAreErrors) {
  EXPECT_EQ(rtMergeSums(nullptr, nullptr), nullptr);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
  EXPECT_EQ(rtGetSums(nullptr), nullptr);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
  rtDeleteSums(nullptr);
  const Maker maker({.samples = 4}, false);
  EXPECT_EQ(rtGetSums(maker.context), nullptr);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  const Sums sums = finished(0, {.samples = 4});
  rtMakeCurrent(maker.context);
  rtContinueFrom(sums.get());
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
  rtRender();
  rtKeepSums(1);
  EXPECT_EQ(rtGetError(), RTenum(RT_SUMS_ERROR)) << "something was committed";
  const Maker timed({.samples = 4});
  rtQualityf(RT_TIME_LIMIT, 1);
  rtRender();
  EXPECT_NE(lastError().find("time limit"), std::string::npos);
}

} // namespace
} // namespace numeric
