// viewing.h: helpers for tests of the viewer: the position of the camera as text, and the names of
// bound nodes.
#pragma once

#include <cmath>

#include "conformance/events/support.h"

namespace xvrml {

inline double tidy(double v) { return std::abs(v) < 5e-6 ? 0 : std::round(v * 1e5) / 1e5; }

// Returns "x y z" of the eye, and of its viewing direction, with at most five decimals.
inline std::string eyeOf(const Browser& browser) {
  const CameraSettings c = browser.camera(1);
  return fmt::format("{:g} {:g} {:g}", tidy(c.matrix[12]), tidy(c.matrix[13]), tidy(c.matrix[14]));
}
inline std::string lookOf(const Browser& browser) {
  const CameraSettings c = browser.camera(1);
  return fmt::format("{:g} {:g} {:g}", tidy(-c.matrix[8]), tidy(-c.matrix[9]), tidy(-c.matrix[10]));
}
inline std::string nameOf(const Node* node) { return node ? node->defName : "none"; }

} // namespace xvrml
