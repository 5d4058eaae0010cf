// display.h: Makes the bytes that a viewer is shown of a frame. A still picture begins with few
// samples, so it fades in over what the viewer saw before; its finished picture is shown as it is.
// Owned by a LiveRenderer. [the browser's thread]
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "libpicture/live.h"
#include "libpicture/live/fade.h"
#include "libpicture/live/recent_viewers.h"

namespace picture::live {

// The facts about a frame that decide how it is shown.
struct ShownFrame {
  uint64_t number = 0; // counts the frames that were started
  LiveFrame::Purpose purpose = LiveFrame::Purpose::still;
  uint32_t viewer = 0;
  int samples = 1;     // samples per pixel that the frame was started with
  int lightStride = 1; // RT_LIGHT_STRIDE
  // as in LiveFrame
  std::optional<double> falseColour;
  int shownWidth = 0, shownHeight = 0;
  int width = 0, height = 0;
};

// Returns the largest weight, 0 to 1, of a still picture with `samples` samples per pixel so far,
// over the preview that was shown before; Fade lowers it where the picture is noisy. It never
// decreases. wanted: the samples of the finished picture.
// seconds: since the frame was started.
double stillWeight(double samples, int wanted, double seconds);

// Scales rows of red, green and blue bytes, linearly between the centres of pixels.
std::vector<uint8_t> scaled(const std::vector<uint8_t>& rgb, int width, int height, int newWidth,
                            int newHeight);

class Display {
 public:
  // Fills sizes, rgb, scaleEnd, covered, samples and preview of `out`. picture: the finished part
  // of the frame, with RT_RGBA and RT_SAMPLES; a preview may have more pixels than its frame.
  // whole: the frame has all its samples.
  void show(const Picture& picture, const ShownFrame& frame, bool whole, double seconds,
            LivePicture& out);
  // Frees what a viewer was shown last.
  void forget(uint32_t viewer) { viewers_.forget(viewer); }

 private:
  // A picture, and whether any of it is a preview.
  struct Bytes {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
    bool preview = false;
  };
  struct Viewer {
    Bytes last;              // the picture that was shown last
    Bytes below;             // the picture that a still frame fades over, in that frame's size
    uint64_t belowFrame = 0; // number of that frame
    Fade fade;               // over that picture
    // The luminance that fits the last finished still picture, or the first picture in false
    // colours while there is none; 0: own colours are shown.
    double fitting = 0;
  };

  // Returns the end of the scale for a picture in false colours, which stays the same while
  // something moves. A finished still picture has the scale that its file would have.
  static double scaleEndOf(const Picture& picture, const ShownFrame& frame, bool whole,
                           Viewer& viewer);

  RecentViewers<Viewer> viewers_;
};

} // namespace picture::live
