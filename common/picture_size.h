// picture_size.h: How large pictures and textures may be. [any thread]
#pragma once

#include <cstdint>

constexpr int64_t largestSide = 65536, mostPixels = int64_t(1) << 28;

constexpr bool isPictureSize(int64_t width, int64_t height) {
  return width >= 1 && height >= 1 && width <= largestSide && height <= largestSide &&
         width * height <= mostPixels;
}

// Returns whether a texture of so many slices of this size is allowed.
constexpr bool isVolumeSize(int64_t width, int64_t height, int64_t depth) {
  return isPictureSize(width, height) && depth >= 1 && depth <= largestSide &&
         width * height <= mostPixels / depth;
}
