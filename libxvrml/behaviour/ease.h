// ease.h: a fraction that starts and stops smoothly. Pure function. [any thread]
#pragma once

#include <algorithm>

namespace xvrml {

// Returns the eased fraction of ISO/IEC 19775-1 19.4.4: it speeds up evenly during the part `out`
// of the interval, moves evenly, and slows down evenly during the part `in`. If out + in is above
// 1, both are scaled to that sum. Negative parts count as 0. t in [0,1].
inline float eased(float t, float out, float in) {
  const auto part = [](float given) { return given > 0 ? std::min(double(given), 1e9) : 0; };
  const double u = t;
  double first = part(out), last = part(in);
  if (const double sum = first + last; sum > 1) {
    first /= sum;
    last /= sum;
  }
  const double scale = 1 / (2 - first - last);
  if (u < first) return float(scale / first * u * u);
  if (u <= 1 - last) return float(scale * (2 * u - first));
  return float(1 - scale * (1 - u) * (1 - u) / last);
}

} // namespace xvrml
