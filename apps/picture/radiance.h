// radiance.h: pictures of radiance, for light from all around: files that the user names on the command line. [any thread]
#pragma once

#include <string>
#include <vector>

namespace picture {

struct Radiance {
  int width = 0, height = 0;
  std::vector<float> rgb; // rows from the bottom up, as rtTexImage2D takes them
};

// By its suffix: exr, hdr (Radiance RGBE), pfm (colour). Throws std::runtime_error.
Radiance readRadiance(const std::string& path);

} // namespace picture
