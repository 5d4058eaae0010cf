#include "libpicture/live/preview_settings.h"

#include "libpicture/live/reconstruction.h"

namespace picture::live {

void drawFreshSamples(RenderSettings& settings, uint64_t number) {
  const uint32_t seed = uint32_t(settings.quality.whole(RT_SEED)) + uint32_t(number);
  settings.quality.set(RT_SEED, int32_t(seed & 0x7fffffff));
  settings.quality.set(RT_JITTER, 1);
}

void askForGuides(RenderSettings& settings) {
  settings.channels |= RT_RGBA | RT_SAMPLES | previewChannels;
  settings.quality.set(RT_FOLLOW_IMAGES, 1);
}

} // namespace picture::live
