// vrml_film.cpp: a film on a surface shows the picture for the world's time (clause 6.28).
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <fmt/format.h>

#include "image/film.h"
#include "image/vrml_scene.h"
#include "xvrml/browser.h"

namespace xvrml::test {
namespace {

// Returns an animated GIF of two one-pixel pictures, one second each: red, then green.
std::string redThenGreen() {
  std::string out = "GIF89a";
  out += std::string("\1\0\1\0\xf0\0\0", 7) +
         std::string("\xff\0\0\0\xff\0", 6); // 1 x 1, with a palette of two entries
  for (int i = 0; i < 2; ++i) {
    out += std::string("\x21\xf9\4\0\x64\0\0\0", 8); // 100 hundredths of a second
    out += std::string("\x2c\0\0\0\0\1\0\1\0\0", 10) + std::string("\2\2", 2); // the whole picture
    out += std::string(i == 0 ? "\x44\1\0" : "\x4c\1\0", 3);                   // clear, colour, end
  }
  return out + ";";
}

TEST(FilmPicture, ASurfaceShowsThePictureOfTheTime) {
  const auto folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("xvrml_film_{}", getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "film.gif", std::ios::binary) << redThenGreen();
  const std::string vrml =
      "#VRML V2.0 utf8\n" + dark +
      square(
          "Appearance { texture DEF M MovieTexture { startTime 1 loop TRUE url \"film.gif\" } }");
  RTcontext context = rtNewContext("threads=1");
  ASSERT_NE(context, nullptr);
  {
    Browser browser(loadWorldFromMemory(vrml, folder / "world.wrl"), BrowserOptions(), 0,
                    RunOptions{.epoch = 0});
    OpenRTMapper mapper(browser.world(), MapOptions());
    rtFrameBuffer(1, 1, RT_RGBA);
    const auto seen = [&](double time) {
      browser.tick(time);
      mapper.update(browser.takeChanges());
      mapper.map(Scene::at(0, 0, 10, 1e-5));
      rtRender();
      Pixel p;
      rtReadPixels(RT_RGBA, &p.r, 4);
      EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
      return p.r > 0.9f && p.g < 0.1f ? "red" : p.g > 0.9f && p.r < 0.1f ? "green" : "else";
    };
    EXPECT_STREQ(seen(0), "red"); // before it starts
    if (decodesFilms()) {
      EXPECT_STREQ(seen(1.5), "red");
      EXPECT_STREQ(seen(2.5), "green");
      EXPECT_STREQ(seen(3.5), "red");
      EXPECT_STREQ(seen(4.5), "green");
      browser.set(*browser.node("M"), "set_stopTime", 4.5);
      EXPECT_STREQ(seen(9), "green"); // keeps the last picture
    }
    for (const Diagnostic& d : browser.world().diagnostics.list())
      EXPECT_FALSE(decodesFilms()) << d.text();
  }
  rtDeleteContext(context);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace xvrml::test
