// picture_source.h: Where surfaces get the pictures of texture nodes from. Exports keep them as
// files, the z-buffer renderer keeps their pixels. [the thread that owns the world]
#pragma once

#include <optional>

#include "xvrml/renderer.h"

namespace picture {

class PictureSource {
 public:
  virtual ~PictureSource() = default;
  // Returns the place of the picture of a texture node; none for null and for a node without a
  // picture.
  virtual std::optional<size_t> of(const xvrml::Node* texture) = 0;
  struct Traits {
    int components = 3;       // 1 grey, 2 grey and alpha, 3 colours, 4 colours and alpha
    bool transparent = false; // a pixel has an alpha below 1
  };
  virtual Traits traitsOf(size_t place) const = 0;
};

// Returns the picture that a texture node shows, with radiances as sRGB codes: brighter ones than 1
// are white. Empty if there is none.
xvrml::Image shownImage(xvrml::TexturePicture& picture);
bool hasTransparentPixel(const xvrml::Image& image);

} // namespace picture
