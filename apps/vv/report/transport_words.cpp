#include "transport_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "libpicture/transport.h"

namespace vv {

namespace {

std::string followedBy(const RTtransportInfo& transport, const picture::RenderSettings& settings) {
  if (!transport.claim) return "defined by the transport plug-in";
  const char* shadows = settings.quality.whole(RT_SHADOWS) ? "with shadows" : "without shadows";
  return fmt::format(fmt::runtime(transport.claim),
                     fmt::arg("depth", settings.quality.whole(RT_MAX_DEPTH)),
                     fmt::arg("shadows", shadows));
}

} // namespace

std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings) {
  const RTtransportInfo transport = picture::transportInfo(stats.transport.chosen);
  std::string claim = followedBy(transport, settings);
  const auto left = picture::omittedLights(stats.transport.chosen, stats.transport.leavesOut);
  if (!left.empty()) {
    claim += "; not included:";
    for (size_t i = 0; i < left.size(); ++i)
      claim += fmt::format("{} {}", i ? "," : "", left[i].text);
  } else if (transport.claim && stats.transport.chosen != RT_TRANSPORT_AUTO) {
    claim += "; no other light is missing";
  }
  constexpr double negligible = .001; // errors are relative to colour + .03
  if (stats.error.unmet > negligible)
    claim += fmt::format(
        "; too few paths through mirrors or glass have hit the brightest emitter: on average a "
        "pixel may lack radiance of up to {:.2g}, which more samples would show",
        stats.error.unmet);
  if (const double clamp = settings.quality[RT_CLAMP]; clamp > 0)
    claim += fmt::format("; samples are clamped to {}, which removes light", clamp);
  return claim;
}

nlohmann::ordered_json transportJson(const RTstats& stats,
                                     const picture::RenderSettings& settings) {
  return {{"chosen", picture::transportName(stats.transport.chosen)},
          {"reason", stats.transport.reason},
          {"claim", transportClaim(stats, settings)},
          {"leaves_out", picture::omittedLightNames(stats)}};
}

} // namespace vv
