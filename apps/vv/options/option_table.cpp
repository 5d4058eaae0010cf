// option_table.cpp: Defines every option of vv: names, argument, help text and effect. The options
// of the group Cluster are in cluster_options.cpp, those of quality settings in
// quality_options.cpp.
#include "options.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include <fmt/format.h>

#include "names.h"
#include "nearest.h"

namespace vv {

namespace {

using xvrml::MapOptions;

void addOutput(Options& o, const std::string& value) {
  if (value == "-") return o.outputs.push_back({"-", picture::Format::png});
  // FORMAT:FILE selects the format for names with another suffix, or without one.
  if (const size_t colon = value.find(':'); colon != value.npos && colon + 1 < value.size()) {
    const std::string file = value.substr(colon + 1);
    if (const auto format = picture::formatNamed(value.substr(0, colon))) {
      if (file != "-") checkFramePlace(file);
      return o.outputs.push_back({file, *format});
    }
    if (picture::filmOf("film." + value.substr(0, colon)) != picture::FilmKind::none)
      throw UsageError(fmt::format("a film is known by its suffix: -o {}.{}, not \"{}\"", file,
                                   value.substr(0, colon), value));
  }
  checkFramePlace(value);
  if (const picture::FilmKind film = picture::filmOf(value); film != picture::FilmKind::none)
    return o.outputs.push_back({value, {}, film});
  auto format = picture::formatOf(value);
  if (!format)
    throw UsageError(
        fmt::format("a file name with one of the suffixes {}, {} was expected, not \"{}\"",
                    picture::formatNames, picture::filmSuffixes, value));
  o.outputs.push_back({value, *format});
}

void setHeadlight(Options& o, const std::string& value) {
  if (value == "auto")
    o.render.headlight = MapOptions::Headlight::automatic;
  else if (value == "on" || value == "off")
    o.render.headlight = value == "on" ? MapOptions::Headlight::on : MapOptions::Headlight::off;
  else
    throw UsageError(fmt::format("on, off or auto was expected, not \"{}\"", value));
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

void setChannels(Options& o, const std::string& value) {
  uint32_t channels = 0;
  std::string known;
  for (const picture::Channel& channel : picture::channelTable())
    known += (known.empty() ? "" : ",") + std::string(channel.name);
  for (std::string_view name : split(value, ',')) {
    const picture::Channel* channel = picture::findChannel(name);
    if (!channel)
      throw UsageError(fmt::format("channels out of {} were expected, not \"{}\"", known, name));
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

void notEmpty(const std::string& value, const char* what) {
  if (value.empty()) throw UsageError(fmt::format("{} was expected", what));
}

const OptionInfo table[] = {
    {"-o,--output", "FILE", "Picture",
     "Picture to write; the format is that of the suffix (exr, png, jpg, ppm, pfm). FORMAT:FILE "
     "says it where the suffix does not. - is standard output (PNG; exr:- and so on for another "
     "format). Of a sequence {frame:4} in the name is the number with four digits, and mp4, webm "
     "or gif makes a film. May be given several times.",
     addOutput, true},
    {"--size", "WxH", "Picture", "Size in pixels, of pictures and of the window (default 800x600).",
     [](Options& o, const std::string& v) { readSize(v, o.render.width, o.render.height); }},
    {"--channels", "LIST", "Picture",
     "Channels of an EXR file, out of rgba, z, normal, albedo, position, id, samples, variance, "
     "error, trust (default rgba). error and trust: the 95 % interval of each colour and whether "
     "it can be trusted; asking for them changes how the samples are made.",
     setChannels},
    {"--colour,--color", "linear|vrml97", "Picture",
     "linear (default): colours of the file are decoded from sRGB, light adds up linearly, PNG, "
     "JPEG and PPM get the sRGB curve. vrml97: the standard's equation on the numbers as written, "
     "no curve anywhere.",
     setColour},
    {"--background", "none|COLOUR|FILE", "Picture",
     "What shows where nothing is drawn; the world's Background is not there then, in mirrors "
     "neither. none: nothing; a PNG has alpha. COLOUR: a name (white), #rgb, #rrggbb, or R,G,B "
     "from 0 to 1. FILE: a picture that covers the whole frame (png, jpg, gif; exr, hdr, pfm).",
     setBackground},
    {"--viewpoint", "NAME|N|all", "View",
     "Look from this viewpoint: DEF name, description or number from 0 (default: the first). all: "
     "a picture each; {viewpoint} in the file name, or else a suffix, tells them apart.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a name, a number or all");
       o.viewpoint = v;
     }},
    {"--camera", "PX,PY,PZ:TX,TY,TZ[:UX,UY,UZ]", "View",
     "Look from a position at a target, with this up vector (default: the axis of --up, or else "
     "0,1,0). With --fit: in this direction, from as far away as all of the world is in the "
     "picture.",
     [](Options& o, const std::string& v) { o.view.lookAt = readCamera(v); }},
    {"--fit", "", "View",
     "Place the camera so that the whole world is seen: in the direction of the first Viewpoint or "
     "of --camera; in a world without Viewpoint from three quarters, which is the default there.",
     [](Options& o, const std::string&) { o.view.fit = true; }},
    {"--up", "x|y|z|-x|-y|-z", "View",
     "The axis that points up: of the view from three quarters, of --turntable and of --camera "
     "(default: y in a world with a Viewpoint; else guessed from what wrote the file and how it "
     "lies, --info says it).",
     [](Options& o, const std::string& v) { o.view.up = readAxis(v); }},
    {"--fov", "DEGREES", "View",
     "The smaller of the two angles of view, instead of the viewpoint's.",
     [](Options& o, const std::string& v) { o.view.fov = readNumber(v, 0, 180); }},
    {"--camera-shader", "CLASS[:PARAM=VALUE...]", "View",
     "Another camera at the same place: ThinLens:radius=.1:focus=5 (depth of field), Panorama "
     "(everything around).",
     [](Options& o, const std::string& v) { o.cameraShader = v; }},
    {"--headlight", "on|off|auto", "View",
     "Light at the camera; auto (default): as NavigationInfo says. A world without Viewpoint, "
     "NavigationInfo and lights gets three soft lights about the camera instead.",
     setHeadlight},
    {"--time", "SECONDS", "Time",
     "The world so long after it was loaded (default 0). Time goes in steps of 1/fps up to here, "
     "as in a sequence; no wall clock is read.",
     [](Options& o, const std::string& v) { o.time = readSeconds(v); }},
    {"--epoch", "SECONDS|now", "Time",
     "When the world is loaded, in seconds since 1970, which startTime and Scripts count in. "
     "Default 1729728000 (24 October 2024), always the same for reproducible pictures; in the "
     "window now, the clock of this machine.",
     [](Options& o, const std::string& v) {
       o.epoch = v == "now" ? secondsSince1970() : readNumber(v, -1, 1e11);
     }},
    {"--frames", "A-B[/STEP]", "Time",
     "A picture of each frame from A to B: frame N shows the world at N/fps seconds, and is the "
     "same picture in any sequence that holds it. The number is put where {frame:4} stands in the "
     "file name, or else before its suffix.",
     [](Options& o, const std::string& v) { o.frames = readFrames(v); }},
    {"--fps", "F", "Time",
     "Frames a second, of sequences, films and the window, and steps of the world's clock (default "
     "30).",
     [](Options& o, const std::string& v) { o.fps = readNumber(v, 0.001, 100000); }},
    {"--turntable", "N", "Time",
     "N pictures, once around the axis that points up (--up) through the world's centre, from the "
     "chosen view on.",
     [](Options& o, const std::string& v) { o.turntable = int(readInteger(v, 1, 100000)); }},
    {"--input", "FILE", "Time",
     "What somebody does to the world, from a script instead of mouse and keys: a line each, "
     "SECONDS and what happens (move X Y, press left, release left, key PageDown, viewpoint NAME "
     "...; docs/window.md). Time goes in steps of 1/fps from 0, so that the same script makes the "
     "same pictures, in the window and with -o (which by default shows the world at the script's "
     "end).",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.inputScript = v;
     }},
    {"--record-input", "FILE", "Time",
     "Write down what is done in the window, for --input. Time begins at 0.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.recordInput = v;
     }},
    {"-D,--define", "DEF.FIELD=VALUE", "Change",
     "Give a field of a node with a DEF name another value before rendering, in VRML's own "
     "spelling (Door.translation='0 0 2', Sign.string='\"open\"'). May be given several times.",
     [](Options& o, const std::string& v) {
       const size_t equals = v.find('=');
       const size_t dot = v.find('.');
       if (equals == v.npos || dot == v.npos || dot == 0 || dot + 1 >= equals)
         throw UsageError(fmt::format("DEF.FIELD=VALUE was expected, not \"{}\"", v));
       o.definitions.push_back(v);
     },
     true},
    {"--compat", "LIST", "Change",
     "Habits of other browsers instead of the standard's rules, out of scripts (a Script without "
     "directOutput TRUE may change nodes, as in the browsers of 1997), textures (a colour texture "
     "multiplies diffuseColor, as in X3D). --explain says what they change.",
     setCompat},
    {"--old-world", "", "Change",
     "As browsers of the nineties showed it: --compat scripts,textures --colour vrml97 --shadows "
     "off.",
     [](Options& o, const std::string&) {
       setCompat(o, "scripts,textures");
       o.render.linear = false;
       o.render.quality.set(RT_SHADOWS, 0);
     }},
    {"--shader", "DEF=CLASS[:PARAM=VALUE...]", "Change",
     "Give a shape, the shapes of an appearance or all below a group another surface shader: "
     "Ball=Glass:index=1.33, Wall=Diffuse:reflectance=.8,.1,.1. * stands for all shapes without a "
     "shader of their own, LIBRARY/CLASS for a class of a plug-in. A texture is a file, @FILE the "
     "content of one. May be given several times.",
     [](Options& o, const std::string& v) {
       const size_t equals = v.find('=');
       if (equals == v.npos || equals == 0)
         throw UsageError(fmt::format("DEF=CLASS[:PARAM=VALUE...] was expected, not \"{}\"", v));
       o.shaders.push_back(v);
     },
     true},
    {"--environment", "FILE[:INTENSITY]", "Change",
     "Light from all around instead of the world's Background: a picture of radiance (exr, hdr, "
     "pfm), columns of equal longitude, its middle towards -z.",
     [](Options& o, const std::string& v) {
       const size_t colon = v.rfind(':');
       const bool factor = colon != v.npos && colon > 0 && v.find('/', colon) == v.npos;
       o.render.environment = factor ? v.substr(0, colon) : v;
       if (factor)
         o.render.environmentIntensity = readNumber(std::string_view(v).substr(colon + 1), 0, 1e9);
       notEmpty(o.render.environment, "a file name");
     }},
    {"--threads", "N", "Quality",
     "Render threads; 0 (default): as many as the process may use. The picture does not depend on "
     "it.",
     [](Options& o, const std::string& v) { o.render.threads = int(readInteger(v, 0, 1024)); }},
    {"--check", "", "Inspect",
     "Read the world, report every problem, make no picture; exit code 4 if there is any.",
     [](Options& o, const std::string&) { o.check = true; }},
    {"--strict", "", "Inspect",
     "Any problem of the world ends the program: exit code 4, or 5 for a plug-in or a texture that "
     "is missing.",
     [](Options& o, const std::string&) { o.strict = true; }},
    {"--info", "", "Inspect", "Say what the world holds.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::info); }},
    {"--list-nodes", "", "Inspect",
     "List the node types with their fields; with a FILE also the prototypes it declares.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::listNodes); }},
    {"--list-viewpoints", "", "Inspect", "List the viewpoints of the world.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::listViewpoints); }},
    {"--list-shaders", "", "Inspect",
     "List the classes of all shader plug-ins with their parameters.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::listShaders); }},
    {"--list-engines", "", "Inspect",
     "List the script engines: what they serve, whether they need --trust, the library they come "
     "from.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::listEngines); }},
    {"--list-keys", "", "Inspect", "List what keys and mouse do in the window.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::listKeys); }},
    {"--explain", "", "Inspect",
     "Say how light is followed and why, and what objects the world is rendered as: each with the "
     "reason, its triangles, bytes and instances.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::explain); }},
    {"--json", "", "Inspect", "--info, --explain and the lists as JSON.",
     [](Options& o, const std::string&) { o.json = true; }},
    {"--stats", "FILE", "Inspect",
     "Write statistics as JSON, one file for a whole sequence; - is standard output.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.stats = v;
     }},
    {"--compare", "REF.exr", "Inspect",
     "Say how far the picture is off another one of the same size and view: RMSE, relMSE, bias "
     "with its interval, largest difference. -o is not needed.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "an OpenEXR file");
       o.compare = v;
     }},
    {"--audit", "[N]", "Inspect",
     "Do the error bars hold? Renders the picture with N seeds (default 20) and once with many "
     "more samples (or takes the picture of --compare instead), and says how many of the 95 % "
     "intervals hold the truth. Exit code 4 if it is not 93 to 97 % of those that are trusted.",
     [](Options& o, const std::string& v) {
       o.audit = v.empty() ? 20 : int(readInteger(v, 2, 10000));
     }},
    {"--watch", "", "Inspect",
     "Make the pictures again whenever the world's file, or one that it uses, changes, until "
     "interrupted; in the window: read it again, the viewer stays.",
     [](Options& o, const std::string&) { o.watch = true; }},
    {"--write", "FILE", "Write", "Write the world as VRML97; - is standard output.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.write = v;
     }},
    {"--record", "FILE", "Write", "Keep the scene as OpenRT edits, for openrt-replay.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a file name");
       o.render.record = v;
     }},
    {"--limit", "NAME=VALUE", "Trust",
     "Raise or lower a limit on what a world may cost; a wrong name lists them. May be given "
     "several times.",
     setLimit, true},
    {"--allow-absolute", "", "Trust", "Follow absolute paths and file: URLs named inside a world.",
     [](Options& o, const std::string&) { o.load.allowAbsolute = true; }},
    {"--shader-path", "DIR[:DIR...]", "Trust", "Folders where shader plug-ins are looked up first.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.render.shaderPath = v;
     }},
    {"--trust", "", "Trust",
     "Scripts may use engines whose programs can do whatever you can (native:, python:, Tk "
     "windows; --list-engines says which).",
     [](Options& o, const std::string&) { o.running.trustScripts = true; }},
    {"--allow-net", "", "Trust", "Scripts may use the network, as far as their engine can.",
     [](Options& o, const std::string&) { o.running.allowNetwork = true; }},
    {"--script-path", "DIR[:DIR...]", "Trust",
     "Folders where script engines are looked up, before $XVRML_SCRIPT_PATH and the installed "
     "ones; nothing that others may write or replace.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.running.scriptPath = v;
     }},
    {"--node-path", "DIR[:DIR...]", "Trust",
     "Folders where node plug-ins are looked up, before $XVRML_NODE_PATH and the installed ones.",
     [](Options& o, const std::string& v) {
       notEmpty(v, "a folder");
       o.nodePath = v;
     }},
    {"-q,--quiet", "", "Talk", "Errors only.",
     [](Options& o, const std::string&) { o.quiet = true; }},
    {"-v,--verbose", "", "Talk", "Every warning, and times.",
     [](Options& o, const std::string&) { o.verbose = true; }},
    {"--version", "", "Talk", "The version.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::version); }},
    {"-h,--help", "", "Talk", "This text.",
     [](Options& o, const std::string&) { o.jobs.push_back(Job::help); }},
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
