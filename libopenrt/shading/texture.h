// texture.h: one image that shaders sample. Made when a commit is applied, immutable afterwards;
// sample() is called from render threads, for batches.
#pragma once

#include <cstdint>

#include "scene/commit.h"

namespace openrt {

class Texture {
 public:
  // texels: what description.texels names, rows from the bottom up. A description that does not fit
  // its texels (a damaged recording) makes a texture without components, which samples as white.
  Texture(const edit::TextureT& description, ArrayPtr texels);

  // 1 grey, 2 grey and alpha, 3 rgb, 4 rgba; 0: nothing to sample.
  uint32_t components() const { return components_; }
  uint32_t width() const { return uint32_t(axis_[0].size); }

  // rgba at n places; grey is replicated, missing alpha is 1. Coordinates that are not finite count
  // as 0.
  void sample(uint32_t n, const float* const uv[2], float* const rgba[4]) const {
    sample_(*this, n, uv, rgba);
  }

  // One direction of the image: texel centres at (i + 1/2) / size, ends joined or held.
  struct Axis {
    int32_t size = 1;
    bool clamp = false;
  };

 private:
  template <class Texel, int components, bool single> static void
  sampleAs(const Texture& texture, uint32_t n, const float* const uv[2], float* const rgba[4]);
  template <class Texel> void choose(bool nearest);
  using Sampler = void (*)(const Texture&, uint32_t, const float* const[2], float* const[4]);

  ArrayPtr texels_;
  Axis axis_[2];
  uint32_t components_ = 0;
  const float* decode_; // 256 values of a colour byte
  Sampler sample_;
};

} // namespace openrt
