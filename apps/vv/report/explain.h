// explain.h: The report of --explain: the light transport of a world, what --compat changes, what
// its shapes are made of by the rules for shaders, and the objects it is rendered as. [main thread]
#pragma once

#include <string>
#include <vector>

#include "libpicture/renderer.h"
#include "options/options.h"
#include "xvrml/world.h"

namespace vv {

// Describes the light transport of a world and what it is rendered as (OpenRTMapper::explain).
// `stats` are those of any picture of the world.
std::string explainWorld(const Options& options, const xvrml::World& world, const RTstats& stats,
                         const std::vector<xvrml::ExplainedObject>& objects);

} // namespace vv
