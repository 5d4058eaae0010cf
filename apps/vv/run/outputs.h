// outputs.h: Checks, before anything is rendered, that the output files can be written and that
// none of them replaces an input file or another output. [main thread]
#pragma once

#include "options/options.h"
#include "xvrml/world.h"

namespace vv {

// Throws Failure if a file cannot be written, is named twice, or is also an input on the command
// line. After this call, vv refuses to replace the input files.
void checkOutputs(const Options& options);

// Warns if no output file keeps the transparency that --background none asks for.
void warnOfAlpha(const Options& options);

// Protects the files that a world consists of, as far as they are known: Inlines, textures,
// prototypes, scripts, sounds. Throws Failure.
void protectFilesOf(const xvrml::World& world, const Options& options);

// Protects them again before `output` is replaced: the world may have read more files since it was
// loaded.
void protectFilesOf(const xvrml::World& world, const std::string& output);

} // namespace vv
