// options.cpp: Parses the command line with CLI11, according to the table of options. No other file
// includes CLI11.
#include "options.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "habits.h"
#include "libpicture/nearest.h"

namespace vv {

namespace {

constexpr JobInfo jobs[] = {
    {Job::help, "--help", false, false},
    {Job::version, "--version", false, false},
    {Job::listKeys, "--list-keys", false, false},
    {Job::listShaders, "--list-shaders", true, false},
    {Job::listEngines, "--list-engines", true, false},
    {Job::listNodes, "--list-nodes", true, false},
    {Job::explain, "--explain", true, true},
    {Job::listViewpoints, "--list-viewpoints", true, true},
    {Job::info, "--info", true, true},
};

// Returns the options of the jobs that print facts: "--info, --explain, ... and --list-engines".
std::string inspections(const char* last) {
  static constexpr Job order[] = {Job::info,           Job::explain,     Job::listNodes,
                                  Job::listViewpoints, Job::listShaders, Job::listEngines};
  std::string text;
  for (const Job job : order) {
    const auto row = std::find_if(std::begin(jobs), std::end(jobs),
                                  [job](const JobInfo& info) { return info.job == job; });
    if (!text.empty()) text += job == order[std::size(order) - 1] ? last : ", ";
    text += row->option;
  }
  return text;
}

std::string longName(const OptionInfo& option) {
  std::string_view names = option.names;
  return std::string(
      names.substr(names.find("--"), names.find(',', names.find("--")) - names.find("--")));
}

void apply(const OptionInfo& option, Options& options, const std::string& value) {
  try {
    option.apply(options, value);
  } catch (const UsageError& error) { throw UsageError(longName(option) + ": " + error.what()); }
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
  const std::string near = picture::nearest(option, allNames());
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

// Checks the options for sequences of pictures.
void checkSequence(const Options& options) {
  if (options.frames && options.time)
    throw UsageError("only one of --time and --frames can be used");
  if (options.frames && options.turntable)
    throw UsageError("only one of --frames and --turntable can be used");
  if (options.isSequence() && !options.makesPictures() && !options.check)
    throw UsageError("--frames and --turntable go with -o (or, to try a world out, with --check)");
  for (const Output& output : options.outputs) {
    if (options.isSequence() && output.path == "-")
      throw UsageError("a sequence needs file names, not standard output");
    if (!options.isSequence() && output.film != picture::FilmKind::none)
      throw UsageError(output.path + ": a film needs --frames or --turntable");
  }
  if (options.watch && !options.makesPictures() && !options.opensWindow())
    throw UsageError("--watch goes with -o, or with the window");
  if (options.watch && options.input == "-")
    throw UsageError("--watch needs a file, not standard input");
}

// Rejects worker options in a command line that names no workers.
void checkCluster(const Options& options) {
  const picture::ClusterSettings& c = options.cluster;
  const auto alone = [&](bool given, const char* name) {
    if (given && !c.used())
      throw UsageError(fmt::format("{} goes with --workers or --listen-workers", name));
  };
  alone(!c.key.empty(), "--key");
  alone(!c.allow.empty(), "--allow-keys");
  alone(c.localThreads >= 0, "--local-threads");
  alone(!c.split.empty(), "--split");
  alone(c.require > 0, "--require-workers");
  alone(c.tolerant, "--tolerant");
  if (!c.allow.empty() && c.key.empty()) throw UsageError("--allow-keys goes with --key");
  if (c.used() && !options.makesPictures() && !options.opensWindow())
    throw UsageError("--workers and --listen-workers go with -o, or with the window");
}

// Checks combinations of options.
void checkTogether(Options& options) {
  if (!options.viewpoint.empty() && (options.view.lookAt || options.view.fit))
    throw UsageError("--viewpoint: not with --camera or --fit, which look from elsewhere");
  if (!options.render.environment.empty() &&
      options.render.background.kind != picture::Background::Kind::world)
    throw UsageError(
        "only one of --environment, which shows all around, and --background can be used");
  if (options.quiet && options.verbose)
    throw UsageError("only one of --quiet and --verbose can be used");
  int toStandardOutput = (options.stats == "-") + (options.write == "-");
  for (const Output& output : options.outputs) toStandardOutput += output.path == "-";
  const auto printed = std::count_if(std::begin(jobs), std::end(jobs), [&](const JobInfo& info) {
    return info.inspects && options.has(info.job);
  });
  toStandardOutput += printed > 0;
  if (toStandardOutput > 1) throw UsageError("only one thing can go to standard output");
  if (options.json && printed == 0) throw UsageError("--json goes with " + inspections(" or "));
  if (printed > 1) throw UsageError("only one of " + inspections(" and ") + " can be used");
  checkSequence(options);
  if (options.stats.size() && !options.makesPictures()) throw UsageError("--stats goes with -o");
  if (options.render.record.size() && !options.makesPictures())
    throw UsageError("--record goes with -o");
  if (options.render.record.size() && (options.allViewpoints() || options.isSequence()))
    throw UsageError(
        "--record keeps one picture's scene: not with --viewpoint all, --frames or --turntable");
  if (options.audit && options.isSequence())
    throw UsageError("--audit is for one picture: not with --frames or --turntable");
  if ((options.audit || options.compare.size()) && toStandardOutput)
    throw UsageError("--audit and --compare write to standard output: nothing else can go there");
  if (options.audit && options.render.timeLimit > 0)
    throw UsageError("--audit: not with --time-limit, which makes no picture twice");
  checkCluster(options);
  if (options.check && options.makesPictures())
    throw UsageError("--check makes no picture: not with -o");
  if (options.makesPictures() && options.allViewpoints())
    for (const Output& output : options.outputs)
      if (output.path == "-")
        throw UsageError("--viewpoint all needs file names, not standard output");
  if (options.opensWindow() && options.allViewpoints())
    throw UsageError("--viewpoint all goes with -o");
  if (!options.recordInput.empty() && (!options.opensWindow() || !options.inputScript.empty()))
    throw UsageError("--record-input goes with the window, and not with --input");
  if (!options.inputScript.empty() && !options.makesPictures() && !options.opensWindow())
    throw UsageError("--input goes with -o, or with the window");
  if (!options.inputScript.empty() && options.opensWindow() && options.time)
    throw UsageError("only one of --input and --time can be used in the window");
  if (!options.inputScript.empty() &&
      (options.audit || options.turntable || options.allViewpoints()))
    throw UsageError("--input: not with --audit, --turntable or --viewpoint all");
  const JobInfo* job = options.job();
  const bool needsWorld = !options.opensWindow() && (!job || job->needsWorld);
  if (needsWorld && options.input.empty())
    throw UsageError(
        "a world (a .wrl file, or - for standard input) was expected; vv --help tells more");
}

} // namespace

std::span<const JobInfo> jobTable() { return jobs; }

const JobInfo* Options::job() const {
  for (const JobInfo& info : vv::jobs)
    if (has(info.job)) return &info;
  return nullptr;
}

// Rewrites optional arguments as NAME=VALUE for the parser. The word after the option is taken as
// its argument only if it begins with a digit.
std::vector<std::string> withOptionalArguments(int argc, char** argv) {
  std::vector<std::string> out;
  for (int i = 1; i < argc; ++i) {
    out.emplace_back(argv[i]);
    for (const OptionInfo& option : optionTable()) {
      if (option.argument[0] != '[' || out.back() != longName(option)) continue;
      const bool given =
          i + 1 < argc && argv[i + 1][0] >= '0' && argv[i + 1][0] <= '9' &&
          std::string_view(argv[i + 1]).find_first_not_of("0123456789") == std::string_view::npos;
      out.back() += std::string("=") + (given ? argv[++i] : "-");
      break;
    }
  }
  std::reverse(out.begin(), out.end()); // CLI11 expects a vector in reverse order
  return out;
}

Options readCommandLine(int argc, char** argv) {
  Options options;
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
  if (inputs.size() > 1) throw UsageError(secondFileHint(inputs[0], inputs[1]));
  if (!app.remaining().empty())
    throw UsageError(fmt::format("\"{}\" was not expected", app.remaining()[0]));
  if (!inputs.empty()) options.input = inputs[0];
  for (size_t i = 0; i < added.size(); ++i) {
    const OptionInfo& option = optionTable()[i];
    if (added[i]->count() == 0) continue;
    if (!*option.argument) apply(option, options, "");
    // If an option holds one value, the last one counts.
    const size_t first = option.repeatable || values[i].empty() ? 0 : values[i].size() - 1;
    for (size_t k = first; k < values[i].size(); ++k)
      apply(option, options, option.argument[0] == '[' && values[i][k] == "-" ? "" : values[i][k]);
  }
  checkTogether(options);
  if (!options.inputScript.empty()) {
    options.script = std::make_shared<InputScript>(readInputScript(options.inputScript));
    if (!options.time && !options.frames && !options.opensWindow())
      options.time = options.script->end;
  }
  const picture::RenderSettings& render = options.render;
  options.render.samples = options.samples.value_or(render.timeLimit > 0 ? 65536
                                                    : render.error > 0   ? 4096
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
      "vv: renders VRML97 worlds.\n\n"
      "  vv world.wrl                    a window to look at it; F1 there lists the keys\n"
      "  vv world.wrl -o picture.png     first viewpoint, or the whole world in view; shadows; 16 "
      "samples a pixel\n"
      "  vv world.wrl --check            say what is wrong with the world\n\n"
      "FILE is .wrl, .wrz or .wrl.gz; - is standard input.\n";
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
  return out + "\nExit codes: 0 done, 1 the picture failed, 2 usage, 3 the world is missing or "
               "unusable, 4 problems found by --check or\n"
               "--strict, 5 a plug-in or a texture is missing under --strict, 6 too few workers "
               "under --require-workers, 75 try again,\n"
               "130 interrupted (what was finished is saved; a second interrupt ends at once; "
               "SIGUSR1 saves and goes on).\n";
}

} // namespace vv
