// option_table.cpp: Defines every option of vv: names, argument, help text and effect. The options
// of the group Cluster are in cluster_options.cpp, those of quality settings in
// quality_options.cpp. Longer than 500 lines because it is one table.
#include "option_info.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include <fmt/format.h>

#include "names.h"
#include "nearest.h"
#include "xvrml/step_error.h"

namespace vv {

namespace {

using xvrml::MapOptions;

void addOutput(Options& o, const std::string& value) {
  if (value == "-") return o.outputs.push_back({"-", picture::formatNamed("png")});
  // FORMAT:FILE selects the format for names with another suffix, or without one.
  if (const size_t colon = value.find(':'); colon != value.npos && colon + 1 < value.size()) {
    const std::string file = value.substr(colon + 1);
    if (const picture::Format* format = picture::formatNamed(value.substr(0, colon))) {
      if (file != "-") checkFramePlace(file);
      return o.outputs.push_back({file, format});
    }
    if (picture::filmOf("film." + value.substr(0, colon)) != picture::FilmKind::none)
      throw UsageError(fmt::format(
          "the suffix of the file name selects a film format: write -o {}.{} instead of \"{}\"",
          file, value.substr(0, colon), value));
  }
  checkFramePlace(value);
  if (const picture::FilmKind film = picture::filmOf(value); film != picture::FilmKind::none)
    return o.outputs.push_back({value, nullptr, film});
  const picture::Format* format = picture::formatOf(value);
  if (!format)
    throw UsageError(
        fmt::format("a file name with one of the suffixes {}, {} was expected, not \"{}\"",
                    picture::formatSuffixes(), picture::filmSuffixes, value));
  o.outputs.push_back({value, format});
}

void notEmpty(const std::string& value, const char* what) {
  if (value.empty()) throw UsageError(fmt::format("{} was expected", what));
}

void setWrite(Options& o, const std::string& value) {
  o.write = value;
  const size_t colon = value.find(':');
  const std::string format = value.substr(0, colon == value.npos ? 0 : colon);
  const bool isExport = picture::exportFormatNamed(format) != nullptr;
  const bool named =
      isExport || format == "wrl" || format == "x3dv" || format == "x3d" || format == "x3dj";
  if (named) o.write = value.substr(colon + 1);
  // The name of a format says the same as the suffix of a file name.
  const std::string name = named ? "." + format : value;
  o.writeFormat = picture::exportFormatOf(name);
  o.writeEncoding = xvrml::writtenEncoding(name);
  notEmpty(o.write, "a file name");
}

void setHeadlight(Options& o, const std::string& value) {
  if (value == "auto")
    o.render.headlight = MapOptions::Headlight::automatic;
  else if (value == "on" || value == "off")
    o.render.headlight = value == "on" ? MapOptions::Headlight::on : MapOptions::Headlight::off;
  else
    throw UsageError(fmt::format("on, off or auto was expected, not \"{}\"", value));
}

void setIsa(Options& o, const std::string& value) {
  try {
    picture::checkIsa(value);
  } catch (const picture::RenderError& error) {
    throw UsageError(fmt::format("{}, not \"{}\"", error.what(), value));
  }
  o.render.isa = value;
}

void setDenoiser(Options& o, const std::string& value) {
  using picture::Denoiser;
  if (value != "auto" && value != "own" && value != "oidn")
    throw UsageError(fmt::format("auto, own or oidn was expected, not \"{}\"", value));
  o.render.denoiser = value == "auto"  ? Denoiser::automatic
                      : value == "own" ? Denoiser::own
                                       : Denoiser::oidn;
  try {
    picture::checkDenoiser(o.render.denoiser);
  } catch (const picture::RenderError& error) { throw UsageError(error.what()); }
}

void setDenoise(Options& o, const std::string&) {
  o.denoise = true;
  try {
    picture::checkDenoiser(picture::Denoiser::oidn);
  } catch (const picture::RenderError& error) { throw UsageError(error.what()); }
}

void addRaw(Options& o, const std::string& value) {
  addOutput(o, value);
  o.outputs.back().raw = true;
}

void setBackground(Options& o, const std::string& value) {
  try {
    o.render.background = picture::readBackground(value);
  } catch (const std::invalid_argument& error) { throw UsageError(error.what()); }
}

void setColour(Options& o, const std::string& value) {
  if (value != "linear" && value != "vrml97")
    throw UsageError(fmt::format("linear or vrml97 was expected, not \"{}\"", value));
  o.render.linear = value == "linear";
}

void setExposure(Options& o, const std::string& value) {
  o.viewGiven = true;
  o.fitExposure = value == "auto";
  if (o.fitExposure) return;
  try {
    // the limits of readNumber are exclusive
    o.render.view.exposure =
        readNumber(value, -picture::mostExposure - 1e-9, picture::mostExposure + 1e-9);
  } catch (const UsageError&) {
    throw UsageError(fmt::format("auto or a number of stops from -{0} to {0} was expected, not "
                                 "\"{1}\"",
                                 picture::mostExposure, value));
  }
}

void setView(Options& o, const std::string& value) {
  o.viewGiven = true;
  const std::optional<picture::ViewCurve> curve = picture::curveNamed(value);
  if (!curve)
    throw UsageError(fmt::format("{} was expected, not \"{}\"", picture::curveNames, value));
  o.render.view.curve = *curve;
}

void setCompat(Options& o, const std::string& value) {
  for (const std::string_view name : split(value, ',')) {
    if (name == "scripts")
      o.run.directOutputAlways = true;
    else if (name == "textures")
      o.render.multiplyTextures = true;
    else
      throw UsageError(fmt::format("scripts or textures was expected, not \"{}\"", name));
  }
}

std::string channelNames(std::string_view separator) {
  std::string names;
  for (const picture::Channel& channel : picture::channelTable())
    names += std::string(names.empty() ? "" : separator) + std::string(channel.name);
  return names;
}

// Returns a sentence for each channel whose name does not say enough.
std::string channelTexts() {
  std::string texts;
  for (const picture::Channel& channel : picture::channelTable())
    if (!channel.text.empty()) texts += fmt::format(" {} {}.", channel.name, channel.text);
  return texts;
}

void setChannels(Options& o, const std::string& value) {
  uint32_t channels = 0;
  for (std::string_view name : split(value, ',')) {
    const picture::Channel* channel = picture::findChannel(name);
    if (!channel)
      throw UsageError(
          fmt::format("one of the channels {} was expected, not \"{}\"", channelNames(","), name));
    channels |= channel->bit;
  }
  o.render.channels = channels | RT_RGBA;
}

void setLimit(Options& o, const std::string& value) {
  const size_t equals = value.find('=');
  const std::string name = value.substr(0, equals);
  std::vector<std::string> names;
  std::string known;
  for (const xvrml::LimitInfo& limit : xvrml::limitTable()) {
    names.emplace_back(limit.name);
    known += (known.empty() ? "" : ", ") + std::string(limit.name);
  }
  // a limit of the running world, not of its file
  constexpr std::string_view ofScripts = "worldScriptSeconds";
  names.emplace_back(ofScripts);
  known += ", " + names.back();
  if (equals == value.npos)
    throw UsageError(
        fmt::format("NAME=VALUE was expected, not \"{}\"; the limits are {}", value, known));
  const uint64_t count = readCount(std::string_view(value).substr(equals + 1));
  if (name == ofScripts) return void(o.run.worldScriptSeconds = double(count));
  if (xvrml::setLimit(o.load.limits, name, count)) return;
  const std::string near = nearest::word(name, names);
  throw UsageError(fmt::format("there is no limit \"{}\"{}; the limits are {}", name,
                               near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                               known));
}

double secondsSince1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void addShader(Options& o, const std::string& value) {
  try {
    if (!value.starts_with('@')) {
      picture::checkShaderRule(value);
      return o.shaders.push_back({value, "--shader", {}, false});
    }
    for (picture::ShaderRule& rule : picture::readShaderRules(value.substr(1)))
      o.shaders.push_back(std::move(rule));
  } catch (const picture::ShaderError& error) {
    throw UsageError(error.what());
  } catch (const std::runtime_error& error) {
    throw Failure{exitInput, fmt::format("--shader: {}", error.what())};
  }
}

void setFrom(Options& o, const std::string& value) {
  o.from.clear();
  for (const std::string_view name : split(value, ',')) {
    const std::optional<picture::Side> side = picture::sideNamed(name);
    if (!side)
      throw UsageError(fmt::format("sides of {}, separated by commas, were expected, not \"{}\"",
                                   picture::sideNames(), name));
    if (std::find(o.from.begin(), o.from.end(), *side) != o.from.end())
      throw UsageError(fmt::format("{} is named twice", name));
    o.from.push_back(*side);
  }
}

using enum Trait;

template <Job job> void ask(Options& o, const std::string&) { o.jobs.push_back(job); }

constexpr const char *sequenceNeeds =
                         "--frames and --turntable need -o (or --check, to test a world)",
                     *samplesNeed = "--samples is for {}; --spp N sets the samples per pixel",
                     *pageNeeds = "--port, --address, --token and --edit need {}";

const OptionInfo table[] = {
    {"-o,--output", "FILE", "Picture",
     "Write the picture to FILE. The suffix selects the format (" + picture::formatSuffixes() +
         "); FORMAT:FILE selects it for any other name. - writes a PNG to standard output (exr:- "
         "an "
         "OpenEXR file, and so on). In a sequence, {frame:4} in the name is replaced by the frame "
         "number with four digits; the suffix mp4, webm or gif makes a film. May be given several "
         "times.",
     addOutput, with(repeatable)},
    {"--size", "WxH", "Picture",
     "Width and height of pictures and of the window, in pixels (default 800x600).",
     [](Options& o, const std::string& v) { readSize(v, o.render.width, o.render.height); },
     with(inPresets)},
    {"--crop", "X,Y,WxH", "Picture",
     "Make only this part of the picture of --size: W x H pixels, the first X from the left and Y "
     "from the top. They have the same bytes as in the whole picture and take their share of its "
     "time. An EXR file says where the part lies (dataWindow in displayWindow).",
     [](Options& o, const std::string& v) { o.render.crop = readCrop(v); }},
    {"--channels", "LIST", "Picture",
     "Channels of an EXR file, separated by commas: " + channelNames(", ") + " (default rgba)." +
         channelTexts(),
     setChannels, with(inPresets)},
    {"--colour,--color", "linear|vrml97", "Picture",
     "linear (default): colours of the file are decoded from sRGB, light is added linearly, and " +
         picture::formatsWith(&picture::Format::appliesCurve) +
         " files get the sRGB curve. vrml97: the standard's lighting equation is applied to the "
         "numbers as written, without any curve.",
     setColour, with(inPresets, inViews)},
    {"--false-colour,--false-color", "auto|MAX", "Picture",
     "Show luminance in colours, with isolines and a legend in cd/m2, in the window and in " +
         picture::formatsWith(&picture::Format::appliesCurve) +
         " files and films. MAX is the luminance at the end of the scale; auto chooses a round one "
         "by the first picture of the run, in the window by each finished picture. The file is "
         "wider than --size by the legend.",
     [](Options& o, const std::string& v) {
       o.falseColour = v == "auto" ? 0 : readNumber(v, 1e-12, 1e12);
     },
     with(inPresets)},
    {"--exposure", "EV|auto", "Picture",
     "Brighten " + picture::formatsWith(&picture::Format::appliesCurve) +
         " files and films by EV stops: light is multiplied by 2 to the power of EV (default 0). "
         "auto fits it to the luminances of the first picture of the run, for all its pictures, "
         "and "
         "says what it chose. EXR files keep the light as it is and record the value.",
     setExposure, with(inPresets)},
    {"--view", "standard|filmic|agx", "Picture",
     "How light beyond the range of screens is shown in the same files. standard (default): cut "
     "off at 1. filmic: Hable's curve, dark ends and bright ends of each colour are compressed. "
     "agx: bright colours turn white gradually, as on film, and hues stay.",
     setView, with(inPresets)},
    {"--background", "none|COLOUR|FILE", "Picture",
     "Replace the world's Background, which then is not seen in mirrors either. none: nothing; " +
         picture::formatsWith(&picture::Format::keepsAlpha) +
         " files are transparent there. COLOUR: a name (white), #rgb, #rrggbb, or R,G,B from 0 to "
         "1. FILE: a picture that covers the whole frame (png, jpg, gif, webp, bmp, tga; exr, hdr, "
         "pfm).",
     setBackground, with(inPresets, inViews, Purpose::surroundings)},
    {"--denoise", "", "Picture",
     "Remove the noise of the pictures of -o by Open Image Denoise 2, which must be installed "
     "(--list-features). Such pictures are biased and have no error bars; files and --stats say "
     "so.",
     setDenoise,
     with(inPresets,
          excludes("--error", "--denoise changes colours by an amount that is not known: it cannot "
                              "be used with {}, which keeps a promise"),
          excludes("--audit", "{} tests error bars, and denoised pictures have none: it cannot be "
                              "used with --denoise"),
          excludes("--compare", "{} needs pictures without bias: it cannot be used with --denoise"),
          excludes("--measure", "{} needs readings without bias: it cannot be used with --denoise"),
          excludes("--false-colour",
                   "{} shows luminance to be read: it cannot be used with --denoise"),
          excludes("--sums", "{} are those of the samples, and a denoised picture is not their "
                             "mean: they cannot be used with --denoise"),
          excludes("--crop", "--denoise looks around each pixel, so that a part would differ from "
                             "the whole picture: it cannot be used with {}"))},
    {"--raw", "FILE", "Picture",
     "With --denoise: also write the picture as it was rendered, in the formats and with the names "
     "that -o knows. May be given several times.",
     addRaw,
     with(repeatable,
          needs("--denoise",
                "--raw needs {}: without it, -o writes the picture as it was rendered"))},
    {"--audit-denoise", "[PERCENT]", "Picture",
     "With --denoise: count the pixels whose denoised colour leaves the 99 % interval of the "
     "picture "
     "before, for --stats, and show them in the channel doubt of EXR files (above 1: doubtful). "
     "The "
     "exit code is 4 if they are more than PERCENT of the pixels that have intervals. Needs --spp "
     "32 "
     "or more.",
     [](Options& o, const std::string& v) {
       o.mostDoubt = v.empty() ? 1 : readNumber(v, -1e-9, 100 + 1e-9) / 100;
     },
     with(needs("--denoise"))},
    {"--preview-raster", "", "Picture",
     "Draw the pictures of -o by a z-buffer instead of rays, for a first look at a large world: "
     "without shadows, reflections, refractions and samples. Files say so.",
     [](Options& o, const std::string&) { o.render.raster = true; },
     with(needs("-o"),
          excludes(
              "--spp,--error,--time-limit,--channels,--transport,--resume,--sums,--seed,"
              "--audit,--compare,--measure,--stats,--false-colour,--denoise,--preview,"
              "--record,--environment,--sky,--studio,--camera-shader,--workers,--listen-workers",
              "--preview-raster draws without rays: it cannot be used with {}"))},
    {"--viewpoint", "NAME|N|all", "View",
     "Look from this viewpoint, given by DEF name, description or number from 0 (default: the "
     "first). all makes a picture from each viewpoint; its name replaces {viewpoint} in the file "
     "name, or is added before the suffix.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a name, a number or all");
       o.viewpoint = v;
     },
     with(inPresets, Purpose::view,
          excludes("--camera,--pose,--fit",
                   "--viewpoint cannot be used with {}, which choose another view"))},
    {"--camera", "PX,PY,PZ:TX,TY,TZ[:UX,UY,UZ]", "View",
     "Look from a position at a target. The up vector defaults to the axis of --up, or else to "
     "0,1,0. With --fit only the direction is used: the camera moves back until the whole world is "
     "in the picture.",
     [](Options& o, const std::string& v) { o.view.lookAt = readCamera(v); },
     with(inPresets, Purpose::view)},
    {"--pose", "MATRIX|FILE", "View",
     "Look from a camera with this pose: a 4x4 matrix from camera to world, 16 numbers row by row "
     "with commas, or a file of them. The camera's x points to the right, y down and z forward, as "
     "in OpenCV; after opengl: before the numbers, y points up and z backward, as in VRML and "
     "Blender.",
     [](Options& o, const std::string& v) {
       if (o.view.lookAt) throw UsageError("only one of --camera and --pose can be used");
       o.view.lookAt = readPose(v, o.poseFile);
       o.posed = true;
     },
     with(Purpose::view,
          excludes("--fit", "--pose says where the camera stands: it cannot be used with {}"))},
    {"--intrinsics", "FX,FY,CX,CY", "View",
     "Focal lengths and principal point in pixels of --size, as OpenCV has them (the centre of the "
     "first pixel is at 0,0), instead of an angle of view: a point at x,y,z of an OpenCV camera "
     "appears at FX x/z + CX, FY y/z + CY. The camera stands as --pose, --camera, --viewpoint or "
     "the first Viewpoint says.",
     [](Options& o, const std::string& v) { o.view.intrinsics = readIntrinsics(v); },
     with(Purpose::angle,
          excludes("--fit,--fov,--camera-shader",
                   "--intrinsics says what the camera sees: it cannot be used with {}"))},
    {"--fit", "", "View",
     "Place the camera so that the whole world is in the picture. It looks in the direction of "
     "--camera or of the first Viewpoint. A world without Viewpoint is shown in three-quarter "
     "view, and there --fit is the default.",
     [](Options& o, const std::string&) { o.view.fit = true; }, with(inPresets, Purpose::view)},
    {"--from", "LIST", "View",
     "Show the whole model from these sides: three-quarter, above, front, back, left, right, top, "
     "bottom. Several, separated by commas, make a picture each; the side replaces {viewpoint} in "
     "the file name, or is added before the suffix. A turntable begins at the first one, and the "
     "others get one picture.",
     setFrom,
     with(inPresets, Purpose::view,
          excludes("--viewpoint,--camera,--pose,--fit",
                   "--from cannot be used with --viewpoint, --camera or --fit, which choose "
                   "another view"))},
    {"--up", "x|y|z|-x|-y|-z", "View",
     "The axis that points up, for the three-quarter view, --turntable and --camera. Default: y in "
     "a world with a Viewpoint; otherwise it is guessed from the program that wrote the file and "
     "from the shape of the model (--info gives the reason).",
     [](Options& o, const std::string& v) { o.view.up = readAxis(v); }, with(inPresets)},
    {"--fov", "DEGREES", "View",
     "Angle of view across the shorter side of the picture, instead of the viewpoint's.",
     [](Options& o, const std::string& v) { o.view.fov = readNumber(v, 0, 180); },
     with(inPresets, Purpose::angle)},
    {"--ortho", "HEIGHT", "View",
     "Show a parallel view, as an OrthoViewpoint does: HEIGHT units of the world between the lower "
     "and the upper edge of the picture.",
     [](Options& o, const std::string& v) { o.view.ortho = readNumber(v, 0, 1e30); },
     with(inPresets, Purpose::angle,
          excludes("--fit,--fov,--intrinsics",
                   "--ortho says what the camera sees: it cannot be used with {}"))},
    {"--camera-shader", "CLASS[:PARAM=VALUE...]", "View",
     "Use a camera shader at the same place: ThinLens:radius=.1:focus=5 (depth of field), Panorama "
     "(everything around).",
     [](Options& o, const std::string& v) { o.cameraShader = v; }, with(inPresets, inViews)},
    {"--headlight", "on|off|auto", "View",
     "Turn the light at the camera on or off. auto (default) follows NavigationInfo; a world "
     "without Viewpoint, NavigationInfo and lights gets three soft lights around the camera "
     "instead.",
     setHeadlight, with(inPresets)},
    {"--time", "SECONDS", "Time",
     "Show the world this many seconds after it was loaded (default 0). World time advances in "
     "steps of 1/fps, as in a sequence; the clock of the machine is not used.",
     [](Options& o, const std::string& v) { o.time = readSeconds(v); }},
    {"--epoch", "SECONDS|now", "Time",
     "Date and time at which the world is loaded, in seconds since 1970; startTime and Scripts use "
     "it. The default is always 1729728000 (24 October 2024), so that pictures are reproducible. "
     "In the window the default is now, the clock of this machine.",
     [](Options& o, const std::string& v) {
       o.epoch = v == "now" ? secondsSince1970() : readNumber(v, -1, 1e11);
     }},
    {"--frames", "A-B[/STEP]", "Time",
     "Make a picture of each frame from A to B. Frame N shows the world at N/fps seconds and is "
     "the same picture in every sequence that contains it. Its number replaces {frame:4} in the "
     "file name, or is added before the suffix.",
     [](Options& o, const std::string& v) { o.frames = readFrames(v); },
     with(excludes("--time", "only one of {} and --frames can be used"),
          excludes("--turntable", "only one of --frames and {} can be used"),
          needs("-o,--check", sequenceNeeds))},
    {"--missing", "", "Time",
     "Make only those frames of --frames whose files are absent or damaged.",
     [](Options& o, const std::string&) { o.missing = true; },
     with(needs("--frames"), needs("-o"), excludes("--viewpoint all,several sides of --from"))},
    {"--jobs", "N", "Time",
     "Make no pictures, but print N commands, each for a part of --frames, for the machines of a "
     "farm (docs/farms.md). They cost about the same, by a few frames that are drawn in small.",
     [](Options& o, const std::string& v) { o.farmJobs = int(readInteger(v, 1, 1000000)); },
     with(needs("--frames"), needs("-o"),
          excludes("--check,--measure,--compare,--stats,--input,--watch,--resume"))},
    {"--join", "", "Time",
     "Make a film of pictures that are there: vv film --join f-*.png -o film.mp4, in the order of "
     "the "
     "command line. All must have one size.",
     [](Options&, const std::string&) {}, with(needs("vv film"))},
    {"--fps", "F", "Time",
     "Frames per second of sequences, films and the window, and steps per second of the world's "
     "clock (default 30).",
     [](Options& o, const std::string& v) { o.fps = readNumber(v, 0.001, 100000); },
     with(inPresets)},
    {"--turntable", "N", "Time",
     "Make N pictures, once around the world's centre, beginning at the chosen view. The camera "
     "turns about the axis that points up (--up).",
     [](Options& o, const std::string& v) { o.turntable = int(readInteger(v, 1, 100000)); },
     with(inPresets, needs("-o,--check", sequenceNeeds))},
    {"--preview", "", "Time",
     "Rebuild each picture of a film from few samples and from the 8 to 15 frames before it, as "
     "the "
     "window does while something moves; --denoise filters them, too. Such pictures are biased and "
     "have no error bars, and their files say so.",
     [](Options& o, const std::string&) { o.render.preview = true; },
     with(excludes("--viewpoint all,several sides of --from",
                   "--preview follows one view: it cannot be used with {}"),
          excludes("--error,--time-limit", "--preview takes --spp samples of each picture and "
                                           "knows no errors: it cannot be used with {}"),
          excludes("--compare",
                   "{} needs pictures without bias: it cannot be used with --preview"))},
    {"--denoiser", "auto|own|oidn", "Time",
     "What smooths the light of previews in windows and on pages: own, the filter that vv always "
     "has; oidn, beside it Open Image Denoise 2, which must be installed; auto (default), that "
     "library where it is there and fast enough.",
     setDenoiser},
    {"--input", "FILE", "Time",
     "Replay mouse and keyboard input from FILE, one event per line: SECONDS EVENT (move X Y, "
     "press left, release left, key PageDown, viewpoint NAME ...; docs/window.md). World time "
     "advances in steps of 1/fps from 0, so the same script makes the same pictures in the window "
     "and with -o. With -o, the picture shows the end of the script by default.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.inputScript = v;
     },
     with(needs("-o,the window"),
          excludes("--audit,--turntable,--viewpoint all,several sides of --from"))},
    {"--record-input", "FILE", "Time",
     "Write the mouse and keyboard input of the window to FILE, for --input. Its time begins at 0.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.recordInput = v;
     },
     with(needs("the window", "--record-input needs {} and cannot be used with --input"),
          excludes("--input", "--record-input needs the window and cannot be used with {}"),
          excludes("--control", "--record-input holds what the user does, not the commands of "
                                "programs: it cannot be used with {}"))},
    {"--preset", "studio|product|technical|pcb|NAME", "Change",
     "Use the options of a preset, unless others are given: studio (soft light, grey backdrop), "
     "product (the same before white), technical (the light of the camera, white), pcb (a "
     "studio for KiCad's boards, with materials by names and colours), or one of a vv.toml."},
    {"--config", "FILE|none", "Change",
     "Take presets and options from FILE, or from none, instead of the vv.toml beside the world "
     "(docs/presets.md)."},
    {"-D,--define", "DEF.FIELD=VALUE", "Change",
     "Set a field of a node with a DEF name before rendering. The value is written as in a VRML "
     "file (Door.translation='0 0 2', Sign.string='\"open\"'). May be given several times.",
     [](Options& o, const std::string& v) {
       const size_t equals = v.find('=');
       const size_t dot = v.find('.');
       if (equals == v.npos || dot == v.npos || dot == 0 || dot + 1 >= equals)
         throw UsageError(fmt::format("DEF.FIELD=VALUE was expected, not \"{}\"", v));
       o.definitions.push_back(v);
     },
     with(repeatable)},
    {"--compat", "LIST", "Change",
     "Follow other browsers instead of the standard. LIST is one or both of: scripts (a Script "
     "without directOutput TRUE may change nodes, as in the browsers of 1997), textures (a colour "
     "texture multiplies diffuseColor, as in X3D). --explain says what they change.",
     setCompat, with(inPresets)},
    {"--exact-shapes", "", "Change",
     "Draw Cylinder and Cone without facets, for lenses, pipes and mirrors. Spheres, ORTQuadric "
     "and "
     "ORTAsphere never have facets.",
     [](Options& o, const std::string&) { o.render.exactShapes = true; }, with(inPresets)},
    {"--step-error", "MM", "Change",
     "Divide the surfaces of STEP models into triangles that are at most MM millimetres away from "
     "them. Without it, MM is a thousandth of the size of each part.",
     [](Options& o, const std::string& v) {
       o.load.stepError = readNumber(v, xvrml::leastStepError, xvrml::mostStepError);
     }},
    {"--point-size", "SIZE", "Change",
     "Draw the points of PointSets, point clouds (PLY) and the like as balls of this diameter, in "
     "the units of their Shape. They are lit in their colours and cast shadows; without it they "
     "are "
     "a pixel wide and unlit.",
     [](Options& o, const std::string& v) { o.render.pointSize = readNumber(v, 0, 1e18); },
     with(inPresets)},
    {"--line-width", "WIDTH", "Change",
     "Draw lines as rods of this diameter, in the units of their Shape, as --point-size does with "
     "points.",
     [](Options& o, const std::string& v) { o.render.lineWidth = readNumber(v, 0, 1e18); },
     with(inPresets)},
    {"--old-world", "", "Change",
     "Show the world as browsers of the nineties did: the same as --compat scripts,textures "
     "--colour vrml97 --shadows off.",
     [](Options& o, const std::string&) {
       setCompat(o, "scripts,textures");
       o.render.linear = false;
       o.render.quality.set(RT_SHADOWS, 0);
     },
     with(inPresets)},
    {"--shader", "SELECTOR=CLASS[:PARAM=VALUE...]|@FILE", "Change",
     "Replace the surface shader of shapes: Ball=Glass:index=1.33, material:PIN-*=Metal. SELECTOR "
     "is a DEF name (of a shape, an appearance, a Material or a group), or material:GLOB, "
     "appearance:GLOB or shape:GLOB for all nodes with such DEF names, also in Inlines and "
     "prototypes, or kicad:GLOB for materials of KiCad's parts (kicad:PIN-*), which need no names, "
     "or colour:R,G,B[,SHININESS] for Materials of about this diffuseColor (and shininess), or * "
     "for all shapes that have no shader yet. CLASS is LIBRARY/CLASS for a "
     "class of a plug-in. The VALUE of a texture is a file name; @FILE as VALUE reads a text from "
     "a file. --shader @FILE reads rules, one a line. May be given several times; the last rule "
     "that selects a shape wins.",
     addShader, with(repeatable, inPresets)},
    {"--placeholders", "", "Change",
     "Draw a clear grey box in the place of each Inline that cannot be read, if its size is known: "
     "by its bboxSize, or by the name of a KiCad part (SOIC-8_3.9x4.9mm.wrl).",
     [](Options& o, const std::string&) { o.placeholders = true; }, with(inPresets)},
    {"--studio", "COLOUR", "Change",
     "Light a model as in a studio: soft boxes that stand where the camera stands, a ground that "
     "catches its shadow, and a backdrop of COLOUR (as for --background), instead of the world's "
     "Background. Lights of the world shine, too.",
     [](Options& o, const std::string& v) {
       try {
         const picture::Background read = picture::readBackground(v);
         if (read.kind != picture::Background::Kind::colour) throw std::invalid_argument("");
         o.render.studio = {true, read.colour};
       } catch (const std::invalid_argument&) {
         throw UsageError(fmt::format("a colour (a name such as white, #rgb, #rrggbb, or R,G,B "
                                      "from 0 to 1) was expected, not \"{}\"",
                                      v));
       }
     },
     with(inPresets, Purpose::surroundings)},
    {"--environment", "FILE[:INTENSITY]", "Change",
     "Light the world from all around with a picture of radiance (exr, hdr, pfm), instead of its "
     "Background. The picture is a longitude-latitude map with its middle towards -z; INTENSITY "
     "multiplies it.",
     [](Options& o, const std::string& v) {
       const size_t colon = v.rfind(':');
       const bool factor = colon != v.npos && colon > 0 && v.find('/', colon) == v.npos;
       o.render.environment = factor ? v.substr(0, colon) : v;
       if (factor)
         o.render.environmentIntensity = readNumber(std::string_view(v).substr(colon + 1), 0, 1e9);
       notEmpty(o.render.environment, "a file name");
     },
     with(inPresets, Purpose::surroundings)},
    {"--sky", "KIND[,KEY=VALUE...]", "Change",
     "Light the world with daylight, in cd/m2, instead of its Background: cie:TYPE (a standard "
     "sky, "
     "1 to 15; 16 is the traditional overcast one), perez:DIRECT/DIFFUSE (W/m2) or "
     "epw:FILE@MM-DDTHH:MM (a weather file). +y is up, -z north, +x east. Keys: "
     "sun=ALTITUDE/AZIMUTH in degrees, or place=LATITUDE/LONGITUDE and "
     "time=2026-06-21T12:00+02:00; lux and direct (illuminance by the sky of cie, default 10000, "
     "and by the sun), dew, ground (reflectance, default .2), north (degrees from -z to +x). "
     "docs/daylight.md tells more.",
     [](Options& o, const std::string& v) {
       try {
         o.render.sky = picture::readSky(v);
         o.skyText = v;
       } catch (const std::invalid_argument& wrong) {
         throw UsageError(wrong.what());
       } catch (const picture::InputError& wrong) {
         throw Failure{exitInput, fmt::format("--sky: {}", wrong.what())};
       }
     },
     with(Purpose::surroundings)},
    {"--threads", "N", "Quality",
     "Number of render threads; 0 (default) is as many as the process may use. The picture does "
     "not depend on it.",
     [](Options& o, const std::string& v) { o.render.threads = int(readInteger(v, 0, 1024)); }},
    {"--isa", "auto|NAME", "Quality",
     "Instruction set of the ray kernels: avx512, avx2, avx, sse4.2, sse2, or neon on ARM. auto "
     "(default) is the best one of this machine. Two machines give the same bytes with the same "
     "one, if their processors are of one maker (docs/accuracy.md). The workers of a cluster use "
     "it, too.",
     setIsa},
    {"--resume", "FILE", "Quality",
     "Keep the samples so far in FILE, and begin with those that it has. However the picture is "
     "interrupted, the same command goes on, and its picture has the same bytes in the end. "
     "--time-limit then ends this run (exit code 7), not the picture. FILE stays when the picture "
     "is done (docs/long-renders.md).",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       if (v == "-") throw UsageError("a file name was expected, not -: the file is read again");
       o.resume = v;
     }},
    {"--resume-every", "SECONDS", "Quality",
     "Write the file of --resume so often (default 60), but never more than 2 % of the time.",
     [](Options& o, const std::string& v) { o.resumeEvery = readNumber(v, 0, 1e6); }},
    {"--sums", "", "Quality",
     "Put the exact sums of the samples behind the pixels of EXR files, so that vv merge can add "
     "pictures of other seeds to them. The file then is about ten times as large.",
     [](Options& o, const std::string&) { o.sums = true; }},
    {"--check", "", "Inspect",
     "Read the world and report every problem, without making a picture. The exit code is 4 if "
     "there is any problem.",
     [](Options& o, const std::string&) { o.check = true; },
     with(excludes("-o", "--check makes no picture: it cannot be used with {}"))},
    {"--strict", "", "Inspect",
     "Stop at any problem of the world, with exit code 4, or 5 if a plug-in or a texture is "
     "missing.",
     [](Options& o, const std::string&) { o.strict = true; }},
    {"--info", "", "Inspect", "Describe the world: nodes, bounds, viewpoints, Scripts, problems.",
     ask<Job::info>},
    {"--list-nodes", "", "Inspect",
     "List the node types with their fields; with a FILE also the prototypes it declares.",
     ask<Job::listNodes>},
    {"--list-viewpoints", "", "Inspect", "List the viewpoints of the world.",
     ask<Job::listViewpoints>},
    {"--list-shaders", "", "Inspect",
     "List the classes of all shader plug-ins with their parameters.", ask<Job::listShaders>},
    {"--list-engines", "", "Inspect",
     "List the script engines: the programs they run, whether they need --trust, and the library "
     "they come from.",
     ask<Job::listEngines>},
    {"--list-features", "", "Inspect",
     "List what of vv depends on libraries that need not be there: Open Image Denoise, the window, "
     "films, vv serve, script engines and their sandbox; and how to get what is missing.",
     ask<Job::listFeatures>},
    {"--list-keys", "", "Inspect", "List what keys and mouse do in the window.",
     ask<Job::listKeys>},
    {"--explain", "", "Inspect",
     "Print the light transport algorithm and why it was chosen, the materials with the rule of "
     "--shader or a preset that each gets its shader from, and the objects that the world is "
     "rendered as: each with the reason, its triangles, bytes and instances.",
     ask<Job::explain>},
    {"--json", "", "Inspect", "Print --info, --explain, the lists and vv compare as JSON.",
     [](Options& o, const std::string&) { o.json = true; }},
    {"--stats", "FILE", "Inspect",
     "Write statistics as JSON, one file for a whole sequence; - is standard output. image.spp is "
     "the "
     "maximum number of samples per pixel, image.spp_mean the mean number taken; error.half_width "
     "is "
     "what --error is compared with (docs/error-bars.md).",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.stats = v;
     },
     with(needs("-o"))},
    {"--compare", "REF.exr", "Inspect",
     "Compare the picture with another one of the same size and view: RMSE, relMSE, bias with its "
     "interval, largest difference. -o is not needed.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "an OpenEXR file");
       o.compare = v;
     }},
    {"--measure", "FILE", "Inspect",
     "Write what the ORTSensors of the world read, in lux, cd/m2 and UGR with their 95 % "
     "intervals, "
     "as .csv, .json or a page .html; - is CSV on standard output. --spp (default here 4096), "
     "--error and "
     "--time-limit say how many samples each point gets (docs/photometry.md). -o is not needed.",
     [](Options& o, const std::string& v) {
       if (v != "-" && !v.ends_with(".csv") && !v.ends_with(".json") && !v.ends_with(".html"))
         throw UsageError(fmt::format("a file name that ends in .csv, .json or .html was expected, "
                                      "or -, not \"{}\"",
                                      v));
       o.measure = v;
     },
     with(excludes("--studio", "--measure reads the light of the world: it cannot be used with {}"),
          excludes("--audit,--frames,--turntable,--viewpoint all,--watch,--record",
                   "--measure reads the sensors of one moment: it cannot be used with {}"))},
    {"--audit", "[N]", "Inspect",
     "Test the error bars: render the picture with N seeds (default 20) and once with many more "
     "samples (or read the picture of --compare instead), and print how many of the 95 % intervals "
     "contain the true value. The exit code is 4 if these are not 93 to 97 % of the trusted "
     "intervals, or if pictures whose paths find emitters by hitting them alone have more light.",
     [](Options& o, const std::string& v) {
       o.audit = v.empty() ? 20 : int(readInteger(v, 2, 10000));
     },
     with(excludes("--frames,--turntable", "--audit tests one picture: it cannot be used with {}"),
          excludes("--time-limit",
                   "--audit cannot be used with {}, whose pictures differ from run to run"),
          excludes("--crop", "--audit tests whole pictures: it cannot be used with {}"))},
    {"--watch", "", "Inspect",
     "Make the pictures again whenever the world's file, or one that it uses, changes, until "
     "interrupted. In the window, reload the world and keep the view.",
     [](Options& o, const std::string&) { o.watch = true; }, with(needs("-o,the window,vv serve"))},
    {"--samples", "N,M", "Inspect",
     "Samples per pixel of the two pictures of vv compare. With the same number twice they "
     "have equal noise, and small changes are found best; with --variance, the variances are "
     "divided by them.",
     [](Options& o, const std::string& v) { o.compared.samples = readSamplesOfTwo(v); },
     with(needs("vv compare", samplesNeed))},
    {"--variance", "", "Inspect",
     "Judge single pixels by the channel variance of both files, which is that of "
     "the pixel, or of its samples if a channel or --samples has their number.",
     nullptr, with(needs("vv compare"))},
    {"--write", "FILE", "Write",
     "Write the world: .x3dv gives X3D in the ClassicVRML encoding, .x3d X3D in XML, .x3dj and "
     ".json X3D in JSON, .glb and .gltf glTF, .stl, .ply and .obj meshes (docs/export.md), every "
     "other name VRML97. FORMAT:FILE "
     "(wrl, "
     "x3dv, glb, ...) selects it for any name; - is standard output.",
     setWrite},
    {"--record", "FILE", "Write", "Write the scene as OpenRT edits, for openrt-replay.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.render.record = v;
     },
     with(needs("-o"),
          excludes("--viewpoint all,--frames,--turntable",
                   "--record writes the scene of one picture: it cannot be used with {}"))},
    {"--port", "N", "Page",
     "Port of the page of vv serve (default 8097); 0 is any free one. The address is printed.",
     [](Options& o, const std::string& v) { o.serve.port = int(readInteger(v, 0, 65535)); },
     with(needs("vv serve", pageNeeds))},
    {"--address", "ADDRESS", "Page",
     "IP address of this machine at which vv serve can be reached, such as 0.0.0.0 for all. "
     "Without it the page can be opened on this machine alone. Needs --token (docs/serve.md).",
     [](Options& o, const std::string& v) {
       notEmpty(v, "an IP address");
       o.serve.address = v;
     },
     with(needs("vv serve", pageNeeds))},
    {"--token", "new|@FILE|TOKEN", "Page",
     "Show the page only to those who have a token: new makes one and prints it, @FILE reads it "
     "from a file. $VV_TOKEN is used without this option.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "new, @FILE or a token");
       o.serve.token = v;
     },
     with(needs("vv serve", pageNeeds))},
    {"--edit", "", "Page",
     "Let those edit the world who open the second address that vv serve prints (docs/serve.md).",
     [](Options& o, const std::string&) { o.serve.edit = true; },
     with(needs("vv serve", pageNeeds))},
    {"--control", "ADDRESS", "Control",
     "Let programs read and change the world, by lines of JSON at this address: 127.0.0.1:PORT, "
     ":PORT, unix:PATH, or with --key FILE also HOST:PORT for other machines; port 0 is any free "
     "one. The address is printed (docs/control.md).",
     [](Options& o, const std::string& v) {
       notEmpty(v, "an address");
       o.control = v;
     },
     with(needs("the window",
                "--control cannot be used with -o, vv serve, --check, --write or a list"))},
    {"--no-window", "", "Control",
     "With --control: run the world without a window; pictures are rendered when a program asks.",
     [](Options& o, const std::string&) { o.noWindow = true; },
     with(needs("--control", "--no-window needs {} (-o makes a picture without a window)"),
          excludes("--input,--record-input,--watch"))},
    {"--limit", "NAME=VALUE", "Trust",
     "Raise or lower a limit on the memory and work that a world may need; a wrong NAME prints the "
     "list of limits. May be given several times.",
     setLimit, with(repeatable)},
    {"--allow-absolute", "", "Trust", "Follow absolute paths and file: URLs named inside a world.",
     [](Options& o, const std::string&) { o.load.allowAbsolute = true; }},
    {"--shader-path", "DIR[:DIR...]", "Trust", "Folders to search first for shader plug-ins.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.render.shaderPath = v;
     }},
    {"--trust", "", "Trust",
     "Let Scripts use engines whose programs can do whatever you can (native:, python:, Tk "
     "windows; --list-engines says which).",
     [](Options& o, const std::string&) { o.running.trustScripts = true; }},
    {"--allow-net", "", "Trust", "Let Scripts use the network, if their engine supports it.",
     [](Options& o, const std::string&) { o.running.allowNetwork = true; }},
    {"--script-path", "DIR[:DIR...]", "Trust",
     "Folders to search for script engines, before $XVRML_SCRIPT_PATH and the installed ones. "
     "Folders that other users may write to are refused.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.running.scriptPath = v;
     }},
    {"--node-path", "DIR[:DIR...]", "Trust",
     "Folders to search for node plug-ins, before $XVRML_NODE_PATH and the installed ones.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.nodePath = v;
     }},
    {"-q,--quiet", "", "Talk", "Print errors only.",
     [](Options& o, const std::string&) { o.quiet = true; },
     with(excludes("--verbose", "only one of --quiet and {} can be used"))},
    {"-v,--verbose", "", "Talk", "Print every warning, and times.",
     [](Options& o, const std::string&) { o.verbose = true; }},
    {"--version", "", "Talk", "Print the version.", ask<Job::version>},
    {"-h,--help", "[TOPIC]", "Talk",
     "Print a short help; with a topic, an option or all, what there is to say about it.",
     [](Options& o, const std::string& v) {
       o.jobs.push_back(Job::help);
       o.helpTopic = v == "-" ? "" : v;
     }},
};

} // namespace

std::span<const OptionInfo> optionTable() {
  static const std::vector<OptionInfo> all = [] {
    std::vector<OptionInfo> rows(std::begin(table), std::end(table));
    const auto insertBefore = [&](std::string_view group, std::span<const OptionInfo> more) {
      const auto place = std::find_if(rows.begin(), rows.end(),
                                      [&](const OptionInfo& o) { return o.group == group; });
      rows.insert(place, more.begin(), more.end());
    };
    insertBefore("Quality", qualityOptions());
    insertBefore("Inspect", clusterOptions());
    return rows;
  }();
  return all;
}

} // namespace vv
