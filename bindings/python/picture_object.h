// picture_object.h: Declares the C++ side of the Python class Picture.
#pragma once

#include <vector>

#include <pybind11/pybind11.h>

#include "libpicture/renderer.h"
#include "objects.h"

struct PictureObject {
  picture::Picture picture;
  pybind11::dict stats;
  std::vector<NodeObject> nodes; // indexed by the numbers of channel id; number 0 is null
  pybind11::object nodeList;     // the same as a tuple; created on first use
  double time = 0;               // time of the world
  // The camera's place; fovy 0: the camera was not a pinhole. `camera` is a Pinhole created on
  // first use, or the camera as the caller gave it.
  xvrml::CameraSettings place{.matrix = {}, .fovy = 0};
  pybind11::object camera;
};

// Returns the bits of the channels with these names (one or several), plus RGBA. Raises TypeError
// or ValueError.
uint32_t channelsOf(const pybind11::object& list);
// Checks the argument `progress`: a function of the fraction done, or None. Raises TypeError.
pybind11::object progressOf(const pybind11::object& given);

// Adds to Picture.stats the light transport, what it omits, and the size of the picture's error.
void describePicture(pybind11::dict& stats, const RTstats& s);
