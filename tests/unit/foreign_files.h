// foreign_files.h: files for the tests of libxvrml/decode, written in memory by the libraries of
// their formats or by hand, and the values that they hold.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace xvrml::test {

using Bytes = std::vector<uint8_t>;

// Returns a value of the OpenEXR pictures; x and y are from the upper left. It is exact as half.
inline float radianceAt(int x, int y, int c) {
  return float(1 + x % 8 + 8 * (y % 16)) * (c == 0 ? 1.0f : c == 1 ? 0.5f : 2.0f);
}

struct ExrKind {
  int compression = 3; // Imf::Compression
  bool isFloat = false, tiled = false, levels = false, upwards = false;
  int width = 40, height = 37, left = -3, top = 7; // data window
  const char* channels = "RGB";                    // one letter each; Z has other values
};
Bytes makeExr(const ExrKind& kind);
// Makes a file of two parts: the first has the channel Z only.
Bytes makeTwoParts(const ExrKind& kind);
// Makes a file that stores luminance and chroma, of one colour.
Bytes makeChroma(int width, int height, float red, float green, float blue);

// Returns a component of the other pictures.
inline uint8_t byteAt(int x, int y, int c) { return uint8_t(x * 7 + y * 31 + c * 85); }
// Returns the alpha of WebP and BMP pictures. It is neither 0, where colours are not kept, nor 255,
// because a picture may not keep an alpha that is 255 everywhere.
inline uint8_t alphaAt(int x, int y) { return uint8_t((byteAt(x, y, 3) & 0x7e) | 1); }

Bytes makeWebp(int width, int height, int components); // without loss
Bytes makeBmp(int width, int height, int components);  // 3 or 4
struct TgaKind {
  int components = 3; // 1, 3 or 4
  bool runs = false, fromTop = false;
};
Bytes makeTga(int width, int height, const TgaKind& kind);

// Makes a sound of one channel with a sine of 440 Hz and amplitude 0.5, at 44100 frames a second.
// format: of libsndfile; empty if the library cannot write it.
Bytes makeSound(int format, int frames);

} // namespace xvrml::test
