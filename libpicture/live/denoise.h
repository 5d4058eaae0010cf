// denoise.h: The stages of a Reconstruction before and after Open Image Denoise: from planes to
// images and back. Each is a function of one row, as in
// stages.h. [any thread]
#pragma once

#include "libpicture/live/oidn.h"
#include "libpicture/live/stages.h"

namespace picture::live {

// Writes a row of the images: what was accumulated of the illumination, and the surfaces.
void imageRow(const Moment& now, const Reading& reading, int y, OidnImages& images);
// Reads a row of the result and writes its mean with `own`, what the à-trous filter has made of the
// same illumination. Where there is no noise, only that counts.
void lightRow(const Moment& now, const Reading& reading, const OidnImages& images, int y,
              const Plane3& own, Plane3& to);

} // namespace picture::live
