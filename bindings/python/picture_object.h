// picture_object.h: the C++ side of the Python class Picture.
#pragma once

#include <pybind11/pybind11.h>

#include "picture/renderer.h"

struct PictureObject {
  picture::Picture picture;
  pybind11::dict stats;
  double time = 0; // of the world
};

// Adds to Picture.stats how light was followed, what is left out and how large the picture's error is.
void describePicture(pybind11::dict& stats, const RTstats& s);
