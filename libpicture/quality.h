// quality.h: the library's table of quality settings (rtGetQualityInfo) for the command line and
// Python, and the values that a picture has for them. [any thread, except applyQuality]
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

// Returns all settings, in the order of the library's table.
const std::vector<RTqualityInfo>& qualityTable();
// Returns what the library knows about a setting (RT_SAMPLES_PER_PIXEL ...).
RTqualityInfo qualityInfo(RTenum quality);
// Returns "a whole number from 1 to 65536" or "a number from 0 to 1", for messages.
std::string qualityRange(RTenum quality);

// Returns "depth: 0 to 10000 expected, not -1", as the messages of rtQuality and rtQualityf. name:
// the setting's name for the user.
std::string qualityFault(const RTqualityInfo& info, std::string_view name, double value);

// Returns the names of a setting's values, for example "auto", "direct" and so on for RT_TRANSPORT.
std::vector<std::string> qualityChoices(RTenum quality);
// Returns "auto, direct, whitted, path or light", for messages.
std::string qualityChoiceList(RTenum quality);
// Returns the value with this name; nothing if no value has it.
std::optional<int> qualityNamed(RTenum quality, std::string_view name);
// Tells whether the values of a setting are 0 and 1 and are named off and on.
bool isSwitch(RTenum quality);

// Holds a value for each setting of the table. Each is the library's default at first. The values
// are not checked.
class QualityValues {
 public:
  QualityValues();
  // Throw std::out_of_range for an unknown setting.
  double operator[](RTenum quality) const { return values_.at(quality); }
  int whole(RTenum quality) const { return int(values_.at(quality)); }
  void set(RTenum quality, double value) { values_.at(quality) = value; }
  bool operator==(const QualityValues&) const = default;

 private:
  std::map<RTenum, double> values_;
};

// Sets all quality settings of the frames that follow, except RT_FRAMES_IN_FLIGHT and RT_PATIENCE,
// which belong to the context. [context-thread]
void applyQuality(const QualityValues& values);

} // namespace picture
