// look.h: Gives a model that says nothing of how it is shown the look and the view of models: in
// pictures, in the window and on pages (docs/decisions/0040-models.md). [main thread]
#pragma once

#include <vector>

#include "options/options.h"
#include "xvrml/world.h"

namespace vv {

// Sets background and studio of the settings for such a model, where the options leave them open.
// Comparisons, readings, other channels and files that programs read keep the world as it is.
void chooseLook(const Options& options, const xvrml::World& world,
                picture::RenderSettings& settings);

// Lets the view leave out the camera of a model's file if it cuts off the model. A view that the
// options name stays as it is.
void chooseView(const Options& options, const xvrml::World& world, picture::View& view);

// Takes or leaves the camera of the file for good, and says, unless it must be quiet, that it is
// left out. viewpoints: those of the world.
void settleView(bool leavesOut, const std::vector<xvrml::ViewpointInfo>& viewpoints, bool quiet,
                picture::View& view);

} // namespace vv
