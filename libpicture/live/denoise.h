// denoise.h: The stages of a Reconstruction before and after Open Image Denoise, which takes the
// place of the à-trous filter: from planes to images and back. Each is a function of one row, as in
// stages.h. [any thread]
#pragma once

#include "libpicture/live/oidn.h"
#include "libpicture/live/stages.h"

namespace picture::live {

// Writes a row of the images: what was accumulated of the illumination, and the surfaces.
void imageRow(const Moment& now, const Reading& reading, int y, OidnImages& images);
// Reads a row of the result as illumination. Where there is no noise, the illumination stays as it
// was accumulated.
void lightRow(const Moment& now, const Reading& reading, const OidnImages& images, int y,
              Plane3& to);

} // namespace picture::live
