// audio.cpp: AudioClip and Sound: clauses 6.4, 6.42 and 4.6.9.
#include <cmath>

#include "behaviour/sound_file.h"
#include "conformance/events/media_files.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

// A world with an AudioClip A of two seconds in clip.wav, at 100 samples a second.
struct Clips {
  explicit Clips(const std::string& fields, const std::string& url = "\"clip.wav\"") {
    folder.write("clip.wav", wav(std::vector<int16_t>(200, 8192), 1, 100));
    folder.write("mono.wav", wav({0, 16384, -32768, 32767}, 1, 4));
    folder.write("song.mid", std::string("MThd\0\0\0\6\0\0\0\1\0\1", 14));
    browser = std::make_unique<Browser>(
        folder.world("Sound { source DEF A AudioClip { url [ " + url + " ] " + fields + " } }"),
        BrowserOptions(), 0, RunOptions{.epoch = 0});
    for (const char* out : {"isActive", "duration_changed"})
      browser->listen(
          *browser->node("A"), out, [this, out](Node&, const FieldInfo&, const Value& value) {
            events.push_back(fmt::format("{:g} {} {}", browser->now(), out, textOf(value)));
          });
  }
  Node& clip() { return *browser->node("A"); }
  void ticks(std::initializer_list<double> times) {
    for (double t : times) browser->tick(t);
  }
  Log take() { return std::exchange(events, {}); }
  Folder folder;
  Log events;
  std::unique_ptr<Browser> browser;
};

TEST(AudioClip, TellsItsDurationWhenRead) {
  Clips c("");
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "duration_changed")), "2");
}

TEST(AudioClip, OfDefaultValuesIsInactive) {
  Clips c("");
  c.ticks({0, 1, 2});
  EXPECT_EQ(c.take(), Log{});
}

TEST(AudioClip, PlaysOnceForItsDuration) {
  Clips c("startTime 1");
  c.ticks({0, 1, 2, 3, 4});
  EXPECT_EQ(c.take(), (Log{"1 isActive TRUE", "3 isActive FALSE"}));
}

TEST(AudioClip, PitchShortensTheCycleAndNotTheDuration) {
  Clips c("startTime 1 pitch 4");
  c.ticks({1, 1.4, 1.5, 2});
  EXPECT_EQ(c.take(), (Log{"1 isActive TRUE", "1.5 isActive FALSE"}));
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "duration_changed")), "2");
}

TEST(AudioClip, LoopsUntilItsStopTime) {
  Clips c("startTime 1 stopTime 6.5 loop TRUE");
  c.ticks({1, 3, 5, 6, 7});
  EXPECT_EQ(c.take(), (Log{"1 isActive TRUE", "7 isActive FALSE"}));
}

TEST(AudioClip, IgnoresSetPitchAndSetStartTimeWhileActive) {
  Clips c("startTime 1 loop TRUE");
  c.ticks({1});
  c.browser->set(c.clip(), "set_pitch", 2.0f);
  c.browser->set(c.clip(), "set_startTime", 9.0);
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "pitch")), "1");
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "startTime")), "1");
}

TEST(AudioClip, RefusesAPitchThatIsNotPositive) {
  Clips c("");
  for (float bad : {0.0f, -1.0f, NAN, INFINITY}) c.browser->set(c.clip(), "set_pitch", bad);
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "pitch")), "1");
}

TEST(AudioClip, AnotherUrlTellsItsDuration) {
  Clips c("");
  c.browser->set(c.clip(), "set_url", MFString{"mono.wav"});
  EXPECT_EQ(c.take(), Log{"0 duration_changed 1"});
}

TEST(AudioClip, TakesTheFirstUrlThatIsThere) {
  Clips c("", "\"none.wav\" \"song.mid\" \"mono.wav\"");
  EXPECT_EQ(textOf(c.browser->get(c.clip(), "duration_changed")), "1");
  EXPECT_EQ(c.browser->world().diagnostics.warnings(), 0u);
}

TEST(AudioClip, ThatCannotBeHadHasDurationMinusOneAndSaysWhy) {
  for (const char* url : {"none.wav", "song.mid", "world.wrl", "http://a/b.wav",
                          "../../../../etc/passwd", "/etc/passwd"}) {
    Clips c("startTime 1", std::string("\"") + url + "\"");
    EXPECT_EQ(textOf(c.browser->get(c.clip(), "duration_changed")), "-1") << url;
    EXPECT_EQ(c.browser->world().diagnostics.warnings(), 1u) << url;
    // Nothing to play: it ends at once, and nodes that wait for its end continue.
    c.ticks({0, 1, 2, 3});
    EXPECT_EQ(c.take(), (Log{"1 isActive TRUE", "2 isActive FALSE"})) << url;
  }
}

TEST(AudioClip, OfUnknownLengthStartedByAnEventIsOverAtTheNextTick) {
  Clips c("", "\"none.wav\"");
  c.ticks({5});
  c.browser->set(c.clip(), "set_startTime", 5.0);
  c.ticks({6, 7});
  EXPECT_EQ(c.take(), (Log{"5 isActive TRUE", "6 isActive FALSE"}));
}

