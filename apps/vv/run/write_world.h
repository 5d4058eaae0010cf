// write_world.h: Writes the world of --write: as VRML97 or X3D, or as an export. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// A world as text, and what looks different in it.
struct WorldText {
  std::string text;
  std::vector<std::string> changes;
};

// Returns a world as VRML97 or X3D. It should not have run: a Script that has run begins anew when
// the text is read, with what it has changed. Throws std::length_error.
WorldText textOf(const Options& options, const xvrml::World& world);
// Writes such a text, and says what changes. Throws std::runtime_error.
void writeWorld(const Options& options, const WorldText& world);
// Writes an export. It has the world at the time of --time, and says what its format has nothing
// for. Throws std::runtime_error.
void exportWorld(const Options& options, xvrml::Browser& browser);

} // namespace vv
