// options.cpp: Parses the command line with CLI11, according to the table of options. No other file
// includes CLI11.
#include "options.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "habits.h"
#include "libpicture/denoiser.h"
#include "nearest.h"
#include "presets.h"

namespace vv {

namespace {

// If several jobs are asked for, the first of the table is done.
constexpr JobInfo jobs[] = {
    {Job::help, false, false},        {Job::version, false, false},
    {Job::serve, false, true},        {Job::listKeys, false, false},
    {Job::listShaders, true, false},  {Job::listEngines, true, false},
    {Job::listFeatures, true, false}, {Job::listNodes, true, false},
    {Job::explain, true, true},       {Job::listViewpoints, true, true},
    {Job::info, true, true},
};

std::string longName(const OptionInfo& option) {
  std::string_view names = option.names;
  return std::string(
      names.substr(names.find("--"), names.find(',', names.find("--")) - names.find("--")));
}

// Returns the name that all messages use: -o, -D, --size.
std::string shownName(const OptionInfo& option) {
  const std::string_view names = option.names;
  return std::string(names.substr(0, names.find(',')));
}

void apply(const Setting& setting, Options& options) {
  const OptionInfo& option = *setting.option;
  try {
    if (!setting.where.empty())
      applyConfined(setting, options);
    else if (option.apply)
      option.apply(options, setting.value);
    else
      options.render.quality.set(option.quality, readQuality(option.quality, setting.value));
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
  if (near.empty()) return fmt::format("there is no option {}; vv --help lists them", option);
  return fmt::format("there is no option {}; did you mean {}?", option, near);
}

// Describes a missing option value; this can happen only at the end of the command line.
std::string missingValue(std::string_view last) {
  for (const OptionInfo& option : optionTable())
    for (std::string_view name : split(option.names, ','))
      if (name == last) return fmt::format("{}: a value was expected: {}", last, option.argument);
  return fmt::format("{}: a value was expected", last);
}

using picture::Background;

// --spp of --preview and of --measure without -o where it is not given
constexpr int previewSamples = 4, measureSamples = 4096;

bool writesToStandardOutput(const Options& o) {
  return std::any_of(o.outputs.begin(), o.outputs.end(),
                     [](const Output& output) { return output.path == "-"; });
}

// Counts the inspections that are asked for.
int inspectionsOf(const Options& o) {
  return int(std::count_if(std::begin(jobs), std::end(jobs),
                           [&](const JobInfo& info) { return info.inspects && o.has(info.job); }));
}

// Counts what goes to standard output.
int printed(const Options& o) {
  const auto pictures = std::count_if(o.outputs.begin(), o.outputs.end(),
                                      [](const Output& output) { return output.path == "-"; });
  return int(pictures) + (o.measure == "-") + (o.stats == "-") + (o.write == "-") +
         (inspectionsOf(o) > 0);
}

bool showsOnePicture(const Options& o) { return !o.severalViews() && !o.isSequence(); }

// A combination of options that cannot be used, and the message for it.
struct Rule {
  bool (*broken)(const Options& options);
  const char* message;
};

// The first broken rule is reported.
constexpr Rule rules[] = {
    {[](const Options& o) { return !o.viewpoint.empty() && (o.view.lookAt || o.view.fit); },
     "--viewpoint cannot be used with --camera, --pose or --fit, which choose another view"},
    {[](const Options& o) { return o.posed && o.view.fit; },
     "--pose says where the camera stands: it cannot be used with --fit"},
    {[](const Options& o) {
       return o.view.intrinsics && (o.view.fit || o.view.fov || !o.cameraShader.empty());
     },
     "--intrinsics says what the camera sees: it cannot be used with --fit, --fov or "
     "--camera-shader"},
    {[](const Options& o) { return o.view.intrinsics && (!o.makesPictures() || o.render.preview); },
     "--intrinsics needs -o without --preview"},
    {[](const Options& o) {
       return !o.from.empty() && (!o.viewpoint.empty() || o.view.lookAt || o.view.fit);
     },
     "--from cannot be used with --viewpoint, --camera or --fit, which choose another view"},
    {[](const Options& o) {
       return o.render.studio.on && (!o.render.environment.empty() ||
                                     o.render.background.kind != Background::Kind::world);
     },
     "--studio has a light and a backdrop of its own: it cannot be used with --environment or "
     "with a --background other than a colour"},
    {[](const Options& o) { return o.render.studio.on && o.measures(); },
     "--measure reads the light of the world: it cannot be used with --studio"},
    {[](const Options& o) {
       return !o.render.environment.empty() && o.render.background.kind != Background::Kind::world;
     },
     "only one of --environment, which shows all around, and --background can be used"},
    {[](const Options& o) { return o.quiet && o.verbose; },
     "only one of --quiet and --verbose can be used"},
    {[](const Options& o) { return printed(o) > 1; }, "only one thing can go to standard output"},
    {[](const Options& o) { return o.json && inspectionsOf(o) == 0; },
     "--json needs --info, --explain, --list-nodes, --list-viewpoints, --list-shaders, "
     "--list-engines or --list-features"},
    {[](const Options& o) { return inspectionsOf(o) > 1; },
     "only one of --info, --explain, --list-nodes, --list-viewpoints, --list-shaders, "
     "--list-engines and --list-features can be used"},
    // sequences of pictures
    {[](const Options& o) { return o.frames && o.time; },
     "only one of --time and --frames can be used"},
    {[](const Options& o) { return o.frames && o.turntable; },
     "only one of --frames and --turntable can be used"},
    {[](const Options& o) { return o.isSequence() && !o.makesPictures() && !o.check; },
     "--frames and --turntable need -o (or --check, to test a world)"},
    {[](const Options& o) { return o.isSequence() && writesToStandardOutput(o); },
     "a sequence needs file names, not standard output"},
    {[](const Options& o) { return o.watch && !o.makesPictures() && !o.showsWorld(); },
     "--watch needs -o, the window or vv serve"},
    {[](const Options& o) { return o.watch && o.input == "-"; },
     "--watch needs a file, not standard input"},
    // files beside the picture
    {[](const Options& o) { return !o.stats.empty() && !o.makesPictures(); }, "--stats needs -o"},
    {[](const Options& o) { return !o.render.record.empty() && !o.makesPictures(); },
     "--record needs -o"},
    {[](const Options& o) { return !o.render.record.empty() && !showsOnePicture(o); },
     "--record writes the scene of one picture: it cannot be used with --viewpoint all, --frames "
     "or --turntable"},
    {[](const Options& o) { return o.audit && o.isSequence(); },
     "--audit tests one picture: it cannot be used with --frames or --turntable"},
    {[](const Options& o) { return (o.audit || !o.compare.empty()) && printed(o) > 0; },
     "--audit and --compare write to standard output: nothing else can go there"},
    {[](const Options& o) {
       return o.measures() && (o.audit || o.isSequence() || o.severalViews() || o.watch ||
                               !o.render.record.empty());
     },
     "--measure reads the sensors of one moment: it cannot be used with --audit, --frames, "
     "--turntable, --viewpoint all, --watch or --record"},
    {[](const Options& o) {
       return o.falseColour &&
              std::none_of(o.outputs.begin(), o.outputs.end(), [](const Output& output) {
                return output.film != picture::FilmKind::none || output.format->appliesCurve;
              });
     },
     "--false-colour needs -o with a film or a file for a screen, such as .png"},
    {[](const Options& o) { return o.falseColour && !o.render.linear; },
     "--false-colour needs light that is added linearly: it cannot be used with --colour vrml97"},
    {[](const Options& o) {
       return (o.fitExposure || !o.render.view.isPlain()) && (!o.render.linear || o.falseColour);
     },
     "--exposure and --view need light that is added linearly, in its own colours: they cannot be "
     "used with --colour vrml97, --old-world or --false-colour"},
    {[](const Options& o) {
       return (o.fitExposure || !o.render.view.isPlain()) && !o.showsWorld() &&
              std::none_of(o.outputs.begin(), o.outputs.end(), [](const Output& output) {
                return output.film != picture::FilmKind::none || output.format->appliesCurve ||
                       output.format->encode == picture::encodeExr;
              });
     },
     "--exposure and --view need -o with a film or a file that they change, such as .png"},
    {[](const Options& o) { return o.fitExposure && (o.showsWorld() || o.audit); },
     "--exposure auto needs -o without --audit; the window and vv serve take a number"},
    {[](const Options& o) { return o.audit && o.render.timeLimit > 0; },
     "--audit cannot be used with --time-limit, whose pictures differ from run to run"},
    // pictures that survive
    {[](const Options& o) { return o.keepsSums() && o.outputs.empty() && o.compare.empty(); },
     "--resume, --sums and --seed A-B need -o"},
    {[](const Options& o) {
       return o.keepsSums() && (!showsOnePicture(o) || o.audit || o.measures() || o.watch ||
                                o.render.preview || !o.render.record.empty());
     },
     "--resume, --sums and --seed A-B are for one picture: they cannot be used with --viewpoint "
     "all, --frames, --turntable, --audit, --measure, --watch, --preview or --record"},
    {[](const Options& o) { return o.render.timeLimit > 0 && o.resume.empty() && o.keepsSums(); },
     "--sums and --seed A-B cannot be used with --time-limit, whose samples depend on the clock, "
     "except with --resume"},
    {[](const Options& o) { return o.render.error > 0 && (o.sums || o.seeds.count() > 1); },
     "--error cannot be used with --sums or --seed A-B: such pictures have other numbers of "
     "samples in every part, and cannot be added; --spp takes the same everywhere"},
    {[](const Options& o) { return o.sums && o.render.background.kind == Background::Kind::file; },
     "--sums cannot be used with a picture as --background, which the sums do not hold"},
    {[](const Options& o) {
       return o.sums && std::none_of(o.outputs.begin(), o.outputs.end(), [](const Output& output) {
                return output.format && output.format->encode == picture::encodeExr;
              });
     },
     "--sums needs -o with an EXR file"},
    // the cluster
    {[](const Options& o) { return !o.cluster.allow.empty() && o.cluster.key.empty(); },
     "--allow-keys needs --key"},
    {[](const Options& o) { return o.cluster.used() && !o.makesPictures() && !o.showsWorld(); },
     "--workers and --listen-workers need -o, the window or vv serve"},
    {[](const Options& o) { return o.check && o.makesPictures(); },
     "--check makes no picture: it cannot be used with -o"},
    {[](const Options& o) {
       return o.makesPictures() && o.severalViews() && writesToStandardOutput(o);
     },
     "--viewpoint all and several sides of --from need file names, not standard output"},
    // the page
    {[](const Options& o) {
       return o.has(Job::serve) &&
              (o.makesPictures() || o.check || !o.write.empty() || inspectionsOf(o) > 0);
     },
     "vv serve shows the world on a page: it cannot be used with -o, --compare, --audit, --check, "
     "--write, --info or a list"},
    {[](const Options& o) { return o.serve.given && !o.has(Job::serve); },
     "--port, --address and --token need vv serve"},
    // control by programs
    {[](const Options& o) { return o.noWindow && o.control.empty(); },
     "--no-window needs --control (-o makes a picture without a window)"},
    {[](const Options& o) { return !o.control.empty() && !o.opensWindow(); },
     "--control cannot be used with -o, vv serve, --check, --write or a list"},
    {[](const Options& o) {
       return o.noWindow && (!o.inputScript.empty() || !o.recordInput.empty() || o.watch);
     },
     "--no-window cannot be used with --input, --record-input or --watch"},
    // the window
    {[](const Options& o) { return o.showsWorld() && o.severalViews(); },
     "--viewpoint all and several sides of --from need -o"},
    {[](const Options& o) {
       return !o.recordInput.empty() && (!o.opensWindow() || !o.inputScript.empty());
     },
     "--record-input needs the window and cannot be used with --input"},
    {[](const Options& o) {
       return !o.inputScript.empty() && !o.makesPictures() && !o.opensWindow();
     },
     "--input needs -o or the window"},
    {[](const Options& o) { return !o.inputScript.empty() && o.opensWindow() && o.time; },
     "only one of --input and --time can be used in the window"},
    {[](const Options& o) {
       return !o.inputScript.empty() && (o.audit || o.turntable || o.severalViews());
     },
     "--input cannot be used with --audit, --turntable, --viewpoint all or several sides of "
     "--from"},
    {[](const Options& o) {
       const JobInfo* job = o.job();
       return o.input.empty() && !o.opensWindow() && (!job || job->needsWorld);
     },
     "a world (a .wrl file, or - for standard input) was expected; vv --help tells more"},
};

// Rejects worker options in a command line that names no workers.
void checkCluster(const Options& options) {
  const picture::ClusterSettings& c = options.cluster;
  const std::pair<bool, const char*> given[] = {{!c.key.empty(), "--key"},
                                                {!c.allow.empty(), "--allow-keys"},
                                                {c.localThreads >= 0, "--local-threads"},
                                                {!c.split.empty(), "--split"},
                                                {c.require > 0, "--require-workers"},
                                                {c.tolerant, "--tolerant"}};
  const auto servesControl = [&](std::string_view name) { // keys protect the control channel, too
    return !options.control.empty() && (name == "--key" || name == "--allow-keys");
  };
  for (const auto& [isGiven, name] : given)
    if (isGiven && !c.used() && !servesControl(name))
      throw UsageError(fmt::format("{} needs --workers or --listen-workers", name));
}

// Refuses parts of pictures that do not exist, or could not have the bytes of the whole.
void checkCrop(const Options& o) {
  const picture::Crop& c = o.render.crop;
  if (c.width == 0) return;
  if (o.outputs.empty() && o.compare.empty())
    throw UsageError("--crop needs -o: the window and vv serve show whole pictures");
  if (c.width > o.render.width - c.x || c.height > o.render.height - c.y)
    throw UsageError(fmt::format("--crop: {},{},{}x{} does not lie within the picture of {}x{} "
                                 "pixels (--size)",
                                 c.x, c.y, c.width, c.height, o.render.width, o.render.height));
  if (o.audit) throw UsageError("--audit tests whole pictures: it cannot be used with --crop");
  if (o.keepsSums())
    throw UsageError("--resume, --sums and --seed A-B keep whole pictures: they cannot be used with "
                     "--crop");
  if (const std::string why = picture::whyNoCrop(o.render); !why.empty())
    throw UsageError("--crop: " + why);
}

// Refuses what a preview cannot be, or could not say of itself.
void checkPreview(const Options& o) {
  if (!o.render.preview) return;
  const bool several =
      o.frames ? o.frames->last - o.frames->first >= o.frames->step : o.turntable > 1;
  const std::pair<bool, const char*> refused[] = {
      {!several || o.outputs.empty(),
       "--preview needs -o with several pictures: --frames FIRST-LAST or --turntable N"},
      {o.severalViews(), "--preview follows one view: it cannot be used with --viewpoint all or "
                         "several sides of --from"},
      {o.render.channels != RT_RGBA, "--preview rebuilds rgba only: it cannot be used with other "
                                     "--channels"},
      {o.render.error > 0 || o.render.timeLimit > 0,
       "--preview takes --spp samples of each picture and knows no errors: it cannot be used with "
       "--error or --time-limit"},
      {!o.compare.empty(), "--compare needs pictures without bias: it cannot be used with "
                           "--preview"}};
  for (const auto& [isBroken, message] : refused)
    if (isBroken) throw UsageError(message);
  for (const Output& output : o.outputs)
    if (output.film == picture::FilmKind::none && !output.format->keepsNote)
      throw UsageError(fmt::format(
          "--preview: {} files cannot say that they are previews; {} files and films can",
          output.format->name, picture::formatsWith(&picture::Format::keepsNote)));
}

// Refuses what needs values without bias, and what could not say that it is denoised.
void checkDenoise(const Options& o) {
  const bool writesRaw = std::any_of(o.outputs.begin(), o.outputs.end(),
                                     [](const Output& output) { return output.raw; });
  const bool keepsErrors = std::any_of(o.outputs.begin(), o.outputs.end(), [](const Output& one) {
    return one.raw && one.format && one.format->encode == picture::encodeExr;
  });
  if (!o.denoise && writesRaw)
    throw UsageError("--raw needs --denoise: without it, -o writes the picture as it was rendered");
  if (!o.denoise) return;
  const std::pair<bool, const char*> refused[] = {
      {o.render.error > 0, "--denoise changes colours by an amount that is not known: it cannot be "
                           "used with --error, which keeps a promise"},
      {o.audit > 0, "--audit tests error bars, and denoised pictures have none: it cannot be used "
                    "with --denoise"},
      {!o.compare.empty(), "--compare needs pictures without bias: it cannot be used with "
                           "--denoise"},
      {o.measures(), "--measure needs readings without bias: it cannot be used with --denoise"},
      {o.falseColour.has_value(), "--false-colour shows luminance to be read: it cannot be used "
                                  "with --denoise"},
      {o.sums, "--sums are those of the samples, and a denoised picture is not their mean: they "
               "cannot be used with --denoise"},
      {o.render.crop.width != 0, "--denoise looks around each pixel, so that a part would differ "
                                 "from the whole picture: it cannot be used with --crop"},
      {o.render.preview, "only one of --preview, which smooths pictures itself, and --denoise can "
                         "be used"},
      {o.outputs.size() == size_t(std::count_if(o.outputs.begin(), o.outputs.end(),
                                                [](const Output& one) { return one.raw; })),
       "--denoise needs -o (in the window, --denoiser chooses what smooths previews)"},
      {(o.render.channels & picture::errorChannels) && !keepsErrors,
       "--denoise: the channels error, trust and variance are those of the picture before; "
       "--raw FILE.exr keeps them"}};
  for (const auto& [isBroken, message] : refused)
    if (isBroken) throw UsageError(message);
  for (const Output& output : o.outputs)
    if (!output.raw && output.film == picture::FilmKind::none && !output.format->keepsNote)
      throw UsageError(fmt::format(
          "--denoise: {} files cannot say that they are denoised; {} files and films can",
          output.format->name, picture::formatsWith(&picture::Format::keepsNote)));
}

// Checks combinations of options.
void checkTogether(const Options& options) {
  if (!options.isSequence())
    for (const Output& output : options.outputs)
      if (output.film != picture::FilmKind::none)
        throw UsageError(output.path + ": a film needs --frames or --turntable");
  checkCluster(options);
  for (const Rule& rule : rules)
    if (rule.broken(options)) throw UsageError(rule.message);
  checkPreview(options);
  checkDenoise(options);
  checkCrop(options);
}

} // namespace

const JobInfo* Options::job() const {
  for (const JobInfo& info : vv::jobs)
    if (has(info.job)) return &info;
  return nullptr;
}

// Returns whether a word is a whole number, perhaps a negative one, which the option then refuses.
bool isWholeNumber(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
}

// `vv serve` and `vv merge` are commands without dashes; worlds of these names are ./serve,
// ./merge.
bool isCommand(int argc, char** argv, std::string_view name) {
  return argc > 1 && std::string_view(argv[1]) == name;
}
bool servesPage(int argc, char** argv) { return isCommand(argc, argv, "serve"); }
bool mergesSums(int argc, char** argv) { return isCommand(argc, argv, "merge"); }

// Takes the files of vv merge, and refuses options that say how to render.
void readMerge(Options& options, const std::vector<std::string>& files,
               const std::vector<std::string>& given) {
  constexpr std::string_view allowed[] = {"-o", "--sums", "--stats", "--compare", "-q", "-v"};
  for (const std::string& name : given)
    if (std::find(std::begin(allowed), std::end(allowed), name) == std::end(allowed))
      throw UsageError(fmt::format("vv merge renders nothing: {} cannot be used with it", name));
  if (files.empty())
    throw UsageError("vv merge: files were expected: EXR files that were written with --sums, or "
                     "files of --resume");
  if (options.outputs.empty()) throw UsageError("vv merge needs -o");
  for (const Output& output : options.outputs)
    if (output.film != picture::FilmKind::none)
      throw UsageError(output.path + ": vv merge makes one picture, not a film");
  options.merge = files;
}

// Rewrites optional arguments as NAME=VALUE for the parser. The word after the option is taken as
// its argument only if it is a whole number.
std::vector<std::string> withOptionalArguments(int argc, char** argv) {
  std::vector<std::string> out;
  for (int i = servesPage(argc, argv) || mergesSums(argc, argv) ? 2 : 1; i < argc; ++i) {
    out.emplace_back(argv[i]);
    for (const OptionInfo& option : optionTable()) {
      if (option.argument[0] != '[' || out.back() != longName(option)) continue;
      const bool given = i + 1 < argc && isWholeNumber(argv[i + 1]);
      out.back() += std::string("=") + (given ? argv[++i] : "-");
      break;
    }
  }
  std::reverse(out.begin(), out.end()); // CLI11 expects a vector in reverse order
  return out;
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
  try {
    app.parse(withOptionalArguments(argc, argv));
  } catch (const CLI::ArgumentMismatch&) {
    throw UsageError(missingValue(argv[argc - 1]));
  } catch (const CLI::ParseError& error) { throw UsageError(error.what()); }
  for (const std::string& extra : app.remaining())
    if (extra.size() > 1 && extra[0] == '-') throw UsageError(unknownOption(extra));
  const bool merges = mergesSums(argc, argv);
  if (inputs.size() > 1 && !merges) throw UsageError(secondFileHint(inputs[0], inputs[1]));
  if (!app.remaining().empty())
    throw UsageError(fmt::format("\"{}\" was not expected", app.remaining()[0]));
  if (!inputs.empty() && !merges) options.input = inputs[0];
  if (servesPage(argc, argv)) options.jobs.push_back(Job::serve);
  std::vector<Setting> given; // on the command line
  for (size_t i = 0; i < added.size(); ++i) {
    const OptionInfo& option = optionTable()[i];
    if (added[i]->count() == 0) continue;
    if (!*option.argument) given.push_back({&option, "", {}, {}, false});
    // If an option holds one value, the last one counts.
    const size_t first = option.repeatable || values[i].empty() ? 0 : values[i].size() - 1;
    for (size_t k = first; k < values[i].size(); ++k)
      given.push_back({&option,
                       option.argument[0] == '[' && values[i][k] == "-" ? "" : values[i][k],
                       {},
                       {},
                       false});
  }
  if (merges && options.jobs.empty()) {
    std::vector<std::string> names;
    for (const Setting& setting : given) {
      names.push_back(shownName(*setting.option));
      apply(setting, options);
    }
    readMerge(options, inputs, names);
    return options;
  }
  for (const Setting& setting : withPresets(std::move(given), options.input))
    apply(setting, options);
  mergeBackdrop(options);
  checkTogether(options);
  if (!options.inputScript.empty()) {
    options.script = std::make_shared<InputScript>(readInputScript(options.inputScript));
    if (!options.time && !options.frames && !options.opensWindow())
      options.time = options.script->end;
  }
  const picture::RenderSettings& render = options.render;
  if (options.from.size() == 1 || options.opensWindow())
    options.view.side = options.from.empty() ? std::optional<picture::Side>() : options.from[0];
  options.view.turns = options.turntable > 0;
  options.render.samples =
      options.samples.value_or(render.timeLimit > 0 && options.resume.empty()  ? 65536
                               : render.error > 0                              ? 4096
                               : options.measures() && options.outputs.empty() ? measureSamples
                               : render.preview                                ? previewSamples
                                                                               : render.samples);
  return options;
}

namespace {

// Breaks `text` into lines of at most `width`; all lines except the first are indented by `indent`
// blanks.
std::string wrapped(std::string_view text, size_t indent, size_t width) {
  std::string out;
  size_t column = 0;
  for (std::string_view word : split(text, ' ')) {
    if (column && column + 1 + word.size() > width) {
      out += "\n" + std::string(indent, ' ');
      column = 0;
    }
    if (column) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

} // namespace

std::string helpText() {
  constexpr size_t indent = 26, width = 100;
  std::string out =
      "vv: renders worlds in VRML and X3D, and meshes.\n"
      "\n"
      "  vv world.wrl                    opens the world in a window; F1 lists the keys\n"
      "  vv world.wrl -o picture.png     writes a picture from the first viewpoint, or of the "
      "whole world\n"
      "  vv world.wrl --check            reports what is wrong with the world\n"
      "  vv merge a.exr b.exr -o c.exr   adds pictures of different seeds, written with --sums\n"
      "  vv serve world.wrl              shows the world on a page for browsers; prints its "
      "address\n"
      "\n"
      "FILE is VRML97 or VRML 1.0 (.wrl, .wrz), X3D (.x3d, .x3dv, .x3dj), STL, PLY, OBJ, OFF or "
      "glTF\n(.gltf, .glb), packed with gzip or not; - is standard input.\n";
  const char* group = "";
  for (const OptionInfo& option : optionTable()) {
    if (std::string_view(group) != option.group) out += fmt::format("\n{}\n", group = option.group);
    std::string head = "  ";
    for (std::string_view name : split(option.names, ','))
      head += fmt::format("{}{}", head.size() > 2 ? ", " : "", name);
    if (*option.argument) head += fmt::format(" {}", option.argument);
    out += head;
    out += head.size() + 1 < indent ? std::string(indent - head.size(), ' ')
                                    : "\n" + std::string(indent, ' ');
    out += wrapped(option.text, indent, width - indent) + "\n";
  }
  return out +
         "\nExit codes\n"
         "  0    done\n"
         "  1    the picture could not be made or written\n"
         "  2    the command line is wrong\n"
         "  3    unusable input: the world, or another file that the command line names, "
         "cannot be read\n"
         "  4    --check, --strict or --audit found problems; --measure found no sensor or a wrong "
         "one\n"
         "  5    under --strict: a plug-in or a texture is missing\n"
         "  6    fewer workers than --require-workers asks for\n"
         "  75   out of memory or another resource, try again\n"
         "  130  interrupted; what was finished is saved. A second interrupt ends at once. "
         "SIGUSR1 saves and goes on\n";
}

} // namespace vv
