// rules.cpp: checks what the rows of options need and exclude, and has the rules that hang on the
// values of options, or on several at once.
#include "rules.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "libpicture/denoiser.h"
#include "option_info.h"

namespace vv {
namespace {

using picture::Background;

bool writesToStandardOutput(const Options& o) {
  return std::any_of(o.outputs.begin(), o.outputs.end(),
                     [](const Output& output) { return output.path == "-"; });
}

// Counts what goes to standard output.
int printed(const Options& o) {
  const auto pictures = std::count_if(o.outputs.begin(), o.outputs.end(),
                                      [](const Output& output) { return output.path == "-"; });
  return int(pictures) + (o.measure == "-") + (o.stats == "-") + (o.write == "-") +
         (inspectionsOf(o) > 0);
}

bool showsOnePicture(const Options& o) { return !o.severalViews() && !o.isSequence(); }

// A name that rows of options can have beside those of options. An option of this name counts only
// if the condition holds.
struct Condition {
  std::string_view name;
  bool (*holds)(const Options& options);
};
constexpr Condition conditions[] = {
    {"-o", [](const Options& o) { return o.makesPictures(); }},
    {"the window", [](const Options& o) { return o.opensWindow(); }},
    {"vv serve", [](const Options& o) { return o.has(Job::serve); }},
    {"vv compare", [](const Options& o) { return o.has(Job::compare); }},
    {"vv film", [](const Options& o) { return o.has(Job::film); }},
    {"--viewpoint all", [](const Options& o) { return o.severalViews(); }},
    {"several sides of --from", [](const Options& o) { return o.severalViews(); }},
    {"--error", [](const Options& o) { return o.render.error > 0; }},
    {"--time-limit", [](const Options& o) { return o.render.timeLimit > 0; }},
};

bool holds(const Options& options, std::string_view name) {
  for (const Condition& condition : conditions)
    if (condition.name == name) return condition.holds(options);
  return options.isGiven(name);
}

// A combination of options that cannot be used, and the message for it.
struct Rule {
  bool (*broken)(const Options& options);
  std::string message;
};

// Returns "a, b or c".
std::string joined(const std::vector<std::string_view>& words, std::string_view last) {
  std::string all;
  for (size_t i = 0; i < words.size(); ++i)
    all += (i == 0                 ? ""
            : i + 1 < words.size() ? ", "
                                   : fmt::format(" {} ", last)) +
           std::string(words[i]);
  return all;
}

std::vector<std::string_view> inspections() {
  std::vector<std::string_view> names;
  for (const JobInfo& info : jobTable)
    if (info.inspects) names.emplace_back(info.name);
  return names;
}

// The first broken rule is reported, after those of the rows of options.
const Rule rules[] = {
    {[](const Options& o) { return o.view.intrinsics && (!o.makesPictures() || o.render.preview); },
     "--intrinsics needs -o without --preview"},
    {[](const Options& o) {
       return o.render.studio.on &&
              (o.render.hasSurroundings() || o.render.background.kind != Background::Kind::world);
     },
     "--studio has a light and a backdrop of its own: it cannot be used with --environment, --sky "
     "or a --background other than a colour"},
    {[](const Options& o) { return o.render.sky && !o.render.environment.empty(); },
     "only one of --sky and --environment can be used"},
    {[](const Options& o) {
       return o.render.hasSurroundings() && o.render.background.kind != Background::Kind::world;
     },
     "only one of --environment and --sky, which show all around, and --background can be used"},
    {[](const Options& o) { return printed(o) > 1; }, "only one thing can go to standard output"},
    {[](const Options& o) { return o.json && inspectionsOf(o) == 0 && !o.has(Job::compare); },
     "--json needs " + joined(inspections(), "or") + ", or vv compare"},
    {[](const Options& o) { return inspectionsOf(o) > 1; },
     fmt::format("only one of {} can be used", joined(inspections(), "and"))},
    // sequences of pictures
    {[](const Options& o) { return o.isSequence() && writesToStandardOutput(o); },
     "a sequence needs file names, not standard output"},
    {[](const Options& o) {
       return (o.missing || o.farmJobs > 0) &&
              std::any_of(o.outputs.begin(), o.outputs.end(), [](const Output& output) {
                return output.film != picture::FilmKind::none;
              });
     },
     "--missing and --jobs are for files of single frames, such as .png: they cannot be used with "
     "a "
     "film"},
    {[](const Options& o) { return (o.missing || o.farmJobs > 0) && o.fitExposure; },
     "--exposure auto is chosen by the first picture of a run, and --missing and --jobs make "
     "several "
     "runs: give a number, as vv tells it for one picture of the film"},
    {[](const Options& o) { return o.farmJobs > 0 && o.input == "-"; },
     "--jobs needs a file, not standard input: each job reads it"},
    {[](const Options& o) { return o.watch && o.input == "-"; },
     "--watch needs a file, not standard input"},
    // values of pictures
    {[](const Options& o) { return (o.audit || !o.compare.empty()) && printed(o) > 0; },
     "--audit and --compare write to standard output: nothing else can go there"},
    {[](const Options& o) {
       return o.falseColour && (!o.opensWindow() || o.noWindow) &&
              std::none_of(o.outputs.begin(), o.outputs.end(), [](const Output& output) {
                return output.film != picture::FilmKind::none || output.format->appliesCurve;
              });
     },
     "--false-colour needs the window, or -o with a film or a file for a screen, such as .png"},
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
    {[](const Options& o) {
       return o.makesPictures() && o.render.denoiser == picture::Denoiser::oidn;
     },
     "--denoiser oidn is for windows and pages: with -o, --denoise filters pictures and previews"},
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
    // many pictures
    {[](const Options& o) {
       return o.makesPictures() && o.severalViews() && writesToStandardOutput(o);
     },
     "--viewpoint all and several sides of --from need file names, not standard output"},
    // the page
    {[](const Options& o) {
       return o.has(Job::edit) && (!o.opensWindow() || o.noWindow || inspectionsOf(o) > 0);
     },
     "vv edit opens a window: it cannot be used with --no-window, -o, --compare, --audit, "
     "--measure, "
     "--check, --write or a list"},
    {[](const Options& o) {
       return o.has(Job::serve) &&
              (o.makesPictures() || o.check || !o.write.empty() || inspectionsOf(o) > 0);
     },
     "vv serve shows the world on a page: it cannot be used with -o, --compare, --audit, --check, "
     "--write, --info or a list"},
    // the window
    {[](const Options& o) { return o.showsWorld() && o.severalViews(); },
     "--viewpoint all and several sides of --from need -o"},
    {[](const Options& o) { return !o.inputScript.empty() && o.opensWindow() && o.time; },
     "only one of --input and --time can be used in the window"},
    {[](const Options& o) {
       const JobInfo* job = o.job();
       return o.input.empty() && (job ? job->needsWorld : !o.opensWindow());
     },
     "a world (a .wrl file, or - for standard input) was expected; vv --help tells more"},
};

// Checks the rules in the rows of the options that are given.
void checkRows(const Options& options) {
  for (const OptionInfo& option : optionTable()) {
    if (option.traits.rules.empty() || !holds(options, longName(option))) continue;
    for (const OptionRule& rule : option.traits.rules) {
      const std::vector<std::string_view> names = split(rule.names, ',');
      const bool any = std::any_of(names.begin(), names.end(),
                                   [&](std::string_view name) { return holds(options, name); });
      if (any == rule.needs) continue;
      const std::string message =
          rule.message ? rule.message
                       : longName(option) + (rule.needs ? " needs {}" : " cannot be used with {}");
      throw UsageError(fmt::format(fmt::runtime(message), joined(names, "or")));
    }
  }
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
  if (o.keepsSums())
    throw UsageError(
        "--resume, --sums and --seed A-B keep whole pictures: they cannot be used with "
        "--crop");
  if (const std::string why = picture::whyNoCrop(o.render); !why.empty())
    throw UsageError("--crop: " + why);
}

// Refuses files that could not say what their picture is. what: what an option makes.
void checkNotes(const Options& o, const char* option, const char* what) {
  for (const Output& output : o.outputs)
    if (!output.raw && output.film == picture::FilmKind::none && !output.format->keepsNote)
      throw UsageError(fmt::format(
          "{}: {} files cannot say that they are {}; {} files and films can", option,
          output.format->name, what, picture::formatsWith(&picture::Format::keepsNote)));
}

// Refuses what a preview cannot be, or could not say of itself.
void checkPreview(const Options& o) {
  if (!o.render.preview) return;
  const std::pair<bool, const char*> refused[] = {
      {!o.isSequence() || o.outputs.empty(),
       "--preview needs -o with the frames of a film: --frames or --turntable"},
      {o.render.channels != RT_RGBA, "--preview rebuilds rgba only: it cannot be used with other "
                                     "--channels"}};
  for (const auto& [isBroken, message] : refused)
    if (isBroken) throw UsageError(message);
  checkNotes(o, "--preview", "previews");
}

// Refuses what needs values without bias, and what could not say that it is denoised.
void checkDenoise(const Options& o) {
  const bool keepsErrors = std::any_of(o.outputs.begin(), o.outputs.end(), [](const Output& one) {
    return one.raw && one.format && one.format->encode == picture::encodeExr;
  });
  if (!o.denoise) return;
  const std::pair<bool, const char*> refused[] = {
      {o.outputs.size() == size_t(std::count_if(o.outputs.begin(), o.outputs.end(),
                                                [](const Output& one) { return one.raw; })),
       "--denoise needs -o (in the window, --denoiser chooses what smooths previews)"},
      {(o.render.channels & picture::errorChannels) && !keepsErrors,
       "--denoise: the channels error, trust and variance are those of the picture before; "
       "--raw FILE.exr keeps them"}};
  for (const auto& [isBroken, message] : refused)
    if (isBroken) throw UsageError(message);
  checkNotes(o, "--denoise", "denoised");
}

} // namespace

void checkTogether(const Options& options) {
  if (!options.isSequence())
    for (const Output& output : options.outputs)
      if (output.film != picture::FilmKind::none)
        throw UsageError(output.path + ": a film needs --frames or --turntable");
  checkRows(options);
  for (const Rule& rule : rules)
    if (rule.broken(options)) throw UsageError(rule.message);
  checkPreview(options);
  if (options.render.raster) checkNotes(options, "--preview-raster", "fast views");
  checkDenoise(options);
  checkCrop(options);
}

} // namespace vv
