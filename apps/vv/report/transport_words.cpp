#include "transport_words.h"

#include <fmt/format.h>

#include "libpicture/transport.h"

namespace vv {

namespace {

std::string followedBy(const RTtransportInfo& transport, const picture::RenderSettings& settings) {
  if (!transport.claim) return "what the transport plug-in claims";
  return fmt::format(fmt::runtime(transport.claim), fmt::arg("depth", settings.depth),
                     fmt::arg("shadows", settings.shadows ? "with shadows" : "without shadows"));
}

} // namespace

std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings) {
  const RTtransportInfo transport = picture::transportInfo(stats.transport);
  std::string claim = followedBy(transport, settings);
  const auto left = picture::omittedLights(stats.transport, stats.transportLeavesOut);
  if (!left.empty()) {
    claim += "; left out:";
    for (size_t i = 0; i < left.size(); ++i)
      claim += fmt::format("{} {}", i ? "," : "", left[i].text);
  } else if (transport.claim && stats.transport != RT_TRANSPORT_AUTO) {
    claim += "; no other light is left out";
  }
  constexpr double negligible = .001; // errors are relative to colour + .03
  if (stats.errorUnmet > negligible)
    claim += fmt::format("; of the paths that only chance leads by way of mirrors or glass to an "
                         "emitter few have met the brightest one: on average a pixel may lack "
                         "radiance of up to {:.2g}, which more samples tell",
                         stats.errorUnmet);
  if (settings.clamp > 0)
    claim += fmt::format("; samples are cut at {}, which takes light away", settings.clamp);
  return claim;
}

} // namespace vv
