// picture_live_fast_view.cpp: Tests the picture of the z-buffer that a LiveRenderer gives before
// the first samples of a large world.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "libpicture/live.h"

namespace {

using namespace picture;

// A square of 2 x side x side triangles that faces the camera.
std::string square(int side) {
  std::string heights;
  for (int i = 0; i <= side * side + 2 * side; ++i) heights += "0 ";
  return fmt::format(R"(#VRML V2.0 utf8
Viewpoint {{ position 0 0 3 }}
Transform {{ rotation 1 0 0 1.5707963 translation -1 1 0 children Shape {{
  appearance Appearance {{ material Material {{ diffuseColor .2 .8 .4 }} }}
  geometry ElevationGrid {{ solid FALSE xDimension {0} zDimension {0} xSpacing {1} zSpacing {1}
    height [ {2} ] }} }} }})",
                     side + 1, 2.0 / side, heights);
}

constexpr int large = 330, small = 100; // 217,800 and 20,000 triangles

LiveFrame frameOf(LiveFrame::Purpose purpose = LiveFrame::Purpose::still) {
  LiveFrame frame;
  frame.width = 40;
  frame.height = 30;
  frame.samples = 4;
  frame.purpose = purpose;
  return frame;
}

// Returns the pictures of a frame, until it has ended.
std::vector<LivePicture> picturesOf(LiveRenderer& live, const LiveFrame& frame) {
  live.start(frame);
  std::vector<LivePicture> pictures;
  while (pictures.empty() || !pictures.back().ended) {
    LivePicture picture;
    if (live.look(picture))
      pictures.push_back(std::move(picture));
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(live.takeFailure(), "");
  return pictures;
}

std::vector<uint8_t> middleOf(const LivePicture& picture) {
  const auto first =
      picture.rgb.begin() + 3 * (picture.width * (picture.height / 2) + picture.width / 2);
  return {first, first + 3};
}

TEST(LiveFastView, comesBeforeTheSamplesOfALargeWorld) {
  xvrml::Browser browser(xvrml::loadWorldFromMemory(square(large), "large.wrl"));
  LiveRenderer live(browser, {});
  const std::vector<LivePicture> pictures = picturesOf(live, frameOf());
  ASSERT_GE(pictures.size(), 2u);
  const LivePicture &fast = pictures.front(), &last = pictures.back();
  EXPECT_TRUE(fast.raster);
  EXPECT_TRUE(fast.preview);
  EXPECT_FALSE(fast.finished);
  EXPECT_EQ(fast.samples, 0);
  EXPECT_EQ(fast.number, last.number);
  ASSERT_EQ(fast.rgb.size(), size_t(40 * 30 * 3));
  EXPECT_EQ(middleOf(fast), middleOf(last)); // the headlight shines straight on it
  for (size_t i = 1; i < pictures.size(); ++i) EXPECT_FALSE(pictures[i].raster) << i;
  EXPECT_FALSE(last.preview);
}

TEST(LiveFastView, isNotInThePictureThatFollows) {
  RenderSettings settings;
  xvrml::Browser one(xvrml::loadWorldFromMemory(square(large), "large.wrl")),
      other(xvrml::loadWorldFromMemory(square(large), "large.wrl"));
  LiveRenderer live(one, settings);
  picturesOf(live, frameOf());
  Picture copied;
  ASSERT_TRUE(live.copy(copied));
  EXPECT_EQ(copied.note, "");
  settings.width = 40;
  settings.height = 30;
  settings.samples = 4;
  EXPECT_EQ(copied.planes, Renderer(other, settings).render({}).picture.planes);
}

TEST(LiveFastView, comesOnceForAWorld) {
  xvrml::Browser browser(xvrml::loadWorldFromMemory(square(large), "large.wrl"));
  LiveRenderer live(browser, {});
  EXPECT_TRUE(picturesOf(live, frameOf(LiveFrame::Purpose::preview)).front().raster);
  EXPECT_FALSE(picturesOf(live, frameOf()).front().raster);
}

TEST(LiveFastView, isNotDrawnOfSmallWorldsAndInFalseColours) {
  xvrml::Browser few(xvrml::loadWorldFromMemory(square(small), "small.wrl")),
      many(xvrml::loadWorldFromMemory(square(large), "large.wrl"));
  LiveRenderer live(few, {}), coloured(many, {});
  EXPECT_FALSE(picturesOf(live, frameOf()).front().raster);
  LiveFrame frame = frameOf();
  frame.falseColour = 1;
  EXPECT_FALSE(picturesOf(coloured, frame).front().raster);
}

} // namespace
