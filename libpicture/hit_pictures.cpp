#include "libpicture/hit_pictures.h"

#include <utility>

#include "libpicture/stage.h"

namespace picture {

namespace {

RenderSettings settingsOf(RenderSettings settings) {
  settings.quality.set(RT_TRANSPORT, RT_TRANSPORT_PATH);
  settings.cluster = nullptr;
  settings.record.clear();
  settings.keepSums = false;
  settings.error = 0;
  settings.channels = RT_RGBA;
  return settings;
}

} // namespace

HitPictures::HitPictures(xvrml::World& world, const RenderSettings& settings)
    : before_(rtGetCurrent()),
      stage_(std::make_unique<Stage>(world, nullptr, settingsOf(settings))) {
  stage_->lightSamples = false;
  stage_->open();
}

HitPictures::~HitPictures() {
  stage_->close();
  rtMakeCurrent(before_);
}

std::vector<float> HitPictures::render(const View& view, int seed) {
  stage_->settings.quality.set(RT_SEED, seed);
  stage_->prepare(view);
  stage_->setUpFrame();
  rtRender();
  throwOnError("rendering");
  stage_->reportMessages();
  Picture picture;
  stage_->readChannels(stage_->settings, picture);
  return std::move(picture.planes[RT_RGBA]);
}

} // namespace picture
