// shader_classes.h: Reads the classes of all installed shader plug-ins, with their parameters. The
// engine checks the plug-ins. [any thread; the current context stays]
#pragma once

#include <string>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

struct ShaderParameter {
  std::string name, text;
  RTenum type = RT_PARAM_FLOAT, frequency = RT_PER_SHADER;
  std::vector<float> value;       // the default; empty: the type has none
  float minimum = 0, maximum = 0; // limits for each number; -FLT_MAX, FLT_MAX: there are none
};

struct ShaderClass {
  std::string name, library, text;
  RTenum role = RT_SURFACE;
  std::vector<ShaderParameter> parameters;
};

// Returns the classes in the order of the folders and of the files in them. shaderPath: folders
// that are searched first. problems: receives a sentence for each plug-in that cannot be used.
// Throws std::runtime_error.
std::vector<ShaderClass> installedShaders(const std::string& shaderPath,
                                          std::vector<std::string>& problems);

} // namespace picture
