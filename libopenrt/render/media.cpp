#include "render/media.h"

#include <algorithm>
#include <cmath>

namespace openrt {

Crossing cross(const MediaStack& stack, uint16_t medium, bool back,
               std::span<const RtsMedium> media) {
  Crossing c{stack, mediumOf(stack, media), 0, true, false};
  if (back) {
    const auto last = std::find(c.behind.rbegin(), c.behind.rend(), medium);
    c.unknown = last == c.behind.rend();
    if (!c.unknown) {
      std::rotate(last.base() - 1, last.base(), c.behind.end());
      c.behind.back() = 0;
    }
    c.to = mediumOf(c.behind, media);
    c.visible = !c.to || media[c.to - 1].priority <= media[medium - 1].priority;
    if (c.unknown || c.visible) c.from = medium;
    return c;
  }
  c.visible = !c.from || media[c.from - 1].priority <= media[medium - 1].priority;
  if (const auto free = std::find(c.behind.begin(), c.behind.end(), uint16_t(0));
      free != c.behind.end())
    *free = medium;
  c.to = medium;
  return c;
}

void absorb(uint16_t medium, float length, std::span<const RtsMedium> media, Vec3f& colour) {
  if (!medium) return;
  for (int k = 0; k < 3; k++) {
    const float a = extinctionOf(media[medium - 1], k);
    if (a != 0) colour[k] *= std::exp(-a * length);
  }
}

} // namespace openrt
