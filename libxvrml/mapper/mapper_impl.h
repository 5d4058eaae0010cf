// mapper_impl.h: the state of an OpenRTMapper. Shared by mapper.cpp (frames), update.cpp (changes)
// and explain.cpp.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "mapper/graph/objects.h"
#include "mapper/graph/places.h"
#include "mapper/shading/appearance.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/fogs.h"
#include "mapper/shading/lights.h"
#include "mapper/views.h"
#include "xvrml/mapper.h"

namespace xvrml {

struct OpenRTMapper::Impl {
  RTcontext context = rtGetCurrent();
  World& world;
  MapOptions options;
  mapper::Graph graph;
  mapper::Places places;
  mapper::ShaderClasses classes;
  mapper::Textures textures;
  mapper::CubeMaps cubes;
  mapper::Volumes volumes;
  mapper::CustomShaders custom;
  mapper::Surfaces surfaces;
  mapper::Objects objects;
  mapper::Lights lights;
  mapper::Fogs fogs;
  mapper::Environment environment;
  std::optional<mapper::Bound> given; // set by bind(); its places may be out of date
  mapper::Bound bound;
  CameraSettings camera; // camera of the last frame; the standard's default before the first frame
  uint64_t regroupings = 0;

  Impl(World& world, const MapOptions& options);
  ~Impl(); // removes everything from the context, if that is still current
  CameraSettings cameraAt(int32_t place) const;
  bool headlight() const;
  bool lightsModel();
  void useCamera(const CameraSettings& settings);
  void rebind();

  // Cached values; they are recomputed on request after their inputs have changed.
  const std::vector<ViewpointInfo>& viewpoints();
  const std::vector<int32_t>& viewpointPlaces();
  const Bounds& bounds();
  const BoundingSphere& sphere();
  const std::vector<Vector>& outermost();
  // Places the Billboards and LODs for a camera, and returns the outermost points in even
  // directions and in `more`.
  std::vector<Vector> outermostFor(const CameraSettings& camera,
                                   const std::optional<mapper::Outermost::Directions>& more);
  CameraSettings fit(const double view[16], double fovy, double aspect);
  bool facesAway(const double view[16]);
  bool followsCamera() const; // something is drawn as the camera says
  bool viewsStale = true, boundsStale = true, countsStale = false, namesStale = true;
  bool sphereStale = true, outermostStale = true, lightStale = true;
  bool farCameraTold = false;
  bool clearTold = false; // whether it was looked for worlds that are wholly transparent
  bool modelLight = false, background = true; // set by setModelLight() and setBackground()
  std::vector<std::string> names;             // shape names by number

  // Changes between frames: update.cpp.
  void update(const FieldChanges& changes);
  bool patient = false;          // set by setPatient()
  std::vector<NodeRef> awaiting; // nodes that have changed, and are planned later
  bool rootsAwait = false;       // the roots of the world are

 private:
  struct Work;
  void planChanged(Work& work);
  void transformChanged(Work& work, Node& node);
  void geometryChanged(Work& work, Node& node);
  void appearanceChanged(Work& work, Node& node);
  void switchChanged(Work& work, Node& node);
  void newSurfaces(Work& work);
  void textured(Work& work, mapper::ItemId shape);
  void regroup();

  std::vector<ViewpointInfo> viewpoints_;
  std::vector<int32_t> viewpointPlaces_;
  Bounds bounds_;
  BoundingSphere sphere_;
  std::vector<Vector> outermost_;
  // Answers of facesAway(), by the direction to the eye.
  std::map<std::array<double, 3>, bool> facing_;
  bool hasUnspecifiedLighting_ = false;
  size_t surfacesKept_ = 64;
};

} // namespace xvrml
