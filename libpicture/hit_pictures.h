// hit_pictures.h: Renders pictures whose paths take no light samples and find emitters by hitting
// them alone (lightsamples=off of rtNewContext), to check what light samples find. [one thread]
#pragma once

#include <memory>
#include <vector>

#include "libpicture/renderer.h"

namespace picture {

class HitPictures {
 public:
  // Maps the world into a context of its own, on this machine. Throws RenderError. The world must
  // outlive this object and must not change.
  HitPictures(xvrml::World& world, const RenderSettings& settings);
  ~HitPictures();
  HitPictures(const HitPictures&) = delete;
  HitPictures& operator=(const HitPictures&) = delete;

  // Returns RT_RGBA of a picture with the samples of the settings. Throws RenderError.
  std::vector<float> render(const View& view, int seed);

 private:
  RTcontext before_; // the context that was current
  std::unique_ptr<class Stage> stage_;
};

} // namespace picture
