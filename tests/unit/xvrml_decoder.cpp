// xvrml_decoder.cpp: pictures and sounds that another process decodes: files as their libraries
// write them, damaged and hostile ones, and what happens when the process is missing, misbehaves or
// dies.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <thread>

#include <sndfile.h>
#include <unistd.h>

#include "behaviour/sound_file.h"
#include "decode/decoder.h"
#include "image/foreign.h"
#include "unit/decoder_world.h"
#include "unit/liar.h"

namespace xvrml::test {
namespace {

RadianceImage radiance(const Bytes& bytes, World& world) {
  return decodeRadiance(bytes, world.room());
}
std::string dataUrl(const Bytes& bytes); // below

void expectRadiance(const RadianceImage& image, const ExrKind& kind, double tolerance) {
  ASSERT_EQ(image.width, kind.width);
  ASSERT_EQ(image.height, kind.height);
  for (int y = 0; y < kind.height; y++)
    for (int x = 0; x < kind.width; x++)
      for (int c = 0; c < 3; c++) {
        const float expected = radianceAt(x, y, kind.channels[0] == 'Y' ? 0 : c),
                    got = image.rgb[size_t(3 * ((kind.height - 1 - y) * kind.width + x) + c)];
        ASSERT_NEAR(got, expected, tolerance) << x << " " << y << " " << c;
      }
}

TEST(Decoder, OpenExrOfEachCompressionWithLinesAndTiles) {
  World world;
  for (int compression = 0; compression <= 9; ++compression)
    for (const bool isFloat : {false, true})
      for (const bool tiled : {false, true}) {
        const ExrKind kind{.compression = compression, .isFloat = isFloat, .tiled = tiled};
        SCOPED_TRACE(std::to_string(compression) + " " + std::to_string(isFloat) +
                     std::to_string(tiled));
        // B44, B44A, DWAA and DWAB lose something. The values reach 256.
        expectRadiance(radiance(makeExr(kind), world), kind, compression < 6 ? 0 : 16);
      }
}

TEST(Decoder, OpenExrOfOtherLayouts) {
  World world(1 << 24);
  for (const ExrKind& kind :
       {ExrKind{.upwards = true}, ExrKind{.tiled = true, .levels = true},
        ExrKind{.width = 1, .height = 1}, ExrKind{.channels = "Y"},
        ExrKind{.left = 1000000, .top = -1000000}, ExrKind{.channels = "RGBAZ"},
        ExrKind{.width = 1100, .height = 1000, .channels = "RGB"}}) // several parts of a message
    expectRadiance(radiance(makeExr(kind), world), kind, 0);
  expectRadiance(radiance(makeTwoParts({}), world), {}, 0);
  const RadianceImage chroma = radiance(makeChroma(10, 6, 4, 2, 1), world);
  ASSERT_EQ(chroma.rgb.size(), 10u * 6 * 3);
  for (size_t i = 0; i < chroma.rgb.size(); ++i)
    EXPECT_NEAR(chroma.rgb[i], i % 3 == 0 ? 4 : i % 3 == 1 ? 2 : 1, .02);
  EXPECT_EQ(whyNot(makeExr({.channels = "AZ"}), world),
            "OpenEXR picture: there are no channels R, G and B and none Y, but A, Z");
}

TEST(Decoder, WebpBmpAndTga) {
  World world;
  for (const auto& [width, height] : {std::pair{13, 9}, {1, 1}, {1, 20}, {300, 200}})
    for (const int components : {3, 4}) {
      expectBytes(image(makeWebp(width, height, components), world), width, height, components,
                  true);
      expectBytes(image(makeBmp(width, height, components), world), width, height, components,
                  true);
    }
  for (const int components : {1, 3, 4})
    for (const bool runs : {false, true})
      for (const bool fromTop : {false, true})
        expectBytes(image(makeTga(17, 5, {components, runs, fromTop}), world), 17, 5, components);
  EXPECT_EQ(mediaTypeOf(makeWebp(2, 2, 3)), "image/webp");
  EXPECT_EQ(mediaTypeOf(makeBmp(2, 2, 3)), "image/bmp");
  EXPECT_EQ(mediaTypeOf(makeTga(2, 2, {})), "image/x-tga");
  Bytes animated = makeWebp(4, 4, 4);
  const Bytes extended = {'V', 'P', '8', 'X', 10, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 3, 0, 0};
  animated.insert(animated.begin() + 12, extended.begin(), extended.end());
  animated[4] = uint8_t(animated.size() - 8);
  EXPECT_EQ(whyNot(animated, world), "WebP picture: it is animated, which is not read");
}

struct SoundKind {
  int format;
  double tolerance;
};

TEST(Decoder, SoundsOfManyFormats) {
  World world;
  constexpr int frames = 22050;
  for (const auto& [format, tolerance] : {SoundKind{SF_FORMAT_WAV | SF_FORMAT_PCM_16, 1e-4},
                                          {SF_FORMAT_WAV | SF_FORMAT_IMA_ADPCM, .2},
                                          {SF_FORMAT_AIFF | SF_FORMAT_PCM_24, 1e-4},
                                          {SF_FORMAT_AU | SF_FORMAT_ULAW, .05},
                                          {SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 1e-4},
                                          {SF_FORMAT_OGG | SF_FORMAT_VORBIS, .1},
                                          {SF_FORMAT_MPEG | SF_FORMAT_MPEG_LAYER_III, -1}}) {
    SCOPED_TRACE(format);
    const Bytes file = makeSound(format, frames);
    if (file.empty() && tolerance < 0) continue; // libsndfile before 1.1 knows no MP3
    const std::string url = dataUrl(file);
    EXPECT_NEAR(soundLength(url, world.room()), .5, .06);
    const Clip clip = readSound(url, world.room());
    EXPECT_EQ(clip.channels, 1);
    EXPECT_EQ(clip.rate, 44100);
    EXPECT_NEAR(double(clip.frames()), frames, 3000); // MP3 and ADPCM have whole blocks
    double energy = 0;
    for (const float sample : clip.samples) energy += sample * sample;
    EXPECT_NEAR(energy, frames * .5 * .5 / 2, frames * .01); // a sine of amplitude 0.5
    for (size_t i = 0; tolerance > 0 && i < size_t(frames); ++i)
      ASSERT_NEAR(clip.samples[i], .5 * std::sin(double(i) * 440 * 2 * 3.14159265 / 44100),
                  tolerance)
          << i;
  }
}

TEST(Decoder, SoundsThatCannotBeRead) {
  World world;
  const auto why = [&](const Bytes& bytes, uint64_t room = 1 << 20) -> std::string {
    try {
      readSound(dataUrl(bytes), world.room(), [&](uint64_t wanted) {
        if (wanted > room) throw std::runtime_error("no room");
      });
    } catch (const std::runtime_error& error) { return error.what(); }
    return "";
  };
  const Bytes whole = makeSound(SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 1000);
  EXPECT_EQ(why(whole), "");
  EXPECT_EQ(why(whole, 3999), "no room");
  EXPECT_EQ(why({'M', 'T', 'h', 'd', 0}), "MIDI is not played");
  for (const Bytes& bytes : {Bytes{'h', 'e', 'l', 'l', 'o'}, Bytes(1, 0), Bytes(10000, 65)})
    EXPECT_NE(why(bytes), "");
  EXPECT_EQ(why(whole), ""); // the process is as good as before
}

TEST(Decoder, SoundsThatDoNotSayTheirLength) {
  World world;
  // FLAC keeps the number of samples in 36 bits of its first block (RFC 9639, 8.2); 0 is unknown.
  Bytes flac = makeSound(SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 22050);
  flac[8 + 13] &= 0xf0;
  const std::string url = dataUrl(with(flac, 8 + 14, 0));
  EXPECT_EQ(soundLength(url, world.room()), .5);
  EXPECT_EQ(readSound(url, world.room()).frames(), 22050u);
  Bytes ogg = makeSound(SF_FORMAT_OGG | SF_FORMAT_VORBIS, 441000);
  ogg.resize(ogg.size() / 2);
  const std::string half = dataUrl(ogg);
  const double seconds = soundLength(half, world.room());
  EXPECT_GT(seconds, 1);
  EXPECT_LT(seconds, 9);
  const Clip clip = readSound(half, world.room());
  EXPECT_NEAR(double(clip.frames()), seconds * 44100, .5);
}

// --- Limits ---

TEST(Decoder, SizesAreCheckedBeforeAnythingIsAllocated) {
  World world(255);
  EXPECT_NE(whyNot(makeExr({.width = 16, .height = 4}), world).find("imagePixels"),
            std::string::npos);
  EXPECT_EQ(whyNot(makeExr({.width = 15, .height = 4}), world), "");
  EXPECT_NE(whyNot(makeWebp(16, 16, 3), world).find("imagePixels"), std::string::npos);
  EXPECT_EQ(whyNot(makeWebp(15, 17, 3), world), "");
  EXPECT_THROW(image(makeBmp(16, 16, 3), world), TooManyPixels);
  World small;
  EXPECT_TRUE(small.budget.take(small.budget.left() - 1000));
  EXPECT_NE(whyNot(makeBmp(20, 20, 3), small).find("worldBytes"), std::string::npos);
  EXPECT_NE(whyNot(makeExr({.width = 20, .height = 20}), small).find("worldBytes"),
            std::string::npos);
  EXPECT_EQ(whyNot(makeBmp(10, 10, 3), small), "");
}

TEST(Decoder, BombsAreRefused) {
  World world(uint64_t(1) << 62); // the limits of the world allow everything
  Bytes exr = makeExr({.compression = 9, .width = 40, .height = 40});
  const std::string name = "dataWindow";
  const auto at =
      size_t(std::search(exr.begin(), exr.end(), name.begin(), name.end()) - exr.begin()) +
      name.size() + 1 + 6 + 4; // name, "box2i", size
  const uint32_t huge = 1'000'000'000;
  EXPECT_NE(whyNot(with(with(exr, at + 8, huge), at + 12, huge), world), "");
  EXPECT_NE(whyNot(with(with(exr, at + 8, 60000), at + 12, 60000), world), "");
  EXPECT_NE(whyNot(with(with(makeBmp(4, 4, 3), 18, huge), 22, huge), world), "");
  EXPECT_NE(whyNot(with(with(makeBmp(4, 4, 3), 18, 65536), 22, 65536), world), "");
  EXPECT_NE(whyNot(with(makeTga(4, 4, {}), 12, 0xffffffff), world), "");
  EXPECT_EQ(whyNot(exr, world), "");
}

// XVRML_DECODER_MUTANTS=10000 makes as many of each file.
TEST(Decoder, DamagedFilesGiveAMessageOrAPicture) {
  const char* const wanted = std::getenv("XVRML_DECODER_MUTANTS");
  const int mutants = wanted ? std::atoi(wanted) : 40;
  std::mt19937 random(1);
  std::vector<Bytes> files;
  for (int compression = 0; compression <= 9; ++compression)
    files.push_back(makeExr({.compression = compression, .tiled = compression % 2 == 0}));
  files.push_back(makeTwoParts({}));
  files.push_back(makeChroma(10, 6, 4, 2, 1));
  files.push_back(makeWebp(20, 20, 4));
  files.push_back(makeBmp(20, 20, 3));
  files.push_back(makeTga(20, 20, {.runs = true}));
  for (const Bytes& whole : files) {
    auto world = std::make_unique<World>();
    for (int i = 0; i < mutants; ++i) {
      if (i % 50 == 49) world = std::make_unique<World>(); // 100 processes of a world may end
      Bytes bytes = whole;
      const int changes = 1 + int(random() % 8);
      for (int k = 0; k < changes; ++k) {
        const size_t end = random() % 2 == 0 ? bytes.size() : std::min<size_t>(bytes.size(), 400);
        bytes[random() % end] =
            random() % 2 == 0 ? uint8_t(random()) : uint8_t(255 * (random() % 2));
      }
      if (random() % 8 == 0) bytes.resize(random() % bytes.size());
      whyNot(bytes, *world);
    }
    EXPECT_EQ(whyNot(whole, *world), "");
  }
  for (const int format : {SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_FLAC | SF_FORMAT_PCM_16,
                           SF_FORMAT_OGG | SF_FORMAT_VORBIS}) {
    World world;
    const Bytes whole = makeSound(format, 500);
    for (int i = 0; i < mutants; ++i) {
      Bytes bytes = whole;
      for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = uint8_t(random());
      try {
        const Clip clip = readSound(dataUrl(bytes), world.room());
        for (const float sample : clip.samples) ASSERT_LE(std::abs(sample), 1);
      } catch (const std::runtime_error&) {}
    }
    EXPECT_GT(readSound(dataUrl(whole), world.room()).frames(), 0u);
  }
}

// --- The process ---

TEST(Decoder, OneProcessOfAWorldEndsWithIt) {
  pid_t process = 0;
  {
    World world;
    EXPECT_EQ(whyNot(makeWebp(4, 4, 3), world), "");
    process = pid_t(world.budget.decoder->processNumber());
    ASSERT_GT(process, 0);
    EXPECT_EQ(whyNot(makeExr({}), world), "");
    EXPECT_NE(whyNot(makeExr({.channels = "Z"}), world), "");
    EXPECT_EQ(world.budget.decoder->processNumber(), process);
  }
  EXPECT_EQ(::kill(process, 0), -1) << "it is gone, and has been waited for";
}

TEST(Decoder, AProcessThatIsKilledCostsOneFile) {
  World world;
  const Bytes file = makeExr({.compression = 0, .isFloat = true, .width = 1000, .height = 1000});
  EXPECT_EQ(whyNot(makeWebp(4, 4, 3), world), "");
  const auto decoder = decoderOf(&world.budget);
  const auto process = pid_t(decoder->processNumber());
  size_t got = 0;
  try {
    decoder->decode(
        {decoding::Format::exr, file, 12 << 20}, [](const decoding::Contents&) { return true; },
        [&](std::span<const char> part) {
          if (got == 0) ::kill(process, SIGKILL);
          got += part.size();
        });
    ADD_FAILURE() << "it has been killed";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    EXPECT_TRUE(
        said.starts_with("xvrml-decoder, which decodes such files, ended by signal 9 (Killed)"))
        << said;
  }
  EXPECT_LT(got, 12'000'000u);
  EXPECT_EQ(decoder->processNumber(), 0);
  EXPECT_EQ(whyNot(makeExr({}), world), "");
  EXPECT_NE(decoder->processNumber(), process);
}

TEST(Decoder, WithoutTheProgramAMessageSaysSo) {
  for (const auto& [program, why] :
       {std::pair{"/nonexistent/xvrml-decoder",
                  "no program decodes it: /nonexistent/xvrml-decoder"},
        {"/bin/true", "xvrml-decoder, which decodes such files, ended with code 0"},
        {"/etc/passwd", "no program decodes it: /etc/passwd"}}) {
    World world;
    setenv("XVRML_DECODER", program, 1);
    const std::string said = whyNot(makeBmp(4, 4, 3), world);
    unsetenv("XVRML_DECODER");
    EXPECT_EQ(said.find(std::string("BMP picture: ") + why), 0u) << said;
    EXPECT_EQ(whyNot(makeBmp(4, 4, 3), world), "");
  }
}

TEST(Decoder, ThreadsTakeTurns) {
  World world;
  const Bytes exr = makeExr({}), webp = makeWebp(50, 50, 3);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) {
        expectRadiance(radiance(exr, world), {}, 0);
        expectBytes(image(webp, world), 50, 50, 3);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(Decoder, AProcessThatLiesIsEnded) {
  using decoding::Op;
  const decoding::Contents honest{2, 2, 3, 1, 0};
  const auto said = [&](const std::function<void(Liar&)>& lie) {
    World world;
    Liar liar(world.budget.decoder, mediaDecoder);
    lie(liar);
    liar.ends();
    return whyNot(makeBmp(2, 2, 3), world);
  };
  const std::string twelve(12, 'x'), broke = "broke the protocol";
  EXPECT_EQ(
      said([&](Liar& l) { l.says(Op::contents, honest).says(Op::bytes, twelve).says(Op::end); }),
      "");
  const auto contains = [&](const char* what, const std::function<void(Liar&)>& lie) {
    const std::string got = said(lie);
    EXPECT_NE(got.find(what), std::string::npos) << got;
  };
  contains("broke the protocol",
           [&](Liar& l) { l.says(Op::contents, honest).says(Op::bytes, twelve + "x"); });
  contains("broke the protocol", [&](Liar& l) { l.says(Op::contents, honest).says(Op::bytes); });
  contains("pixels are missing", [&](Liar& l) {
    l.says(Op::contents, honest).says(Op::bytes, std::string(11, 'x')).says(Op::end);
  });
  contains("ended", [&](Liar& l) { l.says(Op::contents, honest); });
  contains("broke the protocol", [&](Liar& l) { l.says(Op::contents, std::string("short")); });
  contains("sends too small parts", [&](Liar& l) {
    l.says(Op::contents, decoding::Contents{100, 100, 3, 1, 0});
    for (int i = 0; i < 65; ++i) l.says(Op::bytes, "8 bytes!");
  });
  contains("imagePixels", [&](Liar& l) {
    l.says(Op::contents, decoding::Contents{~0ull, ~0ull, 3, 1, 0});
  });
  contains("of a wrong kind", [&](Liar& l) {
    l.says(Op::contents, decoding::Contents{2, 2, ~0u, 1, 0});
  });
  contains("of a wrong kind", [&](Liar& l) {
    l.says(Op::contents, decoding::Contents{2, 2, 3, 4, 0});
  });
  contains("\\x1b", [&](Liar& l) { l.says(Op::failed, "a \x1b[2J trick"); });
}

TEST(Decoder, RatesOfSoundsAreChecked) {
  const auto length = [](double rate) {
    World world;
    Liar liar(world.budget.decoder, mediaDecoder);
    liar.says(decoding::Op::contents, decoding::Contents{1000, 1, 1, sizeof(float), rate});
    return soundLength(dataUrl({1, 2, 3}), world.room());
  };
  EXPECT_EQ(length(1), 1000);
  EXPECT_EQ(length(1e9), 1e-6);
  for (const double rate : {0.0, -1.0, .99, 1.01e9, 1e-300, 1e308, double(NAN), double(INFINITY)})
    EXPECT_THROW(length(rate), std::runtime_error) << rate;
}

std::string dataUrl(const Bytes& bytes) {
  static const char digits[] = "0123456789abcdef";
  std::string url = "data:audio/x,";
  for (const uint8_t byte : bytes) url += {'%', digits[byte >> 4], digits[byte & 15]};
  return url;
}

} // namespace
} // namespace xvrml::test
