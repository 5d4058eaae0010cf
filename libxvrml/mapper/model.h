// model.h: what is shown of a world that does not say how it is to be looked at: which way is up,
// from where, in which light. Pure functions over the render graph; used by the mapper, on its
// thread. The rules are in docs/decisions/0040-models.md.
#pragma once

#include "mapper/graph/graph.h"
#include "mapper/views.h"
#include "xvrml/mapper.h"

namespace xvrml::mapper {

// Guesses the axis that points up from what the file and the shapes are.
UpGuess guessUp(const World& world, const Graph& graph, const Bounds& bounds);

// Returns whether the world brings no light and says nothing about a headlight: no light node, no
// bound NavigationInfo or ORTBackground, no shape with an ORTAppearance.
bool leavesLightOpen(const Graph& graph, const Bound& bound);

// The three lights of a model, in the coordinate system of the camera, as directions that they
// shine in.
struct Lamp {
  Vec3f direction;
  float intensity;
};
inline constexpr Lamp modelLamps[] = {
    {{0.5f, -0.65f, -0.6f}, 0.75f}, // over the viewer's left shoulder
    {{-0.8f, -0.1f, -0.6f}, 0.25f}, // from the right
    {{0, 0, -1}, 0.2f},             // from the eye: nothing that is seen is black
};

} // namespace xvrml::mapper
