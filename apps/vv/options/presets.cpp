#include "options/presets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "libpicture/built_in_presets.h"
#include "libpicture/shader_selector.h"
#include "lower_case.h"
#include "nearest.h"
#include "options/option_info.h"
#include "process/messages.h"

namespace vv {

namespace {

namespace fs = std::filesystem;

constexpr size_t fileBytes = 1 << 20; // a longer file is refused
constexpr int mostPixels = 4096;      // the longest side of a picture
constexpr int mostSamples = 4096;
constexpr int mostTurns = 360;     // pictures of a turntable
constexpr size_t mostPresets = 16; // that build on each other

struct Document {
  std::string name;   // for messages
  std::string folder; // where its files are; empty: it is built in
  toml::table root;
  bool builtIn = false;
};

std::string placeOf(const Document& document, const toml::node& node) {
  const toml::source_position at = node.source().begin;
  return fmt::format("{}:{}:{}", document.name, at.line, at.column);
}

[[noreturn]] void refuse(const Document& document, const toml::node& node, const std::string& why) {
  throw Failure{exitInput, fmt::format("{}: {}", placeOf(document, node), why)};
}

Document parse(std::string_view text, const std::string& name, const std::string& folder) {
  Document document{name, folder, {}, folder.empty()};
  try {
    document.root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Failure{exitInput,
                  fmt::format("{}:{}:{}: {}", name, at.line, at.column, error.description())};
  }
  return document;
}

Document readFile(const std::string& path) {
  std::error_code unknown;
  std::string text(fileBytes + 1, '\0');
  std::ifstream file;
  if (fs::is_regular_file(path, unknown)) file.open(path, std::ios::binary);
  if (!file.is_open()) throw Failure{exitInput, fmt::format("--config: cannot read {}", path)};
  file.read(text.data(), std::streamsize(text.size()));
  text.resize(size_t(std::max<std::streamsize>(file.gcount(), 0)));
  if (text.size() > fileBytes)
    throw Failure{exitInput,
                  fmt::format("{} is longer than {} bytes, too long for options", path, fileBytes)};
  const std::string folder = fs::path(path).parent_path().string();
  return parse(text, path, folder.empty() ? "." : folder);
}

bool hasName(const OptionInfo& option, std::string_view name) {
  for (const std::string_view one : split(option.names, ','))
    if (one.starts_with("--") && one.substr(2) == name) return true;
  return false;
}

const OptionInfo& optionNamed(const Document& document, const toml::key& key,
                              const toml::node& node) {
  const std::string_view name = key.str();
  std::vector<std::string> known;
  bool exists = false;
  for (const OptionInfo& option : optionTable()) {
    const bool isNamed = hasName(option, name);
    exists |= isNamed;
    if (!option.traits.inPresets) continue;
    if (isNamed) return option;
    for (const std::string_view one : split(option.names, ','))
      if (one.starts_with("--")) known.emplace_back(one.substr(2));
  }
  const std::string near = nearest::word(std::string(name), known);
  const toml::source_position at = key.source().begin;
  const std::string where = at.line > 0 ? fmt::format("{}:{}:{}", document.name, at.line, at.column)
                                        : placeOf(document, node);
  throw Failure{exitInput,
                exists ? fmt::format("{}: {} can only be set on the command line", where, name)
                       : fmt::format("{}: there is no option {}{}", where, name,
                                     near.empty() ? "; docs/presets.md lists them"
                                                  : fmt::format("; did you mean {}?", near))};
}

// Returns a value as the command line would have it; nothing for a switch that is off.
std::optional<std::string> textOf(const Document& document, const OptionInfo& option,
                                  const toml::node& node) {
  const bool isSwitch = !*option.argument, onOff = std::string_view(option.argument) == "on|off";
  if (const auto* flag = node.as_boolean()) {
    if (onOff) return flag->get() ? "on" : "off";
    if (!isSwitch)
      refuse(document, node, fmt::format("{} was expected, not a boolean", option.argument));
    return flag->get() ? std::optional<std::string>("") : std::nullopt;
  }
  if (isSwitch) refuse(document, node, "true or false was expected");
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  refuse(document, node, fmt::format("a text or a number was expected: {}", option.argument));
}

void addOption(const Document& document, const toml::key& key, const toml::node& node,
               std::vector<Setting>& out) {
  const OptionInfo& option = optionNamed(document, key, node);
  const auto add = [&](const toml::node& one) {
    if (const auto text = textOf(document, option, one))
      out.push_back({&option, *text, placeOf(document, one), document.folder, document.builtIn});
  };
  const auto* list = node.as_array();
  if (!list) return add(node);
  if (!option.traits.repeatable)
    refuse(document, node, fmt::format("{} has one value, not a list", key.str()));
  for (const toml::node& one : *list) add(one);
}

bool isFor(const OptionInfo& option, std::string_view name) { return hasName(option, name); }

// Tells whether an option replaces another one.
bool replaces(const Setting& later, const Setting& earlier) {
  if (later.option == earlier.option) return !later.option->traits.repeatable;
  const Purpose purpose = later.option->traits.purpose;
  if (purpose == Purpose::own || purpose != earlier.option->traits.purpose) return false;
  // a studio takes its backdrop from a colour of --background
  if (!isFor(*later.option, "background") || !isFor(*earlier.option, "studio")) return true;
  try {
    return picture::readBackground(later.value).kind != picture::Background::Kind::colour;
  } catch (const std::invalid_argument&) { return true; }
}

// Puts a layer over those below it. A field of view that was chosen for the sides of `from` goes
// with them.
void cover(std::vector<Setting>& settings, std::vector<Setting> layer) {
  const auto names = [](const std::vector<Setting>& all, std::string_view name) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Setting& one) { return isFor(*one.option, name); });
  };
  const bool otherView = names(layer, "viewpoint") || names(layer, "camera") ||
                         names(layer, "fit") || names(layer, "pose");
  if (otherView && names(settings, "from"))
    std::erase_if(settings, [](const Setting& one) { return isFor(*one.option, "fov"); });
  std::erase_if(settings, [&](const Setting& earlier) {
    return std::any_of(layer.begin(), layer.end(),
                       [&](const Setting& later) { return replaces(later, earlier); });
  });
  std::move(layer.begin(), layer.end(), std::back_inserter(settings));
}

