// error_map.h: the errors of all pixels of a picture: corrections that need a pixel's neighbours,
// and statistics of the whole picture. store(): [render] each pixel by one thread. Everything else
// is called by one thread when the picture is finished.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "openrt/frame.h"
#include "render/film/ledger.h"
#include "render/film/picture_error.h"
#include "render/wave/tiles.h"

namespace openrt {

// Floor for relative errors (sum of the colours), so that errors of dark pixels are not
// exaggerated.
inline constexpr float darkest = 0.03f;

struct PixelError {
  float mean[3] = {};
  float halfWidth[3] = {}; // half-width of the 95 % interval of each colour
  float relative = 1;      // relativeError() of the half-widths
  PixelNoise noise;
  uint32_t samples = 0;
  bool trusted = false;
  bool dark = false; // no random path of the pixel or of its window has found light
  // All samples are equal and no path took a random decision: the pixel is exact unless an edge
  // cuts its corner.
  bool constant = false;
};

// Returns the sum of the colours' errors over the sum of the colours and `darkest`, at most 1.
float relativeError(double sum, const float colors[3]);

class ErrorMap {
 public:
  // summary: statistics only. full: also the data for doubtConstants(). doubts: only the data for
  // doubtConstants(); summary() is not available.
  enum class Kind { none, summary, full, doubts };
  ErrorMap() = default;
  ErrorMap(uint32_t width, uint32_t height, Kind kind);
  bool empty() const { return relative_.empty(); }
  void store(size_t pixel, const PixelError& e);
  // Widens the intervals of constant pixels beside pixels that differ. Such a pixel is not known to
  // be exact: an edge may cut a corner that no sample hit. The new interval is the bound given by
  // the rule of three, for a corner of any colour that the pixels around it have. The same is done
  // at the border of a picture that is not of one colour. Calls `changed` for each such pixel.
  // known: whether the colours around can be trusted. If not, the pixel loses its trust.
  void doubtConstants(
      const std::function<void(size_t pixel, const float halfWidth[3], bool known)>& changed);
  // Records the radiance that each finished pixel of a tile may lack because no sample has found it
  // (ledger.h), summed over the colours.
  //  - bound: bound by the samples of the tile. Pixels with random samples whose interval is
  //    narrower lose their trust; `distrusted` is called for each of these.
  //  - expected: bound if light is found equally often everywhere in the picture. It widens the
  //    interval of the summary's mean.
  void addMissing(const Tile& tile, double bound, double expected,
                  const std::function<void(size_t pixel)>& distrusted);
  // Returns the statistics of the picture, without level, unmet and method.
  RTerrorStats summary() const;

 private:
  struct Seen {
    float mean[3];
    uint32_t samples; // 0: the pixel is not finished
    bool constant;
  };
  bool border(uint32_t x, uint32_t y) const {
    return x == 0 || y == 0 || x + 1 == width_ || y + 1 == height_;
  }
  bool beside(uint32_t x, uint32_t y) const;
  bool coloursKnown(uint32_t x, uint32_t y) const;
  void range(uint32_t x, uint32_t y, float out[3]) const;
  uint32_t width_ = 0, height_ = 0;
  std::vector<float> relative_; // NaN: not finished; negative: not trusted
  // Expected relative error of doubted constant pixels; NaN: the pixel is not in doubt.
  std::vector<float> doubted_;
  std::vector<PixelNoise> noise_;
  std::vector<Seen> seen_;
  float range_[3] = {}; // range of all pixels' colours; set by doubtConstants()
  double missing_ = 0;  // sum over the pixels of the relative error by missing radiance
};

} // namespace openrt
