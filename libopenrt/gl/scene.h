// scene.h: keeps what OpenRT has been told, and tells it only what a frame has changed. An object
// lives as long as frames have its geometry, and some frames longer. The k-th use of a geometry in
// a frame is the k-th instance of its object. Shaders of materials are used again with other
// parameters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "gl/camera.h"
#include "gl/frame.h"
#include "gl/picture.h"

namespace rtgl {

class Scene {
 public:
  int lightMode = -1; // RTGL_*; -1: as the environment says
  int samples = 4;

  // Commits a frame and renders it. Returns false if there is no viewport or an error.
  bool show(const Frame& frame);
  // Adds samples of the same frame. Returns their number, or 0 if no frame was shown.
  int refine();
  const Film& film() const { return film_; }
  bool linear() const;

 private:
  struct Instance {
    RTid id, shader = 0;
    Matrix matrix;
    bool visible = true;
  };
  struct Shape { // an object of OpenRT
    RTid object;
    std::vector<Part> parts;
    std::vector<Instance> instances;
    size_t used = 0; // instances that this frame has used
    uint64_t lastFrame = 0;
  };
  struct Paint { // a shader of a material
    RTid shader = 0;
    Material material;
    std::array<float, 3> ambient, specularShare; // those of the lights
    int kind = 0;
    uint64_t lastFrame = 0;
  };
  struct Surroundings { // what the environment depends on
    Color clear;
    Fog fog;
    std::array<float, 3> ambient;
    bool linear;
    bool operator==(const Surroundings&) const = default;
  };
  struct Lamp {
    RTid shader = 0, id = 0;
    Light light;
    int kind = 0;
  };

  void useMaterials(const Frame& frame, const LightSet& lights);
  void setMaterial(Paint& paint, const Material& material, const LightSet& lights);
  void setOpenGlMaterial(const Material& material, const LightSet& lights);
  void setLinearMaterial(const Material& material);
  void useShapes(const Frame& frame);
  Shape& shapeOf(const Draw& draw);
  void place(Shape& shape, const Draw& draw, RTid shader);
  void forget();
  void useLights(const LightSet& lights);
  void useLamp(Lamp& lamp, const Light& light);
  void useEnvironment(const Frame& frame, const LightSet& lights);
  void useCamera(const Frame& frame);
  bool render(int samples);
  RTid classOf(const char* name, const char* library = nullptr);

  std::unordered_map<std::string, RTid> classes_;
  std::unordered_multimap<size_t, Shape> shapes_;
  std::vector<Paint> paints_;
  std::vector<size_t> paintOf_; // index of the paint of each draw of this frame
  std::array<Lamp, lightCount> lamps_;
  RTid ambientShader_ = 0, environment_ = 0;
  std::optional<std::array<float, 3>> ambient_;
  std::optional<Camera> camera_;
  RTid cameras_[2] = {0, 0};
  std::optional<Surroundings> surroundings_;
  int shownLight_ = -1;
  uint64_t frame_ = 0, renderedFrame_ = 0;
  Film film_;
};

} // namespace rtgl
