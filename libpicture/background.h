// background.h: Chooses and draws what is visible where no geometry is: the world's own Background,
// nothing, one colour or a picture. For every choice except the first, the world is rendered
// without its Background, and the finished picture is composited over the colours by its alpha.
// A backdrop is put behind what screens show only (Picture::backdrop). [any thread]
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace picture {

struct PictureFacts;

struct Background {
  // backdrop: a colour that screens and files for them show, and programs do not read
  enum class Kind : unsigned char { world, none, colour, file, backdrop } kind = Kind::world;
  // display values from 0 to 1 (sRGB-encoded); linear pictures convert them to linear
  std::array<float, 3> colour{};
  std::string file; // png, jpg, gif, webp, bmp or tga; exr, hdr and pfm hold radiance
  bool operator==(const Background&) const = default;
};

// Parses "none", a colour (a name, #rgb, #rrggbb, or R,G,B from 0 to 1) or the name of a picture
// file. Throws std::invalid_argument that says what was expected.
Background readBackground(const std::string& text);
inline constexpr const char* backgroundForms =
    "none, a colour (a name such as white, #rgb, #rrggbb, or R,G,B from 0 to 1) or a picture (png, "
    "jpg, gif, webp, bmp, tga, exr, hdr, pfm)";

// Sets what a picture says about its background: whether it is transparent, and its backdrop.
void setBackdrop(const Background& background, PictureFacts& picture);

// Draws a background behind frames: a colour, or a picture. The picture is centred and scaled until
// it covers the frame; it is neither rotated nor stretched.
class BackgroundLayer {
 public:
  // Reads the file, if there is one; throws std::runtime_error that names it. With the other
  // kinds, nothing is drawn here; Picture::backdrop is for Kind::backdrop.
  BackgroundLayer(const Background& background, bool linear);
  // Composites the plane `rgba` (premultiplied colours, first row at the top) over the background.
  // Every pixel is opaque afterwards.
  void compositeOver(std::vector<float>& rgba, int width, int height) const;

 private:
  // x and y are in pixels of the background picture
  void colourAt(double x, double y, float rgb[3]) const;
  void read(const std::string& file, bool linear);
  int width_ = 0, height_ = 0; // 0: there is nothing to draw; a colour is a picture of one pixel
  std::vector<float> rgb_;     // first row at the top
};

} // namespace picture
