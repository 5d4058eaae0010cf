// model.h: defaults for a model that does not say how it is to be viewed: up axis, viewing
// direction and lights. Pure functions over the render graph, used by the mapper on its thread. The
// rules are in docs/decisions/0040-models.md.
#pragma once

#include "mapper/graph/graph.h"
#include "mapper/views.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

// Guesses the up axis from the file and the shapes.
UpGuess guessUp(const World& world, const Graph& graph, const Bounds& bounds);

// Returns whether the world specifies no lighting: no light node, no bound NavigationInfo or
// ORTBackground, no shape with an ORTAppearance.
bool hasUnspecifiedLighting(const Graph& graph, const Bound& bound);

// Returns the number of Shapes if all are wholly transparent by their materials, so that nothing
// can be seen; else 0.
size_t countIfAllClear(const Graph& graph);

// The three lights of a model, in camera coordinates. direction: where the light travels to.
struct Lamp {
  Vec3f direction;
  float intensity;
};
inline constexpr Lamp modelLamps[] = {
    {{0.5f, -0.65f, -0.6f}, 0.75f}, // over the viewer's left shoulder
    {{-0.8f, -0.1f, -0.6f}, 0.25f}, // from the right
    {{0, 0, -1}, 0.2f},             // from the camera, so that nothing visible is black
};

} // namespace xvrml::mapper
