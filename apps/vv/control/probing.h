// probing.h: Says which pixel of which picture a probe needs, and what was read there. Pure
// functions. [any thread]
#pragma once

#include <string>

#include "control/command.h"
#include "libpicture/measure.h"
#include "session/still.h"

namespace vv::control {

// A picture of which one pixel is read.
struct Probing {
  Still still;
  int x = 0, y = 0; // the pixel, in the picture that is made
  std::string hit;  // what is seen there, as JSON
};

// settings: those of the pictures, with the size of the whole one. Only the pixel is made, where
// that gives what the whole picture would.
Probing probingAt(const Probe& probe, const picture::RenderSettings& settings);

// Returns the result as JSON.
std::string resultOf(const Probing& probing, const picture::Picture& picture);
// Returns the result of a probe of illuminance, a sensor with one point. hit: what is seen there.
std::string resultOf(const picture::Measurement& read, const std::string& hit);

} // namespace vv::control
