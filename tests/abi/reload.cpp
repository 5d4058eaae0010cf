// reload.cpp: shader libraries reloaded while a program runs, after the file in the folder was
// replaced by another version.
#include <filesystem>
#include <fstream>
#include <functional>

#include <unistd.h>

#include "small_scene.h"

namespace {

using namespace abi_test;
namespace fs = std::filesystem;

class Reload : public SmallScene {
 protected:
  std::string folders() const override { return folder.string() + ":" + OPENRT_TEST_PLUGINS; }
  void SetUp() override {
    folder = fs::temp_directory_path() / ("openrt_reload_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    fs::permissions(folder, fs::perms::owner_all);
    install(1);
    SmallScene::SetUp();
    id = shader("Versioned", "version");
    color = rtParameterHandle("color");
    gone = rtParameterHandle("gone");
    shift = rtParameterHandle("shift");
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
  }
  void TearDown() override {
    SmallScene::TearDown();
    fs::remove_all(folder);
  }
  // Replaces the file like a linker: a new file takes the old one's place.
  void put(const std::function<void(const fs::path&)>& write) {
    const fs::path fresh = folder / "fresh";
    write(fresh);
    fs::rename(fresh, folder / "version.so");
  }
  void install(int version) {
    put([&](const fs::path& to) {
      fs::copy_file(std::string(OPENRT_TEST_PLUGINS) + "/versions/" + std::to_string(version) +
                        "/version.so",
                    to);
    });
  }
  fs::path folder;
  RTid id = 0;
  int color = -1, gone = -1, shift = -1;
};

TEST_F(Reload, NothingChangedNothingLoaded) {
  EXPECT_EQ(rtReloadShaders(), 0);
  EXPECT_NEAR(picture(1)[0], 0.1f, 1e-6);
  EXPECT_EQ(rtReloadShaders(), 0);
}

TEST_F(Reload, TheNewFunctionsHaveTheValuesOfTheOldNames) {
  rtParameter3f(color, 0.25f, 0.5f, 1);
  rtParameter1f(shift, 0.125f);
  EXPECT_NEAR(picture(1)[0], 0.375f, 1e-6);
  install(2);
  EXPECT_EQ(rtReloadShaders(), 1);
  // Gain 2 x the colour that was set + the default of the parameter whose type changed.
  const std::vector<float> pixel = picture(1);
  EXPECT_NEAR(pixel[0], 1.0f, 1e-6);
  EXPECT_NEAR(pixel[1], 1.5f, 1e-6);
  EXPECT_NEAR(pixel[2], 2.5f, 1e-6);
  // Handles stay valid and names are looked up again. A removed parameter keeps its handle without
  // a name and without effect.
  EXPECT_EQ(rtParameterHandle("color"), color);
  rtParameter3f(color, 0, 0, 0);
  rtParameter1f(gone, 5);
  rtParameter1f(shift, 5);
  EXPECT_NEAR(picture(1)[0], 0.5f, 1e-6);
  const int fresh = rtParameterHandle("shift");
  EXPECT_NE(fresh, shift);
  rtParameter2f(fresh, 0.75f, 0);
  rtParameter1f(rtParameterHandle("gain"), 3);
  EXPECT_NEAR(picture(1)[0], 0.75f, 1e-6);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  EXPECT_EQ(rtParameterHandle("gone"), -1);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_PARAMETER));
  int count = 0;
  RTparameterInfo info{};
  rtGetShaderClass(rtNewShaderClass("Versioned", "version"), nullptr, &count);
  EXPECT_EQ(count, 5);
  rtGetParameterInfo(rtNewShaderClass("Versioned", "version"), gone, &info);
  EXPECT_STREQ(info.name, "");
  // Back to the first version.
  install(1);
  EXPECT_EQ(rtReloadShaders(), 1);
  EXPECT_EQ(rtParameterHandle("gone"), gone);
  EXPECT_NEAR(picture(1)[0], 0 + 5 + 5, 1e-5);
}

