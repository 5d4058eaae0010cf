// options.cpp: Parses the command line with CLI11, according to the table of options. No other file
// includes CLI11.
#include "options.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "habits.h"
#include "libpicture/denoiser.h"
#include "nearest.h"
#include "option_info.h"
#include "option_words.h"
#include "presets.h"
#include "rules.h"

namespace vv {

const OptionInfo* optionCalled(std::string_view word) {
  for (const OptionInfo& option : optionTable())
    for (std::string_view name : split(option.names, ','))
      if (name == word) return &option;
  return nullptr;
}

std::string longName(const OptionInfo& option) {
  std::string_view names = option.names;
  return std::string(
      names.substr(names.find("--"), names.find(',', names.find("--")) - names.find("--")));
}

namespace {

// Returns the name that all messages use: -o, -D, --size.
std::string shownName(const OptionInfo& option) {
  const std::string_view names = option.names;
  return std::string(names.substr(0, names.find(',')));
}

void apply(const Setting& setting, Options& options) {
  const OptionInfo& option = *setting.option;
  options.given.push_back(&option);
  try {
    if (!setting.where.empty())
      applyConfined(setting, options);
    else
      applyValue(option, setting.value, options);
  } catch (const UsageError& error) {
    throw UsageError(setting.where.empty() ? fmt::format("{}: {}", shownName(option), error.what())
                                           : fmt::format("{}: {}: {}", setting.where,
                                                         longName(option).substr(2), error.what()));
  }
}

// A colour of --background is the backdrop of a studio.
void mergeBackdrop(Options& options) {
  picture::Background& background = options.render.background;
  if (!options.render.studio.on || background.kind != picture::Background::Kind::colour) return;
  options.render.studio.backdrop = background.colour;
  background = {};
}

std::vector<std::string> allNames() {
  std::vector<std::string> names;
  for (const OptionInfo& option : optionTable())
    for (std::string_view name : split(option.names, ',')) names.emplace_back(name);
  return names;
}

std::string unknownOption(std::string option) {
  option = option.substr(0, option.find('='));
  if (const std::string hint = optionHint(option); !hint.empty()) return hint;
  const std::string near = nearest::word(option, allNames());
  if (near.empty()) return fmt::format("there is no option {}; vv --help all lists them", option);
  return fmt::format("there is no option {}; did you mean {}?", option, near);
}

// Describes a missing value of an option.
std::string missingValue(std::string_view name) {
  if (const OptionInfo* const option = optionCalled(name))
    return fmt::format("{}: a value was expected: {}", name, option->argument);
  return fmt::format("{}: a value was expected", name);
}

// --spp of --preview where it is not given
constexpr int previewSamples = 4;

} // namespace

// Counts the inspections that are asked for.
int inspectionsOf(const Options& o) {
  return int(std::count_if(std::begin(jobTable), std::end(jobTable),
                           [&](const JobInfo& info) { return info.inspects && o.has(info.job); }));
}

bool Options::isGiven(std::string_view name) const {
  const OptionInfo* const option = optionCalled(name);
  if (!option) throw std::logic_error(fmt::format("there is no option {}", name));
  return std::find(given.begin(), given.end(), option) != given.end();
}

void applyValue(const OptionInfo& option, const std::string& value, Options& options) {
  if (option.apply) return option.apply(options, value);
  if (option.quality)
    options.render.quality.set(option.quality, readQuality(option.quality, value));
}

const JobInfo* Options::job() const {
  for (const JobInfo& info : jobTable)
    if (has(info.job)) return &info;
  return nullptr;
}

// Returns whether a word is a number without exponent, perhaps one that the option then refuses.
bool isPlainNumber(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && word.find_first_not_of("0123456789.") == word.npos &&
         word.find_first_of("0123456789") != word.npos;
}

// Returns the job of a command without dashes, such as `vv serve`; null for other command
// lines. Worlds of these names are ./serve, ./merge.
const JobInfo* commandOf(int argc, char** argv) {
  for (const JobInfo& info : jobTable)
    if (info.name[0] != '-' && argc > 1 && std::string_view(argv[1]) == info.name) return &info;
  return nullptr;
}

// Tells whether the word after an option is its value.
bool takesNext(std::string_view word) {
  const OptionInfo* const option = optionCalled(word);
  return option && *option->argument && option->argument[0] != '[';
}

// Refuses options that a command without a world does not know. given: their names.
void refuseOthers(const char* command, std::initializer_list<std::string_view> allowed,
                  const std::vector<std::string>& given) {
  for (const std::string& name : given)
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end())
      throw UsageError(
          fmt::format("vv {} renders nothing: {} cannot be used with it", command, name));
}

