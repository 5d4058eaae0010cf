#include "server/flow.h"

#include <cmath>

namespace vv::server {

PictureSize pictureSizeFor(int width, int height, double most) {
  const double w = std::max(width, 1), h = std::max(height, 1);
  const double scale =
      std::min({1.0, maxPictureSide / w, maxPictureSide / h, std::sqrt(most / (w * h))});
  return {std::max(1, int(w * scale)), std::max(1, int(h * scale))};
}

} // namespace vv::server
