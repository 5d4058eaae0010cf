// texture.h: one image that shaders sample. Created after a commit and immutable afterwards. Render
// threads call sample() for batches.
#pragma once

#include <cstdint>

#include "scene/commit.h"

namespace openrt {

class Texture {
 public:
  // texels: the array that description.texels refers to, slices of rows from the bottom up. If the
  // texels are too short for the description (a damaged recording), the texture has no components
  // and samples as white.
  Texture(const edit::TextureT& description, ArrayPtr texels);

  // Returns 1 grey, 2 grey and alpha, 3 rgb, 4 rgba; 0: no image.
  uint32_t components() const { return components_; }
  uint32_t width() const { return uint32_t(axis_[0].size); }

  // Writes linear rgba at n texture coordinates. Grey is replicated; a missing alpha is 1.
  // Coordinates that are not finite count as 0.
  void sample(uint32_t n, const float* const uv[2], float* const rgba[4]) const {
    sample_(*this, n, uv, rgba);
  }
  // Does the same at (s, t, r). sample() sees the first slice of a texture with depth.
  void sampleVolume(uint32_t n, const float* const str[3], float* const rgba[4]) const;

  // One axis of the image. Texel centres are at (i + 1/2) / size. Coordinates repeat, clamp (also
  // after they were mirrored into the image), or lead to the border.
  struct Axis {
    int32_t size = 1;
    bool clamp = false, mirror = false, border = false;
  };

 private:
  template <class Texel, int components, bool single> static void
  sampleAs(const Texture& texture, uint32_t n, const float* const uv[2], float* const rgba[4]);
  template <class Texel, int components, bool single>
  static void sampleBordered(const Texture& texture, uint32_t n, const float* const uv[2],
                             float* const rgba[4]);
  template <class Texel>
  void sampleVolumeAs(uint32_t n, const float* const str[3], float* const rgba[4]) const;
  template <class Texel> void choose(bool nearest);
  using Sampler = void (*)(const Texture&, uint32_t, const float* const[2], float* const[4]);

  ArrayPtr texels_;
  Axis axis_[3];
  float border_[4] = {}; // as the components of a texel
  uint32_t components_ = 0;
  bool float_ = false, nearest_ = false;
  const float* decode_; // table of 256: colour byte to linear value
  Sampler sample_;
};

} // namespace openrt
