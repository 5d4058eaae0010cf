// bare_model.h: Chooses how a model that does not say how it is shown looks: before a neutral
// backdrop, or in a studio (docs/decisions/0040-models.md). vv, its window, its pages and Python
// ask here, so that a model has one look everywhere. [any thread that owns the nodes]
#pragma once

#include <string>

#include "libpicture/renderer.h"
#include "xvrml/world.h"

namespace picture {

// The look of a world.
enum class Look : unsigned char {
  own,      // the world says something about it
  backdrop, // a model alone
  studio    // a model alone, of which a part shows what is around it
};

// Returns the look of the world as it is. shadersGiven: the user has given shapes shaders by rules
// (shader_rules.h). They are ORTAppearances, which say nothing about the look then.
Look lookOf(const xvrml::World& world, bool shadersGiven);

// Returns what changes in the look of a world that becomes a file of X3D or VRML97, for people;
// empty: nothing. A model of glTF with a camera or a shader is a world there, and has its own look.
std::string changeOfLook(const xvrml::World& world);

// Returns whether the first Viewpoint may be left out of a view that names no camera: that of a
// glTF file with a model alone. Modellers write the camera of their window into such files. A file
// with several cameras, or one that moves, shows what its author wanted to be seen.
bool mayLeaveCameraOut(const xvrml::World& world, const View& view);

// Returns whether the settings leave the look to the world: no background, environment or studio.
bool leavesLookOpen(const RenderSettings& settings);

// Sets background and studio of settings that leave them open, and for a studio a curve that keeps
// highlights, if the view is plain.
void choose(Look look, RenderSettings& settings);

} // namespace picture
