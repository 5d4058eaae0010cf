// quality_options.cpp: Makes an option of vv from each row of the library's table of quality
// settings (rtGetQualityInfo), a part of the table of options (option_info.h). A few options have
// words or values of their own.
#include "option_info.h"

#include <algorithm>
#include <cctype>
#include <deque>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "libpicture/transport.h"

namespace vv {

namespace {

using enum Trait;

// Holds what vv says about a setting instead of what follows from the library's table.
struct Wording {
  RTenum quality;
  const char* name = nullptr;     // null: the setting's name
  const char* argument = nullptr; // null: the names of the values, N or X
  const char* text = nullptr;     // null: the setting's text, range and default
  // Null: any value that the library allows is put into RenderSettings::quality.
  void (*apply)(Options& options, const std::string& value) = nullptr;
  OptionTraits traits = {};
};

// The order is that of --help. Settings without a row follow.
const Wording wordings[] = {
    {RT_SAMPLES_PER_PIXEL, "--spp", nullptr,
     "Samples per pixel, 1 to 65536 (default 16; with --preview 4; in the window 256, added one "
     "after the other).",
     [](Options& o, const std::string& v) {
       o.samples = int(readQuality(RT_SAMPLES_PER_PIXEL, v));
     },
     with(inPresets, Purpose::precision)},
    {RT_TARGET_ERROR, nullptr, "E|E%",
     "Sample each part of the picture until the average error bar is E of the brightness (for "
     "example 2%), with at most --spp samples per pixel (default here 4096).",
     [](Options& o, const std::string& v) { o.render.error = readShare(RT_TARGET_ERROR, v); },
     with(inPresets, Purpose::precision)},
    {RT_TIME_LIMIT, nullptr, "SECONDS",
     "Sample the whole picture in rounds for about this time, with at most --spp samples per pixel "
     "(default here 65536). Such a picture depends on the speed of the machine.",
     [](Options& o, const std::string& v) { o.render.timeLimit = readQuality(RT_TIME_LIMIT, v); },
     with(Purpose::precision)},
    {RT_MAX_DEPTH, nullptr, nullptr,
     "Maximum number of surfaces that a path may pass through or bounce off, 0 to 10000 (default "
     "25).",
     nullptr, with(inPresets)},
    {.quality = RT_TRANSPORT, .traits = with(inPresets)},
    {RT_ENERGY_CUT, nullptr, "E",
     "With whitted, end branches of reflection and refraction that carry less than this share of "
     "the camera ray, 0 to 1 (default 1/4096).",
     [](Options& o, const std::string& v) {
       o.render.quality.set(RT_ENERGY_CUT, readShare(RT_ENERGY_CUT, v));
     },
     with(inPresets)},
    {RT_CLAMP, nullptr, "RADIANCE",
     "Limit the radiance of each sample. This removes fireflies, but also light; --stats says how "
     "much (default: no limit).",
     nullptr, with(inPresets)},
    {.quality = RT_SHADOWS, .traits = with(inPresets)},
    {RT_SEED, nullptr, "N|A-B",
     "Choose another set of sample positions (default 0). A-B: add the pictures of the seeds from "
     "A "
     "to B, of --spp samples each, as vv merge does.",
     [](Options& o, const std::string& v) {
       constexpr long long most = 2147483647;
       const size_t dash = v.find('-', 1);
       const std::string last = dash == v.npos ? v : v.substr(dash + 1);
       o.seeds.first = uint32_t(readInteger(v.substr(0, dash), 0, most));
       o.seeds.last = uint32_t(readInteger(last, 0, most));
       if (o.seeds.last < o.seeds.first || o.seeds.count() > 65536)
         throw UsageError(fmt::format(
             "a number or a range such as 0-3, of at most 65536 seeds, was expected, not \"{}\"",
             v));
       o.render.quality.set(RT_SEED, double(o.seeds.first));
     }},
};

// vv chooses RT_PROGRESSIVE, RT_FRAMES_IN_FLIGHT, RT_VIEW and RT_PATIENCE itself and leaves the
// others to the engine.
constexpr RTenum withoutOption[] = {RT_REPLICATES, RT_PROGRESSIVE, RT_FRAMES_IN_FLIGHT,
                                    RT_TILE_SIZE,  RT_VIEW,        RT_MEASURE,
                                    RT_PATIENCE};

// Keeps a text until the program ends.
const char* keep(std::string text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(text)).c_str();
}

std::string nameOf(const RTqualityInfo& info) {
  std::string name = std::string("--") + info.name;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string argumentOf(const RTqualityInfo& info) {
  if (picture::isSwitch(info.quality)) return "on|off";
  if (info.choices) return fmt::format("{}", fmt::join(picture::qualityChoices(info.quality), "|"));
  return info.isReal ? "X" : "N";
}

// Returns the help text of --transport, made of what the library says of each transport.
std::string transportText() {
  std::string all = fmt::format(
      "Light transport algorithm. {} (default) {}; --explain and --stats say which and why.",
      picture::transportName(RT_TRANSPORT_AUTO), picture::transportInfo(RT_TRANSPORT_AUTO).text);
  for (RTenum i = RT_TRANSPORT_AUTO + 1; const char* does = picture::transportInfo(i).text; ++i)
    all += fmt::format(" {}: {}.", picture::transportName(i), does);
  return all;
}

std::string textOf(const RTqualityInfo& info) {
  if (info.quality == RT_TRANSPORT) return transportText();
  std::string text = info.text;
  text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  if (info.choices)
    return fmt::format(
        "{} (default {}).", text,
        picture::qualityChoices(info.quality)[size_t(info.defaultValue) - size_t(info.minimum)]);
  return fmt::format("{} ({:.10g} to {:.10g}{}, default {:.10g}).", text, info.minimum,
                     info.maximum, info.zeroIsAuto ? ", or 0: chosen by the engine" : "",
                     info.defaultValue);
}

OptionInfo optionOf(const Wording& wording) {
  const RTqualityInfo info = picture::qualityInfo(wording.quality);
  return {wording.name ? wording.name : keep(nameOf(info)),
          wording.argument ? wording.argument : keep(argumentOf(info)),
          "Quality",
          wording.text ? wording.text : textOf(info),
          wording.apply,
          wording.traits,
          wording.quality};
}

} // namespace

std::span<const OptionInfo> qualityOptions() {
  static const std::vector<OptionInfo> all = [] {
    std::vector<OptionInfo> rows;
    for (const Wording& wording : wordings) rows.push_back(optionOf(wording));
    for (const RTqualityInfo& info : picture::qualityTable()) {
      const bool isThere = std::any_of(std::begin(wordings), std::end(wordings),
                                       [&](const Wording& w) { return w.quality == info.quality; });
      const bool isOffered = std::find(std::begin(withoutOption), std::end(withoutOption),
                                       info.quality) == std::end(withoutOption);
      if (!isThere && isOffered) rows.push_back(optionOf({.quality = info.quality}));
    }
    return rows;
  }();
  return all;
}

} // namespace vv
