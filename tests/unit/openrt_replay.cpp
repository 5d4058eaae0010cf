// openrt_replay.cpp: a scene that changes over several frames is recorded while the local backend
// renders it. The program openrt-replay must produce the same bytes for every frame. Also its exit
// codes.
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drawing.h"
#include "openrt/openrt.h"

namespace {

namespace fs = std::filesystem;
using Picture = std::vector<float>; // rgb, first row at the top

constexpr int width = 48, height = 32;

class Replay : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("openrt_replay_" + std::to_string(::getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  int replay(const std::string& arguments) {
    const std::string command =
        "'" OPENRT_REPLAY "' " + arguments + " >'" + (folder / "out").string() + "' 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const {
    std::ifstream file(folder / "out");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string quoted(const char* name) const { return "'" + (folder / name).string() + "'"; }
  Picture readPfm(const char* name) const {
    std::ifstream file(folder / name, std::ios::binary);
    std::string magic, w, h, scale;
    file >> magic >> w >> h >> scale;
    file.get();
    EXPECT_EQ(magic + " " + w + " " + h + " " + scale,
              "PF " + std::to_string(width) + " " + std::to_string(height) + " -1.0");
    Picture rows(3 * width * height), picture;
    file.read(reinterpret_cast<char*>(rows.data()), std::streamsize(rows.size() * sizeof(float)));
    EXPECT_TRUE(file.good());
    for (int y = height; y-- > 0;)
      picture.insert(picture.end(), &rows[3 * width * y], &rows[3 * width * y] + 3 * width);
    return picture;
  }

  fs::path folder;
};

Picture rendered() {
  rtRender();
  std::vector<float> rgba(4 * width * height);
  rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  Picture picture;
  for (size_t i = 0; i < rgba.size(); i += 4)
    picture.insert(picture.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return picture;
}

bool same(const Picture& a, const Picture& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Renders four frames. Between them objects are moved, recoloured, redefined and deleted.
std::vector<Picture> recordFrames(const fs::path& recording) {
  const RTcontext context =
      rtNewContext(("threads=2 record=\"" + recording.string() + "\"").c_str());
  EXPECT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
  std::vector<Picture> frames;
  const RTid surface = rtNewShader(rtNewShaderClass("VRML97", nullptr));
  rtBindShader(surface);
  const RTid ball = rtBeginObject(0);
  rtSphere(0.7f);
  rtEndObject();
  const RTid pair = rtBeginObject(0);
  rtTranslated(-0.9, 0, 0);
  rtInstantiateObject(ball);
  rtLoadIdentity();
  rtTranslated(0.9, 0, 0);
  rtInstantiateObject(ball);
  rtEndObject();
  const RTid floor = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtVertex3d(-5.1, -1.1, 5);
  rtVertex3d(5.1, -1.1, 5);
  rtVertex3d(5.1, -1.1, -5);
  rtVertex3d(-5.1, -1.1, -5);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(floor);
  // A body of surfaces without facets; the arrays are gone once they are drawn.
  const RTid glass = rtNewShader(rtNewShaderClass("Glass", nullptr));
  const RTid lens = rtBeginObject(0);
  const auto drawLens = [&](double conic) {
    std::vector<double> terms{.01, -.002};
    rtBindShader(glass);
    rtTranslated(0, -.5, 1);
    rtAsphere(.4, conic, terms.size(), terms.data(), .1, .6);
    rtTranslated(0, 0, .2);
    std::vector<double> plane{0, 0, 1, 0, 0, 0, .1, 0, 0, -1e-3}, low{-.5, -.4, -.3},
        high{.5, .4, .3};
    rtQuadric(plane.data(), low.data(), high.data());
    rtBindShader(surface);
    rtCone(.2, .1, .3, .6);
  };
  drawLens(-1.5);
  rtEndObject();
  rtInstantiateObject(lens);
  const RTid instance = rtInstantiateObject(pair);
  rtPushMatrix();
  rtTranslated(0, 1.4, -1);
  rtScaled(.4, .3, .4);
  const RTid lively = rtInstantiateObject(pair);
  rtInstanceHint(lively, RT_DYNAMIC);
  rtTranslated(0, -4, 0);
  const RTid hidden = rtInstantiateObject(ball);
  rtInstanceHint(hidden, RT_DYNAMIC);
  rtInstanceVisible(hidden, 0);
  rtPopMatrix();
  rtPushMatrix();
  rtRotated(-60, 1, 0.5, 0);
  const RTid light = rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
  rtPopMatrix();
  rtLookAt(0, 1, 5, 0, 0, 0, 0, 1, 0);
  rtPerspective(45);
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 2);
  frames.push_back(rendered());

  const double moved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0.25, -1, 1};
  rtInstanceMatrix(instance, moved);
  const double small[16] = {.5, 0, 0, 0, 0, .5, 0, 0, 0, 0, .5, 0, -1, 1.2, 0, 1};
  rtInstanceMatrix(lively, small);
  rtInstanceVisible(hidden, 1);
  frames.push_back(rendered());

  rtParameter3f(rtParameterHandle("diffuseColor"), 0.9f, 0.1f, 0.2f);
  rtBeginObject(lens);
  drawLens(.5);
  rtEndObject();
  rtBeginObject(ball);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(-1, -1, 0);
  rtVertex3f(1, -1, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  frames.push_back(rendered());

  rtInstanceMatrix(lively, moved);
  rtInstanceVisible(instance, 0);
  rtDeleteShader(surface);
  rtDeleteObject(floor);
  rtRemoveLight(light);
  frames.push_back(rendered());
  rtDeleteContext(context);
  return frames;
}

TEST_F(Replay, EveryFrameHasTheSameBytes) {
  const std::vector<Picture> frames = recordFrames(folder / "a recording");
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_FALSE(same(frames[0], frames[1]) || same(frames[1], frames[2]) ||
               same(frames[2], frames[3]));
  for (int frame = 1; frame <= 4; frame++) {
    ASSERT_EQ(replay(quoted("a recording") + " -o " + quoted("frame.pfm") +
                     " --threads 1 --frame " + std::to_string(frame)),
              0)
        << said();
    EXPECT_TRUE(same(readPfm("frame.pfm"), frames[size_t(frame - 1)])) << "frame " << frame;
  }
  ASSERT_EQ(replay(quoted("a recording") + " -o " + quoted("last.pfm") + " --stats"), 0) << said();
  EXPECT_TRUE(same(readPfm("last.pfm"), frames[3]));
  EXPECT_NE(said().find("\"frames\": 4"), std::string::npos) << said();
}

// The photons that guide paths are traced again (photon_guide.h).
TEST_F(Replay, GuidedPathsHaveTheSameBytes) {
  Picture frame;
  drawing::drawIn(
      rtNewContext(("threads=2 record=\"" + (folder / "guided").string() + "\"").c_str()), [&] {
        drawing::drawRoom();
        rtFrameBuffer(width, height, RT_RGBA);
        rtQuality(RT_SAMPLES_PER_PIXEL, 32);
        rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
        frame = rendered();
        RTstats stats{};
        stats.size = sizeof stats;
        rtGetStats(&stats);
        EXPECT_NE(std::strstr(stats.transport.reason, ", guided"), nullptr)
            << stats.transport.reason;
      });
  ASSERT_EQ(replay(quoted("guided") + " -o " + quoted("frame.pfm") + " --threads 1"), 0) << said();
  EXPECT_TRUE(same(readPfm("frame.pfm"), frame));
}

TEST_F(Replay, ValuesOfVerticesAndAReload) {
  const RTcontext context = rtNewContext(("threads=2 shaderpath=" OPENRT_TEST_PLUGINS " record=\"" +
                                          (folder / "colours").string() + "\"")
                                             .c_str());
  ASSERT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
  rtBindShader(rtNewShader(rtNewShaderClass("Varying", "varying")));
  const int color = rtParameterHandle("color"), show = rtParameterHandle("show"),
            triple = rtParameterHandle("triple");
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLE_STRIP);
  for (int i = 0; i < 12; i++) {
    rtParameter3f(color, float(i % 3) / 2, float(i % 5) / 4, float(i % 2));
    rtParameter3f(triple, float(i % 2), float(i % 4) / 4, float(i % 7) / 7);
    rtVertex3d(0.4 * i - 2.2, i % 2 ? 1.1 : -1.1, -0.01 * i);
  }
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  rtTranslated(0, 0, 5);
  rtPerspective(45);
  rtLoadIdentity();
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  std::vector<Picture> frames{rendered()};
  rtParameter1i(show, 3);
  EXPECT_EQ(rtReloadShaders(), 0);
  frames.push_back(rendered());
  rtDeleteContext(context);
  EXPECT_FALSE(same(frames[0], frames[1]));
  for (int frame = 1; frame <= 2; frame++) {
    ASSERT_EQ(replay(quoted("colours") + " -o " + quoted("frame.pfm") +
                     " --shader-path '" OPENRT_TEST_PLUGINS "' --frame " + std::to_string(frame)),
              0)
        << said();
    EXPECT_TRUE(same(readPfm("frame.pfm"), frames[size_t(frame - 1)])) << "frame " << frame;
  }
}

TEST_F(Replay, AnExportCountsTheValuesOfTextures) {
  const RTcontext context =
      rtNewContext(("threads=1 record=\"" + (folder / "textures").string() + "\"").c_str());
  ASSERT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
  RTid textures[2];
  rtGenTextures(2, textures);
  std::string bytes = "fifteen  texels";
  rtBindTexture(textures[0]);
  rtTexImage3D(1, 5, 1, 3, RT_UNSIGNED_BYTE, bytes.data());
  const float floats[3] = {1, 2, 3};
  rtBindTexture(textures[1]);
  rtTexImage2D(3, 1, 1, RT_FLOAT, floats);
  rtPerspective(45);
  rtFrameBuffer(width, height, RT_RGBA);
  rendered();
  rtDeleteContext(context);
  ASSERT_EQ(replay(quoted("textures") + " --export " + quoted("scene.json")), 0) << said();
  const auto contents = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  std::string json = contents("scene.json");
  std::erase_if(json, [](char c) { return c == ' ' || c == '\n'; });
  EXPECT_NE(
      json.find(
          "\"depth\":3,\"components\":1,\"float\":false,\"srgb\":false,\"texels\":{\"offset\":0,"
          "\"count\":15}"),
      std::string::npos)
      << json;
  EXPECT_NE(
      json.find(
          "\"depth\":1,\"components\":3,\"float\":true,\"srgb\":false,\"texels\":{\"offset\":16,"
          "\"count\":3}"),
      std::string::npos)
      << json;
  bytes.append(1, '\0').append(reinterpret_cast<const char*>(floats), sizeof floats);
  EXPECT_EQ(contents("scene.json.bin"), bytes);
}

TEST_F(Replay, ExitCodes) {
  recordFrames(folder / "good");
  EXPECT_EQ(replay("--help"), 0);
  EXPECT_EQ(replay(""), 2);
  EXPECT_EQ(replay(quoted("good") + " --nonsense"), 2);
  EXPECT_EQ(replay(quoted("good") + " --frame 0"), 2);
  EXPECT_EQ(replay(quoted("absent")), 3);
  EXPECT_NE(said().find("No such file"), std::string::npos) << said();
  EXPECT_EQ(replay(quoted("good") + " --frame 5"), 3);
  EXPECT_NE(said().find("has 4 frames"), std::string::npos) << said();
  fs::resize_file(folder / "good", fs::file_size(folder / "good") - 10);
  EXPECT_EQ(replay(quoted("good")), 3);
  EXPECT_NE(said().find("the file ends in the middle"), std::string::npos) << said();
  std::ofstream(folder / "text") << "this is no recording at all";
  EXPECT_EQ(replay(quoted("text")), 3);
  EXPECT_NE(said().find("not a recording"), std::string::npos) << said();
}

TEST_F(Replay, APictureThatCannotBeWritten) {
  recordFrames(folder / "good");
  EXPECT_EQ(replay(quoted("good") + " --frame 1 -o /nonexistent/folder/x.pfm"), 1);
  EXPECT_NE(said().find("cannot be written"), std::string::npos) << said();
  EXPECT_EQ(replay(quoted("good") + " --frame 1 -o " + quoted("x.png")), 2); // not a PFM
  EXPECT_FALSE(fs::exists(folder / "x.png"));
  EXPECT_NE(said().find("only PFM files are written"), std::string::npos) << said();
}

} // namespace
