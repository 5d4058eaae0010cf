#include "run/scripted_view.h"

#include <algorithm>

#include "start/world_clock.h"

namespace vv {

ScriptedView::ScriptedView(const Options& options, xvrml::Browser& browser,
                           picture::Renderer& renderer, const picture::View& view)
    : options_(options), renderer_(renderer), view_(view), pilot_(browser, 0, options.view),
      replay_(pilot_, *options.script, [this](const InputEvent&, Action action) {
        if (action == Action::frameAll) frameAll();
        if (action == Action::beginAgain) present();
      }) {
  pilot_.setAspect(double(options.render.width) / options.render.height);
  if (options.render.linear && !options.denoise) pilot_.allowFalseColours(options.falseColour);
  if (pilot_.begin(view, options.viewpoint)) present();
  pilot_.animateTransitions();
}

double ScriptedView::instantOf(double time) const { return timeOfStep(time, options_.fps); }

picture::View ScriptedView::view() {
  picture::View view;
  view.shader = options_.view.shader;
  view.intrinsics = options_.view.intrinsics;
  view.viewer = pilot_.camera();
  renderer_.change([this](picture::RenderSettings& s) {
    const std::optional<bool> switched = pilot_.headlight();
    s.headlight = options_.render.headlight;
    s.view.exposure = std::clamp(options_.render.view.exposure + pilot_.exposure(),
                                 -picture::mostExposure, picture::mostExposure);
    if (switched)
      s.headlight =
          *switched ? xvrml::MapOptions::Headlight::on : xvrml::MapOptions::Headlight::off;
  });
  return view;
}

void ScriptedView::frameAll() {
  pilot_.frameAll(renderer_.cameraAround(pilot_.camera(), pilot_.aspect()));
}

void ScriptedView::present() {
  const std::optional<picture::View> view = pilot_.initialView(view_);
  if (!view) return frameAll();
  const picture::Renderer::Place place = renderer_.placeOf(*view);
  pilot_.present(place.camera, place.up);
}

} // namespace vv
