// picture_object.h: the C++ side of the Python class Picture.
#pragma once

#include <vector>

#include <pybind11/pybind11.h>

#include "libpicture/renderer.h"
#include "objects.h"

struct PictureObject {
  picture::Picture picture;
  pybind11::dict stats;
  std::vector<NodeObject> nodes; // by the numbers of channel id; of number 0: null
  pybind11::object nodeList;     // the same as a tuple, once somebody has asked for it
  double time = 0;               // of the world
  // Where it was taken from; fovy 0: by no pinhole. camera: as Pinhole, once somebody has asked for
  // it, or as it was given.
  xvrml::CameraSettings place{.matrix = {}, .fovy = 0};
  pybind11::object camera;
};

// The channels of these names (one or several) and RGBA, as bits. Raises TypeError or ValueError.
uint32_t channelsOf(const pybind11::object& list);
// What the argument progress asks for: a function of the fraction done, or None. Raises TypeError.
pybind11::object progressOf(const pybind11::object& given);

// Adds to Picture.stats how light was followed, what is left out and how large the picture's error
// is.
void describePicture(pybind11::dict& stats, const RTstats& s);