TEST(AudioClip, PlaysFromTheTimeOfTheWorld) {
  Clips c("startTime 1 pitch 0.5 loop TRUE");
  EXPECT_EQ(playingOf(c.clip()).clip, nullptr);
  c.ticks({1, 2});
  EXPECT_EQ(playingOf(c.clip()).position, 0.5);
  EXPECT_EQ(playingOf(c.clip()).pitch, 0.5);
  EXPECT_EQ(playingOf(c.clip()).clip->frames(), 200u);
  EXPECT_EQ(playingOf(c.clip()).clip->samples[7], 0.25f);
  c.ticks({6}); // (6 - 1) modulo 4
  EXPECT_EQ(playingOf(c.clip()).position, 0.5);
}

TEST(Wav, ReadsEightSixteenTwentyFourAndThirtyTwoBitsAndFloats) {
  const Folder folder;
  const auto make = [](int format, int bits, const std::string& data) {
    const uint32_t frame = uint32_t(bits / 8);
    return "RIFF" + little(0, 4) + "WAVEodd " + little(3, 4) + "abc" + little(0, 1) + "fmt " +
           little(16, 4) + little(uint32_t(format), 2) + little(1, 2) + little(8, 4) +
           little(8 * frame, 4) + little(frame, 2) + little(uint32_t(bits), 2) + "data" +
           little(uint32_t(data.size()), 4) + data;
  };
  const float half = 0.5f;
  folder.write("8.wav", make(1, 8, little(192, 1) + little(64, 1)));
  folder.write("16.wav", make(1, 16, little(0x4000, 2) + little(0xc000, 2)));
  folder.write("24.wav", make(1, 24, little(0x400000, 3) + little(0xc00000, 3)));
  folder.write("32.wav", make(1, 32, little(0x40000000, 4) + little(0xc0000000, 4)));
  folder.write(
      "f.wav",
      make(3, 32, std::string(reinterpret_cast<const char*>(&half), 4) + little(0xbf000000, 4)));
  const Limits limits;
  for (const char* name : {"8.wav", "16.wav", "24.wav", "32.wav", "f.wav"}) {
    EXPECT_EQ(readSound(folder / name, {limits}).samples, (std::vector<float>{0.5f, -0.5f}))
        << name;
    EXPECT_EQ(soundLength(folder / name, {limits}), 0.25) << name;
  }
}

TEST(Wav, WhatIsCutOffOrDamagedIsRefusedOrReadAsFarAsItGoes) {
  const Folder folder;
  const Limits limits;
  Budget budget(1 << 24);
  const ImageRoom room{limits, ~uint64_t(0), &budget};
  const std::string whole = wav({1, 2, 3, 4}, 1, 4);
  for (size_t n = 0; n < whole.size(); ++n) {
    folder.write("cut.wav", whole.substr(0, n));
    try {
      EXPECT_LE(readSound(folder / "cut.wav", room).frames(), 4u);
    } catch (const std::runtime_error& error) { EXPECT_NE(std::string(error.what()), ""); }
  }
  for (size_t i = 0; i < whole.size(); ++i) {
    for (const char c : {'\0', '\xff'}) {
      std::string bad = whole;
      bad[i] = c;
      folder.write("bad.wav", bad);
      try {
        EXPECT_LE(readSound(folder / "bad.wav", room).frames(), 8u);
      } catch (const std::runtime_error&) {}
    }
  }
}

TEST(Sound, IsAtFullIntensityWithinTheInnerEllipsoid) {
  auto s = std::make_unique<nodes::Sound>();
  s->minFront = 4;
  s->minBack = 1;
  s->maxFront = 20;
  s->maxBack = 5;
  s->intensity = 0.5f;
  for (const Vec3f at : {Vec3f{0, 0, 0}, Vec3f{0, 0, 3.99f}, Vec3f{0, 0, -0.99f}})
    EXPECT_EQ(soundGain(*s, at), 0.5);
  EXPECT_LT(soundGain(*s, {0, 0, 4.01f}), 0.5);
  EXPECT_LT(soundGain(*s, {0, 0, -1.01f}), 0.5);
}

TEST(Sound, FallsLinearlyInDecibelsToMinusTwentyAtTheOuterEllipsoid) {
  auto s = std::make_unique<nodes::Sound>();
  s->minFront = 4;
  s->minBack = 1;
  s->maxFront = 20;
  s->maxBack = 5;
  for (double part : {0.25, 0.5, 1.0}) {
    EXPECT_NEAR(20 * std::log10(soundGain(*s, {0, 0, float(4 + 16 * part)})), -20 * part, 1e-4);
    EXPECT_NEAR(20 * std::log10(soundGain(*s, {0, 0, float(-1 - 4 * part)})), -20 * part, 1e-4);
  }
  EXPECT_EQ(soundGain(*s, {0, 0, 20.1f}), 0);
  EXPECT_EQ(soundGain(*s, {0, 0, -5.1f}), 0);
}

