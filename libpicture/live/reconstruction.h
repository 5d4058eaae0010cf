// reconstruction.h: Rebuilds a picture of something that moves from a few samples per pixel.
//
// Each new frame has one or a few samples per pixel and guides (depth, normal, albedo, position,
// motion, names) that follow mirror images. Its radiance is divided by the albedo, accumulated over
// the earlier frames by reprojection, filtered across the pixels under the guidance of the measured
// variance, and multiplied by the albedo again (C. Schied et al., "Spatiotemporal Variance-Guided
// Filtering", HPG 2017). docs/decisions/0050-live-previews.md says what differs from the paper.
//
// The result is a preview: it is biased, and no error bar, no file and no still picture may be
// made from it. LiveRenderer owns one Reconstruction for each viewer. [one thread at a time; a call
// uses several threads]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libpicture/files/picture.h"
#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace picture::live {

// The channels that a frame must have for a preview, besides RT_RGBA and RT_SAMPLES. The frame must
// be rendered with quality RT_FOLLOW_IMAGES 1.
constexpr uint32_t previewChannels =
    RT_DEPTH | RT_NORMAL | RT_ALBEDO | RT_POSITION | RT_NAME | RT_MOTION | RT_REFLECTION | RT_PLACE;

class OidnFilter;

// How the frame's camera projects. A camera whose shader is not null cannot be inverted: its frames
// are accumulated only while the camera rests.
struct FrameCamera {
  xvrml::CameraSettings settings;
  double aspect = 1; // width / height of the frame
  // The background, where nothing is hit, has its place on the screen, wherever the camera looks.
  bool fixedBackground = false;
};

// The largest RT_LIGHT_STRIDE.
constexpr int mostLightStride = 4;

// The pixels of a picture that is made from frames of fewer pixels; 0: those of the frame.
struct ShownSize {
  int width = 0, height = 0;
};

class Reconstruction {
 public:
  // threads: 0: as many as the process may use.
  explicit Reconstruction(int threads = 0);
  ~Reconstruction();
  Reconstruction(const Reconstruction&) = delete;
  Reconstruction& operator=(const Reconstruction&) = delete;

  // Forgets everything that was accumulated: after a jump to another world.
  void reset();

  // Adds a frame and returns the rebuilt picture: it is described as the frame is, without names,
  // and its only plane is RT_RGBA. Frames may differ in size. The bytes depend on the frames since
  // reset() and on nothing else, in particular not on the number of threads. `frame` must have the
  // planes of previewChannels, RT_RGBA and RT_SAMPLES; otherwise std::invalid_argument is thrown.
  // With RT_VARIANCE and several samples per pixel, these tell noise from detail.
  //
  // A frame without noise comes out unchanged but for anti-aliasing over time: its illumination is
  // that of neighbours on the same surface, or of straight edges.
  //
  // lightStride: RT_LIGHT_STRIDE of the frame, 1 to mostLightStride. From 2 on, pixels take their
  // illumination from the blocks around them that show the same surface; edges and textures keep
  // the size of the pixels. Frames may differ in it.
  //
  // denoiser: filters the illumination beside the filter of this class, where there is noise; null:
  // none does. The bytes then depend on its library and on this machine, too.
  //
  // shown: the size of the picture, which may have up to 65536 pixels each way. Where it has more
  // pixels than the frame, each sample counts for the pixel that it lies in, so what rests is sharp
  // after a few frames. It is never smaller than the frame, and may differ from frame to frame.
  Picture add(const Picture& frame, const FrameCamera& camera, int lightStride = 1,
              OidnFilter* denoiser = nullptr, ShownSize shown = {});

  // Facts about the last add(), for reports and tests.
  struct Facts {
    double seconds = 0;     // time of the call
    double reprojected = 0; // fraction of the pixels that found themselves in the frame before
    double history = 0;     // accumulated frames, mean over the pixels
    bool denoised = false;  // the denoiser has filtered the frame
    double denoising = 0;   // part of `seconds`: time of the denoiser
    double showing = 0;     // part of `seconds`: time of the stages at the size of the picture
    std::string problem; // why it has failed and this class has filtered the frame; "": it has not
  };
  const Facts& facts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace picture::live
