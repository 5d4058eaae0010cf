// picture_live_patience.cpp: previews go on while what has appeared is read and built, and still
// pictures wait for it.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "libpicture/live.h"

using namespace picture;
using State = LiveRenderer::State;

namespace {

constexpr int side = 500; // heights each way of what appears

std::string worldText() {
  std::string heights;
  for (int i = 0; i < side * side; ++i) heights += fmt::format("{} ", i % 7 * 0.001);
  return fmt::format(
      "#VRML V2.0 utf8\n"
      "Viewpoint {{ position 0 1 6 }}\n"
      "Shape {{ appearance Appearance {{ material Material {{ }} }} geometry Box {{ }} }}\n"
      "DEF Big Switch {{ choice Transform {{ translation -2 -1.5 -2 children Shape {{\n"
      "  appearance Appearance {{ material Material {{ diffuseColor 1 0 0 }} }}\n"
      "  geometry ElevationGrid {{ xDimension {0} zDimension {0} xSpacing 0.008\n"
      "    zSpacing 0.008 height [ {1} ] }} }} }} }}\n",
      side, heights);
}

class LivePatience : public testing::Test {
 protected:
  LivePatience() {
    settings_.threads = 2;
    settings_.channels = RT_RGBA;
  }
  LiveFrame frame(LiveFrame::Purpose purpose, double x) {
    LiveFrame frame;
    frame.width = 48;
    frame.height = 36;
    frame.samples = 1;
    frame.purpose = purpose;
    frame.view.viewer = browser_.camera(4.0 / 3);
    frame.view.viewer->matrix[12] += x;
    return frame;
  }
  LivePicture finish(LiveRenderer& live, const LiveFrame& frame) const {
    live.start(frame);
    while (live.state() != State::idle) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(live.takeFailure(), "");
    LivePicture picture, last;
    while (live.look(picture)) last = picture;
    EXPECT_TRUE(last.finished);
    return last;
  }
  void appear() {
    browser_.set(*browser_.node("Big"), "whichChoice", xvrml::Value(int32_t(0)));
    browser_.tick(1);
  }
  xvrml::Browser browser_{xvrml::loadWorldFromMemory(worldText(), "appears.wrl")};
  RenderSettings settings_;
};

TEST_F(LivePatience, PreviewsFollowTheCameraWhileWhatAppearsIsBuilt) {
  LiveRenderer live(browser_, settings_);
  finish(live, frame(LiveFrame::Purpose::still, 0));
  const LivePicture before = finish(live, frame(LiveFrame::Purpose::rawPreview, 0));
  EXPECT_FALSE(before.outdated);
  appear();
  LivePicture shown = finish(live, frame(LiveFrame::Purpose::preview, .1));
  EXPECT_TRUE(shown.outdated) << "half a million triangles within 20 ms?";
  EXPECT_EQ(shown.stats.scene.triangles, before.stats.scene.triangles);
  const std::vector<uint8_t> first = shown.rgb;
  int outdated = 0;
  for (double x = .2; shown.outdated && outdated < 10'000; x += .1, ++outdated)
    shown = finish(live, frame(LiveFrame::Purpose::preview, x));
  EXPECT_FALSE(shown.outdated);
  EXPECT_GE(shown.stats.scene.triangles, 2u * (side - 1) * (side - 1));
  EXPECT_NE(shown.rgb, first);
}

TEST_F(LivePatience, StillPicturesWaitAndHaveTheirBytes) {
  std::vector<uint8_t> shown;
  {
    LiveRenderer live(browser_, settings_);
    finish(live, frame(LiveFrame::Purpose::still, 0));
    appear();
    EXPECT_TRUE(finish(live, frame(LiveFrame::Purpose::preview, .1)).outdated);
    const LivePicture still = finish(live, frame(LiveFrame::Purpose::still, .2));
    EXPECT_FALSE(still.outdated);
    EXPECT_GE(still.stats.scene.triangles, 2u * (side - 1) * (side - 1));
    Picture copied;
    ASSERT_TRUE(live.copy(copied));
    shown = displayBytes(copied);
  }
  RenderSettings settings = settings_;
  const LiveFrame same = frame(LiveFrame::Purpose::still, .2);
  settings.width = same.width;
  settings.height = same.height;
  settings.samples = same.samples;
  EXPECT_EQ(shown, displayBytes(Renderer(browser_, settings).render(same.view).picture));
}

TEST_F(LivePatience, RootsComeLaterToo) {
  LiveRenderer live(browser_, settings_);
  finish(live, frame(LiveFrame::Purpose::still, 0));
  const uint64_t before = finish(live, frame(LiveFrame::Purpose::preview, 0)).stats.scene.triangles;
  const auto other = xvrml::loadWorldFromMemory(worldText(), "other.wrl");
  browser_.addRoot(other->scope.roots.at(1));
  const xvrml::NodeRef big = other->scope.roots.at(2);
  browser_.addRoot(big);
  browser_.set(*big, "whichChoice", xvrml::Value(int32_t(0)));
  LivePicture shown = finish(live, frame(LiveFrame::Purpose::preview, .1));
  EXPECT_TRUE(shown.outdated);
  EXPECT_EQ(shown.stats.scene.triangles, before);
  for (int i = 0; shown.outdated && i < 10'000; ++i)
    shown = finish(live, frame(LiveFrame::Purpose::preview, .1));
  EXPECT_GE(shown.stats.scene.triangles, 2u * (side - 1) * (side - 1));
}

TEST_F(LivePatience, AnotherWorldTakesThePlaceOfOneThatIsRead) {
  LiveRenderer live(browser_, settings_);
  finish(live, frame(LiveFrame::Purpose::still, 0));
  appear();
  EXPECT_TRUE(finish(live, frame(LiveFrame::Purpose::preview, .1)).outdated);
  const auto other = xvrml::loadWorldFromMemory("#VRML V2.0 utf8\nShape { geometry IndexedFaceSet "
                                                "{ coord Coordinate { point [ 0 0 0, 1 0 0, 0 "
                                                "1 0 ] } coordIndex [ 0 1 2 ] } }",
                                                "other.wrl");
  browser_.replaceWorld(other->scope.roots);
  browser_.tick(2);
  const LivePicture shown = finish(live, frame(LiveFrame::Purpose::preview, .1));
  EXPECT_EQ(shown.map.triangles, 1u);
}

} // namespace
