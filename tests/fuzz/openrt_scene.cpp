// openrt_scene.cpp: renders scenes of hostile recordings and messages of the cluster: commits with
// any numbers in surfaces, matrices, cameras and frame settings. What the validator accepts must
// render, and answer ray queries, without a fault. The input is a sequence of choices and numbers.
// libFuzzer calls this on one thread.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "backend/backend.h"
#include "backend/queries.h"
#include "backend/record/validator.h"
#include "fuzz_input.h"
#include "scene/channels.h"
#include "scene/transports.h"
#include "shading/registry.h"

namespace {

using namespace openrt;

constexpr uint32_t width = 4, height = 3;
// Surfaces first, then lights, then cameras, then an environment.
constexpr const char* classNames[] = {"VRML97",
                                      "GlobalIllumination",
                                      "Glass",
                                      "RoughGlass",
                                      "Fog",
                                      "Diffuse",
                                      "VRML97PointLight",
                                      "VRML97SpotLight",
                                      "PerspectiveCamera",
                                      "OrthographicCamera",
                                      "VRML97Environment"};
constexpr uint32_t surfaces = 6, lights = 2, cameras = 2;
constexpr uint32_t firstClass = 1, firstShader = 21, firstObject = 41, firstInstance = 51,
                   firstLight = 61;
constexpr uint32_t sky = firstShader + surfaces + lights + cameras;

const ShaderRegistry& shaders() {
  static const auto* const known = new ShaderRegistry(shaderFolders(""));
  return *known;
}

// Makes commits and renders them with a backend of their own.
class Game {
 public:
  explicit Game(std::span<const std::byte> bytes) : in_(bytes) {}

  void play() {
    begin();
    for (int i = 0; i < 4 && !in_.empty(); i++) {
      for (size_t n = in_.below(6); n > 0; n--) change();
      if (!show()) return;
      ask();
    }
  }

 private:
  template <class Edit> void add(Edit&& edit) {
    commit_->edits.edits.emplace_back(new edit::EditT)->any.Set(std::forward<Edit>(edit));
  }

  double number() {
    const uint8_t b = in_.byte();
    if (b < 210) return (int(b % 41) - 20) * 0.1;
    return b < 240 ? std::pow(10.0, 2.5 * (b - 225)) : in_.real();
  }

  // Returns the number of values to choose from: seldom one more than is allowed.
  size_t allowed(size_t count) { return count + (in_.byte() > 250); }

  // Returns a length, seldom a number that is none.
  double length() {
    const double any = number();
    return in_.byte() > 250 ? any : std::clamp(std::fabs(any), 1e-3, 1e3);
  }

  std::unique_ptr<edit::Matrix> matrix() {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (size_t n = in_.below(4); n > 0; n--) {
      const size_t column = in_.below(4);
      m[4 * column + in_.below(3)] = in_.byte() > 30 ? std::clamp(number(), -1e3, 1e3) : number();
    }
    return std::make_unique<edit::Matrix>(m);
  }

  template <class T> ArrayId array(const std::vector<T>& values) {
    const auto made = std::make_shared<Array>(values.size() * sizeof(T));
    std::memcpy(made->data(), values.data(), made->size());
    commit_->arrays[++lastArray_] = made;
    return lastArray_;
  }

  void begin() {
    for (uint32_t i = 0; i < std::size(classNames); i++) {
      edit::ShaderClassT shaderClass;
      shaderClass.id = firstClass + i;
      shaderClass.name = classNames[i];
      add(std::move(shaderClass));
      edit::ShaderT shader;
      shader.id = firstShader + i;
      shader.shaderClass = firstClass + i;
      add(std::move(shader));
    }
    frame();
    camera();
    object();
    instance();
    light();
  }

  void change() {
    switch (in_.below(7)) {
    case 0: return frame();
    case 1: return camera();
    case 2: return light();
    case 3: return parameter();
    case 4: return object();
    default: return instance();
    }
  }

  void frame() {
    edit::FrameSettingsT frame;
    frame.width = width;
    frame.height = height;
    frame.channels = (in_.raw<uint32_t>() & allChannels) | RT_RGBA;
    frame.samples = uint32_t(1 + in_.below(20));
    frame.depth = uint32_t(in_.below(6));
    frame.seed = in_.byte();
    frame.shadows = in_.flip();
    frame.transport = uint8_t(in_.below(allowed(std::size(transports))));
    frame.replicates = uint32_t(in_.below(4));
    if (in_.byte() > 230) frame.clamp = float(number());
    frame.progressive = in_.flip();
    frame.followImages = in_.flip();
    frame.jitter = in_.flip();
    frame.lightStride = uint8_t(1 + in_.below(allowed(4)));
    frame.view = uint32_t(in_.below(3));
    frame.measure = uint8_t(in_.below(allowed(3)));
    add(std::move(frame));
  }

  void camera() {
    edit::CameraT camera;
    camera.shader = firstShader + surfaces + lights + uint32_t(in_.below(cameras));
    camera.matrix = matrix();
    if (in_.flip()) {
      auto m = std::array<double, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1};
      camera.matrix = std::make_unique<edit::Matrix>(m);
    }
    add(std::move(camera));
  }

  void light() {
    edit::LightT light;
    light.id = firstLight + uint32_t(in_.below(2));
    light.shader = firstShader + surfaces + uint32_t(in_.below(lights));
    light.matrix = matrix();
    add(std::move(light));
  }

