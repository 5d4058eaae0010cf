// views.h: bindable nodes: viewpoints and cameras, background, fog, navigation. [the mapper's
// thread]
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapper/graph/places.h"
#include "mapper/outermost.h"
#include "mapper/rt.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/textures.h"
#include "xvrml/mapper.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

// The bound nodes and the first place of each. A place is `none` if nothing is bound or the node is
// not drawn at present.
struct Bound {
  NodeRef viewpoint, background, fog, navigationInfo;
  int32_t viewpointPlace = none, backgroundPlace = none, fogPlace = none;
};
// Binds the first node of each kind in the file, ignoring Inlines (clause 4.6.10).
Bound firstBound(const Graph& graph, const Places& places);
Bound boundTo(const Graph& graph, const Places& places, const BoundNodes& nodes);

// Returns all viewpoints in file order. place: receives the index of each into Places::all.
std::vector<ViewpointInfo> listViewpoints(const Graph& graph, const Places& places,
                                          std::vector<int32_t>& place);

// Returns the sensors at all places, in file order. Warns of those in a group with a
// DirectionalLight, which does not reach them.
std::vector<SensorInfo> listSensors(const Graph& graph, const Places& places,
                                    Diagnostics& diagnostics);
// Returns the ORTLights that are on at all places, in file order.
std::vector<SensorInfo> listLamps(const Graph& graph, const Places& places);

// Returns the camera of a Viewpoint; for null that of the standard's default Viewpoint. parent:
// world matrix of what stands in the node: that of its parent, or its place on a globe.
CameraSettings cameraOf(const Node* viewpoint, const Matrix& parent, double aspect);
// Returns the directions, across the lines of sight, in which a world's outermost points make such
// a camera exact: cameraAround() sees all of the world if it has these points. Returns nullopt if
// its margin makes good for the error of even directions, which it does in pictures of up to 90
// degrees.
std::optional<Outermost::Directions> directionsAcross(const double view[16], double fovy,
                                                      double aspect);
// Returns a camera that looks along the view's -z and has all of these points in the picture.
CameraSettings cameraAround(std::span<const Vector> points, const double view[16], double fovy,
                            double aspect);
// Returns whether a camera sees all of these points.
bool seesAll(std::span<const Vector> points, const CameraSettings& camera, double aspect);
// Returns false only if a bound NavigationInfo turns the headlight off (clause 6.29: the default is
// on).
bool hasHeadlight(const Bound& bound);

// Sets Background, TextureBackground, EnvironmentLight, and Fog or the LocalFog of the top level,
// as the scene's environment: one shader of the class VRML97Environment, or the shader of an
// ORTBackground.
class Environment {
 public:
  Environment(World& world, bool linearColor, ShaderClasses& classes, Textures& textures,
              CubeMaps& cubes, CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures), cubes_(cubes),
        custom_(custom) {}
  // Notes that fields of the node have changed. It has no effect unless the node is bound.
  void changed(const Node& node) {
    stale_ |= &node == background_.get() || &node == fog_.get() || &node == light_.get();
  }
  // Updates the environment if anything has changed. The places' world matrices must be those of
  // the frame.
  void updateForFrame(const Graph& graph, const Places& places, const Bound& bound);
  void clear(); // removes the environment
  uint64_t parametersSet() const { return sets_; }

 private:
  using Faces = RTid[cubeFaces]; // in the order of CubeFace
  void setAll(ShaderSetup& shader, const Faces& pictures, const CubeMap& light);
  template <class Sky>
  void setBackground(ShaderSetup& shader, const Sky& node, const Faces& pictures);
  void setLight(ShaderSetup& shader, const CubeMap& light);
  void picturesOfBackground(Faces& pictures);
  CubeMap picturesOfLight();
  int32_t findLight(const Graph& graph, const Places& places);
  void useCustom(nodes::ORTBackground& node);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Textures& textures_;
  CubeMaps& cubes_;
  CustomShaders& custom_;
  NodeRef background_, fog_, light_;
  // Matrices of the environment and of the coordinate systems of the fog and the light.
  Matrix matrix_, fogMatrix_, lightMatrix_;
  bool reportedLights_ = false;
  RTid shader_ = 0, used_ = 0; // our own shader; the shader that the scene uses
  bool stale_ = false;
  uint64_t sets_ = 0;
};

} // namespace xvrml::mapper
