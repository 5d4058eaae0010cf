// faults.cpp: the log names shaders that go wrong: NaN in their results, crashes.
#include <csignal>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

#include "small_scene.h"

namespace {

using namespace abi_test;

class Faults : public SmallScene {
 protected:
  void square(const char* className) {
    shader(className, "faulty");
    const RTid object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
    rtEndObject();
    rtInstantiateObject(object);
  }
};

TEST_F(Faults, NaNInRadianceIsZeroCountedAndNamedOnceAFrame) {
  square("Nan");
  const std::vector<float> pixels = picture(4);
  for (size_t i = 0; i < 16; i++) {
    const bool left = i % 4 < 2;
    for (int k = 0; k < 3; k++)
      EXPECT_EQ(pixels[4 * i + size_t(k)], left && k < 2 ? 0.0f : 0.5f) << i << " " << k;
  }
  EXPECT_EQ(stats().leftOut.shaderFaults, 8u);
  EXPECT_EQ(log.count("shader Nan of faulty returned NaN or infinity"), 1u);
  EXPECT_TRUE(log.has("(8 points)"));
  picture(4);
  EXPECT_EQ(log.count("shader Nan of faulty"), 2u); // another frame reports again
}

TEST_F(Faults, ALobeThatIsNotFiniteHasNoWeight) {
  square("NanLobe");
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  const std::vector<float> pixels = picture(2);
  for (size_t i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) EXPECT_EQ(pixels[4 * i + size_t(k)], 0.25f);
  EXPECT_EQ(stats().leftOut.shaderFaults, 4u);
  EXPECT_EQ(log.count("shader NanLobe of faulty"), 1u);
}

constexpr const char* said = "bounds bodies that paths have left but never entered";

// Places a body of these faces.
template <class Faces> RTid body(RTid shader, const Faces& faces) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  faces();
  rtEndObject();
  return rtInstantiateObject(object);
}

TEST_F(Faults, BodiesThatAreLeftButWereNeverEnteredAreNamed) {
  const RTid glass = shader("Glass", nullptr);
  RTid placed = body(glass, [] { rtSphere(0.5f); });
  picture(16);
  rtDeleteInstance(placed);
  placed = body(glass, [] { rtSphere(100); }); // the camera is inside
  picture(16);
  EXPECT_EQ(log.count(said), 0u);
  rtDeleteInstance(placed);
  rtRotatef(180, 1, 0, 0);
  body(glass, [] {
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
  });
  picture(4);
  EXPECT_EQ(log.count(said), 1u);
  EXPECT_TRUE(log.has("shader Glass of"));
  EXPECT_TRUE(log.has("(16 points)"));
}

// Camera paths enter the sheet and never leave; paths from the lamp behind it leave only.
TEST_F(Faults, BodiesThatPathsFromLampsLeaveButNeverEnteredAreNamed) {
  rtUseLight(shader("VRML97PointLight", nullptr));
  const RTid glass = shader("Glass", nullptr);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  const RTid around = body(glass, [] { rtSphere(0.5f); }); // the lamp is inside
  picture(16);
  rtDeleteInstance(around);
  EXPECT_EQ(log.count(said), 0u);
  rtTranslatef(0, 0, 1);
  body(glass, [] {
    rtBegin(RT_QUADS);
    squareVertices();
    rtEnd();
  });
  picture(16);
  EXPECT_EQ(log.count(said), 1u);
}

TEST_F(Faults, GoodShadersHaveNone) {
  rtBindShader(0);
  const RTid object = rtBeginObject(0);
  rtSphere(0.5f);
  rtEndObject();
  rtInstantiateObject(object);
  picture(8);
  EXPECT_EQ(stats().leftOut.shaderFaults, 0u);
  EXPECT_TRUE(log.lines.empty());
  EXPECT_EQ(rtRunningShader(), nullptr);
}

void nameTheShader(int number) {
  const char* const name = rtRunningShader();
  if (name && write(STDOUT_FILENO, name, std::strlen(name)) < 0) _exit(3);
  signal(number, SIG_DFL);
  raise(number);
}

