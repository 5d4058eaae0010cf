#include "transport_words.h"

#include <fmt/format.h>

#include "libpicture/transport.h"

namespace vv {

namespace {

std::string followedBy(RTenum transport, const picture::RenderSettings& settings) {
  const int depth = settings.quality.whole(RT_MAX_DEPTH);
  const char* shadows = settings.quality.whole(RT_SHADOWS) ? "with shadows" : "without shadows";
  switch (transport) {
  case RT_TRANSPORT_DIRECT:
    return fmt::format("light straight from lamps and emitters, {}: exact at each place", shadows);
  case RT_TRANSPORT_WHITTED:
    return fmt::format("light straight from lamps and emitters, {}, with its reflections and "
                       "refractions as far as {} surfaces and the energy cut: exact at each place",
                       shadows, depth);
  case RT_TRANSPORT_PATH:
    return fmt::format("all light on ways of at most {} surfaces that paths from the camera can "
                       "find: an unbiased estimate",
                       depth);
  case RT_TRANSPORT_LIGHT:
    return fmt::format("all light on ways of at most {} surfaces, what lamps send through mirrors "
                       "and lenses included: an unbiased estimate",
                       depth);
  case RT_TRANSPORT_AUTO: return "the engine has not said how light was followed";
  default: return "what the transport plug-in claims";
  }
}

} // namespace

std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings) {
  std::string claim = followedBy(stats.transport, settings);
  const auto left = picture::omittedLights(stats.transport, stats.transportLeavesOut);
  if (!left.empty()) {
    claim += "; left out:";
    for (size_t i = 0; i < left.size(); ++i)
      claim += fmt::format("{} {}", i ? "," : "", left[i].text);
  } else if (stats.transport >= RT_TRANSPORT_DIRECT && stats.transport <= RT_TRANSPORT_LIGHT) {
    claim += "; no other light is left out";
  }
  constexpr double negligible = .001; // errors are relative to colour + .03
  if (stats.errorUnmet > negligible)
    claim += fmt::format("; of the paths that only chance leads by way of mirrors or glass to an "
                         "emitter few have met the brightest one: on average a pixel may lack "
                         "radiance of up to {:.2g}, which more samples tell",
                         stats.errorUnmet);
  if (const double clamp = settings.quality[RT_CLAMP]; clamp > 0)
    claim += fmt::format("; samples are cut at {}, which takes light away", clamp);
  return claim;
}

} // namespace vv
