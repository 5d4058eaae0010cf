// option_info.h: The row of the table of options, which parses the command line and prints --help.
// [one thread]
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/options.h"

namespace vv {

// Options of one purpose replace each other: one of the command line takes the place of those of
// presets.
enum class Purpose : uint8_t { own, view, surroundings, precision, angle };

// Says that an option needs one of other options, or cannot be used with any of them.
struct OptionRule {
  bool needs;
  // Separated by commas. Names of options, or of the conditions in rules.cpp, such as "-o".
  const char* names;
  // {} stands for the names; null: "--x needs {}" or "--x cannot be used with {}".
  const char* message;
};
constexpr OptionRule needs(const char* names, const char* message = nullptr) {
  return {true, names, message};
}
constexpr OptionRule excludes(const char* names, const char* message = nullptr) {
  return {false, names, message};
}

enum class Trait : uint8_t {
  repeatable, // may be given several times
  // A preset or a vv.toml may set the option. It may have come with a world from somewhere: such an
  // option writes no files, reads none elsewhere, runs no programs, trusts a world no more than
  // before, and does not use the network.
  inPresets,
  inViews // kept in the command of a view, as are the groups Change, Quality and Trust
};

// Traits that only some options have.
struct OptionTraits {
  bool repeatable = false, inPresets = false, inViews = false;
  Purpose purpose = Purpose::own;
  std::vector<OptionRule> rules; // the first one that is broken is reported

  void add(Trait trait) {
    (trait == Trait::repeatable  ? repeatable
     : trait == Trait::inPresets ? inPresets
                                 : inViews) = true;
  }
  void add(Purpose one) { purpose = one; }
  void add(const OptionRule& rule) { rules.push_back(rule); }
};
template <class... T> OptionTraits with(const T&... traits) {
  OptionTraits all;
  (all.add(traits), ...);
  return all;
}

// A row of the table. `argument` is empty for a switch, and in brackets if it is optional; a
// missing optional argument gives the value "". `apply` throws UsageError. It is null if the option
// sets `quality`, or if Options::isGiven is asked for it.
struct OptionInfo {
  const char* names; // "-o,--output"
  const char* argument;
  const char* group;
  std::string text;
  void (*apply)(Options& options, const std::string& value) = nullptr;
  OptionTraits traits = {};
  RTenum quality = 0; // RT_*; only used without `apply`
};
std::span<const OptionInfo> optionTable();
// Returns the option with this name, such as "-o" or "--size", or null.
const OptionInfo* optionCalled(std::string_view word);
// Returns the first name with two dashes.
std::string longName(const OptionInfo& option);
// Stores a value of the command line. Throws UsageError.
void applyValue(const OptionInfo& option, const std::string& value, Options& options);
std::span<const OptionInfo> qualityOptions(); // the rows of quality settings, group Quality
std::span<const OptionInfo> clusterOptions(); // the rows of the group Cluster

} // namespace vv
