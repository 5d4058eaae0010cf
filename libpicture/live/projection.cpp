#include "libpicture/live/projection.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace picture::live {

Projection::Projection(const FrameCamera& given) : camera(given) {
  const xvrml::CameraSettings& settings = given.settings;
  for (int axis = 0; axis < 3; axis++) {
    for (int k = 0; k < 3; k++) rotation[axis][k] = float(settings.matrix[4 * axis + k]);
    const double place = settings.matrix[12 + axis];
    eye[axis] = float(place);
    eyeRest[axis] = float(place - double(eye[axis]));
  }
  parallel = settings.fovy == 0;
  const double height = parallel ? settings.height : 2 * std::tan(settings.fovy / 2);
  perHeight = float(1 / height);
  scale[0] = float(1 / (height * given.aspect));
  scale[1] = -float(1 / height);
  const auto finite = [](auto& numbers) {
    return std::all_of(std::begin(numbers), std::end(numbers),
                       [](float v) { return std::isfinite(v); });
  };
  usable = !settings.shader && height > 0 && given.aspect > 0 && finite(scale) && finite(eye) &&
           finite(eyeRest) && finite(rotation[0]) && finite(rotation[1]) && finite(rotation[2]);
}

bool areEqual(const FrameCamera& a, const FrameCamera& b) {
  return a.settings == b.settings && a.aspect == b.aspect;
}

} // namespace picture::live
