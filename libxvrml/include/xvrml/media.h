// media.h: what plays in a running world, for those who show and sound it: the pictures of
// MovieTextures, the samples of AudioClips, how loud Sounds are. Nothing here opens a device. [the
// browser's thread; mix, soundGain, soundLevels: any]
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "xvrml/nodes.h"

namespace xvrml {

// --- MovieTexture (clause 6.28) ---

// The picture that a MovieTexture of a running world shows: the first (speed < 0: the last) before
// it starts, the one of its time while active, and the last one shown after. Null: the world does
// not run, or there is none. Whenever it becomes another one a change of `url` is reported. It is
// decoded when asked for; the pointer is good until time or the node changes.
const Image* currentImage(const Node& movieTexture);

// --- AudioClip (clause 6.4) ---

// Decoded sound.
struct Clip {
  int channels = 0;
  double rate = 0;            // frames a second
  std::vector<float> samples; // in [-1,1], the channels of a frame one after the other
  size_t frames() const { return channels > 0 ? samples.size() / size_t(channels) : 0; }
};
struct Playing {
  std::shared_ptr<const Clip> clip; // null: nothing plays
  double position = 0;              // seconds into the clip
  double pitch = 1;                 // seconds of the clip for a second of the world
  bool loop = false;
};
// What an AudioClip of a running world plays at the last tick. Its samples are read when first
// asked for: of WAVE files, PCM or floats.
Playing playingOf(const Node& audioClip);

// --- Sound (clause 6.42) ---

// Loudness in [0,1] at a place in the Sound's own coordinate system: `intensity` in the inner
// ellipsoid, then linear in decibels down to -20 dB (a tenth) at the outer one, 0 beyond. The
// location is a focus of both, on the axis of the direction. Where an outer ellipsoid is no larger
// than the inner one, the sound ends at the inner one.
double soundGain(const nodes::Sound& sound, const Vec3f& viewer);

struct SoundLevels {
  double left = 0, right = 0; // factors of amplitude, in [0,1.42]
};
// With the same power in any direction, if `spatialize`; else both are the gain. viewer: in the
// Sound's coordinates; fromViewer: the sound's location in the viewer's (x right, z back). Within
// the inner ellipsoid the direction fades towards the location.
SoundLevels soundLevels(const nodes::Sound& sound, const Vec3f& viewer, const Vec3f& fromViewer);

class Browser;
struct Heard {
  const Node* sound = nullptr; // good until the world changes
  Playing playing;
  SoundLevels levels;
};
// What the viewer hears at the last tick: Sounds in the scene whose clip plays, silent ones too;
// one for each place that a Sound has, at most 16. [the browser's thread]
std::vector<Heard> heardIn(Browser& browser);

// Adds what plays to `stereo`: pairs of left and right samples, `rate` pairs a second. One channel
// goes to both sides; of more the first two are left and right. Linear between samples; beyond the
// end there is silence, or with loop the beginning.
void mix(const Playing& playing, const SoundLevels& levels, double rate, std::span<float> stereo);

} // namespace xvrml
