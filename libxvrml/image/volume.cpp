// volume.cpp: makes volumes of files, of lists of numbers and of pictures.
#include "image/volume.h"

#include <fmt/format.h>

#include <algorithm>

#include "image/cube_faces.h"
#include "image/decoders.h"

namespace xvrml {
namespace {

// Appends the pixels of a picture with more components, if it has fewer.
void append(const Image& slice, int components, std::vector<uint8_t>& pixels) {
  const int own = slice.components;
  const bool grey = own <= 2, alpha = own % 2 == 0;
  for (size_t at = 0; at < slice.pixels.size(); at += size_t(own)) {
    const uint8_t* from = &slice.pixels[at];
    const int colors = components >= 3 ? 3 : 1;
    for (int c = 0; c < colors; ++c) pixels.push_back(from[grey ? 0 : c]);
    if (components % 2 == 0) pixels.push_back(alpha ? from[own - 1] : uint8_t(255));
  }
}

} // namespace

void checkVolumeSize(const uint64_t (&sides)[3], uint64_t components, uint64_t working,
                     const ImageRoom& room, const char* format) {
  const auto [width, height, depth] = sides;
  if (depth == 0) throw std::runtime_error(fmt::format("{} without slices", format));
  if (depth > maximumImageSide)
    throw std::runtime_error(
        fmt::format("{} has {} slices, at most {} are read", format, depth, maximumImageSide));
  checkImageSize(width, height, room.limits, format);
  // The product is below 2^48.
  if (width * height * depth > room.limits.imagePixels)
    throw std::runtime_error(
        fmt::format("{} of {} x {} x {} pixels is beyond the limit 'imagePixels' ({})", format,
                    width, height, depth, room.limits.imagePixels));
  const uint64_t bytes = width * height * depth * components;
  if (bytes > room.bytes)
    throw std::runtime_error(
        fmt::format("{} takes {} bytes: all pictures of a world together take at most 4 bytes for "
                    "each pixel of the limit 'imagePixels' ({})",
                    format, bytes, room.limits.imagePixels));
  if (room.budget && bytes + working > room.budget->left())
    throw std::runtime_error(
        fmt::format("{} takes {} bytes: together with the rest of the world, more than {}", format,
                    bytes + working, room.budget->name()));
}

Volume decodeVolume(std::span<const uint8_t> bytes, const ImageRoom& room) {
  if (looksLikeNrrd(bytes)) return decodeNrrd(bytes, room);
  if (looksLikeDds(bytes)) return decodeDdsVolume(bytes, room);
  if (mediaTypeOf(bytes).empty())
    throw std::runtime_error("not an NRRD or DDS file, nor a picture of a known format");
  Image slice = decodeImage(bytes.data(), bytes.size(), room);
  return {slice.width, slice.height, 1, slice.components, std::move(slice.pixels)};
}

Volume volumeOf(std::span<const int32_t> image, const ImageRoom& room) {
  if (image.size() < 4) return {};
  const int components = image[0];
  const std::span<const int32_t> sides = image.subspan(1, 3), pixels = image.subspan(4);
  if (std::any_of(image.begin(), image.begin() + 4, [](int32_t n) { return n < 0; }) ||
      components > 4)
    throw std::runtime_error(
        fmt::format("image begins with {} {} {} {}, expected 0 to 4 components and three sizes",
                    image[0], image[1], image[2], image[3]));
  if (components == 0 || std::find(sides.begin(), sides.end(), 0) != sides.end()) return {};
  checkVolumeSize({uint64_t(sides[0]), uint64_t(sides[1]), uint64_t(sides[2])},
                  uint64_t(components), 0, room, "image");
  const uint64_t count = uint64_t(sides[0]) * uint64_t(sides[1]) * uint64_t(sides[2]);
  if (pixels.size() < count)
    throw std::runtime_error(fmt::format("image has {} pixels, expected {} x {} x {} = {}",
                                         pixels.size(), sides[0], sides[1], sides[2], count));
  Volume volume{sides[0], sides[1], sides[2], components, {}};
  volume.pixels.reserve(size_t(count) * size_t(components));
  for (const int32_t pixel : pixels.first(size_t(count)))
    for (int c = components; c-- > 0;) volume.pixels.push_back(uint8_t(uint32_t(pixel) >> (8 * c)));
  return volume;
}

Volume stacked(std::span<const Image> slices, const ImageRoom& room) {
  if (slices.empty()) return {};
  const Image& first = slices[0];
  bool color = false, alpha = false;
  for (size_t i = 0; i < slices.size(); ++i) {
    const Image& slice = slices[i];
    if (slice.width != first.width || slice.height != first.height)
      throw std::runtime_error(fmt::format("texture {} has {} x {} pixels, expected {} x {} as the "
                                           "first one",
                                           i, slice.width, slice.height, first.width,
                                           first.height));
    color |= slice.components >= 3;
    alpha |= slice.components % 2 == 0;
  }
  const int components = (color ? 3 : 1) + (alpha ? 1 : 0);
  checkVolumeSize({uint64_t(first.width), uint64_t(first.height), slices.size()},
                  uint64_t(components), 0, room, "volume");
  Volume volume{first.width, first.height, int(slices.size()), components, {}};
  for (const Image& slice : slices) append(slice, components, volume.pixels);
  return volume;
}

} // namespace xvrml
