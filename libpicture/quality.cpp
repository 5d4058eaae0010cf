#include "libpicture/quality.h"

#include <algorithm>
#include <span>
#include <sstream>

#include <fmt/format.h>

namespace picture {

const std::vector<RTqualityInfo>& qualityTable() {
  static const std::vector<RTqualityInfo> table = [] {
    std::vector<RTqualityInfo> rows;
    RTqualityInfo info{};
    info.size = sizeof info;
    for (int i = 0; rtGetQualityInfo(i, &info); ++i) rows.push_back(info);
    return rows;
  }();
  return table;
}

RTqualityInfo qualityInfo(RTenum quality) {
  for (const RTqualityInfo& info : qualityTable())
    if (info.quality == quality) return info;
  return {};
}

std::string qualityRange(RTenum quality) {
  const RTqualityInfo info = qualityInfo(quality);
  if (info.maximum > 1e30) return fmt::format("a number of at least {:.10g}", info.minimum);
  return fmt::format("a {}number from {:.10g} to {:.10g}", info.isReal ? "" : "whole ",
                     info.minimum, info.maximum);
}

std::string qualityFault(const RTqualityInfo& info, std::string_view name, double value) {
  return fmt::format("{}: {:.10g} to {:.10g}{} expected, not {:.10g}", name, info.minimum,
                     info.maximum, info.zeroIsAuto ? ", or 0," : "", value);
}

std::vector<std::string> qualityChoices(RTenum quality) {
  const RTqualityInfo info = qualityInfo(quality);
  std::istringstream words(info.choices ? info.choices : "");
  std::vector<std::string> names;
  for (std::string name; words >> name;) names.push_back(name);
  return names;
}

std::string qualityChoiceList(RTenum quality) {
  const std::vector<std::string> names = qualityChoices(quality);
  const std::span<const std::string> all(names);
  return fmt::format("{} or {}", fmt::join(all.first(all.size() - 1), ", "), all.back());
}

std::optional<int> qualityNamed(RTenum quality, std::string_view name) {
  const std::vector<std::string> names = qualityChoices(quality);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return int(qualityInfo(quality).minimum) + int(found - names.begin());
}

bool isSwitch(RTenum quality) {
  const RTqualityInfo info = qualityInfo(quality);
  return info.choices && info.choices == std::string_view("off on");
}

QualityValues::QualityValues() {
  for (const RTqualityInfo& info : qualityTable()) values_[info.quality] = info.defaultValue;
}

void applyQuality(const QualityValues& values) {
  for (const RTqualityInfo& info : qualityTable()) {
    if (info.quality == RT_FRAMES_IN_FLIGHT || info.quality == RT_PATIENCE) continue;
    if (info.isReal)
      rtQualityf(info.quality, values[info.quality]);
    else
      rtQuality(info.quality, values.whole(info.quality));
  }
}

} // namespace picture
