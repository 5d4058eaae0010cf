// presets.h: Fills arguments of World.render() from the presets that vv has, too
// (docs/presets.md). [GIL held]
#pragma once

#include <string>
#include <vector>

#include "render_request.h"

// Sets the arguments that the preset `given.preset` names and the caller has left as they are. Does
// nothing if it names none. Returns its rules for shaders, SELECTOR=Class:param=value. Raises
// ValueError for an unknown preset.
std::vector<std::string> applyPreset(RenderArguments& given);
