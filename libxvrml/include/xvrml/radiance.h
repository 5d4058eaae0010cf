// radiance.h: pictures whose numbers are radiance and not colours of a screen: skies, lamps. [any
// thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "xvrml/limits.h"

namespace xvrml {

struct RadianceImage {
  int width = 0, height = 0;
  std::vector<float> rgb; // three numbers a pixel, linear, at least 0; rows from the bottom up
};

// Reads a Radiance picture (.hdr), a colour PFM or an OpenEXR picture; the content says which one
// it is. Of OpenEXR: one part of scan lines with the channels R, G, B or Y, stored as they are,
// run-length coded or deflated (NONE, RLE, ZIPS, ZIP). A pixel counts four times against
// limits.imagePixels. Throws std::runtime_error, whose text says what is wrong with the file.
RadianceImage readRadiance(const std::string& path, const Limits& limits = {});
RadianceImage decodeRadiance(const uint8_t* bytes, size_t size, const Limits& limits = {});

// Returns whether bytes begin as one of these formats does.
bool looksLikeRadiance(const uint8_t* bytes, size_t size);

} // namespace xvrml
