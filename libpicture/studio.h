// studio.h: Lights a model as in a photographer's studio: soft boxes all around, a backdrop, and a
// ground that catches the model's shadow. The lights stand where the camera stands, so that in a
// turntable the model turns. [the context's thread]
#pragma once

#include <array>
#include <vector>

#include "openrt/openrt.h"
#include "xvrml/mapper.h"

namespace picture {

struct Studio {
  bool on = false;
  // display values from 0 to 1 (sRGB-encoded) of the backdrop and of the ground in full light
  std::array<float, 3> backdrop{};
  bool operator==(const Studio&) const = default;
};

// The radiance of the studio from all around, as EnvironmentMap wants it: rows from the bottom,
// linear RGB. +y is up, the camera is at +z. The lower half is the backdrop.
struct StudioLight {
  int width = 0, height = 0;
  std::vector<float> rgb;
  std::array<double, 3> groundReflectance{}; // with it the ground has the radiance of the backdrop
};
StudioLight makeStudioLight(const std::array<float, 3>& backdrop, bool linear);

// Puts the studio into the current context. It owns a shader, a texture and an object of it.
class StudioSet {
 public:
  // Sets up the studio for this camera. `up`: the model's up axis. The ground is left out if the
  // camera is below it; the light then comes from below.
  void place(const Studio& studio, bool linear, const xvrml::CameraSettings& camera,
             const xvrml::Bounds& bounds, xvrml::Axis up);
  // Deletes what it has made. The context must be current.
  void clear();
  // Forgets what it has made, because the context is gone.
  void forget() { *this = StudioSet(); }

 private:
  RTid environment_ = 0, texture_ = 0, groundShader_ = 0, ground_ = 0, instance_ = 0;
  Studio made_;
  std::array<double, 16> placed_{}; // matrix of the ground
};

} // namespace picture
