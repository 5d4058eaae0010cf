// views.h: bindable nodes: viewpoints and cameras, background, fog, navigation. Used by the mapper,
// on its thread.
#pragma once

#include <vector>

#include "mapper/graph/places.h"
#include "mapper/rt.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/textures.h"
#include "xvrml/mapper.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

// The nodes that are bound, and the first place of each: `none` where nothing is bound or the node
// is not drawn at present.
struct Bound {
  NodeRef viewpoint, background, fog, navigationInfo;
  int32_t viewpointPlace = none, backgroundPlace = none, fogPlace = none;
};
// Of each kind the first in the file, not counting Inlines (clause 4.6.10).
Bound firstBound(const Graph& graph, const Places& places);
Bound boundTo(const Graph& graph, const Places& places, const BoundNodes& nodes);

// All viewpoints in the order of the file; place: of each, in Places::all.
std::vector<ViewpointInfo> listViewpoints(const Graph& graph, const Places& places,
                                          std::vector<int32_t>& place);

// The camera of a Viewpoint node whose parent stands under a matrix; of the standard's default for
// null.
CameraSettings cameraOf(const Node* viewpoint, const Matrix& parent, double aspect);
// False only if the bound NavigationInfo says so (clause 6.29: the default has a headlight).
bool hasHeadlight(const Bound& bound);

// Background and Fog as the scene's environment: one shader of the class VRML97Environment
// (clauses 6.5 and 6.19), or that of an ORTBackground.
class Environment {
 public:
  Environment(World& world, bool linearColor, ShaderClasses& classes, Textures& textures,
              CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures),
        custom_(custom) {}
  // The fields of a node that may be bound have changed.
  void changed(const Node& node) { stale_ |= &node == background_.get() || &node == fog_.get(); }
  // Sets what is another than before. The places' world matrices must be those of the frame.
  void follow(const Places& places, const Bound& bound);
  void clear(); // removes it
  uint64_t parametersSet() const { return sets_; }

 private:
  void setAll(ShaderSetup& shader, const RTid (&pictures)[6]);
  void setBackground(ShaderSetup& shader, const nodes::Background& node, const RTid (&pictures)[6]);
  void setFog(ShaderSetup& shader);
  void useCustom(nodes::ORTBackground& node);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Textures& textures_;
  CustomShaders& custom_;
  NodeRef background_, fog_;
  Matrix matrix_, fogMatrix_;  // of the environment; of the fog's coordinate system
  RTid shader_ = 0, used_ = 0; // our own; the one that the scene has
  bool stale_ = false;
  uint64_t sets_ = 0;
};

} // namespace xvrml::mapper
