// lights.h: light nodes and the headlight as OpenRT lights. Called by the mapper for every camera,
// on its thread.
#pragma once

#include <unordered_map>
#include <unordered_set>

#include "mapper/graph/places.h"
#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/custom_shaders.h"

namespace xvrml::mapper {

enum class CameraLight : uint8_t { none, head, model };

class Lights {
 public:
  Lights(World& world, bool linearColor, ShaderClasses& classes, CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), custom_(custom),
        quota_(world, "lights") {}

  // Makes, moves or removes the lights of all places. The places' objects and instances must exist,
  // because light scopes refer to them.
  void updateForFrame(const Graph& graph, Places& places);
  // The fields of a light node have changed.
  void changed(Node& light);
  // Removes the lights of places that are gone (remove) and the shaders of nodes without items
  // (forget).
  void remove(const std::vector<Place>& gone);
  void forget(const Graph& graph);
  void clear(Places& places); // removes everything
  // Sets the directional lights that move with the camera and cast no shadows: the headlight, or
  // the three lights of model.h.
  void atCamera(CameraLight light, const CameraSettings& camera);
  uint64_t count() const { return count_; }
  uint64_t changes() const { return changes_; }
  uint64_t parametersSet() const { return sets_; }

 private:
  void makeOrMove(Place& place, const Item& item);
  void scope(Place& place, const Item& item, const Places& places);
  // Removes a light. bytes: what it gives back to the world's budget (lights at the camera took
  // nothing).
  void removeLight(RTid& light, uint64_t bytes = bytesOfLight);
  RTid shaderOf(Node& light);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  CustomShaders& custom_;
  struct CameraAttachedLight {
    RTid light = 0, shader = 0;
  };
  void removeCameraLights();

  CameraLight atCamera_ = CameraLight::none;
  CameraAttachedLight headlight_, modelLights_[3];
  Matrix view_; // camera matrix of the lights at the camera
  Quota quota_;
  uint64_t count_ = 0, changes_ = 0, sets_ = 0;
  struct LightShader {
    RTid shader = 0;
    bool own = true; // false for the shader of an ORTShader
  };
  std::unordered_map<const Node*, LightShader> shaders_; // by node; only nodes that have items
  std::unordered_set<const Node*> remade_;               // ORTLights whose shader has been replaced
};

} // namespace xvrml::mapper
