// views.h: bindable nodes as bound at time 0: viewpoints and cameras, background, fog, navigation. Used by the mapper.
#pragma once

#include <vector>

#include "openrt/places.h"
#include "openrt/rt.h"
#include "openrt/textures.h"
#include "xvrml/openrt.h"

namespace xvrml::mapping {

// Places of the bindables that are bound first: of each kind the first in the file, not counting Inlines (clause 4.6.10);
// `none` where there is none.
struct Bound {
  int32_t viewpoint = none, background = none, fog = none, navigationInfo = none;
};
Bound firstBound(const Graph& graph, const Places& places);
Bound placesOf(const Graph& graph, const Places& places, const BoundNodes& nodes);

// All viewpoints in the order of the file; place: of each, in Places::all.
std::vector<ViewpointInfo> listViewpoints(const Graph& graph, const Places& places, std::vector<int32_t>& place);

// The camera of a Viewpoint node whose parent stands under a matrix; of the standard's default for null.
CameraSettings cameraOf(const Node* viewpoint, const Matrix& parent, double aspect);
// A camera that looks along the view's -z from where all of bounds is in the picture.
CameraSettings cameraAround(const Bounds& bounds, const Matrix& view, double fovy, double aspect);
// False only if the bound NavigationInfo says so (clause 6.29: the default has a headlight).
bool hasHeadlight(const Graph& graph, const Places& places, const Bound& bound);

// Background and Fog as the scene's environment: one shader of the class VRML97Environment. matrices: the places' world.
void useEnvironment(World& world, bool linearColor, const Graph& graph, const Places& places, const Bound& bound,
                    ShaderClasses& classes, Textures& textures);

} // namespace xvrml::mapping