// Takes the files of vv merge.
void readMerge(Options& options, const std::vector<std::string>& files,
               const std::vector<std::string>& given) {
  refuseOthers("merge", {"-o", "--sums", "--stats", "--compare", "-q", "-v"}, given);
  if (files.empty())
    throw UsageError("vv merge: files were expected: EXR files that were written with --sums, or "
                     "files of --resume");
  if (!options.makesPictures())
    throw UsageError("vv merge: -o FILE was expected, for the picture of all seeds, or --compare "
                     "REF.exr, to compare it");
  for (const Output& output : options.outputs)
    if (output.film != picture::FilmKind::none)
      throw UsageError(output.path + ": vv merge makes one picture, not a film");
  options.merge = files;
  checkTogether(options);
}

// Takes the files of vv compare.
void readCompare(Options& options, const std::vector<std::string>& files,
                 const std::vector<std::string>& given) {
  refuseOthers("compare", {"-o", "--samples", "--variance", "--json", "-q", "-v"}, given);
  if (files.size() != 2)
    throw UsageError(fmt::format("vv compare: two pictures were expected, not {}", files.size()));
  for (const Output& output : options.outputs) {
    if (output.film != picture::FilmKind::none)
      throw UsageError(output.path + ": vv compare makes one picture, not a film");
    if (output.path == "-")
      throw UsageError("vv compare writes to standard output: -o needs a file name");
  }
  options.compared.files = files;
  checkTogether(options);
}

// Takes the pictures of vv film --join.
void readFilm(Options& options, const std::vector<std::string>& files,
              const std::vector<std::string>& given) {
  refuseOthers("film", {"-o", "--join", "--fps", "-q", "-v"}, given);
  if (files.empty() || !options.isGiven("--join"))
    throw UsageError("vv film --join FILE... -o FILM was expected, with pictures in their order");
  if (options.outputs.empty())
    throw UsageError(
        fmt::format("vv film: -o FILM was expected, one of {}", picture::filmSuffixes));
  for (const Output& output : options.outputs)
    if (output.film == picture::FilmKind::none)
      throw UsageError(
          fmt::format("{}: vv film makes a film, one of {}", output.path, picture::filmSuffixes));
  options.joined = files;
}

// Reads the files of a command that takes no world. given: the names of its options.
using ReadFiles = void (*)(Options&, const std::vector<std::string>& files,
                           const std::vector<std::string>& given);

// Returns the reader of a command that takes no world; null for others.
ReadFiles filesReaderOf(Job command) {
  switch (command) {
  case Job::merge: return readMerge;
  case Job::compare: return readCompare;
  case Job::film: return readFilm;
  default: return nullptr;
  }
}

// Refuses --NAME=VALUE of an option without a value, and --NAME= of one whose value is optional.
void refuseUselessEquals(std::string_view word) {
  const size_t equals = word.find('=');
  const OptionInfo* const option = word.starts_with("--") && equals != word.npos
                                       ? optionCalled(word.substr(0, equals))
                                       : nullptr;
  if (!option) return;
  if (!*option->argument)
    throw UsageError(fmt::format("{} takes no value: {} was not expected", word.substr(0, equals),
                                 word.substr(equals)));
  if (option->argument[0] == '[' && equals + 1 == word.size())
    throw UsageError(missingValue(word.substr(0, equals)));
}

// Rewrites optional arguments as NAME=VALUE for the parser. The word after the option is taken as
// its argument only if it is a number, or may be a topic of --help. The words after "--" are
// files: they go to `files`.
std::vector<std::string> withOptionalArguments(int argc, char** argv,
                                               std::vector<std::string>& files) {
  std::vector<std::string> out;
  for (int i = commandOf(argc, argv) ? 2 : 1; i < argc; ++i) {
    const bool isValue = !out.empty() && takesNext(out.back());
    if (!isValue && std::string_view(argv[i]) == "--") {
      files.assign(argv + i + 1, argv + argc);
      break;
    }
    if (isValue) {
      out.emplace_back(argv[i]);
      continue;
    }
    refuseUselessEquals(argv[i]);
    appendOptionWord(out, argv[i], takesNext);
    const OptionInfo* const option = optionCalled(argv[i]);
    if (!option || option->argument[0] != '[') continue;
    out.back() = longName(*option);
    const bool given = i + 1 < argc && (isPlainNumber(argv[i + 1]) || out.back() == "--help");
    out.back() += std::string("=") + (given ? argv[++i] : "-");
  }
  std::reverse(out.begin(), out.end()); // CLI11 expects a vector in reverse order
  return out;
}