// sideways: half the focal parameter, 2 f b / (f + b)
TEST(Sound, ItsLocationIsAFocusOfTheEllipsoids) {
  auto s = std::make_unique<nodes::Sound>();
  s->minFront = 4;
  s->minBack = 1;
  s->maxFront = 20;
  s->maxBack = 5;
  EXPECT_EQ(soundGain(*s, {1.59f, 0, 0}), 1);
  EXPECT_LT(soundGain(*s, {1.61f, 0, 0}), 1);
  EXPECT_NEAR(soundGain(*s, {0, 8, 0}), 0.1, 1e-6);
  // A point of the outer ellipsoid: half axes 12.5 and 10, centre 7.5 ahead.
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const double x = 10 * std::sin(angle) * 0.999, z = 7.5 + 12.5 * std::cos(angle) * 0.999;
    EXPECT_NEAR(soundGain(*s, {float(x), 0, float(z)}), 0.1, 2e-3) << angle;
  }
}

TEST(Sound, PointsInItsDirectionFromItsLocation) {
  auto s = std::make_unique<nodes::Sound>();
  s->minFront = 4;
  s->minBack = 1;
  s->maxFront = 20;
  s->maxBack = 5;
  s->location = {100, 0, 0};
  s->direction = {-3, 0, 0};
  EXPECT_EQ(soundGain(*s, {96.5f, 0, 0}), 1);
  EXPECT_LT(soundGain(*s, {102, 0, 0}), 1);
}

TEST(Sound, OddEllipsoidsGiveNumbers) {
  auto s = std::make_unique<nodes::Sound>();
  for (const float minimum : {0.0f, 1.0f, 1e30f})
    for (const float maximum : {0.0f, 1.0f, 1e30f}) {
      s->minFront = s->maxBack = minimum;
      s->maxFront = s->minBack = maximum;
      for (const Vec3f at :
           {Vec3f{0, 0, 0}, Vec3f{0, 0, 1}, Vec3f{1e30f, 0, 0}, Vec3f{NAN, 0, 0}}) {
        const double gain = soundGain(*s, at);
        EXPECT_TRUE(gain >= 0 && gain <= 1) << minimum << " " << maximum;
      }
    }
}

TEST(Sound, IsHeardFromItsSideWithTheSamePowerEverywhere) {
  auto s = std::make_unique<nodes::Sound>();
  const Vec3f viewer{0, 0, 5}; // outside the inner ellipsoid
  const double gain = soundGain(*s, viewer);
  const SoundLevels ahead = soundLevels(*s, viewer, {0, 0, -5}),
                    right = soundLevels(*s, viewer, {5, 0, 0}),
                    left = soundLevels(*s, viewer, {-5, 0, 0});
  EXPECT_NEAR(ahead.left, gain, 1e-9);
  EXPECT_NEAR(ahead.right, gain, 1e-9);
  EXPECT_NEAR(right.left, 0, 1e-9);
  EXPECT_NEAR(left.right, 0, 1e-9);
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const SoundLevels l =
        soundLevels(*s, viewer, {float(5 * std::sin(angle)), 0, float(5 * std::cos(angle))});
    EXPECT_NEAR(l.left * l.left + l.right * l.right, 2 * gain * gain, 1e-9);
  }
}

TEST(Sound, NotSpatializedIsTheSameOnBothSides) {
  auto s = std::make_unique<nodes::Sound>();
  s->spatialize = false;
  const SoundLevels l = soundLevels(*s, {0, 0, 5}, {5, 0, 0});
  EXPECT_EQ(l.left, l.right);
  EXPECT_EQ(l.left, soundGain(*s, {0, 0, 5}));
}

TEST(Sound, MixingAddsWithLevelsPitchAndLoop) {
  auto clip = std::make_shared<Clip>(Clip{1, 4, {0, 1, 0, -1}});
  std::vector<float> out(16, 0.5f);
  mix({clip, 0, 1, false}, {1, 0.5}, 8, out); // twice the rate: half way between samples
  const std::vector<float> expected{0.5f, 0.5f, 1, 0.75f, 1.5f,  1, 1, 0.75f,
                                    0.5f, 0.5f, 0, 0.25f, -0.5f, 0, 0, 0.25f};
  EXPECT_EQ(out, expected);
  std::vector<float> loop(8, 0);
  mix({clip, 0.75, 2, true}, {1, 1}, 4, loop); // every second sample from the fourth on
  EXPECT_EQ(loop, (std::vector<float>{-1, -1, 1, 1, -1, -1, 1, 1}));
  std::vector<float> once(8, 0);
  mix({clip, 0.75, 1, false}, {1, 1}, 4, once);
  EXPECT_EQ(once, (std::vector<float>{-1, -1, 0, 0, 0, 0, 0, 0}));
}

} // namespace
} // namespace xvrml
