// presets.h: Reads presets and the vv.toml beside a world, and merges their options with those of
// the command line. No other file includes toml++. readCommandLine() calls this once. [one thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// An option with its value, as written.
struct Setting {
  const OptionInfo* option;
  std::string value;
  std::string where;    // file, line and column; empty: the command line
  std::string folder;   // holds the file; empty: the command line, or a built-in preset
  bool builtIn = false; // rules that select nothing are no problem
};

// Returns the settings to apply, in order. Those of a preset or a vv.toml come first, and without
// those that `given` replaces: the same option, or another one for the same purpose. `world` is the
// path of the world. Throws UsageError or Failure (input) that names file, line and column.
std::vector<Setting> withPresets(std::vector<Setting> given, const std::string& world);

// Applies a setting of a preset. The files that it names must be inside its folder. Throws
// UsageError.
void applyConfined(const Setting& setting, Options& options);

} // namespace vv
