// sound.cpp: computes the loudness of sounds and mixes them for xvrml/media.h (clause 6.42).

#include <algorithm>
#include <cmath>

#include "geometry/matrix.h"
#include "xvrml/media.h"

namespace xvrml {
namespace {

// Returns the distance, at an angle to the direction, from the location to the ellipsoid that
// reaches `front` ahead and `back` behind. The location is a focus of the ellipsoid. With a =
// (front + back) / 2 and c = (front - back) / 2 the polar form is (a^2 - c^2) / (a - c cosine).
double radius(double front, double back, double cosine) {
  if (!(front > 0 && back > 0)) return 0;
  return 2 * front * back / (front + back - (front - back) * cosine);
}

struct Distances {
  double viewer = 0, inner = 0, outer = 0; // from the location towards the viewer
};
Distances distances(const nodes::Sound& sound, const Vec3f& viewer) {
  const Vector way = vector(viewer) - vector(sound.location), direction = vector(sound.direction);
  const double length = way.length(), product = length * direction.length();
  const double cosine = product > 0 ? std::clamp(way.dot(direction) / product, -1.0, 1.0) : 1;
  return {length, radius(sound.minFront, sound.minBack, cosine),
          radius(sound.maxFront, sound.maxBack, cosine)};
}

// Returns the linearly interpolated sample of one channel. place: position in frames.
double sampleAt(const Clip& clip, double place, int channel, bool loop) {
  const size_t frames = clip.frames(), at = size_t(place), next = at + 1 < frames ? at + 1 : 0;
  const double a = clip.samples[at * size_t(clip.channels) + size_t(channel)];
  const double b =
      next == 0 && !loop ? 0 : clip.samples[next * size_t(clip.channels) + size_t(channel)];
  return a + (b - a) * (place - double(at));
}

} // namespace

double soundGain(const nodes::Sound& sound, const Vec3f& viewer) {
  const Distances d = distances(sound, viewer);
  const double intensity = std::clamp(double(sound.intensity), 0.0, 1.0);
  if (!std::isfinite(d.viewer)) return 0;
  if (d.viewer <= d.inner) return intensity;
  if (!(d.outer > d.inner) || d.viewer > d.outer) return 0;
  // -20 dB at the outer ellipsoid
  return intensity * std::pow(10, -(d.viewer - d.inner) / (d.outer - d.inner));
}

SoundLevels soundLevels(const nodes::Sound& sound, const Vec3f& viewer, const Vec3f& fromViewer) {
  const double gain = soundGain(sound, viewer);
  const double away = vector(fromViewer).length();
  if (!sound.spatialize || !(away > 0) || gain == 0) return {gain, gain};
  const Distances d = distances(sound, viewer);
  const double inside = d.inner > 0 ? std::min(1.0, d.viewer / d.inner) : 1;
  const double angle = (fromViewer.x / away * inside + 1) * M_PI / 4; // 0: left, pi/2: right
  // Straight ahead both equal the gain, as without a direction.
  return {gain * std::sqrt(2) * std::cos(angle), gain * std::sqrt(2) * std::sin(angle)};
}

void mix(const Playing& playing, const SoundLevels& levels, double rate, std::span<float> stereo) {
  if (!playing.clip || playing.clip->frames() == 0 || !(rate > 0) || !(playing.pitch > 0)) return;
  const Clip& clip = *playing.clip;
  const double frames = double(clip.frames()), step = clip.rate * playing.pitch / rate;
  double place = playing.position * clip.rate;
  if (!(place >= 0) || !std::isfinite(step)) return;
  for (size_t i = 0; i + 1 < stereo.size(); i += 2, place += step) {
    if (place >= frames) {
      if (!playing.loop) return;
      place = std::fmod(place, frames);
    }
    stereo[i] += float(levels.left * sampleAt(clip, place, 0, playing.loop));
    stereo[i + 1] +=
        float(levels.right * sampleAt(clip, place, std::min(1, clip.channels - 1), playing.loop));
  }
}

} // namespace xvrml
