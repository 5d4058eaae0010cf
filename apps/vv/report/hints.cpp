#include "hints.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "libpicture/transport.h"

namespace vv {

namespace {

using Headlight = xvrml::MapOptions::Headlight;

// Renders a picture with one sample per pixel, then restores the renderer's settings.
picture::RenderResult probe(const picture::View& view, picture::Renderer& renderer,
                            Headlight headlight) {
  picture::RenderSettings before;
  renderer.change([&](picture::RenderSettings& s) {
    before = s;
    s.samples = 1;
    s.error = 0;
    s.preview = false;
    s.channels = RT_RGBA | RT_DEPTH;
    s.headlight = headlight;
  });
  picture::RenderResult result = renderer.render(view);
  renderer.change([&](picture::RenderSettings& s) { s = before; });
  return result;
}

struct Seen {
  bool anything = true; // some pixel shows a shape
  bool black = true;    // no pixel that shows a shape is brighter than black
};

Seen lookAt(const picture::RenderResult& probe) {
  const auto depth = probe.picture.planes.find(RT_DEPTH);
  if (probe.interrupted || depth == probe.picture.planes.end()) return {true, false};
  const std::vector<uint8_t> bytes = picture::displayBytes(probe.picture);
  Seen seen{false, true};
  for (size_t i = 0; i < depth->second.size(); ++i) {
    if (!std::isfinite(depth->second[i])) continue;
    seen.anything = true;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) seen.black = seen.black && bytes[k] <= 1;
  }
  return seen;
}

} // namespace

bool showsNothing(const picture::Picture& picture) {
  if (!picture.planes.contains(RT_RGBA)) return false;
  const std::vector<uint8_t> bytes = picture::displayBytes(picture);
  for (size_t i = 3; i < bytes.size(); ++i)
    if (std::abs(int(bytes[i]) - int(bytes[i - 3])) > 1) return false;
  return !bytes.empty();
}

bool mayBeUnlit(const Options& options, const picture::RenderResult& result) {
  return result.stats.scene.lights == 0 && result.picture.planes.contains(RT_RGBA) &&
         (options.render.background.kind == picture::Background::Kind::colour ||
          options.render.background.kind == picture::Background::Kind::backdrop);
}

std::string tooBrightHint(const picture::Picture& picture) {
  constexpr double many = 0.5, white = 1.02;
  if (!picture.linear || picture.view.curve != picture::ViewCurve::standard ||
      !picture.planes.contains(RT_RGBA))
    return {};
  const std::vector<float>& rgba = picture::rgbaOf(picture);
  const double scale = std::exp2(picture.view.exposure);
  size_t bright = 0;
  for (size_t i = 0; i < rgba.size(); i += 4)
    if (scale * (0.2126 * rgba[i] + 0.7152 * rgba[i + 1] + 0.0722 * rgba[i + 2]) > white) ++bright;
  const double share = double(bright) / double(std::max<size_t>(rgba.size() / 4, 1));
  if (share < many) return {};
  return fmt::format("{:.0f} % of the pixels are brighter than white: --exposure auto, or --view "
                     "filmic, shows what is there",
                     100 * share);
}

std::string hintFor(const Options& options, const picture::View& view,
                    const picture::RenderResult& result, picture::Renderer& renderer) {
  const xvrml::Bounds bounds = renderer.bounds();
  const auto empty = [&](const char* why) {
    return fmt::format("warning: {}: {}; the picture shows only the background", options.input,
                       why);
  };
  if (bounds.empty) return empty("no shape to draw");
  const bool isPoint = std::equal(bounds.minimum, bounds.minimum + 3, bounds.maximum);
  if (isPoint && result.map.triangles > 0) return empty("all shapes are scaled down to a point");
  // The mapper has warned of a camera that stands too far away (OpenRTMapper::Impl::useCamera).
  const double* place = result.camera.matrix + 12;
  if (!(std::hypot(place[0], place[1], place[2]) <= 1e17)) return {};
  const Seen seen = lookAt(probe(view, renderer, options.render.headlight));
  if (!seen.anything) {
    if (isPoint) // a point of a PointSet, or spheres without a size
      return "all of the world is at one point, and nothing of it is in view from here";
    const size_t viewpoints = renderer.viewpoints().size();
    const bool chosen = view.lookAt || view.pinhole || viewpoints > 0;
    if (options.render.crop.width > 0) return "nothing is in view in this part of the picture";
    if (view.fit || view.side || !chosen)
      return "nothing is in view, although the camera is on all of the world: its shapes are "
             "smaller "
             "than a pixel from here, or show only backs, which are not drawn";
    return fmt::format(
        "nothing is in view from here: --fit shows all of the world{}",
        viewpoints > 1 ? fmt::format(", --viewpoint one of its {} viewpoints", viewpoints) : "");
  }
  // Black shapes may be intended: suggest an option only if it makes them brighter.
  if (!seen.black || lookAt(probe(view, renderer, Headlight::on)).black) return {};
  const std::string black =
      showsNothing(result.picture) ? "the picture is black: " : "all shapes in view are black: ";
  if (result.stats.scene.lights == 0) {
    constexpr uint32_t other = RT_LEAVES_EMITTERS | RT_LEAVES_SKY;
    const RTenum transport = result.stats.transport.chosen;
    for (const picture::OmittedLight& left :
         picture::omittedLights(transport, result.stats.transport.leavesOut & other))
      return black + fmt::format("the world has no lamp, and --transport {} leaves out {}; "
                                 "--transport path",
                                 picture::transportName(transport), left.text);
    return black + "the world has no light and its headlight is off; --headlight on";
  }
  return black + "no light reaches what is in view; --headlight on adds one at the camera";
}

} // namespace vv
