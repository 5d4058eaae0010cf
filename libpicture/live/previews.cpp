#include "libpicture/live/previews.h"

#include <cmath>

namespace picture::live {

Picture Previews::rebuild(uint32_t viewer, const Picture& frame, const FrameCamera& camera,
                          int lightStride, const WorldStep& step, double denoising,
                          ShownSize shown) {
  Viewer& own = viewers_.of(viewer);
  try {
    if (!own.reconstruction)
      own.reconstruction = std::make_unique<Reconstruction>(threads_);
    else if (own.world != step.before)
      own.reconstruction->reset();
    own.world = step.now;
    const double cells = std::ceil(double(frame.width) / lightStride) *
                         std::ceil(double(frame.height) / lightStride);
    OidnFilter* const filter = oidn_.filterFor(own.denoised, cells, denoising);
    Picture rebuilt = own.reconstruction->add(frame, camera, lightStride, filter, shown);
    const Reconstruction::Facts& facts = own.reconstruction->facts();
    showing_ = facts.showing;
    denoisedBy_ = facts.denoised ? filter->name() : "";
    if (facts.denoised) oidn_.took(cells, facts.denoising);
    if (!facts.problem.empty()) oidn_.failed(facts.problem);
    return rebuilt;
  } catch (...) {
    forget(viewer);
    throw;
  }
}

} // namespace picture::live