// Finds presets in the documents, the user's own first, and follows the presets they build on.
class Presets {
 public:
  // The documents must outlive it. Copies of them would not know their lines.
  explicit Presets(const std::vector<Document>& documents) : documents_(documents) {}

  // Puts the settings of a preset over `settings`. `asking` names the place that asks for it.
  void add(const std::string& name, const std::string& asking, std::vector<Setting>& settings) {
    if (!open_.insert(name).second)
      throw Failure{exitInput, fmt::format("{}: preset {} builds on itself", asking, name)};
    if (open_.size() > mostPresets + 1)
      throw Failure{exitInput, fmt::format("{}: more than {} presets build on each other", asking,
                                           mostPresets)};
    for (const Document& document : documents_) {
      const toml::table* presets = document.root["preset"].as_table();
      if (const toml::node* found = presets ? presets->get(name) : nullptr) {
        addTable(document, *found, settings);
        open_.erase(name);
        return;
      }
    }
    refuseUnknown(name, asking);
  }

  // Puts the options of a table over `settings`, and below them those of its preset.
  void addTable(const Document& document, const toml::node& node, std::vector<Setting>& settings) {
    const toml::table* table = node.as_table();
    if (!table) refuse(document, node, "a table of options was expected");
    if (const toml::node* base = table->get("preset")) {
      if (!base->as_string()) refuse(document, *base, "the name of a preset was expected");
      add(base->as_string()->get(), placeOf(document, *base), settings);
    }
    std::vector<Setting> layer;
    for (const auto& [key, one] : *table)
      if (key.str() != "preset" && key.str() != "match") addOption(document, key, one, layer);
    cover(settings, std::move(layer));
  }

 private:
  [[noreturn]] void refuseUnknown(const std::string& name, const std::string& asking) const {
    std::vector<std::string> known;
    for (const Document& document : documents_)
      if (const toml::table* presets = document.root["preset"].as_table())
        for (const auto& [key, node] : *presets) known.emplace_back(key.str());
    const std::string near = nearest::word(name, known);
    const std::string text =
        fmt::format("{}: there is no preset \"{}\"{}; the presets are {}", asking, name,
                    near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                    fmt::format("{}", fmt::join(known, ", ")));
    if (asking == "--preset") throw UsageError(text);
    throw Failure{exitInput, text};
  }

  const std::vector<Document>& documents_;
  std::set<std::string> open_; // presets that are being read
};

// Tells whether the block is for this file.
bool matches(const Document& document, const toml::node& block, const std::string& file) {
  const toml::table* table = block.as_table();
  if (!table) refuse(document, block, "a table of options was expected");
  const toml::node* match = table->get("match");
  if (!match) return true;
  bool any = false;
  const auto test = [&](const toml::node& one) {
    const auto* text = one.as_string();
    if (!text) refuse(document, one, "a pattern for file names was expected, such as \"*.wrl\"");
    any |= picture::matchesGlob(text->get(), file);
  };
  if (const auto* list = match->as_array())
    for (const toml::node& one : *list) test(one);
  else
    test(*match);
  return any;
}

void checkRoot(const Document& document) {
  for (const auto& [key, node] : document.root) {
    const bool files = key.str() == "files" && node.is_array_of_tables(),
               presets = key.str() == "preset" && node.is_table();
    if (!files && !presets)
      refuse(document, node,
             fmt::format("[[files]] or [preset.NAME] was expected, not {}", key.str()));
  }
  if (const toml::table* presets = document.root["preset"].as_table())
    for (const auto& [key, node] : *presets) { // reports wrong options of presets that are not used
      if (!node.is_table()) refuse(document, node, "a table of options was expected");
      std::vector<Setting> unused;
      for (const auto& [name, one] : *node.as_table())
        if (name.str() != "preset") addOption(document, name, one, unused);
    }
}

