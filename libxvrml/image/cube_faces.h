// cube_faces.h: pictures that show everything around a point: six faces of a cube, or one picture
// of the whole sphere. Called by the mapper. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "xvrml/radiance.h"

namespace xvrml {

// The faces as a Background names them: each is seen from inside. Those of the sides are upright;
// the upper edge of the top is towards +z, that of the bottom towards -z.
enum class CubeFace : uint8_t { front, back, left, right, top, bottom };
inline constexpr size_t cubeFaces = 6;

// One of the lists has pictures: six in the order of CubeFace, or one of all longitudes and
// latitudes with its middle along -z.
struct CubePictures {
  std::vector<Image> images;
  std::vector<RadianceImage> radiance;
};

// Decodes a DDS cube map or any other picture. The shape of a picture tells its layout: 4 by 3 and
// 3 by 4 square faces are a cross; others show the sphere. Throws std::runtime_error.
CubePictures decodeCube(std::span<const uint8_t> bytes, const ImageRoom& room);

// Does it for DDS files. looksLikeDds(): they begin like one.
CubePictures decodeDds(std::span<const uint8_t> bytes, const ImageRoom& room);
bool looksLikeDds(std::span<const uint8_t> bytes);

} // namespace xvrml
