// media.h: what plays in a running world, for programs that show or play it: the pictures of
// MovieTextures, the samples of AudioClips, the loudness of Sounds. No device is opened here. [the
// browser's thread; mix, soundGain, soundLevels: any]
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "xvrml/nodes.h"

namespace xvrml {

// --- MovieTexture (clause 6.28) ---

// Returns the picture that a MovieTexture of a running world shows; null if the world does not run
// or there is no picture.
// - before it starts: the first picture (with speed < 0, the last);
// - while active: the picture at its time;
// - after: the last picture shown.
//
// A change of `url` is reported whenever the picture becomes another one. The picture is decoded by
// this call. The pointer is valid until time or the node changes.
const Image* currentImage(const Node& movieTexture);

// --- AudioClip (clause 6.4) ---

// Decoded sound.
struct Clip {
  int channels = 0;
  double rate = 0;            // frames a second
  std::vector<float> samples; // in [-1,1]; the channels of a frame lie one after the other
  size_t frames() const { return channels > 0 ? samples.size() / size_t(channels) : 0; }
};
struct Playing {
  std::shared_ptr<const Clip> clip; // null: nothing plays
  double position = 0;              // seconds into the clip
  double pitch = 1;                 // seconds of the clip per second of the world
  bool loop = false;
};
// Returns what an AudioClip of a running world plays at the last tick. Its samples are read by the
// first call. libsndfile reads the file, in the process xvrml-decoder.
Playing playingOf(const Node& audioClip);

// --- Sound (clause 6.42) ---

// Returns the loudness in [0,1] at a point in the Sound's own coordinate system:
// - inside the inner ellipsoid: `intensity`;
// - from there to the outer ellipsoid: linear in decibels, down to -20 dB (a tenth);
// - beyond: 0.
//
// `location` is a focus of both ellipsoids, on the axis given by `direction`. If an outer ellipsoid
// is no larger than the inner one, the sound ends at the inner one.
double soundGain(const nodes::Sound& sound, const Vec3f& viewer);

struct SoundLevels {
  double left = 0, right = 0; // amplitude factors in [0,1.42], or those times AudioClip.gain
};
// Returns the amplitude factors for both ears. With `spatialize`, their total power is the same for
// all directions; otherwise both are the gain. viewer: in the Sound's coordinates; fromViewer: the
// Sound's location in the viewer's coordinates (x right, z back). Within the inner ellipsoid the
// direction fades out towards the location.
SoundLevels soundLevels(const nodes::Sound& sound, const Vec3f& viewer, const Vec3f& fromViewer);

class Browser;
struct Heard {
  const Node* sound = nullptr; // valid until the world changes
  Playing playing;
  SoundLevels levels;
};
// Returns what the viewer hears at the last tick: the Sounds in the scene whose clip plays, silent
// ones included. A Sound has one entry for each place where it is used, at most 16. [the browser's
// thread]
std::vector<Heard> heardIn(Browser& browser);

// Adds a playing clip to `stereo`: pairs of left and right samples, `rate` pairs a second. A mono
// clip goes to both sides; of more channels, the first two are left and right. Samples are
// interpolated linearly. Beyond the end comes silence, or the beginning if the clip loops.
void mix(const Playing& playing, const SoundLevels& levels, double rate, std::span<float> stereo);

} // namespace xvrml
