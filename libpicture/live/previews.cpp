#include "libpicture/live/previews.h"

namespace picture::live {

Picture Previews::rebuild(uint32_t viewer, const Picture& frame, const FrameCamera& camera,
                          int lightStride, const WorldStep& step) {
  Viewer& own = viewers_.of(viewer);
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
