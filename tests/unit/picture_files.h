// picture_files.h: PNG, JPEG and GIF files made in memory for the tests of libxvrml/image.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace xvrml::test {

using Bytes = std::vector<uint8_t>;
// Returns a sample of a picture: column, row from the top, component.
using Sample = std::function<uint16_t(int x, int y, int c)>;

struct PngKind {
  int colorType; // libpng's colour type
  int bitDepth = 8;
  bool interlaced = false;
  std::vector<uint8_t> paletteAlpha; // tRNS chunk of a palette
  int transparentGrey = -1;          // tRNS chunk of a grey picture
};
// Makes a PNG file. Palette pictures have the entries (i, 2 i, 3 i).
Bytes makePng(int width, int height, const PngKind& kind, const Sample& sample);

// components 4: CMYK as Adobe writes it
Bytes makeJpeg(int width, int height, int components, bool progressive, const Sample& sample);

struct GifFrame {
  int left = 0, top = 0, width = 0, height = 0;
  bool interlaced = false;
  int transparent = -1;
  bool ownPalette = false; // local palette, entry i is (255 - i, 0, 0)
};
// Makes a GIF file. The global palette has 64 entries; entry i is (i, 2 i, 3 i).
Bytes makeGif(int width, int height, const std::vector<GifFrame>& frames, const Sample& sample);

} // namespace xvrml::test
