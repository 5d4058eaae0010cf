// live.h: Renders a running world while its user continues to interact. Frames are started and
// polled; no call waits for one. While something moves, frames are previews, which are rebuilt from
// few samples; once nothing moves, a still frame fades in over the last one of them. With a
// cluster, frames overlap: the next one may start while the last jobs of the previous one are
// outstanding. One OpenRT context and one mapper live on a thread of their own, as in renderer.h.
// [one thread: the browser's]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libpicture/measure.h"
#include "libpicture/renderer.h"

namespace picture {

// A frame to be rendered. Fewer pixels and samples finish sooner. A still picture is refined from 1
// sample per pixel on and can be polled at any time. Neither polling nor earlier frames change the
// result: the finished picture has the same bytes as Renderer::render with the same samples.
struct LiveFrame {
  // The camera is `viewer` if set, otherwise the browser's viewer (the bound Viewpoint plus the
  // user's navigation).
  View view;
  int width = 0, height = 0;
  int samples = 1;
  // Holds for a preview the pixels each way of the blocks in which one pixel gets light
  // (RT_LIGHT_STRIDE).
  int lightStride = 1;
  // Holds for a preview the seconds that Denoiser::automatic may take (live/denoise_choice.h).
  double denoising = 0;
  // still: refined from 1 sample per pixel on, with the bytes of Renderer::render.
  // preview: of something that moves; the picture is rebuilt from this frame and earlier previews
  //   of the same viewer (live/reconstruction.h) and is never part of a file or a still picture.
  // rawPreview: of something that moves; its samples are shown as they are.
  // The samples of both kinds of previews differ from frame to frame.
  enum class Purpose : uint8_t { still, preview, rawPreview };
  Purpose purpose = Purpose::still;
  // Whom the frame is for. Each viewer has accumulated frames of its own, and a still frame fades
  // in over what its viewer was shown last. At most eight viewers are remembered.
  uint32_t viewer = 0;
  // How the picture is shown: none: in its own colours; otherwise its luminance in false colours,
  // up to this end of the scale in cd/m2, or to one that fits the picture (0).
  std::optional<double> falseColour;
  // The size that previews are shown in, which may be larger than the frame: rebuilt ones take
  // their pixels from the frames before, and isolines of false colours are as fine as these pixels;
  // 0: that of the frame.
  int shownWidth = 0, shownHeight = 0;
};

// The state of a frame when it was polled.
struct LivePicture {
  int width = 0, height = 0; // those of the frame
  // Display bytes, first row at the top. Pixels without a sample yet show the viewer's previous
  // picture. A still picture with few samples is mixed with the preview before it.
  std::vector<uint8_t> rgb;
  int shownWidth = 0, shownHeight = 0;                    // the size of `rgb`
  uint64_t number = 0;                                    // what start() returned for the frame
  LiveFrame::Purpose purpose = LiveFrame::Purpose::still; // as in the frame
  int lightStride = 1;                                    // as in the frame
  double covered = 0;    // fraction of the pixels that have samples, 0 to 1
  double samples = 0;    // samples taken so far, mean over the pixels
  double seconds = 0;    // seconds since the frame was started
  double alone = 0;      // seconds of an ended frame during which no other frame was in flight
  bool finished = false; // all samples are taken
  // Rebuilt from few samples, or mixed with such a picture: biased, and to be called a preview.
  bool preview = false;
  // Drawn by the z-buffer (raster/raster.h) while a large world is prepared for rays: a first
  // picture to be shown until there is another. It has no samples and is part of no other picture.
  bool raster = false;
  // Finished or cancelled; no more updates follow. overhead, map and stats are valid.
  bool ended = false;
  // Shows the world before its last changes, from the present camera: what these need is still
  // being read or built. Holds for previews that have ended. Another preview should follow.
  bool outdated = false;
  // Part of `seconds` before tracing began: reading the world and building acceleration structures.
  double overhead = 0;
  double scaleEnd = 0;    // the luminance at the end of the scale of false colours; 0: own colours
  std::string denoisedBy; // the library that has filtered a preview; "": none has
  double rebuilding = 0;  // part of `seconds` after tracing: the time of the Reconstruction
  double showing = 0;     // part of `rebuilding` that the size of the shown picture takes
  xvrml::MapStats map{};
  RTstats stats{};
};

// A reading of sensors, without a picture.
struct LiveMeasure {
  // Chooses levels of detail and billboards.
  View view;
  // The sensors; none: all ORTSensors of the world, in the order of the file.
  std::vector<PlacedSensor> sensors;
  int samples = 1; // samples of each point
};

struct LiveReadings {
  std::vector<Measurement> sensors;
  std::string failure; // why there are none; "": all are there
};

class LiveRenderer {
 public:
  // Returns at once; the world's geometry is read with the first frame. The browser must outlive
  // the renderer.
  LiveRenderer(xvrml::Browser& browser, const RenderSettings& settings);
  ~LiveRenderer();
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;

