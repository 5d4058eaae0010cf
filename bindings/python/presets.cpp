#include "presets.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "libpicture/built_in_presets.h"
#include "objects.h"

namespace {

void setNumber(picture::QualityValues& quality, RTenum setting, double value) {
  // the table's default is the value of a caller who says nothing
  if (quality[setting] == picture::QualityValues()[setting]) quality.set(setting, value);
}

// Sets one argument. A preset of the table has no others (test_presets_of_python), but for the
// placeholders of vv: a world of Python is drawn as it is.
void apply(std::string_view name, const toml::node& value, RenderArguments& given) {
  const std::string text = value.value_or(std::string());
  const bool looksFromElsewhere =
      !given.camera.is_none() || !given.viewpoint.is_none() || given.fit || given.from;
  if (name == "from" && !looksFromElsewhere) given.from = text;
  if (name == "up" && !given.up) given.up = text;
  if (name == "fov" && !given.fov) given.fov = value.value_or(0.0);
  if (name == "spp" && !given.spp) given.spp = value.value_or(0);
  if (name == "clamp") setNumber(given.quality, RT_CLAMP, value.value_or(0.0));
  if (name == "background" && given.background.is_none()) given.background = py::str(text);
  if (name == "studio" && given.studio.is_none() && !given.studioColour) given.studioColour = text;
}

} // namespace

std::vector<std::string> applyPreset(RenderArguments& given) {
  std::vector<std::string> rules;
  if (!given.preset) return rules;
  const toml::table root = toml::parse(picture::builtInPresets);
  const toml::table& presets = *root["preset"].as_table();
  std::string next = *given.preset;
  while (!next.empty()) { // a preset comes before the one that it begins with
    const toml::table* const preset = presets[next].as_table();
    if (!preset) {
      std::string known;
      for (const auto& [name, unused] : presets)
        known += (known.empty() ? "'" : ", '") + std::string(name.str()) + "'";
      throw py::value_error(fmt::format("preset: {} expected, not '{}'", known, next));
    }
    next.clear();
    for (const auto& [key, value] : *preset) {
      if (key.str() == "preset") next = value.value_or(std::string());
      apply(key.str(), value, given);
      if (const toml::array* all = key.str() == "shader" ? value.as_array() : nullptr)
        for (const toml::node& rule : *all) rules.push_back(rule.value_or(std::string()));
    }
  }
  return rules;
}
