// live_previews.h: a world in which every sample is bright or dark by chance, and its live pictures
// frame by frame. For tests of previews.
#pragma once

#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "libpicture/live.h"

namespace live_previews {

using namespace picture;
using Purpose = LiveFrame::Purpose;
using State = LiveRenderer::State;

// A sky that is bright above and dark below: every sample of the box is bright or dark, by chance.
inline constexpr const char* noisy = R"(#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 10 fieldOfView 0.6 }
Background { skyColor [ 1 1 1, 1 1 1, 0 0 0, 0 0 0 ] skyAngle [ 1.5, 1.6, 3.1 ] }
DEF Place Transform { children
  Shape { appearance Appearance { material Material { diffuseColor 0.8 0.8 0.8 } } geometry Box { size 0.6 2 0.6 } } }
)";

inline std::unique_ptr<xvrml::Browser> browserOf() {
  return std::make_unique<xvrml::Browser>(xvrml::loadWorldFromMemory(noisy, "previews.wrl"));
}

inline void moveTo(xvrml::Browser& browser, double x) {
  browser.set(*browser.node("Place"), "translation", xvrml::Value(xvrml::Vec3f{float(x), 0, 0}));
  browser.tick(browser.now() + .01);
}

inline RenderSettings settingsOf(uint32_t channels = RT_RGBA, int seed = 0) {
  RenderSettings settings;
  settings.threads = 2;
  settings.channels = channels;
  settings.quality.set(RT_TRANSPORT, RT_TRANSPORT_PATH);
  settings.quality.set(RT_SEED, seed);
  return settings;
}

inline LiveFrame frameOf(Purpose purpose, int width = 64, int height = 48, int samples = 1) {
  LiveFrame frame;
  frame.purpose = purpose;
  frame.width = width;
  frame.height = height;
  frame.samples = samples;
  return frame;
}

inline LiveFrame previewOf(uint32_t viewer = 0, int width = 64, int height = 48) {
  LiveFrame frame = frameOf(Purpose::preview, width, height);
  frame.viewer = viewer;
  return frame;
}

inline LiveFrame seenFrom(LiveFrame frame, const xvrml::Browser& browser, double x) {
  frame.view.viewer = browser.camera(4.0 / 3);
  frame.view.viewer->matrix[12] += x;
  return frame;
}

inline void nap() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

inline void waitFor(LiveRenderer& live) {
  while (live.state() != State::idle) nap();
}

inline LivePicture finish(LiveRenderer& live, const LiveFrame& frame) {
  const uint64_t number = live.start(frame);
  waitFor(live);
  EXPECT_EQ(live.takeFailure(), "");
  LivePicture picture;
  EXPECT_TRUE(live.look(picture));
  EXPECT_TRUE(picture.finished && picture.ended);
  EXPECT_EQ(picture.number, number);
  EXPECT_EQ(picture.purpose, frame.purpose);
  EXPECT_EQ(picture.width, frame.width);
  EXPECT_EQ(picture.height, frame.height);
  EXPECT_EQ(picture.rgb.size(), size_t(3 * frame.width * frame.height));
  EXPECT_EQ(picture.covered, 1);
  return picture;
}

inline Picture headless(xvrml::Browser& browser, RenderSettings settings, const LiveFrame& frame) {
  settings.width = frame.width;
  settings.height = frame.height;
  settings.samples = frame.samples;
  return Renderer(browser, settings).render(frame.view).picture;
}

} // namespace live_previews