// Refuses an option whose value is missing, so that the next option would be taken for it.
void refuseSwallowedOptions(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    const std::string_view word = argv[i], next = argv[i + 1];
    if (word == "--") return;
    if (!takesNext(word)) continue;
    if (next.starts_with("--") && optionCalled(next.substr(0, next.find('='))))
      throw UsageError(fmt::format("{}, not the option {}", missingValue(word), next));
    ++i; // any other value
  }
}

Options readCommandLine(int argc, char** argv) {
  Options options;
  options.render.denoiser = picture::Denoiser::automatic;
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  std::vector<std::string> inputs;
  app.add_option("FILE", inputs);
  std::vector<std::vector<std::string>> values(optionTable().size());
  std::vector<CLI::Option*> added;
  for (const OptionInfo& option : optionTable()) {
    CLI::Option* one =
        *option.argument
            ? app.add_option(option.names, values[added.size()])->allow_extra_args(false)
            : app.add_flag(option.names);
    added.push_back(one);
  }
  refuseSwallowedOptions(argc, argv);
  std::vector<std::string> files;
  try {
    app.parse(withOptionalArguments(argc, argv, files));
  } catch (const CLI::ArgumentMismatch&) {
    throw UsageError(missingValue(argv[argc - 1]));
  } catch (const CLI::ParseError& error) { throw UsageError(error.what()); }
  for (const std::string& extra : app.remaining())
    if (extra.size() > 1 && extra[0] == '-') throw UsageError(unknownOption(extra));
  inputs.insert(inputs.end(), files.begin(), files.end());
  const JobInfo* const command = commandOf(argc, argv);
  if (command) options.jobs.push_back(command->job);
  const ReadFiles readFiles = command ? filesReaderOf(command->job) : nullptr;
  if (!app.remaining().empty())
    throw UsageError(fmt::format("\"{}\" was not expected", app.remaining()[0]));
  if (!inputs.empty() && !readFiles) options.input = inputs[0];
  std::vector<Setting> given; // on the command line
  for (size_t i = 0; i < added.size(); ++i) {
    const OptionInfo& option = optionTable()[i];
    if (added[i]->count() == 0) continue;
    if (!*option.argument) given.push_back({&option, "", {}, {}, false});
    // If an option holds one value, the last one counts.
    const size_t first = option.traits.repeatable || values[i].empty() ? 0 : values[i].size() - 1;
    for (size_t k = first; k < values[i].size(); ++k)
      given.push_back({&option,
                       option.argument[0] == '[' && values[i][k] == "-" ? "" : values[i][k],
                       {},
                       {},
                       false});
  }
  if (inputs.size() > 1 && !readFiles) {
    // The second file may stand behind an option with an empty value: --spp= 64.
    Options unused;
    for (const Setting& setting : given)
      if (setting.value.empty() && *setting.option->argument) apply(setting, unused);
    throw UsageError(secondFileHint(inputs[0], inputs[1]));
  }
  if (readFiles) {
    std::vector<std::string> names;
    for (const Setting& setting : given) {
      names.push_back(shownName(*setting.option));
      apply(setting, options);
    }
    if (!options.has(Job::help) && !options.has(Job::version)) readFiles(options, inputs, names);
    return options;
  }
  for (const Setting& setting : withPresets(std::move(given), options.input))
    apply(setting, options);
  mergeBackdrop(options);
  checkTogether(options);
  const picture::RenderSettings& render = options.render;
  if (options.from.size() == 1 || options.opensWindow())
    options.view.side = options.from.empty() ? std::optional<picture::Side>() : options.from[0];
  options.view.turns = options.turntable > 0;
  options.render.samples = options.samples.value_or(
      render.timeLimit > 0 && options.resume.empty()  ? 65536
      : render.error > 0                              ? 4096
      : options.measures() && options.outputs.empty() ? Options::measureSamples
      : render.preview                                ? previewSamples
                                                      : render.samples);
  return options;
}

} // namespace vv
