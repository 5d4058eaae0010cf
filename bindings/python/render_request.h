// render_request.h: Turns the arguments of World.render() into the settings and the view of a
// picture. A table in render_request.cpp says how each argument is checked. [GIL held]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "libpicture/renderer.h"

namespace py = pybind11;

// The arguments; render.cpp has Python's signature. The values are the defaults.
struct RenderArguments {
  py::object size = py::make_tuple(800, 600);
  std::optional<long long> spp;
  py::object viewpoint = py::none();
  py::object camera = py::none();
  bool fit = false;
  std::optional<double> fov, ortho;
  long long threads = 0;
  std::string colour = "linear";
  py::object headlight = py::str("auto");
  py::object channels = py::none();
  py::object cluster = py::none();
  py::object progress = py::none();
  bool multiplyTextures = false, exactShapes = false, raster = false;
  double pointSize = 0, lineWidth = 0;
  std::optional<std::string> up;
  py::object background = py::none();
  std::string isa = "auto";
  py::object exposure = py::float_(0.0);
  std::string view = "standard";
  py::object crop = py::none();
  py::object studio = py::none(); // a colour, or False: neither a studio nor the look of models
  std::optional<std::string> from, preset, sky;
  std::optional<std::string> studioColour; // set by the preset; no parameter of Python
  picture::QualityValues quality; // parameters that are quality settings (quality_parameters.h)
};

// The picture that the arguments ask for, except viewpoint, cluster and progress.
struct RenderRequest {
  picture::RenderSettings settings;
  picture::View view;
  uint32_t channels = 0; // the channels of the Picture; the settings may have more
  // How the Picture is shown; fitExposure: with an exposure that fits it instead of this one.
  // The settings do not have it, so that the scene is kept between pictures.
  picture::ViewTransform shown;
  bool fitExposure = false;
  // The arguments leave the look to the world (libpicture/bare_model.h).
  bool isLookOpen = false;
};

// Returns the instruction set. Raises ValueError if this machine does not have it.
std::string checkedIsa(const std::string& isa);

// Returns a number of stops; nothing for 'auto'. Raises ValueError.
std::optional<double> exposureOf(const py::object& given);
// Returns the curve with this name. Raises ValueError.
picture::ViewCurve curveOf(const std::string& name);

// Raises TypeError, ValueError or IndexError for the first argument that is wrong.
RenderRequest requestOf(const RenderArguments& given);

// Returns the index of the viewpoint with this name, description or number. Raises TypeError,
// KeyError or IndexError.
size_t viewpointIndex(const std::vector<xvrml::ViewpointInfo>& list, const py::object& wanted);
