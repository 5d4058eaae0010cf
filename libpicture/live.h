// live.h: renders a running world while its user goes on working: a frame is started and looked
// after, never waited for. With a cluster frames overlap: the next one may be started while the
// last jobs of the one before are under way. One OpenRT context and one mapper on a thread of their
// own, as in renderer.h. Called by one thread, the browser's.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libpicture/renderer.h"

namespace picture {

// A frame to be made. Fewer pixels and samples come sooner; the picture is refined from 1 sample a
// pixel on and can be looked at at any time. However often it was looked at, the finished picture
// has the bytes of Renderer::render with the same samples.
struct LiveFrame {
  View view; // viewer set: looked at from there; else from the bound Viewpoint, where the browser's
             // viewer has gone from it
  int width = 0, height = 0;
  int samples = 1;
};

// What can be seen of a frame by now.
struct LivePicture {
  int width = 0, height = 0;
  // Display bytes, first row at the top. Pixels without a sample yet show what they did in the
  // picture before.
  std::vector<uint8_t> rgb;
  double covered = 0;    // part of the pixels that have samples, 0 to 1
  double samples = 0;    // taken so far, mean over the pixels
  double seconds = 0;    // since the frame was started
  double alone = 0;      // ended: of the seconds: while no other frame was in flight
  bool finished = false; // all samples are taken
  bool ended =
      false; // finished, or given up: there will not be more of it; overhead, map and stats hold
  double overhead =
      0; // of the seconds: until light was traced, for reading the world and building structures
  xvrml::MapStats map{};
  RTstats stats{};
};

class LiveRenderer {
 public:
  // Returns at once; the world's geometry is read with the first frame. The browser must live as
  // long as the renderer.
  LiveRenderer(xvrml::Browser& browser, const RenderSettings& settings);
  ~LiveRenderer();
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;

  enum class State : uint8_t {
    idle,
    mapping,   // the world is being read: the browser and its nodes must be left alone
    rendering, // the browser may go on; the frame shows the world as it was
    ready      // the same, and another frame may be started behind it: never without a cluster
  };
  State state() const;
  // Only if idle or ready (else std::logic_error). Takes the browser's changes and returns at once.
  // Two frames are in flight at most: what is seen is one frame old.
  void start(const LiveFrame& frame);
  // The frames in flight end soon, the older one as well; what is finished of them stays visible.
  // No frame: nothing happens.
  void cancel();
  // A frame that has ended, each once and in their order; else the one in flight, if it is alone
  // and there is more of it than at the last call. Never waits.
  bool look(LivePicture& picture);
  // The same with all channels of the settings, for a file; false before the first frame.
  bool copy(Picture& picture);
  // Quality of the following frames. [idle]
  void change(const std::function<void(RenderSettings&)>& change);
  const std::vector<xvrml::ViewpointInfo>&
  viewpoints() const;           // after the first mapping; [not while mapping]
  xvrml::Bounds bounds() const; // the same
  xvrml::CameraSettings cameraOf(const View& view, double aspect) const; // see camera.h; the same
  xvrml::Axis upOf(const View& view) const;                              // see camera.h; the same
  // Why the last frame could not be made (RenderError's text), once; "" if nothing was wrong.
  std::string takeFailure();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace picture
