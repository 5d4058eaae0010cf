// hearing.cpp: the sound that the viewer of a running world hears: clauses 6.42 and 4.6.9.
#include "conformance/events/media_files.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

const std::string clip = "source DEF A AudioClip { url \"clip.wav\" loop TRUE } ";

struct Hearing {
  explicit Hearing(const std::string& text) {
    folder.write("clip.wav", wav(std::vector<int16_t>(200, 8192), 1, 100));
    browser =
        std::make_unique<Browser>(folder.world(text), BrowserOptions(), 0, RunOptions{.epoch = 0});
    browser->tick(0);
  }
  std::vector<Heard> now() { return heardIn(*browser); }
  Folder folder;
  std::unique_ptr<Browser> browser;
};

TEST(Hearing, StandsWhereTheSoundDoes) {
  Hearing h("Viewpoint { position 0 0 0 } Transform { translation 3 0 0 children Sound { minFront "
            "50 minBack 50 maxFront 60 maxBack 60 location 2 0 0 " +
            clip + "} }");
  const std::vector<Heard> heard = h.now();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_TRUE(heard[0].playing.clip);
  EXPECT_GT(heard[0].levels.right, heard[0].levels.left);
  double behind[16] = {-1, 0, 0,  0, 0, 1, 0, 0,
                       0,  0, -1, 0, 0, 0, 0, 1}; // turned around: the other ear
  h.browser->placeViewer(behind);
  EXPECT_NEAR(h.now()[0].levels.left, heard[0].levels.right, 1e-6);
}

TEST(Hearing, EveryPlaceOfASoundCounts) {
  Hearing h("DEF S Sound { " + clip +
            "} Transform { translation 1 0 0 children USE S } Transform { translation 2 0 0 "
            "children USE S }");
  EXPECT_EQ(h.now().size(), 3u);
}

TEST(Hearing, WhatASwitchLeavesOutIsNotHeard) {
  Hearing h("DEF W Switch { whichChoice 0 choice [ Sound { " + clip + "} Group {} ] }");
  EXPECT_EQ(h.now().size(), 1u);
  h.browser->set(*h.browser->node("W"), "whichChoice", SFInt32(1));
  EXPECT_TRUE(h.now().empty());
}

TEST(Hearing, SoundsThatComeAndGoAreFollowed) {
  Hearing h("DEF G Group { children DEF S Sound { " + clip + "} }");
  Node& group = *h.browser->node("G");
  const MFNode sounds{h.browser->node("S")};
  EXPECT_EQ(h.now().size(), 1u);
  h.browser->set(group, "removeChildren", sounds);
  EXPECT_TRUE(h.now().empty());
  h.browser->set(group, "addChildren", sounds);
  EXPECT_EQ(h.now().size(), 1u);
}

TEST(Hearing, AClipThatRestsIsSilent) {
  Hearing h("Sound { source AudioClip { url \"clip.wav\" startTime 5 } } Sound {}");
  EXPECT_TRUE(h.now().empty());
  h.browser->tick(5);
  EXPECT_EQ(h.now().size(), 1u);
}

} // namespace
} // namespace xvrml