// Returns the output of a process that renders with the shader, and how it ends.
void crashWith(const char* className, int transport, const std::string& config, std::string& text,
               int& status) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) { // the child runs no code of the test framework
    dup2(ends[1], STDOUT_FILENO);
    signal(SIGSEGV, nameTheShader);
    rtNewContext(config.c_str());
    rtQuality(RT_TRANSPORT, transport);
    rtTranslated(0, 0, 10);
    rtOrtho(2);
    rtLoadIdentity();
    rtBindShader(rtNewShader(rtNewShaderClass(className, "faulty")));
    const RTid object = rtBeginObject(0);
    rtSphere(0.5f);
    rtEndObject();
    rtInstantiateObject(object);
    rtFrameBuffer(4, 4, RT_RGBA);
    rtRender();
    _exit(0);
  }
  close(ends[1]);
  char buffer[256];
  for (ssize_t n = 0; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, size_t(n));
  close(ends[0]);
  ASSERT_EQ(waitpid(child, &status, 0), child);
}

TEST_F(Faults, ACrashCanBeNamed) {
  const struct {
    const char* name;
    int transport;
  } cases[] = {{"Crash", RT_TRANSPORT_DIRECT}, {"BadLobe", RT_TRANSPORT_PATH}};
  for (const auto& each : cases) {
    std::string text;
    int status = 0;
    crashWith(each.name, each.transport, config() + " shaderpath=\"" + folders() + "\"", text,
              status);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV) << each.name << " " << status;
    EXPECT_EQ(text, std::string(each.name) + " of faulty");
  }
}

TEST_F(Faults, NaNInALobeOfItsOwnIsCounted) {
  square("BadLobe");
  rtBindShader(0);
  rtUseLight(rtNewShader(rtNewShaderClass("VRML97DirectionalLight", nullptr)));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_DIRECT);
  const std::vector<float> pixels = picture(2);
  EXPECT_EQ(pixels[0], 0.0f);
  EXPECT_NEAR(pixels[1], 0.5 * 0.25 * 3.14159265,
              1e-6); // the light gives a white diffuse surface a radiance of 1: an irradiance of pi
  EXPECT_GT(stats().leftOut.shaderFaults, 0u);
  EXPECT_EQ(log.count("shader BadLobe of faulty"), 1u);
}

class Diagnosed : public Faults {
 protected:
  std::string config() const override { return "backend=debug:local threads=1"; }
};

TEST_F(Diagnosed, TraitsThatKeepSilent) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  square("SilentLamp");
  rtTranslated(0, 0, 1);
  square("SilentVeil");
  rtTranslated(0, 0, 1);
  square("SilentGloss");
  picture(2);
  EXPECT_EQ(
      log.count("shader SilentGloss of faulty has glossy lobes, but its traits lack RTS_GLOSSY"),
      1u);
  EXPECT_FALSE(log.has("SilentLamp of faulty has emission")); // occluded by the others
}

TEST_F(Diagnosed, ScatteringThatTraitsExclude) {
  square("SilentScatter");
  picture(2);
  EXPECT_EQ(log.count("shader SilentScatter of faulty has lobes that scatter, but its traits have "
                      "RTS_NO_SCATTER"),
            1u);
}

TEST_F(Diagnosed, EmissionThatVariesAgainstTheTraits) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  square("UnevenLamp");
  picture(2);
  EXPECT_EQ(log.count("shader UnevenLamp of faulty has emission that varies, but its traits have "
                      "RTS_UNIFORM_EMISSION"),
            1u);
}

TEST_F(Diagnosed, EmissionAndTransparencyThatAreNotAnnounced) {
  square("SilentLamp");
  rtTranslated(0, 0, 1);
  square("SilentVeil");
  picture(2);
  EXPECT_EQ(
      log.count(
          "shader SilentVeil of faulty lets light through, but its traits lack RTS_TRANSPARENT"),
      1u);
  EXPECT_EQ(log.count("shader SilentLamp of faulty has emission, but its traits lack RTS_EMISSIVE"),
            1u);
}

} // namespace
