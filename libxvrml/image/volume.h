// volume.h: volumes of pixels, for textures in space (ISO/IEC 19775-1 clause 33). Called by the
// mapper. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"

namespace xvrml {

// Slices of equal size, from r = 0 on. Each has rows from the bottom up, of `components` bytes a
// pixel.
struct Volume {
  int width = 0, height = 0, depth = 0, components = 0;
  std::vector<uint8_t> pixels;
};

// These functions throw std::runtime_error with the reason if there is no such volume, or if it is
// too large for the room.

// Decodes a file: NRRD, DDS, or any picture, which is one slice.
Volume decodeVolume(std::span<const uint8_t> bytes, const ImageRoom& room);
// Decodes NRRD files (teem.sourceforge.net/nrrd/format.html) with three axes, or with four whose
// first one is the components. Numbers are raw, packed by gzip, or text. Bytes without sign are
// colours; other numbers are scaled so that the smallest is black and the largest white.
Volume decodeNrrd(std::span<const uint8_t> bytes, const ImageRoom& room);
bool looksLikeNrrd(std::span<const uint8_t> bytes);
// Decodes a DDS file that is a volume, or a picture of one slice.
Volume decodeDdsVolume(std::span<const uint8_t> bytes, const ImageRoom& room);

// Returns the volume of PixelTexture3D.image: components, width, height, depth, then one number for
// each pixel, as in SFImage. It is empty if the list is too short for a size, or if a size is 0.
Volume volumeOf(std::span<const int32_t> image, const ImageRoom& room);
// Stacks pictures of one size. They get the components of the richest.
Volume stacked(std::span<const Image> slices, const ImageRoom& room);

// Throws if a side is 0 or above maximumImageSide, if there are more pixels than
// limits.imagePixels, or if `components` bytes a pixel plus `working` bytes exceed the room.
void checkVolumeSize(const uint64_t (&sides)[3], uint64_t components, uint64_t working,
                     const ImageRoom& room, const char* format);

} // namespace xvrml
