// background.h: what shows where nothing is drawn: what the world has there, nothing, one colour, a
// picture. With any but the first the world is rendered without its Background, and colours are put
// behind the finished picture by its alpha. [any thread]
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace picture {

struct Background {
  enum class Kind : unsigned char { world, none, colour, file } kind = Kind::world;
  std::array<float, 3>
      colour{};     // display values: 0 to 1, with the sRGB curve where colours are linear
  std::string file; // png, jpg, gif; exr, hdr, pfm: radiance
  bool operator==(const Background&) const = default;
};

// Reads "none", a colour (a name, #rgb, #rrggbb, or R,G,B from 0 to 1) or the name of a picture's
// file. Throws std::invalid_argument that says what was expected.
Background readBackground(const std::string& text);
inline constexpr const char* backgroundForms =
    "none, a colour (a name such as white, #rgb, #rrggbb, or R,G,B from 0 to 1) or a picture (png, "
    "jpg, gif, exr, hdr, pfm)";

// What is put behind a frame: a colour, or a picture that is scaled, without turning or stretching,
// until it covers the frame, its middle in the middle.
class Backcloth {
 public:
  // Reads the file, if it is one; throws std::runtime_error that names it. Kind::none and
  // Kind::world: nothing is put behind.
  Backcloth(const Background& background, bool linear);
  // Puts it behind a plane rgba of premultiplied colours, first row at the top; every pixel is
  // opaque then.
  void putBehind(std::vector<float>& rgba, int width, int height) const;

 private:
  void colourAt(double x, double y, float rgb[3]) const; // in its pixels
  void read(const std::string& file, bool linear);
  int width_ = 0, height_ = 0; // 0: nothing; a colour is a picture of one pixel
  std::vector<float> rgb_;     // first row at the top
};

} // namespace picture
