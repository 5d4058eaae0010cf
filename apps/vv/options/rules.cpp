// rules.cpp: combinations of options that cannot be used, each with its message.
#include "rules.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "libpicture/denoiser.h"

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
    {[](const Options& o) {
       return o.view.ortho && (o.view.fit || o.view.fov || o.view.intrinsics);
     },
     "--ortho says what the camera sees: it cannot be used with --fit, --fov or --intrinsics"},
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
    {[](const Options& o) { return !o.recordInput.empty() && !o.control.empty(); },
     "--record-input holds what the user does, not the commands of programs: it cannot be used "
     "with --control"},
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
       return o.input.empty() && o.merge.empty() && !o.opensWindow() && (!job || job->needsWorld);
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
    throw UsageError(
        "--resume, --sums and --seed A-B keep whole pictures: they cannot be used with "
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
} // namespace

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

} // namespace vv