  enum class State : uint8_t {
    idle,
    mapping,   // the world is being read: the browser and its nodes must not be touched
    rendering, // the browser may continue; the frame shows the world as it was
    ready      // same as rendering, but another frame may be started; happens only with a cluster
  };
  State state() const;
  // Starts a frame from the browser's changes and returns at once: the frame's number, from 1 on.
  // Throws std::logic_error unless the state is idle or ready. At most two frames are in flight, so
  // the display lags by at most one frame.
  uint64_t start(const LiveFrame& frame);
  // Reads sensors from the browser's changes, with the settings of Renderer::measure but for the
  // samples, and returns at once. The state is mapping and rendering meanwhile, and idle when
  // takeReadings() has them. It is no frame: what look(), copy() and recolour() know stays. Throws
  // std::logic_error unless the state is idle.
  void measure(const LiveMeasure& measure);
  // Returns, once, what the last measure() has read; nothing while it is under way.
  std::optional<LiveReadings> takeReadings();
  // Ends the frames in flight soon, including the older one. Finished parts of still frames stay
  // visible; previews are dropped. So ends what is measured. Does nothing without either.
  void cancel();
  // Returns each ended frame once, in order. Otherwise returns the frame in flight, if it is the
  // only one, is not a preview and has new samples since the last call. Never waits.
  bool look(LivePicture& picture);
  // Shows the finished still picture of a frame with another LiveFrame::falseColour: look() returns
  // it once more. Returns false if another frame has been started, or the picture is not finished.
  bool recolour(uint64_t number, std::optional<double> falseColour);
  // Copies a still picture with all channels of the settings, for a file: that of the frame in
  // flight if it is a still one and every pixel has a sample, otherwise that of the last still
  // frame that ended. So while something moves it is not the picture that is shown: start a still
  // frame first. Previews, rebuilt or not, are never copied. Returns false before the first still
  // frame.
  // number: receives what start() returned for its frame.
  bool copy(Picture& picture, uint64_t* number = nullptr);
  // Frees what is kept for a viewer who has left: the accumulated frames and what was shown last.
  void forget(uint32_t viewer);
  // Frees the pictures that are kept for all viewers, and gives the memory back to the system; the
  // geometry of the world stays. copy() has nothing before the next still frame. The pictures of
  // the last frame itself go when another frame starts: a small one, if nobody looks. [idle]
  void release();
  // Changes the quality of the following frames. [idle]
  void change(const std::function<void(RenderSettings&)>& change);
  // Valid after the first mapping. [not while mapping]
  const std::vector<xvrml::ViewpointInfo>& viewpoints() const;
  xvrml::Bounds bounds() const; // Valid after the first mapping. [not while mapping]
  // See camera.h; needs the first mapping. [not while mapping]
  xvrml::CameraSettings cameraOf(const View& view, double aspect) const;
  // See camera.h; needs the first mapping. [not while mapping]
  bool leavesViewpointOut(const View& view, double aspect) const;
  // Returns the camera that looks as another one does and shows all that is drawn; needs the first
  // mapping. [not while mapping]
  xvrml::CameraSettings cameraAround(const xvrml::CameraSettings& camera, double aspect) const;
  // See camera.h; needs the first mapping. [not while mapping]
  xvrml::Axis upOf(const View& view) const;
  // Returns, once, why the last frame failed (RenderError's text); "" if it did not.
  std::string takeFailure();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace picture
