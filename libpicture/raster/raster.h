// raster.h: Draws a world by a z-buffer, in the style of the OpenGL renderers of VRML browsers: for
// a first view of worlds that rays need long for. There is one sample a pixel. Lamps cast no
// shadows; nothing is reflected or refracted. docs/decisions/0088-fast-view.md says what is simpler
// than in pictures by rays. [the thread that owns the world]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "xvrml/mapper.h"

namespace picture {

struct RasterView {
  xvrml::CameraSettings camera; // its shader is not used
  // Replaces the matrix of the camera: a matrix from camera to world that may shear.
  const double* toWorld = nullptr;
  int width = 0, height = 0;
  bool linear = true; // decodes sRGB colours and adds light linearly
  xvrml::MapOptions::Headlight headlight = xvrml::MapOptions::Headlight::automatic;
  // The bound nodes of a running world; none: the first of each kind in the file.
  std::optional<xvrml::BoundNodes> bound;
  bool showsBackground = true; // false: pixels without a shape stay transparent
  std::string shaderPath;      // folders, separated by colons
  int threads = 0;             // 0: as many as the process may use
};

// Files of such a picture say this.
inline constexpr const char* rasterNote =
    "fast view: a z-buffer picture without shadows, reflections and refractions";

// Returns the plane rgba, premultiplied, first row at the top. The world must not change meanwhile.
// Throws std::length_error for a world with more places than xvrml::RenderOptions::maximumVisits.
std::vector<float> rasterize(const xvrml::World& world, const RasterView& view);

} // namespace picture
