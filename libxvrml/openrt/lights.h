// lights.h: light nodes and the headlight as OpenRT lights. Called by the mapper for every camera, on its thread.
#pragma once

#include <unordered_map>

#include "openrt/places.h"
#include "openrt/rt.h"

namespace xvrml::mapping {

class Lights {
 public:
  Lights(World& world, bool linearColor, ShaderClasses& classes) : world_(world), linear_(linearColor), classes_(classes) {}

  // Makes, moves or removes the lights of all places. Objects and instances of the places must be there: scopes name them.
  void follow(const Graph& graph, Places& places);
  // A directional light along the view that casts no shadows.
  void headlight(bool on, const CameraSettings& camera);
  void remove(Places& places); // all
  uint64_t count() const { return count_; }

 private:
  RTid shaderOf(Node& light);
  RTid makeShader(Node& light);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  RTid headlight_ = 0;
  uint64_t count_ = 0;
  std::unordered_map<const Node*, RTid> shaders_;
};

} // namespace xvrml::mapping
