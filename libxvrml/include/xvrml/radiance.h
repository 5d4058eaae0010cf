// radiance.h: pictures that hold radiance instead of screen colours: skies, lamps. [any thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "xvrml/limits.h"

namespace xvrml {

struct RadianceImage {
  int width = 0, height = 0;
  std::vector<float> rgb; // three numbers per pixel, linear, at least 0; rows from the bottom up
};

// Reads a Radiance picture (.hdr), a colour PFM or an OpenEXR picture. The format is recognised by
// the content. OpenEXR files, of any compression and with lines or tiles, give the channels R, G, B
// or Y of their first part that has them. Another process decodes them, the program xvrml-decoder.
// A pixel counts four times against limits.imagePixels. Throws std::runtime_error with a text that
// says what is wrong with the file.
RadianceImage readRadiance(const std::string& path, const Limits& limits = {});
RadianceImage decodeRadiance(const uint8_t* bytes, size_t size, const Limits& limits = {});

// Returns whether the bytes begin like one of these formats.
bool looksLikeRadiance(const uint8_t* bytes, size_t size);

} // namespace xvrml