// Returns the value of an option on the command line, and takes it out of the list.
std::optional<std::string> take(std::vector<Setting>& given, std::string_view name) {
  std::optional<std::string> value;
  std::erase_if(given, [&](const Setting& setting) {
    if (!isFor(*setting.option, name)) return false;
    value = setting.value;
    return true;
  });
  return value;
}

std::string inside(const std::string& folder, const std::string& path) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(fs::absolute(folder, error), error),
                 place = fs::weakly_canonical(root / path, error),
                 relative = place.lexically_relative(root);
  if (error || fs::path(path).is_absolute() || relative.empty() || *relative.begin() == "..")
    throw UsageError(fmt::format("a file inside {} was expected, not \"{}\"", folder, path));
  if (fs::exists(place, error) && !fs::is_regular_file(place, error))
    throw UsageError(fmt::format("\"{}\" is not an ordinary file", path));
  return place.string();
}

bool isGltf(std::string name) {
  name = lowerCase(name);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name.ends_with(".glb") || name.ends_with(".gltf");
}

} // namespace

std::vector<Setting> withPresets(std::vector<Setting> given, const std::string& world) {
  const std::optional<std::string> preset = take(given, "preset"), config = take(given, "config");
  const bool quiet = std::any_of(given.begin(), given.end(), [](const Setting& setting) {
    return isFor(*setting.option, "quiet");
  });
  std::string path = config.value_or("");
  if (!config && !world.empty() && world != "-") {
    const fs::path beside = fs::path(world).parent_path() / "vv.toml";
    std::error_code unknown;
    if (fs::is_regular_file(beside, unknown)) path = beside.string();
  }
  if (config && config->empty()) throw UsageError("--config: a file name or none was expected");
  if (config && *config == "none") path.clear();
  if (path.empty() && !preset) return given;

  std::vector<Document> documents;
  documents.reserve(2);
  std::vector<Setting> settings;
  if (!path.empty()) {
    documents.push_back(readFile(path));
    checkRoot(documents[0]);
  }
  documents.push_back(parse(picture::builtInPresets, "built-in presets", ""));
  Presets presets(documents);
  if (!path.empty())
    if (const toml::array* blocks = documents[0].root["files"].as_array()) {
      const std::string file = fs::path(world).filename().string();
      bool used = false;
      for (const toml::node& block : *blocks) {
        std::vector<Setting> unused;
        const bool isUsed = matches(documents[0], block, file);
        presets.addTable(documents[0], block, isUsed ? settings : unused);
        used |= isUsed;
      }
      if (used && !config && !quiet)
        say(fmt::format("vv: {} sets options for this world; --config none ignores it", path));
    }
  if (preset) {
    std::vector<Setting> layer;
    presets.add(*preset, "--preset", layer);
    cover(settings, std::move(layer));
  }
  // glTF says itself that y is up (glTF 2.0, 3.4).
  if (isGltf(world))
    std::erase_if(settings, [](const Setting& setting) {
      return setting.builtIn && isFor(*setting.option, "up");
    });
  cover(settings, std::move(given));
  return settings;
}

void applyConfined(const Setting& setting, Options& options) {
  const OptionInfo& option = *setting.option;
  const std::string name = longName(option).substr(2);
  if (name == "shader" && setting.value.starts_with('@') && !setting.folder.empty())
    option.apply(options, "@" + inside(setting.folder, setting.value.substr(1)));
  const size_t rules = options.shaders.size();
  if (name == "shader") {
    if (!setting.value.starts_with('@')) option.apply(options, setting.value);
    for (size_t i = setting.value.starts_with('@') ? 0 : rules; i < options.shaders.size(); ++i) {
      picture::ShaderRule& rule = options.shaders[i];
      if (!rule.folder.empty()) continue;
      rule.folder = setting.folder;
      rule.mayMatchNothing = setting.builtIn;
      if (rule.where == "--shader") rule.where = setting.where + ":";
    }
    return;
  }
  applyValue(option, setting.value, options);
  if (setting.folder.empty()) return;
  if (name == "environment")
    options.render.environment = inside(setting.folder, options.render.environment);
  if (name == "background" && !options.render.background.file.empty())
    options.render.background.file = inside(setting.folder, options.render.background.file);
  if (name == "camera-shader") options.cameraShaderFolder = setting.folder;
  if (options.render.width > mostPixels || options.render.height > mostPixels)
    throw UsageError(fmt::format("at most {0}x{0} pixels can be set here; --size has no such limit",
                                 mostPixels));
  if (options.samples.value_or(0) > mostSamples)
    throw UsageError(
        fmt::format("at most {} can be set here; --spp has no such limit", mostSamples));
  if (options.turntable > mostTurns)
    throw UsageError(
        fmt::format("at most {} can be set here; --turntable has no such limit", mostTurns));
}

} // namespace vv
