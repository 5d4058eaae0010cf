// origins.h: keeps the points and places of a model small, because glTF and scenes hold them in
// single precision. [one thread]
#pragma once

#include <gp_XYZ.hxx>

#include "model.h"

namespace xvrml::decoding {

// Returns where the origin of what a box holds should be: near its middle, in numbers that single
// precision has, if the box is many times its size away from the origin; otherwise the origin.
gp_XYZ originFor(const gp_XYZ& least, const gp_XYZ& most);

// Describes where a model is, in metres.
struct Extent {
  double away = 0; // the largest coordinate
  double size = 0; // the diagonal of its box
};
// Moves the origin of each assembly whose parts are far away from it, as originFor() does. The node
// above takes what was moved, and at last a new node above all. So parts keep their places to each
// other, and only the place of the whole is a large number.
Extent moveOrigins(Model& model);

} // namespace xvrml::decoding