  void parameter() {
    edit::ParameterT parameter;
    const auto which = uint32_t(in_.below(std::size(classNames)));
    const RtsClass& known = shaders().find(classNames[which], "");
    parameter.shader = firstShader + which;
    parameter.index = uint32_t(in_.below(known.paramCount + 1));
    const bool exists = parameter.index < known.paramCount;
    const bool whole = exists && known.params[parameter.index].type == RTS_INT;
    for (size_t n = exists && !whole ? 1 + in_.below(4) : 0; n > 0; n--)
      parameter.floats.push_back(float(number()));
    parameter.integer = int(in_.number());
    add(std::move(parameter));
  }

  std::unique_ptr<edit::GeometryT> geometry() {
    auto made = std::make_unique<edit::GeometryT>();
    made->primitive = edit::Primitive(in_.below(6));
    made->shader = in_.flip() ? firstShader + uint32_t(in_.below(surfaces)) : 0;
    made->matrix = matrix();
    made->cull = in_.flip();
    made->clockwise = in_.flip();
    made->width = float(length());
    const auto numbers = [this](size_t n) {
      std::vector<double> all(n);
      for (double& one : all) one = number();
      return all;
    };
    switch (made->primitive) {
    case edit::Primitive::Sphere: break;
    case edit::Primitive::Quadric:
      made->surface = numbers(13);
      for (size_t k = 0; k < 3; k++) made->surface.push_back(made->surface[10 + k] + length());
      break;
    case edit::Primitive::Asphere:
      made->surface = numbers(4 + in_.below(9));
      made->surface[3] = length();
      made->surface[2] = in_.flip() ? 0 : made->surface[3] / 2;
      break;
    default: {
      const size_t points = 3 + in_.below(6), corners = 6;
      const std::vector<double> all = numbers(3 * points);
      made->points = array(std::vector<float>(all.begin(), all.end()));
      std::vector<uint32_t> indices;
      for (size_t i = 0; i < corners; i++) indices.push_back(uint32_t(in_.below(points)));
      made->indices = array(indices);
    }
    }
    return made;
  }

  void object() {
    edit::ObjectT object;
    object.id = firstObject + uint32_t(in_.below(2));
    object.dynamic = in_.flip();
    for (size_t n = 1 + in_.below(2); n > 0; n--) object.geometries.push_back(geometry());
    known_[object.id - firstObject] = true;
    add(std::move(object));
  }

  void instance() {
    const auto which = uint32_t(in_.below(2));
    if (!known_[which]) return;
    edit::InstanceT instance;
    instance.id = firstInstance + 2 * which + uint32_t(in_.flip());
    instance.object = firstObject + which;
    instance.matrix = matrix();
    instance.visible = in_.byte() > 10;
    instance.dynamic = instance.id & 1;
    if (in_.byte() > 200) instance.fog = sky;
    add(std::move(instance));
  }

  // Renders the frame. Returns false if the validator refuses the commit.
  bool show() {
    commit_->edits.render = true;
    const std::shared_ptr<const Commit> commit = std::exchange(commit_, std::make_shared<Commit>());
    try {
      validator_.check(*commit);
    } catch (const std::runtime_error&) { return false; }
    backend_->apply(commit);
    backend_->start();
    backend_->wait();
    std::array<float, size_t(width) * height * 4> rgba;
    if (!backend_->read(RT_RGBA, rgba)) __builtin_trap();
    return true;
  }

  void ask() {
    Queries* const queries = backend_->queries();
    if (!queries || in_.empty()) return;
    RTrayd rayInDouble{};
    RTray ray{};
    for (size_t k = 0; k < 3; k++) {
      rayInDouble.origin[k] = number();
      rayInDouble.direction[k] = number();
      ray.origin[k] = float(rayInDouble.origin[k]);
      ray.direction[k] = float(rayInDouble.direction[k]);
    }
    rayInDouble.tfar = number();
    ray.tfar = float(rayInDouble.tfar);
    RThit hit{};
    RThitd hitDouble{};
    uint8_t occluded = 0;
    uint32_t count = 0;
    queries->castRays({&ray, 1}, {&hit, 1});
    queries->occludedRays({&ray, 1}, {&occluded, 1});
    queries->countHits({&ray, 1}, {&count, 1});
    queries->castDouble({&rayInDouble, 1}, {&hitDouble, 1});
    queries->occludeDouble({&rayInDouble, 1}, {&occluded, 1});
    queries->countDouble({&rayInDouble, 1}, {&count, 1});
    // As rtPick allows.
    const auto place = [this] { return std::clamp(length() - 10, -1e9, 1e9); };
    const double x = place();
    if (const double y = place(); std::isfinite(x + y)) queries->pick(x, y, hit);
  }

  static BackendOptions options() {
    BackendOptions made;
    made.threads = 1;
    made.shaders = &shaders();
    return made;
  }

  FuzzInput in_;
  CommitValidator validator_{&shaders()};
  std::unique_ptr<Backend> backend_ = makeLocalBackend(options());
  std::shared_ptr<Commit> commit_ = std::make_shared<Commit>();
  ArrayId lastArray_ = 0;
  bool known_[2] = {};
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size > 4096) return -1;
  Game(std::as_bytes(std::span(data, size))).play();
  return 0;
}
