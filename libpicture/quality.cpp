#include "libpicture/quality.h"

#include <sstream>

#include <fmt/format.h>

namespace picture {

RTqualityInfo qualityInfo(RTenum quality) {
  RTqualityInfo info{};
  info.size = sizeof info;
  for (int i = 0; rtGetQualityInfo(i, &info); ++i)
    if (info.quality == quality) return info;
  return {};
}

std::string qualityRange(RTenum quality) {
  const RTqualityInfo info = qualityInfo(quality);
  return fmt::format("a {}number from {:.10g} to {:.10g}", info.isReal ? "" : "whole ",
                     info.minimum, info.maximum);
}

std::vector<std::string> qualityChoices(RTenum quality) {
  const RTqualityInfo info = qualityInfo(quality);
  std::istringstream words(info.choices ? info.choices : "");
  std::vector<std::string> names;
  for (std::string name; words >> name;) names.push_back(name);
  return names;
}

} // namespace picture
