// vrml_scene.h: renders a few lines of VRML for tests, with one context and one world. Colours are
// as written in the world, without a tone curve.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace xvrml::test {

struct Pixel {
  float r = 0, g = 0, b = 0, a = 0;
};

struct SceneOptions {
  std::string config = "threads=1";
  int width = 1, height = 1, samples = 1;
  bool shadows = true, linearColor = false, multiplyTextures = false;
  MapOptions::Headlight headlight = MapOptions::Headlight::automatic;
  uint32_t channels = RT_RGBA;
  std::string header = "#VRML V2.0 utf8";
};

class Scene {
 public:
  explicit Scene(const std::string& body, const SceneOptions& options = {}) : options_(options) {
    context_ = rtNewContext(options.config.c_str());
    if (!context_) ADD_FAILURE() << "no context: " << (rtGetError(), rtGetErrorMessage());
    world = loadWorldFromMemory(options.header + "\n" + body, "scene.wrl");
    MapOptions map;
    map.linearColor = options.linearColor;
    map.headlight = options.headlight;
    map.aspect = double(options.width) / options.height;
    mapper = std::make_unique<OpenRTMapper>(*world, map);
    mapper->setMultiplyTextures(options.multiplyTextures);
    rtFrameBuffer(options.width, options.height, options.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, options.samples);
    rtQuality(RT_SHADOWS, options.shadows);
  }
  ~Scene() {
    rtMakeCurrent(context_);
    mapper.reset();
    rtDeleteContext(context_);
  }
  Scene(const Scene&) = delete;

  // Returns a camera at a position that looks along -z, with a vertical field of view.
  static CameraSettings at(double x, double y, double z, double fovy) {
    CameraSettings camera{};
    for (int i = 0; i < 4; ++i) camera.matrix[5 * i] = 1;
    camera.matrix[12] = x;
    camera.matrix[13] = y;
    camera.matrix[14] = z;
    camera.fovy = fovy;
    return camera;
  }

  std::vector<Pixel> render(const CameraSettings& camera) {
    rtMakeCurrent(context_);
    mapper->map(camera);
    rtRender();
    std::vector<Pixel> picture(size_t(options_.width) * size_t(options_.height));
    rtReadPixels(RT_RGBA, &picture[0].r, 4 * picture.size());
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    return picture;
  }
  std::vector<Pixel> render() { return render(mapper->viewpointCamera(0)); }
  std::vector<float> channel(RTenum name, size_t components) {
    std::vector<float> values(size_t(options_.width) * size_t(options_.height) * components);
    rtMakeCurrent(context_);
    rtReadPixels(name, values.data(), values.size());
    return values;
  }
  void expectNoMessages() {
    for (const Diagnostic& d : world->diagnostics.list()) ADD_FAILURE() << d.text();
  }

  std::unique_ptr<World> world;
  std::unique_ptr<OpenRTMapper> mapper;

 private:
  SceneOptions options_;
  RTcontext context_ = nullptr;
};

// Returns the pixel that a camera at (0 0 z) sees straight ahead. The field of view is so small
// that the position in the pixel does not matter.
inline Pixel ahead(const std::string& body, double z = 10, const SceneOptions& options = {}) {
  Scene scene(body, options);
  const Pixel pixel = scene.render(Scene::at(0, 0, z, 1e-5))[0];
  scene.expectNoMessages();
  return pixel;
}

inline const std::string dark = "NavigationInfo { headlight FALSE }\n";

// Returns a square of side 2 at z = 0 that faces +z.
inline std::string square(const std::string& appearance, const std::string& more = "",
                          double half = 1) {
  const std::string h = std::to_string(half);
  return "Shape { appearance " + appearance +
         " geometry IndexedFaceSet { coord Coordinate { point [ -" + h + " -" + h + " 0, " + h +
         " -" + h + " 0, " + h + " " + h + " 0, -" + h + " " + h +
         " 0 ] } coordIndex [ 0 1 2 3 -1 ] " + more + " } }\n";
}
inline std::string material(const std::string& fields = "") {
  return "Appearance { material Material { " + fields + " } }";
}

} // namespace xvrml::test
