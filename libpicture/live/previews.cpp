#include "libpicture/live/previews.h"

#include <algorithm>

namespace picture::live {

Previews::Viewer& Previews::viewerOf(uint32_t viewer) {
  if (!viewers_.contains(viewer) && viewers_.size() >= mostViewers) {
    const auto older = [](const auto& a, const auto& b) { return a.second.used < b.second.used; };
    viewers_.erase(std::min_element(viewers_.begin(), viewers_.end(), older));
  }
  Viewer& found = viewers_[viewer];
  found.used = ++uses_;
  return found;
}

Picture Previews::rebuild(uint32_t viewer, const Picture& frame, const FrameCamera& camera,
                          int lightStride, const WorldStep& step) {
  Viewer& own = viewerOf(viewer);
  try {
    if (!own.reconstruction)
      own.reconstruction = std::make_unique<Reconstruction>(threads_);
    else if (own.world != step.before)
      own.reconstruction->reset();
    own.world = step.now;
    return own.reconstruction->add(frame, camera, lightStride);
  } catch (...) {
    forget(viewer);
    throw;
  }
}

} // namespace picture::live