TEST_F(Reload, AFailureKeepsTheOldOne) {
  rtParameter3f(color, 0.5f, 0.5f, 0.5f);
  EXPECT_NEAR(picture(1)[0], 0.5f, 1e-6);
  put([](const fs::path& to) { std::ofstream(to) << "no library\n"; });
  EXPECT_EQ(rtReloadShaders(), 0);
  EXPECT_EQ(rtGetError(), RTenum(RT_PLUGIN_ERROR));
  EXPECT_NE(std::string(rtGetErrorMessage()).find("rtReloadShaders: shader library"),
            std::string::npos)
      << rtGetErrorMessage();
  EXPECT_NEAR(picture(1)[0], 0.5f, 1e-6);
  install(3); // without the class
  EXPECT_EQ(rtReloadShaders(), 0);
  EXPECT_EQ(rtGetError(), RTenum(RT_PLUGIN_ERROR));
  EXPECT_NE(std::string(rtGetErrorMessage()).find("its class Versioned is gone"), std::string::npos)
      << rtGetErrorMessage();
  EXPECT_NEAR(picture(1)[0], 0.5f, 1e-6);
  fs::remove(folder / "version.so");
  EXPECT_EQ(rtReloadShaders(), 0);
  EXPECT_EQ(rtGetError(), RTenum(RT_PLUGIN_ERROR));
  EXPECT_NEAR(picture(1)[0], 0.5f, 1e-6);
  install(2);
  EXPECT_EQ(rtReloadShaders(), 1);
  EXPECT_NEAR(picture(1)[0], 1.5f, 1e-6);
}

TEST_F(Reload, AFrameInFlightKeepsTheOldOne) {
  rtParameter3f(color, 0.5f, 0.5f, 0.5f);
  constexpr int n = 64;
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  rtFrameBuffer(n, n, RT_RGBA);
  rtSwapBuffers();
  install(2);
  EXPECT_EQ(rtReloadShaders(), 1); // while a frame renders
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtSwapBuffers();
  const std::vector<float> before = read(n);
  rtSwapBuffers();
  const std::vector<float> after = read(n);
  for (size_t i = 0; i < before.size(); i += 4) {
    ASSERT_NEAR(before[i], 0.5f, 1e-5) << i;
    ASSERT_NEAR(after[i], 1.5f, 1e-6) << i;
  }
}

TEST_F(Reload, AnotherContextHasTheFileThatIsThere) {
  EXPECT_NEAR(picture(1)[0], 0.1f, 1e-6);
  install(2);
  const RTcontext other = rtNewContext(("threads=1 shaderpath=\"" + folders() + "\"").c_str());
  rtBindShader(rtNewShader(rtNewShaderClass("Versioned", "version")));
  EXPECT_EQ(rtReloadShaders(), 0); // it is up to date
  EXPECT_GE(rtParameterHandle("gain"), 0);
  rtDeleteContext(other);
  rtMakeCurrent(context);
  EXPECT_NEAR(picture(1)[0], 0.1f, 1e-6); // this context keeps its old library
  EXPECT_EQ(rtReloadShaders(), 1);
}

TEST_F(Reload, PointersGoOnAsTheClassDeclaresThem) {
  const float points[4][3] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
              blue[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  rtVertexPointer(3, RT_FLOAT, 0, points);
  rtParameterPointer(color, 0, blue[0]);
  install(2);
  EXPECT_EQ(rtReloadShaders(), 1);
  const RTid object = rtBeginObject(0);
  rtDrawArrays(RT_QUADS, 0, 4);
  rtEndObject();
  rtInstantiateObject(object);
  EXPECT_NEAR(picture(1)[2], 2.5f, 1e-6);
}

TEST_F(Reload, NotWithinADefinition) {
  rtBeginObject(0);
  EXPECT_EQ(rtReloadShaders(), 0);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
  rtEndObject();
}

TEST_F(Reload, ValuesOfGeometryKeepTheirPlace) {
  const RTid object = rtBeginObject(0);
  rtTranslated(0, 0, 1);
  rtBegin(RT_QUADS);
  rtParameter3f(color, 1, 0.5f, 0.25f);
  squareVertices();
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  EXPECT_NEAR(picture(1)[2], 0.25f, 1e-6);
  install(2);
  EXPECT_EQ(rtReloadShaders(), 1);
  EXPECT_NEAR(picture(1)[2], 2 * 0.25f + 0.5f, 1e-6);
}

} // namespace
