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
        ration_(world, "lights") {}

  // Makes, moves or removes the lights of all places. Objects and instances of the places must be
  // there: scopes name them.
  void follow(const Graph& graph, Places& places);
  // The fields of a light node have changed.
  void changed(Node& light);
  // Places that are no more, items that are no more.
  void remove(const std::vector<Place>& gone);
  void forget(const Graph& graph);
  void clear(Places& places); // takes everything away
  // Directional lights that go with the camera and cast no shadows: the headlight, or the three of
  // model.h.
  void atCamera(CameraLight light, const CameraSettings& camera);
  uint64_t count() const { return count_; }
  uint64_t changes() const { return changes_; }
  uint64_t parametersSet() const { return sets_; }

 private:
  void makeOrMove(Place& place, const Item& item);
  void scope(Place& place, const Places& places);
  // Removes a light; bytes: what of the world's budget it gives back (those at the camera took
  // nothing).
  void takeAway(RTid& light, uint64_t bytes = bytesOfLight);
  RTid shaderOf(Node& light);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  CustomShaders& custom_;
  struct AtCamera {
    RTid light = 0, shader = 0;
  };
  void takeFromCamera();

  CameraLight atCamera_ = CameraLight::none;
  AtCamera headlight_, modelLights_[3];
  Matrix view_; // of the lights at the camera
  Ration ration_;
  uint64_t count_ = 0, changes_ = 0, sets_ = 0;
  struct Known {
    RTid shader = 0;
    bool own = true; // not that of an ORTShader
  };
  std::unordered_map<const Node*, Known> shaders_; // of nodes that have items
  std::unordered_set<const Node*> remade_;         // ORTLights that have another shader than before
};

} // namespace xvrml::mapper
