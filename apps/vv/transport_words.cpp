// transport_words.cpp: see transport_words.h.
#include "transport_words.h"

#include <fmt/format.h>

namespace vv {

namespace {

std::string claimOf(RTenum transport, const picture::RenderSettings& settings) {
  const char* shadows = settings.shadows ? "with shadows" : "without shadows";
  switch (transport) {
  case RT_TRANSPORT_DIRECT:
    return fmt::format(
        "light straight from the lamps, {}: exact at each place; mirror images and light between surfaces are left out", shadows);
  case RT_TRANSPORT_WHITTED:
    return fmt::format(
        "light straight from the lamps, {}, with all its reflections and refractions as far as {} surfaces and the "
        "energy cut: exact at each place; light between surfaces is left out",
        shadows, settings.depth);
  case RT_TRANSPORT_PATH:
    return fmt::format("all light on ways of at most {} surfaces that paths from the camera can find: an unbiased estimate",
                       settings.depth);
  case RT_TRANSPORT_LIGHT:
    return fmt::format(
        "all light on ways of at most {} surfaces, what lamps send through mirrors and lenses included: an unbiased "
        "estimate",
        settings.depth);
  case RT_TRANSPORT_AUTO: return "the engine has not said how light was followed";
  default: return "what the transport plug-in claims";
  }
}

} // namespace

std::string transportClaim(RTenum transport, const picture::RenderSettings& settings) {
  std::string claim = claimOf(transport, settings);
  if (settings.clamp > 0) claim += fmt::format("; samples are cut at {}, which takes light away", settings.clamp);
  return claim;
}

} // namespace vv
