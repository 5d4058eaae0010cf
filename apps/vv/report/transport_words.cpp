#include "transport_words.h"

#include <fmt/format.h>

#include "libpicture/transport.h"

namespace vv {

namespace {

std::string followedBy(RTenum transport, const picture::RenderSettings& settings) {
  const char* shadows = settings.shadows ? "with shadows" : "without shadows";
  switch (transport) {
  case RT_TRANSPORT_DIRECT:
    return fmt::format("direct light from lamps and emitters, {}: exact at each point", shadows);
  case RT_TRANSPORT_WHITTED:
    return fmt::format(
        "direct light from lamps and emitters, {}, with its reflections and refractions at up to "
        "{} surfaces, down to the energy cut: exact at each point",
        shadows, settings.depth);
  case RT_TRANSPORT_PATH:
    return fmt::format("all light on paths of at most {} surfaces that can be sampled from the "
                       "camera: an unbiased estimate",
                       settings.depth);
  case RT_TRANSPORT_LIGHT:
    return fmt::format("all light on paths of at most {} surfaces, including light from lamps "
                       "through mirrors and lenses: an unbiased estimate",
                       settings.depth);
  case RT_TRANSPORT_AUTO: return "the engine did not report its transport";
  default: return "defined by the transport plug-in";
  }
}

} // namespace

std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings) {
  std::string claim = followedBy(stats.transport, settings);
  const auto left = picture::omittedLights(stats.transport, stats.transportLeavesOut);
  if (!left.empty()) {
    claim += "; not included:";
    for (size_t i = 0; i < left.size(); ++i)
      claim += fmt::format("{} {}", i ? "," : "", left[i].text);
  } else if (stats.transport >= RT_TRANSPORT_DIRECT && stats.transport <= RT_TRANSPORT_LIGHT) {
    claim += "; no other light is missing";
  }
  constexpr double negligible = .001; // errors are relative to colour + .03
  if (stats.errorUnmet > negligible)
    claim += fmt::format(
        "; too few paths through mirrors or glass have hit the brightest emitter: on average a "
        "pixel may lack radiance of up to {:.2g}, which more samples would show",
        stats.errorUnmet);
  if (settings.clamp > 0)
    claim += fmt::format("; samples are clamped to {}, which removes light", settings.clamp);
  return claim;
}

} // namespace vv
