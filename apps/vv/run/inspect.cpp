#include "run/inspect.h"

#include "report/explain.h"
#include "report/node_list.h"
#include "report/report.h"

namespace vv {

picture::RenderSettings withoutPicture(picture::RenderSettings settings) {
  settings.backend = "null";
  settings.record.clear();
  settings.cluster.reset();
  return settings;
}

std::string inspectWorld(const Options& options, xvrml::Browser& browser) {
  picture::Renderer renderer(browser, withoutPicture(options.render));
  const picture::Renderer::Place place = renderer.placeOf(options.view);
  return describeWorld(browser.world(), renderer.viewpoints(), renderer.bounds(),
                       {picture::axisName(place.up), place.reason}, options.running.scriptPath,
                       options.json);
}

// Renders a picture of a single pixel, because the engine chooses the transport when it renders.
std::string inspectObjects(const Options& options, xvrml::Browser& browser) {
  picture::RenderSettings settings = options.render;
  settings.record.clear();
  settings.cluster.reset();
  settings.width = settings.height = settings.samples = 1;
  settings.channels = RT_RGBA;
  settings.error = settings.timeLimit = 0;
  picture::Renderer renderer(browser, settings);
  const picture::RenderResult result = renderer.render(options.view);
  return explainWorld(options, browser.world(), result.stats, renderer.explain());
}

std::string inspectNodes(const Options& options, xvrml::Browser& browser) {
  return listNodes(&browser.world(), options.json);
}

std::string inspectViewpoints(const Options& options, xvrml::Browser& browser) {
  picture::Renderer renderer(browser, withoutPicture(options.render));
  return listViewpoints(renderer.viewpoints(), options.json);
}

} // namespace vv
