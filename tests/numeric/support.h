// support.h: scenes for tests against closed forms. Uses only the public C API. The tests are class
// D of the accuracy catalogue: one sample, no randomness in the value, relative tolerance 1e-5.
#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "numeric/catalogue.h"
#include "openrt/openrt.h"

namespace numeric {

inline constexpr double pi = 3.14159265358979323846;

struct Vec {
  double x = 0, y = 0, z = 0;
};

struct Rgba {
  float r = 0, g = 0, b = 0, a = 0;
};

// Expects |got - expected| / max(expected, floor) to be within the tolerance, as the catalogue
// defines it.
inline void expectClose(double got, double expected, double relative = 1e-5, double floor = 1e-2) {
  EXPECT_NEAR(got, expected, relative * std::max(std::fabs(expected), floor));
}
inline void expectGrey(const Rgba& got, double expected, double relative = 1e-5) {
  expectClose(got.r, expected, relative);
  expectClose(got.g, expected, relative);
  expectClose(got.b, expected, relative);
}
inline void expectColor(const Rgba& got, Vec expected, double relative = 1e-5) {
  expectClose(got.r, expected.x, relative);
  expectClose(got.g, expected.y, relative);
  expectClose(got.b, expected.z, relative);
}

// A shader with parameters, of a stock class or a library.
class Shader {
 public:
  explicit Shader(const char* name, const char* library = nullptr)
      : id_(rtNewShader(rtNewShaderClass(name, library))) {
    EXPECT_NE(id_, 0u) << name;
  }
  Shader& set(const char* name, std::initializer_list<double> values) {
    const int handle = bind(name);
    std::vector<float> v;
    for (double x : values) v.push_back(static_cast<float>(x));
    switch (v.size()) {
    case 1: rtParameter1f(handle, v[0]); break;
    case 2: rtParameter2f(handle, v[0], v[1]); break;
    case 3: rtParameter3f(handle, v[0], v[1], v[2]); break;
    case 4: rtParameter4f(handle, v[0], v[1], v[2], v[3]); break;
    case 16: rtParameter16f(handle, v.data()); break;
    default: ADD_FAILURE() << name << ": " << v.size() << " numbers";
    }
    rtBindShader(0);
    return *this;
  }
  Shader& setList(const char* name, const std::vector<float>& values) {
    rtParameterfv(bind(name), values.size(), values.data());
    rtBindShader(0);
    return *this;
  }
  Shader& setInt(const char* name, int value) {
    rtParameter1i(bind(name), value);
    rtBindShader(0);
    return *this;
  }
  Shader& setTexture(const char* name, RTid texture) {
    rtParameterTexture(bind(name), texture);
    rtBindShader(0);
    return *this;
  }
  operator RTid() const { return id_; }

 private:
  int bind(const char* name) {
    rtBindShader(id_);
    const int handle = rtParameterHandle(name);
    EXPECT_GE(handle, 0) << name;
    return handle;
  }
  RTid id_;
};

// A fixture with a context of its own. It fails if an error is pending at the end.
class Scene : public testing::Test {
 protected:
  void SetUp() override {
    context_ = rtNewContext("threads=1");
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtFrameBuffer(1, 1, RT_RGBA);
    rtLoadIdentity();
  }
  void TearDown() override {
    const RTstats last = stats(); // statistics of the last frame
    noteRays(last.rays.camera + last.rays.shadow + last.rays.secondary);
    const RTenum error = rtGetError();
    EXPECT_EQ(error, RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context_);
  }

  // A grey Lambert surface that may emit.
  static Shader matt(double reflectance, double radiance = 0) {
    Shader s("Diffuse");
    s.set("reflectance", {reflectance, reflectance, reflectance})
        .set("emission", {radiance, radiance, radiance});
    return s;
  }

  // Defines a square in the plane z = 0 that faces +z; with a colour per vertex if `color` is
  // given.
  static RTid square(RTid shader, double half = 10, const Vec* color = nullptr) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtBegin(RT_QUADS);
    rtNormal3f(0, 0, 1);
    if (color) rtColor3f(float(color->x), float(color->y), float(color->z));
    const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (const auto& c : corners) {
      rtTexCoord2f(float(0.5 + 0.5 * c[0]), float(0.5 + 0.5 * c[1]));
      rtVertex3d(half * c[0], half * c[1], 0);
    }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  // Instantiates the object under the current matrix.
  static RTid place(RTid object) { return rtInstantiateObject(object); }
  // Places an object at a point or at a height z, facing up or turned to face down.
  static RTid placeAt(Vec at, RTid object, bool down = false) {
    rtPushMatrix();
    rtTranslated(at.x, at.y, at.z);
    if (down) rtRotated(180, 1, 0, 0);
    const RTid placed = place(object);
    rtPopMatrix();
    return placed;
  }
  static RTid placeAt(double z, RTid object, bool down = false) {
    return placeAt(Vec{0, 0, z}, object, down);
  }

  // A perspective camera. Its angle of view is in degrees.
  static void cameraAt(Vec from, Vec to, double fovy) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(from.x, from.y, from.z, to.x, to.y, to.z, 0, 1, 0);
    rtPerspective(fovy);
    rtPopMatrix();
  }

  static RTid use(const Shader& light) { return rtUseLight(light); }
  static Shader directional(Vec direction) {
    Shader s("VRML97DirectionalLight");
    s.set("direction", {direction.x, direction.y, direction.z});
    return s;
  }
  // A white directional light. Its direction makes an angle with the axis -z in the plane y = 0,
  // and it comes from +x.
  static Shader tilted(double degrees) {
    const double t = degrees * pi / 180;
    return directional({-std::sin(t), 0, -std::cos(t)});
  }
  static Shader point(Vec location, std::initializer_list<double> attenuation) {
    Shader s("VRML97PointLight");
    s.set("location", {location.x, location.y, location.z}).set("attenuation", attenuation);
    return s;
  }

  // Returns what one ray straight down -z through (x, y) sees. The view is so narrow that the
  // position in it does not matter.
  static Rgba look(double x = 0, double y = 0, double height = 20) {
    static constexpr double narrow = 1e-6;
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(x, y, height);
    rtOrtho(narrow);
    rtPopMatrix();
    return render();
  }
  // Returns what a ray from a point at a distance above (0, 0, 0) sees.
  static Rgba lookFrom(double distance) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, distance);
    rtPerspective(1e-4);
    rtPopMatrix();
    return render();
  }
  static Rgba render(uint32_t channels = RT_RGBA) {
    rtFrameBuffer(1, 1, channels);
    rtRender();
    Rgba pixel;
    rtReadPixels(RT_RGBA, &pixel.r, 4);
    return pixel;
  }

  // Renders a square picture; returns its RGBA pixels.
  static std::vector<float> picture(int edge) {
    rtFrameBuffer(edge, edge, RT_RGBA);
    rtRender();
    std::vector<float> rgba(size_t(4 * edge * edge));
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  // Returns the mean of the red channel.
  static double mean(const std::vector<float>& rgba) {
    double sum = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) sum += double(rgba[i]);
    return sum / (double(rgba.size()) / 4);
  }

  static RTid texture(int components, std::initializer_list<float> texel) {
    RTid id = 0;
    rtGenTextures(1, &id);
    rtBindTexture(id);
    rtTexImage2D(components, 1, 1, RT_FLOAT, texel.begin());
    return id;
  }

  static RTstats stats() {
    RTstats s{};
    s.size = sizeof s;
    rtGetStats(&s);
    return s;
  }

 private:
  RTcontext context_ = nullptr;
};

} // namespace numeric
