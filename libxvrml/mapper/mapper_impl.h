// mapper_impl.h: what an OpenRTMapper is made of. Shared by mapper.cpp (frames), update.cpp
// (changes) and explain.cpp.
#pragma once

#include <optional>

#include "mapper/graph/objects.h"
#include "mapper/graph/places.h"
#include "mapper/shading/appearance.h"
#include "mapper/shading/custom_shaders.h"
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
  mapper::CustomShaders custom;
  mapper::Surfaces surfaces;
  mapper::Objects objects;
  mapper::Lights lights;
  mapper::Environment environment;
  std::optional<mapper::Bound> given; // by bind(); its places may be old
  mapper::Bound bound;
  CameraSettings camera; // of the last frame; before the first the standard's
  uint64_t regroupings = 0;

  Impl(World& world, const MapOptions& options);
  ~Impl(); // takes everything out of the context again, if that is still the current one
  CameraSettings cameraAt(int32_t place) const;
  bool headlight() const;
  bool lightsModel();
  void useCamera(const CameraSettings& settings);
  void rebind();

  // Made when asked for, after what they follow from has changed.
  const std::vector<ViewpointInfo>& viewpoints();
  const std::vector<int32_t>& viewpointPlaces();
  const Bounds& bounds();
  const BoundingSphere& sphere();
  bool viewsStale = true, boundsStale = true, countsStale = false, namesStale = true;
  bool sphereStale = true, lightStale = true;
  bool modelLight = false, background = true; // as setModelLight() and setBackground() say
  std::vector<std::string> names;             // of the shapes, by number

  // Between frames: update.cpp.
  void update(const FieldChanges& changes);

 private:
  struct Work;
  void transformed(Work& work, Node& node);
  void reshaped(Work& work, Node& node);
  void relooked(Work& work, Node& node);
  void relit(Work& work, Node& node);
  void newSurfaces(Work& work);
  void textured(Work& work, mapper::ItemId shape);
  void regroup();

  std::vector<ViewpointInfo> viewpoints_;
  std::vector<int32_t> viewpointPlaces_;
  Bounds bounds_;
  BoundingSphere sphere_;
  bool leavesLightOpen_ = false;
  size_t surfacesKept_ = 64;
};

} // namespace xvrml
