// drawing.h: draws the differences of two pictures in standard errors (standardErrors). A pure
// function. [any thread]
#pragma once

#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

// Returns a picture of the differences. forScreens: grey where there is none, orange where the
// second picture has more light, blue where it has less, with the full colour from 6 standard
// errors on. If not, each colour of the result is that of the difference.
Picture drawErrors(const PictureFacts& size, const std::vector<float>& errors, bool forScreens);

} // namespace picture
