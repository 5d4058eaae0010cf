// outputs.h: before anything is rendered: can the files be written that are asked for, and does
// none of them take the place of a file that is read, or of another one? [main thread]
#pragma once

#include "options/options.h"
#include "xvrml/world.h"

namespace vv {

// Throws Failure if a file cannot be written, is named twice, or is one that the command line names
// to be read. Afterwards no file of vv replaces one of these.
void checkOutputs(const Options& options);

// The same for the files that a world is made of, as far as they are known: Inlines, textures,
// prototypes, scripts, sounds. Throws Failure.
void keepFilesOf(const xvrml::World& world, const Options& options);

// Before a file is replaced: the world may have read further files since it was loaded.
void keepFilesOf(const xvrml::World& world, const std::string& output);

} // namespace vv
