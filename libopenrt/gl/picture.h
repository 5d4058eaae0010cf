// picture.h: the sum of the samples of a frame, what lies over it, and its colours for screens.
#pragma once

#include <memory>
#include <vector>

namespace rtgl {

class Overlay;

class Film {
 public:
  int width = 0, height = 0, samples = 0;
  bool linear = false; // the colours are light, and are encoded as sRGB asks

  // cover: lies over the picture; null: nothing does.
  void restart(int newWidth, int newHeight, bool isLinear, std::shared_ptr<const Overlay> cover);
  // Adds an RGBA picture, the mean of `count` samples.
  void add(const std::vector<float>& rgba, int count);
  // Returns component c of a pixel as shown, 0 to 1. Rows count from the top.
  float shown(int x, int y, int c) const;
  const unsigned char* bytes() const;

 private:
  std::vector<double> sum_;
  std::shared_ptr<const Overlay> cover_;
  mutable std::vector<unsigned char> bytes_;
};

float encoded(float linear); // to sRGB
float decoded(float srgb);

} // namespace rtgl
