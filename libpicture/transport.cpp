#include "libpicture/transport.h"

#include <utility>

#include "libpicture/quality.h"

namespace picture {

namespace {

// Returns the names, indexed by RT_TRANSPORT_*.
const std::vector<std::string>& names() {
  static const std::vector<std::string> choices = qualityChoices(RT_TRANSPORT);
  return choices;
}

} // namespace

const char* transportName(RTenum transport) {
  return transport < names().size() ? names()[transport].c_str() : "plug-in";
}

RTtransportInfo transportInfo(RTenum transport) {
  RTtransportInfo info{};
  info.size = sizeof info;
  return rtGetTransportInfo(transport, &info) ? info : RTtransportInfo{};
}

std::vector<OmittedLight> omittedLights(RTenum transport, uint32_t leaves) {
  static constexpr std::pair<uint32_t, OmittedLight> table[] = {
      {RT_LEAVES_IMAGES, {"mirror_images", "reflections in mirrors and the view through glass"}},
      {RT_LEAVES_BETWEEN, {"interreflection", "light between surfaces"}},
      {RT_LEAVES_EMITTERS, {"emitters", "light of emitters on other surfaces"}},
      {RT_LEAVES_SKY, {"sky", "light of the sky on surfaces"}},
      {RT_LEAVES_CAUSTICS,
       {"caustics", "light from point and directional lamps through mirrors or glass"}},
  };
  std::vector<OmittedLight> list;
  for (const auto& [bit, left] : table)
    if (leaves & bit) list.push_back(left);
  if (transportInfo(transport).tracesLamps && (leaves & RT_LEAVES_CAUSTICS))
    list.back().text = "light from point and directional lamps through mirrors or glass, where it "
                       "is itself seen through them";
  return list;
}

std::vector<std::string> omittedLightNames(const RTstats& stats) {
  std::vector<std::string> names;
  for (const OmittedLight& left : omittedLights(stats.transport.chosen, stats.transport.leavesOut))
    names.emplace_back(left.name);
  return names;
}

} // namespace picture
