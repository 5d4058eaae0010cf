// hints.cpp: see hints.h.
#include "hints.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vv {

namespace {

constexpr const char* black = "the picture is black: ";

bool anythingInView(const Options& options, const picture::View& view, picture::Renderer& renderer) {
  renderer.change([](picture::RenderSettings& s) {
    s.samples = 1;
    s.error = 0;
    s.channels = RT_RGBA | RT_DEPTH;
  });
  const picture::RenderResult probe = renderer.render(view);
  renderer.change([&](picture::RenderSettings& s) {
    s.samples = options.render.samples;
    s.error = options.render.error;
    s.channels = options.render.channels;
  });
  const auto depth = probe.picture.planes.find(RT_DEPTH);
  if (probe.interrupted || depth == probe.picture.planes.end()) return true;
  return std::any_of(depth->second.begin(), depth->second.end(), [](float d) { return std::isfinite(d); });
}

} // namespace

bool showsNothing(const picture::Picture& picture) {
  if (!picture.planes.contains(RT_RGBA)) return false;
  const std::vector<uint8_t> bytes = picture::displayBytes(picture);
  for (size_t i = 3; i < bytes.size(); ++i)
    if (std::abs(int(bytes[i]) - int(bytes[i - 3])) > 1) return false;
  return !bytes.empty();
}

std::string hintFor(const Options& options, const picture::View& view, const picture::RenderResult& result,
                    picture::Renderer& renderer) {
  if (renderer.bounds().empty) return "there is nothing to see: the world has no shapes that could be drawn";
  if (!anythingInView(options, view, renderer)) {
    const size_t viewpoints = renderer.viewpoints().size();
    return fmt::format("nothing is in view from here: --fit shows all of the world{}",
                       viewpoints > 1 ? fmt::format(", --viewpoint one of its {} viewpoints", viewpoints) : "");
  }
  const std::vector<uint8_t> bytes = picture::displayBytes(result.picture);
  if (std::any_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte > 1; })) return {};
  if (options.render.headlight == xvrml::MapOptions::Headlight::on) return {};
  if (result.stats.lights == 0) return std::string(black) + "the world has no light and its headlight is off; --headlight on";
  return std::string(black) + "no light reaches what is in view; --headlight on adds one at the camera";
}

} // namespace vv
